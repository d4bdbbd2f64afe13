// Scene nodes: the records of a VOX file's scene graph as they are read, before they are followed
// (scene_graph.hpp).
//
//     nTRN transform -> nGRP group -> nTRN ... -> nSHP shape -> models
#pragma once

#include <pfvox/error.hpp>
#include <string_view>
#include <vector>

#include "import/vox/chunks.hpp"
#include "import/vox/rotation.hpp"

namespace pfvox::import::vox {

/// A step key of an animated transform: p -> rotation * p + translation in VOX axes (z up), voxels.
struct TransformKey {
    std::int32_t frame = 0;
    GridTransform parentFromChild;
};

/// A step key of an animated shape.
struct ShapeKey {
    std::int32_t frame = 0;
    std::int32_t model = 0;
};

struct Node {
    enum class Kind : std::uint8_t { Transform, Group, Shape };

    Kind kind = Kind::Group;
    std::int32_t id = 0;
    std::string_view chunkId;       ///< for messages
    std::uint64_t offsetBytes = 0;  ///< of its chunk
    std::string_view name;          ///< `_name`; a view into the file's bytes
    bool hidden = false;
    bool loops = false;                       ///< keys repeat after the last one
    std::int32_t layerId = -1;                ///< transforms only; -1 = none
    std::vector<std::int32_t> children;       ///< one of a transform, any number of a group
    std::vector<TransformKey> transformKeys;  ///< of a transform, at least one
    std::vector<ShapeKey> shapeKeys;          ///< of a shape, perhaps none

    [[nodiscard]] tl::unexpected<Error> fail(ErrorCode code, std::string message) const;
};

/// Reads chunk nTRN, nGRP or nSHP. Errors: Truncated, BadValue (rotation, translation, counts), each with the
/// node id.
Result<Node> readNode(Chunk& chunk);

struct LayerRecord {
    std::int32_t id = 0;
    std::string_view name;
    bool hidden = false;
};

/// Reads chunk LAYR.
Result<LayerRecord> readLayer(Chunk& chunk);

/// The key that holds at `frame`: the one with the largest frame not after it, else the earliest. With
/// `loops` the frames after the last key continue from the first. Of keys with equal frames the first counts.
/// `keys` is not empty.
template <class Key>
const Key& keyAt(const std::vector<Key>& keys, std::int64_t frame, bool loops) {
    const Key* earliest = &keys.front();
    const Key* last = &keys.front();
    for (const Key& key : keys) {
        if (key.frame < earliest->frame) earliest = &key;
        if (key.frame > last->frame) last = &key;
    }
    const std::int64_t first = earliest->frame;
    const std::int64_t period = last->frame - first + 1;
    if (loops && frame > last->frame) frame = first + (frame - first) % period;
    const Key* best = earliest;
    for (const Key& key : keys) {
        if (key.frame <= frame && key.frame > best->frame) best = &key;
    }
    return *best;
}

}  // namespace pfvox::import::vox

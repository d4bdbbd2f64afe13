#include "import/vox/scene_nodes.hpp"

#include <fmt/format.h>

namespace pfvox::import::vox {

namespace {

constexpr std::size_t kMaxNameBytes = 4096;

tl::unexpected<Error> failAtNode(const Chunk& chunk, std::int32_t id, std::string_view message) {
    return chunk.fail(ErrorCode::BadValue, fmt::format("node {}: {}", id, message));
}

Result<std::string_view> readName(const Chunk& chunk, std::int32_t id, const Dict& attributes) {
    const std::string_view name = attributes.find("_name").value_or("");
    if (name.size() > kMaxNameBytes) {
        return failAtNode(
            chunk, id,
            fmt::format("its name has {} bytes; at most {} are accepted", name.size(), kMaxNameBytes));
    }
    return name;
}

/// `_f`, the frame at which a key begins to hold.
Result<std::int32_t> readFrame(const Chunk& chunk, std::int32_t id, const Dict& attributes) {
    const auto text = attributes.find("_f");
    if (!text) return 0;
    const auto frame = parseInt(*text);
    if (!frame) return failAtNode(chunk, id, fmt::format("_f \"{}\" is no frame number", *text));
    return *frame;
}

Result<TransformKey> readTransformKey(Chunk& chunk, std::int32_t id) {
    PFVOX_TRY(const Dict, attributes, chunk.readDict("the attributes of a frame"));
    PFVOX_TRY(const std::int32_t, frame, readFrame(chunk, id, attributes));
    TransformKey key{.frame = frame, .parentFromChild = {}};
    if (const auto text = attributes.find("_r")) {
        const auto byte = parseInt(*text);
        const auto rotation = byte ? decodeRotation(*byte) : std::nullopt;
        if (!rotation) {
            return failAtNode(
                chunk, id,
                fmt::format("_r \"{}\" is no rotation: its rows must name different columns; the file is "
                            "damaged or was written wrongly",
                            *text));
        }
        key.parentFromChild.rotation = *rotation;
    }
    if (const auto text = attributes.find("_t")) {
        const auto t = parseInt3(*text);
        if (!t) {
            return failAtNode(chunk, id,
                              fmt::format("_t \"{}\" is no translation: three whole numbers are", *text));
        }
        key.parentFromChild.translation = {(*t)[0], (*t)[1], (*t)[2]};
    }
    return key;
}

Result<void> readTransform(Chunk& chunk, Node& node) {
    constexpr std::size_t kLeastFrameBytes = 4;  // an empty dictionary
    PFVOX_TRY(const std::int32_t, child, chunk.readInt("the child's id"));
    node.children.push_back(child);
    PFVOX_CHECK(chunk.readInt("the reserved id"));
    PFVOX_TRY(const std::int32_t, layer, chunk.readInt("the layer id"));
    node.layerId = layer;
    PFVOX_TRY(const std::uint32_t, frames, chunk.readCount(kLeastFrameBytes, "the number of frames"));
    for (std::uint32_t i = 0; i < frames; ++i) {
        PFVOX_TRY(TransformKey, key, readTransformKey(chunk, node.id));
        node.transformKeys.push_back(key);
    }
    if (node.transformKeys.empty()) node.transformKeys.emplace_back();
    return {};
}

Result<void> readGroup(Chunk& chunk, Node& node) {
    PFVOX_TRY(const std::uint32_t, count, chunk.readCount(sizeof(std::int32_t), "the number of children"));
    for (std::uint32_t i = 0; i < count; ++i) {
        PFVOX_TRY(const std::int32_t, child, chunk.readInt("a child's id"));
        node.children.push_back(child);
    }
    return {};
}

Result<void> readShape(Chunk& chunk, Node& node) {
    constexpr std::size_t kLeastModelBytes = 8;  // an id and an empty dictionary
    PFVOX_TRY(const std::uint32_t, count, chunk.readCount(kLeastModelBytes, "the number of models"));
    for (std::uint32_t i = 0; i < count; ++i) {
        PFVOX_TRY(const std::int32_t, model, chunk.readInt("a model's id"));
        PFVOX_TRY(const Dict, attributes, chunk.readDict("the attributes of a model"));
        PFVOX_TRY(const std::int32_t, frame, readFrame(chunk, node.id, attributes));
        node.shapeKeys.push_back({.frame = frame, .model = model});
    }
    return {};
}

}  // namespace

tl::unexpected<Error> Node::fail(ErrorCode code, std::string message) const {
    return failAt(code, offsetBytes, "chunk " + std::string(chunkId), std::move(message));
}

Result<Node> readNode(Chunk& chunk) {
    PFVOX_TRY(const std::int32_t, id, chunk.readInt("the node id"));
    PFVOX_TRY(const Dict, attributes, chunk.readDict("the node's attributes"));
    PFVOX_TRY(const std::string_view, name, readName(chunk, id, attributes));
    Node node;
    node.id = id;
    node.chunkId = chunk.id();
    node.offsetBytes = chunk.offsetBytes();
    node.name = name;
    node.hidden = attributes.flag("_hidden");
    node.loops = attributes.flag("_loop");
    if (chunk.id() == "nTRN") {
        node.kind = Node::Kind::Transform;
        PFVOX_CHECK(readTransform(chunk, node));
    } else if (chunk.id() == "nGRP") {
        node.kind = Node::Kind::Group;
        PFVOX_CHECK(readGroup(chunk, node));
    } else {
        node.kind = Node::Kind::Shape;
        PFVOX_CHECK(readShape(chunk, node));
    }
    return node;
}

Result<LayerRecord> readLayer(Chunk& chunk) {
    PFVOX_TRY(const std::int32_t, id, chunk.readInt("the layer id"));
    PFVOX_TRY(const Dict, attributes, chunk.readDict("the layer's attributes"));
    PFVOX_TRY(const std::string_view, name, readName(chunk, id, attributes));
    // Files before version 0.99 say `_visible` instead.
    const auto visible = attributes.find("_visible");
    const bool hidden = attributes.flag("_hidden") || (visible && !attributes.flag("_visible"));
    return LayerRecord{.id = id, .name = name, .hidden = hidden};
}

}  // namespace pfvox::import::vox

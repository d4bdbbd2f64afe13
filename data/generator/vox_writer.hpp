// Writes MagicaVoxel files with models, materials, layers and a scene graph.
//
// Only the bytes of chunks are the library's: placement and numbering are of their own, so that an error of
// the importer cannot hide behind the same error in the exporter. z is up, as in MagicaVoxel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "canvas.hpp"
#include "palette.hpp"

namespace pfvox::demo {

/// A signed permutation of the axes: row i of the matrix has `sign[i]` in column `column[i]`. world = R *
/// model.
struct Rotation {
    glm::ivec3 column{0, 1, 2};
    glm::ivec3 sign{1};

    glm::ivec3 operator*(glm::ivec3 v) const {
        return {sign.x * v[column.x], sign.y * v[column.y], sign.z * v[column.z]};
    }
    /// The `_r` byte of the file format.
    int code() const;
};

/// Quarter turns about the vertical axis, counter-clockwise seen from above.
Rotation turned(int quarters);
/// Left and right exchanged.
Rotation mirroredX();

/// One node of the scene: a model or a group of further nodes, placed.
struct Node {
    std::string name;
    int model = -1;  ///< index of the model; -1 = group
    std::vector<Node> children;
    Rotation rotation{};
    glm::ivec3 translation{0};  ///< where the middle voxel of the model or the origin of the group goes
    int layer = 0;
};

/// A node that puts the lowest corner of a model, after its rotation, at `corner`.
Node placeAtCorner(const std::string& name, int model, glm::ivec3 modelSize, glm::ivec3 corner,
                   Rotation rotation = {});

struct LayerText {
    std::string name;
    bool hidden = false;
};

struct VoxScene {
    std::vector<Canvas> models;
    std::vector<Node> nodes;  ///< empty: a file without a scene graph
    std::vector<LayerText> layers;
};

/// The bytes of a .vox file. Equal scenes give equal bytes.
std::string writeVox(const VoxScene& scene, const Palette& palette);

}  // namespace pfvox::demo

#include "import/vdb/grid_placement.hpp"

namespace pfvox::import::vdb {

namespace {

/// OpenVDB's values sit at whole coordinates, so voxel i covers [i - 0.5, i + 0.5]; ours covers [i, i + 1].
Affine indexFromModel(UpAxis up) {
    Affine affine{1.0};
    if (up == UpAxis::Z) {
        affine[0] = {1.0, 0.0, 0.0};
        affine[1] = {0.0, 0.0, 1.0};
        affine[2] = {0.0, -1.0, 0.0};
    }
    affine[3] = glm::dvec3{-0.5};
    return affine;
}

/// The frame of the file, z or y up, to ours.
Affine worldFromFile(UpAxis up) {
    Affine affine{1.0};
    if (up == UpAxis::Z) {
        affine[1] = {0.0, 0.0, -1.0};
        affine[2] = {0.0, 1.0, 0.0};
    }
    return affine;
}

Affine fileFromIndex(const openvdb::math::Transform& transform) {
    const openvdb::math::Mat4d matrix = transform.baseMap()->getAffineMap()->getMat4();
    Affine affine;
    for (int row = 0; row < 4; ++row) {
        // OpenVDB multiplies row vectors from the left: its rows are our columns.
        for (int column = 0; column < 3; ++column) affine[row][column] = matrix(row, column);
    }
    return affine;
}

}  // namespace

Affine worldFromModel(const openvdb::math::Transform& transform, UpAxis up) {
    return compose(worldFromFile(up), compose(fileFromIndex(transform), indexFromModel(up)));
}

}  // namespace pfvox::import::vdb

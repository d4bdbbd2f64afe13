#include "import/grid_transform.hpp"

namespace pfvox::import {

glm::i64vec3 Rotation::operator*(glm::i64vec3 p) const {
    glm::i64vec3 result;
    for (int row = 0; row < 3; ++row)
        result[row] = sign[static_cast<std::size_t>(row)] * p[column[static_cast<std::size_t>(row)]];
    return result;
}

Rotation Rotation::operator*(const Rotation& b) const {
    Rotation product;
    for (std::size_t row = 0; row < 3; ++row) {
        product.column[row] = b.column[column[row]];
        product.sign[row] = static_cast<std::int8_t>(sign[row] * b.sign[column[row]]);
    }
    return product;
}

Rotation Rotation::inverse() const {
    Rotation transposed;
    for (std::uint8_t row = 0; row < 3; ++row) {
        transposed.column[column[row]] = row;
        transposed.sign[column[row]] = sign[row];
    }
    return transposed;
}

glm::i64vec3 GridTransform::applyToCell(glm::i64vec3 cell) const {
    glm::i64vec3 corner = apply(cell);
    for (int row = 0; row < 3; ++row) {
        if (rotation.sign[static_cast<std::size_t>(row)] < 0) --corner[row];
    }
    return corner;
}

GridTransform GridTransform::operator*(const GridTransform& b) const {
    return {.rotation = rotation * b.rotation, .translation = apply(b.translation)};
}

GridTransform GridTransform::inverse() const {
    const Rotation back = rotation.inverse();
    return {.rotation = back, .translation = -(back * translation)};
}

Affine GridTransform::toAffine(double scale) const {
    Affine affine{0.0};
    for (int row = 0; row < 3; ++row) {
        const auto r = static_cast<std::size_t>(row);
        affine[rotation.column[r]][row] = scale * rotation.sign[r];
        affine[3][row] = scale * static_cast<double>(translation[row]);
    }
    return affine;
}

}  // namespace pfvox::import

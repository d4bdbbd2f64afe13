#include "import/vox/rotation.hpp"

namespace pfvox::import::vox {

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

std::optional<Rotation> decodeRotation(std::int32_t byte) {
    if (byte < 0 || byte > 127) return std::nullopt;
    const auto bits = static_cast<std::uint32_t>(byte);
    const auto first = static_cast<std::uint8_t>(bits & 3u);
    const auto second = static_cast<std::uint8_t>((bits >> 2) & 3u);
    if (first == 3 || second == 3 || first == second) return std::nullopt;
    const auto signOf = [bits](unsigned row) {
        return static_cast<std::int8_t>((bits >> (4 + row)) & 1u ? -1 : 1);
    };
    return Rotation{.column = {first, second, static_cast<std::uint8_t>(3 - first - second)},
                    .sign = {signOf(0), signOf(1), signOf(2)}};
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

}  // namespace pfvox::import::vox

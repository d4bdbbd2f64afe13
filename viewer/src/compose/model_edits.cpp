#include "compose/model_edits.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace pfvox::viewer {

namespace {

constexpr glm::dvec3 kUp{0.0, 1.0, 0.0};

glm::dmat3 aboutAxis(double radians, const glm::dvec3& axis) {
    return glm::dmat3(glm::rotate(glm::dmat4(1.0), radians, axis));
}

glm::dmat3 rotationOf(const glm::dvec3& angles) {
    return aboutAxis(angles.z, {0, 0, 1}) * aboutAxis(angles.y, {0, 1, 0}) * aboutAxis(angles.x, {1, 0, 0});
}

/// The inverse of rotationOf. Where y is a quarter turn, x and z turn about the same axis: z is 0 then.
glm::dvec3 anglesOf(const glm::dmat3& m) {
    const double sineY = glm::clamp(-m[0][2], -1.0, 1.0);
    if (std::abs(sineY) > 1.0 - 1e-12)
        return {std::atan2(-m[2][1], m[1][1]), std::copysign(0.5 * std::numbers::pi, sineY), 0.0};
    return {std::atan2(m[1][2], m[2][2]), std::asin(sineY), std::atan2(m[0][1], m[0][0])};
}

bool isUniform(const SceneModel& model) {
    if (!model.cubeEdgeMetres) return true;
    const glm::dvec3 edge = *model.cubeEdgeMetres;
    return edge.x == edge.y && edge.y == edge.z;
}

}  // namespace

glm::dvec3 footOf(const WorldBounds& box) {
    if (box.empty()) return glm::dvec3(0.0);
    return {0.5 * (box.min.x + box.max.x), box.min.y, 0.5 * (box.min.z + box.max.z)};
}

glm::dvec3 turnedAngles(const glm::dvec3& rotateRadians, double radians) {
    // A model that only ever turned about the vertical keeps an angle that people can read.
    if (rotateRadians.x == 0.0 && rotateRadians.z == 0.0)
        return {0.0, std::remainder(rotateRadians.y + radians, 2.0 * std::numbers::pi), 0.0};
    return anglesOf(aboutAxis(radians, kUp) * rotationOf(rotateRadians));
}

SceneModel turnedAbout(SceneModel model, const glm::dvec3& center, double radians) {
    model.rotateRadians = turnedAngles(model.rotateRadians, radians);
    if (isUniform(model))
        model.translateMetres = center + aboutAxis(radians, kUp) * (model.translateMetres - center);
    return model;
}

SceneModel resized(SceneModel model, const Resize& resize) {
    if (model.cubeEdgeMetres) {
        *model.cubeEdgeMetres *= resize.factor;
    } else {
        model.metresPerVoxel = resize.factor * model.metresPerVoxel.value_or(resize.voxelMetres);
    }
    model.translateMetres = resize.center + resize.factor * (model.translateMetres - resize.center);
    return model;
}

ProbeGridRequest requestOf(const ProbeGrid& grid, const glm::uvec3& proximityCells) {
    // A double of the float -3.6 is -3.6000001430511475; of its shortest decimal it is what the user would
    // write.
    const auto decimals = [](const glm::vec3& v) {
        glm::dvec3 exact;
        for (int axis = 0; axis < 3; ++axis) {
            std::array<char, 32> text{};
            const auto end = std::to_chars(text.data(), text.data() + text.size(), v[axis]).ptr;
            std::from_chars(text.data(), end, exact[axis]);
        }
        return exact;
    };
    return {.position = grid.origin + decimals(grid.start),
            .stepMetres = decimals(grid.step),
            .count = grid.counts,
            .proximityCells = proximityCells};
}

}  // namespace pfvox::viewer

#include "canvas.hpp"

namespace pfvox::demo {

std::uint32_t hashOf(glm::ivec3 p, std::uint32_t seed) {
    std::uint32_t h = seed * 0x9e3779b9u + 0x7f4a7c15u;
    for (int axis = 0; axis < 3; ++axis) {
        h ^= static_cast<std::uint32_t>(p[axis]) * 0x85ebca6bu;
        h = (h << 13) | (h >> 19);
        h = h * 5u + 0xe6546b64u;
    }
    h ^= h >> 16;
    h *= 0x7feb352du;
    h ^= h >> 15;
    h *= 0x846ca68bu;
    return h ^ (h >> 16);
}

int patchNoise(glm::ivec3 p, int scale, std::uint32_t seed) {
    const glm::ivec3 shifted = p + 4096;  // keeps the division away from negative numbers
    const glm::ivec3 cell = shifted / scale;
    const glm::ivec3 inside = shifted - cell * scale;
    const auto corner = [&](int x, int y, int z) {
        return static_cast<int>(hashOf(cell + glm::ivec3{x, y, z}, seed) & 0xffu);
    };
    const auto mix = [&](int a, int b, int t) { return (a * (scale - t) + b * t) / scale; };
    const auto plane = [&](int z) {
        return mix(mix(corner(0, 0, z), corner(1, 0, z), inside.x),
                   mix(corner(0, 1, z), corner(1, 1, z), inside.x), inside.y);
    };
    return mix(plane(0), plane(1), inside.z);
}

void Canvas::box(Box box, const Brush& brush) {
    fillWhere(
        box, [](glm::ivec3) { return true; }, brush);
}

void Canvas::fillWhere(Box box, const std::function<bool(glm::ivec3)>& inside, const Brush& brush) {
    const glm::ivec3 low = glm::max(box.min, glm::ivec3{0});
    const glm::ivec3 high = glm::min(box.max, size_);
    for (int z = low.z; z < high.z; ++z) {
        for (int y = low.y; y < high.y; ++y) {
            for (int x = low.x; x < high.x; ++x) {
                const glm::ivec3 p{x, y, z};
                if (inside(p)) set(p, brush(p));
            }
        }
    }
}

void Canvas::ball(glm::ivec3 centerHalf, int radiusHalf, const Brush& brush) {
    const Box around{(centerHalf - radiusHalf) / 2 - 1, (centerHalf + radiusHalf) / 2 + 2};
    fillWhere(
        around,
        [&](glm::ivec3 p) {
            const glm::ivec3 d = 2 * p + 1 - centerHalf;
            return d.x * d.x + d.y * d.y + d.z * d.z <= radiusHalf * radiusHalf;
        },
        brush);
}

void Canvas::cone(const Cone& cone, const Brush& brush) {
    const int widest = std::max(cone.bottomRadiusHalf, cone.topRadiusHalf);
    const glm::ivec2 low = (cone.centerHalf - widest) / 2 - 1;
    const glm::ivec2 high = (cone.centerHalf + widest) / 2 + 2;
    const int height = std::max(cone.zMax - cone.zMin - 1, 1);
    fillWhere(
        {{low, cone.zMin}, {high, cone.zMax}},
        [&](glm::ivec3 p) {
            const glm::ivec2 d = 2 * glm::ivec2{p} + 1 - cone.centerHalf;
            const int step = p.z - cone.zMin;
            const int radius = (cone.bottomRadiusHalf * (height - step) + cone.topRadiusHalf * step) / height;
            return d.x * d.x + d.y * d.y <= radius * radius;
        },
        brush);
}

void Canvas::torus(glm::ivec3 centerHalf, glm::ivec2 radiiHalf, int axis, const Brush& brush) {
    const int ring = radiiHalf.x;
    const int tube = radiiHalf.y;
    const Box around{(centerHalf - ring - tube) / 2 - 1, (centerHalf + ring + tube) / 2 + 2};
    fillWhere(
        around,
        [&](glm::ivec3 p) {
            // (distance to the axis - ring)^2 + height^2 <= tube^2, squared once more to avoid the root.
            const glm::ivec3 d = 2 * p + 1 - centerHalf;
            const int squared = d.x * d.x + d.y * d.y + d.z * d.z;
            const int fromAxis = squared - d[axis] * d[axis];
            const std::int64_t sum = squared + ring * ring - tube * tube;
            return sum <= 0 || sum * sum <= std::int64_t{4} * ring * ring * fromAxis;
        },
        brush);
}

}  // namespace pfvox::demo

#include "support/procedural.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pfvox::test {

std::uint64_t Random::next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

double Random::uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53;
}

int Random::integer(int low, int high) {
    return low + static_cast<int>(next() % static_cast<std::uint64_t>(high - low + 1));
}

glm::dvec3 Random::direction() {
    const double z = uniform(-1.0, 1.0);
    const double angle = uniform(0.0, 2.0 * std::numbers::pi);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

Material material(std::uint8_t r, std::uint8_t g, std::uint8_t b, float emissionStrength) {
    Material m;
    m.baseColor = {r, g, b, 255};
    if (emissionStrength > 0.0f) m.type = MaterialType::Emit;
    m.emissionStrength = emissionStrength;
    return m;
}

void fillBox(VoxelModel& model, const VoxelBox& box,
             const std::function<std::optional<MaterialIndex>(glm::ivec3)>& materialOf) {
    for (int z = box.min.z; z < box.max.z; ++z) {
        for (int y = box.min.y; y < box.max.y; ++y) {
            for (int x = box.min.x; x < box.max.x; ++x) {
                if (const auto m = materialOf({x, y, z})) model.set({x, y, z}, *m);
            }
        }
    }
}

OctreeAsset build(const VoxelAsset& asset) {
    Result<OctreeAsset> built = buildOctrees(asset, Limits{});
    if (!built) {
        ADD_FAILURE() << describe(built.error());
        return {};
    }
    return *std::move(built);
}

VoxelAsset demoRoom() {
    VoxelAsset asset;
    asset.materials = {material(222, 214, 200), material(188, 62, 48),         material(70, 122, 92),
                       material(64, 96, 168),   material(255, 214, 140, 6.0f), material(150, 112, 74)};
    VoxelModel& room = asset.models.emplace_back();
    room.name = "room";
    constexpr VoxelBox kRoom{{0, 0, 0}, {64, 40, 64}};
    fillBox(room, kRoom, [](glm::ivec3 p) -> std::optional<MaterialIndex> {
        const bool checker = ((p.x / 8 + p.z / 8) & 1) != 0;
        if (p.y < 2) return checker ? 5 : 0;
        if (p.x < 2) return 1;
        if (p.x >= 62) return 2;
        if (p.z < 2) return 0;
        const glm::dvec3 fromBall = glm::dvec3(p) + 0.5 - glm::dvec3(24.0, 12.0, 30.0);
        if (glm::dot(fromBall, fromBall) < 100.0) return 3;
        if (p.x >= 40 && p.x < 56 && p.z >= 10 && p.z < 40 && p.y < 2 + (40 - p.z) / 3) return 5;
        const bool lamp = p.x >= 10 && p.x < 14 && p.z >= 10 && p.z < 14;
        if (lamp && p.y < 20) return 0;
        if (lamp && p.y < 24) return 4;
        return std::nullopt;
    });
    Instance& instance = asset.instances.emplace_back();
    instance.name = "room";
    instance.worldFromModel = Affine{0.1};
    return asset;
}

VoxelModel randomModel(Random& random, int edge, double density, int materials) {
    VoxelModel model;
    fillBox(model, {{0, 0, 0}, glm::ivec3(edge)}, [&](glm::ivec3) -> std::optional<MaterialIndex> {
        if (random.uniform(0.0, 1.0) >= density) return std::nullopt;
        return static_cast<MaterialIndex>(random.integer(0, materials - 1));
    });
    return model;
}

VoxelModel largeModel(int materials) {
    VoxelModel model;
    const auto materialAt = [&](glm::ivec3 p) {
        return static_cast<MaterialIndex>((p.x / 8 + 3 * (p.y / 8) + 5 * (p.z / 8)) % materials);
    };
    // A wavy sheet through all regions, pillars every 64 voxels, and solid blocks that become large leaves.
    for (int z = 0; z < 520; ++z) {
        for (int x = 0; x < 600; ++x) {
            const int y = 150 + static_cast<int>(40.0 * std::sin(x * 0.021) + 60.0 * std::cos(z * 0.017));
            model.set({x, y, z}, materialAt({x, y, z}));
            if (x % 64 == 3 && z % 64 == 5) {
                for (int p = 0; p < 300; ++p) model.set({x, p, z}, materialAt({x, p, z}));
            }
        }
    }
    model.fillTile({256, 0, 256}, 6, 0);
    model.fillTile({512, 256, 0}, 5, static_cast<MaterialIndex>(materials - 1));
    return model;
}

}  // namespace pfvox::test

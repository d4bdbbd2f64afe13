// A hall for pictures of light: two rooms with a doorway between them, one under an open roof, one with a
// lamp, a metal ball, a pane of glass and a clear-coated block; and a coarse probe field of it, as a file.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <pfvox/bake.hpp>
#include <pfvox/pf_vox.hpp>
#include <pfvox/scene.hpp>

#include "support/procedural.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {

inline VoxelAsset litHall() {
    VoxelAsset asset;
    asset.materials = {material(225, 220, 210),       material(200, 50, 40),  material(60, 150, 70),
                       material(255, 220, 160, 7.0f), material(235, 190, 90), material(190, 225, 235),
                       material(40, 60, 190)};
    asset.materials[4].type = MaterialType::Metal;
    asset.materials[4].metalness = 1.0f;
    asset.materials[4].roughness = 0.0f;
    asset.materials[5].type = MaterialType::Glass;
    asset.materials[5].transparency = 0.85f;
    asset.materials[6].type = MaterialType::Plastic;
    asset.materials[6].roughness = 0.1f;
    VoxelModel& hall = asset.models.emplace_back();
    hall.name = "hall";
    fillBox(hall, {{0, 0, 0}, {56, 24, 28}}, [](glm::ivec3 p) -> std::optional<MaterialIndex> {
        const auto within = [&](glm::ivec3 low, glm::ivec3 high) {
            return glm::all(glm::greaterThanEqual(p, low)) && glm::all(glm::lessThan(p, high));
        };
        if (p.y < 2) return 0;
        if (p.y >= 22)
            return within({6, 22, 6}, {22, 24, 22}) ? std::nullopt : std::optional<MaterialIndex>(0);
        if (p.x < 2) return 1;
        if (p.x >= 54) return 2;
        if (p.z < 2) return 0;
        if (p.x >= 27 && p.x < 29)
            return within({27, 2, 8}, {29, 14, 20}) ? std::nullopt : std::optional<MaterialIndex>(0);
        const glm::dvec3 fromBall = glm::dvec3(p) + 0.5 - glm::dvec3(14.0, 7.0, 9.0);
        if (glm::dot(fromBall, fromBall) < 25.0) return 4;
        if (within({40, 18, 10}, {46, 20, 16})) return 3;
        if (within({34, 2, 18}, {35, 14, 26})) return 5;
        if (within({44, 2, 6}, {50, 9, 12})) return 6;
        return std::nullopt;
    });
    Instance& instance = asset.instances.emplace_back();
    instance.name = "hall";
    instance.worldFromModel = Affine{0.1};
    return asset;
}

inline constexpr const char* kLitHallScene = R"(probeGridPos = [0.5, 0.5, 0.5]
probeGridStep = [1.5, 1.2, 0.9]
probeGridCount = [4, 2, 3]
proximityGridSize = [14, 6, 7]
[sun]
direction = [0.3, -1.0, -0.2]
irradiance = [3.0, 2.8, 2.5]
[sky]
zenith = [0.20, 0.32, 0.60]
horizon = [0.40, 0.45, 0.50]
ground = [0.30, 0.27, 0.24]
[[cameras]]
name = "front"
position = [2.4, 1.5, 6.0]
target = [2.75, 0.95, 0.0]
fovYDegrees = 46.0
[[models]]
path = "hall.pf_vox"
)";

/// Writes hall.toml and hall.pf_vox.
inline void writeLitHall(const std::filesystem::path& folder) {
    const auto bytes = encodePfVox(build(litHall()), EncodeSettings{});
    ASSERT_TRUE(bytes) << describe(bytes.error());
    writeText(folder / "hall.pf_vox", {reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    writeText(folder / "hall.toml", kLitHallScene);
}

/// A field that is quick to bake: coarse and noisy.
inline BakeSettings quickBake() {
    BakeSettings settings;
    settings.resolution = {.depth = 32, .light = 16, .irradiance = 8, .moments = 14};
    settings.minSamples = 32;
    settings.maxSamples = 32;
    settings.noiseTarget = 0.0f;
    settings.maxBounces = 6;
    settings.toolName = "test";
    return settings;
}

/// The hall's field, kept beside the golden pictures that show it, so that they do not change with the baker.
/// With PFVOX_UPDATE_GOLDEN set it is baked anew.
inline std::filesystem::path litHallProbes(gpu::Device& device, const LoadedScene& scene) {
    const std::filesystem::path file = std::filesystem::path(PFVOX_TESTS_DIR) / "image/golden/hall.pf_probe";
    if (std::getenv("PFVOX_UPDATE_GOLDEN") == nullptr) return file;
    BakeSettings settings = quickBake();
    settings.resolution = {.depth = 64, .light = 16, .irradiance = 8, .moments = 14};
    settings.minSamples = settings.maxSamples = 64;
    settings.zstdLevel = 19;
    BakeObserver observer;
    DiagnosticList diagnostics;
    const auto baked = bakeProbes(device, scene, settings, file, observer, diagnostics);
    EXPECT_TRUE(baked) << describe(baked.error());
    return file;
}

}  // namespace pfvox::test

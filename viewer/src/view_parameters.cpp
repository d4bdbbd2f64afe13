#include "view_parameters.hpp"

#include <algorithm>
#include <cmath>

#include "atlas_layout.hpp"
#include "view_passes.hpp"

namespace pfvox::viewer {

namespace {

constexpr double kAmbientReach = 0.2;  // of the scene's diagonal
constexpr double kGroundRadius = 3.0;

/// In the middle under everything; y of a radius of 0 = none.
glm::vec4 groundUnder(const PictureInput& input, const PictureSettings& settings, double diagonal) {
    const gpu::WorldBox& box = input.scene.bounds();
    if (!hasGround(input, settings)) return glm::vec4(0.0f);
    const glm::dvec3 middle = 0.5 * (box.min + box.max);
    return {input.scene.onDevice({middle.x, box.min.y, middle.z}), kGroundRadius * diagonal};
}

std::uint64_t joined(glm::uvec2 words) {
    return std::uint64_t{words.y} << 32 | words.x;
}

}  // namespace

shared::ViewParameters viewParametersOf(const ViewCamera& camera, const PictureSettings& settings,
                                        const PictureInput& input) {
    constexpr float kStepsAtHotEnd = 96.0f;
    const CameraFrame frame = frameOf(camera);
    const double tanY = std::tan(glm::radians(0.5 * camera.fovYDegrees));
    const double tanX = tanY * settings.width / settings.height;
    const Lighting& light = settings.lighting;
    const auto probeCount =
        static_cast<std::uint32_t>(input.probes != nullptr ? input.probes->probes.size() : 0);
    const AtlasLayout atlas = atlasLayout(settings, probeCount);
    const gpu::WorldBox& box = input.scene.bounds();
    const double diagonal = box.empty() ? 0.0 : glm::length(box.max - box.min);
    const glm::vec4 ground = groundUnder(input, settings, diagonal);
    const GpuEmitters* const emitters = input.emitters;
    return {.cameraPosition = input.scene.onDevice(camera.position),
            .width = settings.width,
            .cameraForward = glm::vec3(frame.forward),
            .height = settings.height,
            .cameraRight = glm::vec3(frame.right * tanX),
            .samplesPerPixel = settings.samplesPerPixel,
            .cameraUp = glm::vec3(frame.up * tanY),
            .mode = static_cast<std::uint32_t>(drawnMode(input, settings)),
            .sunDirection = glm::normalize(light.sunDirection),
            .exposure = light.exposure,
            .sunIrradiance = light.sunIrradiance,
            .stepScale = kStepsAtHotEnd,
            .skyZenith = light.skyZenith,
            .cone = static_cast<float>(2.0 * tanY / settings.height) * settings.lodPixels,
            .skyHorizon = light.skyHorizon,
            .firstSample = 0,
            .skyGround = light.skyGround,
            .toneMap = static_cast<std::uint32_t>(settings.toneMap),
            .field = input.probes != nullptr ? input.probes->field.address() : glm::uvec2(0),
            .atlasFirst = atlas.first,
            .atlasCount = atlas.count,
            .atlasColumns = atlas.columns,
            .atlasCell = atlas.cell,
            .ambientRays = settings.ambientRays,
            .ambientReach = static_cast<float>(kAmbientReach * diagonal),
            .groundMiddle = glm::vec3(ground),
            .groundRadius = ground.w,
            .emitters = emitters != nullptr ? emitters->address() : glm::uvec2(0),
            .emitterCount = emitters != nullptr ? emitters->count() : 0,
            .emitterPower = emitters != nullptr ? emitters->power() : 0.0f,
            .faces = input.faces() != nullptr ? input.faces()->address() : glm::uvec2(0),
            .reserved0 = 0,
            .reserved1 = 0};
}

PictureStatistics statisticsOf(const ViewCounts& counts, std::uint64_t cameraRays) {
    PictureStatistics s;
    s.cameraRays = cameraRays;
    s.steps = joined(counts[shared::kCountSteps]);
    s.hits = joined(counts[shared::kCountHits]);
    s.stepLimitRays = joined(counts[shared::kCountStepLimit]);
    s.sunRays = joined(counts[shared::kCountSunRays]);
    s.reflectionRays = joined(counts[shared::kCountReflectionRays]);
    s.ambientRays = joined(counts[shared::kCountAmbientRays]);
    s.withoutValue = joined(counts[shared::kCountWithoutValue]);
    for (std::size_t i = 0; i < s.tiers.size(); ++i) s.tiers[i] = joined(counts[shared::kCountTiers + i]);
    for (std::size_t i = 0; i < s.fieldStates.size(); ++i)
        s.fieldStates[i] = joined(counts[shared::kCountFieldStates + i]);
    s.fieldAgrees = joined(counts[shared::kCountFieldAgrees]);
    return s;
}

}  // namespace pfvox::viewer

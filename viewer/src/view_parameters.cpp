#include "view_parameters.hpp"

#include <algorithm>
#include <cmath>

#include "view_passes.hpp"

namespace pfvox::viewer {

namespace {

/// How the maps lie in the picture.
struct AtlasLayout {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::uint32_t columns = 1;
    std::uint32_t cell = 1;
};

/// The largest cell with which all probes fit, but none under kSmallestCell: then there are pages.
AtlasLayout atlasLayout(const PictureSettings& settings, std::uint32_t probes) {
    constexpr std::uint32_t kSmallestCell = 32;
    const std::uint32_t width = settings.width;
    const std::uint32_t height = settings.height;
    const std::uint32_t shortEdge = std::min(width, height);
    if (settings.atlas.probe >= 0 || probes == 0) {
        const auto probe = static_cast<std::uint32_t>(std::max(settings.atlas.probe, 0));
        return {.first = std::min(probe, std::max(probes, 1u) - 1), .count = probes == 0 ? 0u : 1u, .columns = 1, .cell = shortEdge};
    }
    const auto fits = [&](std::uint32_t cell) { return std::uint64_t{width / cell} * (height / cell) >= probes; };
    const std::uint32_t least = std::min(kSmallestCell, shortEdge);
    std::uint32_t cell = shortEdge;
    while (cell > least && !fits(cell)) --cell;
    const std::uint32_t perPage = std::max((width / cell) * (height / cell), 1u);
    const std::uint32_t page = std::min(settings.atlas.page, (probes - 1) / perPage);
    return {.first = page * perPage,
            .count = std::min(perPage, probes - page * perPage),
            .columns = std::max(width / cell, 1u),
            .cell = cell};
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
    const auto probeCount = static_cast<std::uint32_t>(input.probes != nullptr ? input.probes->probes.size() : 0);
    const AtlasLayout atlas = atlasLayout(settings, probeCount);
    return {.cameraPosition = glm::vec3(camera.position),
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
            .reserved0 = 0,
            .reserved1 = 0};
}

PictureStatistics statisticsOf(const ViewCounts& counts, std::uint64_t cameraRays) {
    PictureStatistics s;
    s.cameraRays = cameraRays;
    s.steps = joined(counts[shared::kCountSteps]);
    s.hits = joined(counts[shared::kCountHits]);
    s.cappedRays = joined(counts[shared::kCountCapped]);
    s.sunRays = joined(counts[shared::kCountSunRays]);
    s.reflectionRays = joined(counts[shared::kCountReflectionRays]);
    s.withoutValue = joined(counts[shared::kCountWithoutValue]);
    for (std::size_t i = 0; i < s.tiers.size(); ++i) s.tiers[i] = joined(counts[shared::kCountTiers + i]);
    for (std::size_t i = 0; i < s.fieldStates.size(); ++i)
        s.fieldStates[i] = joined(counts[shared::kCountFieldStates + i]);
    s.fieldAgrees = joined(counts[shared::kCountFieldAgrees]);
    return s;
}

}  // namespace pfvox::viewer

#include "view_passes.hpp"

#include <pfvox_shaders/shaders.hpp>
#include <string>

#include "shared/view.glsl.h"

namespace pfvox::viewer {

namespace {

constexpr std::array<std::string_view, kPasses> kPassNames{
    "scene", "geometry", "sun", "ambient", "reflections", "light", "field", "atlas", "resolve"};

bool isLit(ViewMode mode) {
    return mode == ViewMode::Final || mode == ViewMode::Indirect || mode == ViewMode::Tiers;
}

bool shines(const PictureInput& input, ViewMode mode) {
    const gpu::SceneStatistics& scene = input.scene.statistics();
    return mode == ViewMode::Final && (scene.hasGlass || scene.hasMirrors);
}

bool hasSun(const PictureSettings& settings) {
    const glm::vec3& sun = settings.lighting.sunIrradiance;
    return sun.x > 0.0f || sun.y > 0.0f || sun.z > 0.0f;
}

std::vector<Pass> passesOf(const PictureInput& input, const PictureSettings& settings) {
    const ViewMode mode = drawnMode(input, settings);
    if (mode == ViewMode::Field || mode == ViewMode::FieldDifference) return {Pass::Field};
    if (isAtlas(mode)) return {Pass::Atlas};
    if (!isLit(mode)) return {Pass::Scene};
    std::vector<Pass> passes{Pass::Geometry};
    if (mode == ViewMode::Final && hasSun(settings)) passes.push_back(Pass::Sun);
    if (isGuessed(input, settings)) passes.push_back(Pass::Ambient);
    if (shines(input, mode)) passes.push_back(Pass::Reflections);
    passes.push_back(Pass::Light);
    return passes;
}

/// Whether probes say what is indirect.
bool asksProbes(const PictureInput& input) {
    return input.probes != nullptr && input.faces() == nullptr;
}

std::span<const std::uint32_t> codeOf(Pass pass, bool probes) {
    switch (pass) {
        case Pass::Geometry:
            return shaders::kViewGeometry;
        case Pass::Sun:
            return shaders::kViewSun;
        case Pass::Ambient:
            return shaders::kViewAmbient;
        case Pass::Reflections:
            return probes ? shaders::kViewReflectionsProbes : shaders::kViewReflections;
        case Pass::Light:
            return probes ? shaders::kViewLightProbes : shaders::kViewLight;
        case Pass::Field:
            return shaders::kViewField;
        case Pass::Atlas:
            return shaders::kViewAtlas;
        case Pass::Scene:
        case Pass::Resolve:
            break;
    }
    return shaders::kViewScene;
}

}  // namespace

std::string_view toString(Pass pass) {
    return kPassNames[static_cast<std::size_t>(pass)];
}

ViewMode drawnMode(const PictureInput& input, const PictureSettings& settings) {
    const ViewNeeds needs = entryOf(settings.mode).needs;
    const bool hasDepth = input.probes != nullptr && input.probes->info.resolution.depth != 0;
    const bool fits = needs == ViewNeeds::Nothing ||
                      (needs == ViewNeeds::Probes && input.probes != nullptr) ||
                      (needs == ViewNeeds::DepthMaps && hasDepth);
    return fits ? settings.mode : ViewMode::Final;
}

bool hasGround(const PictureInput& input, const PictureSettings& settings) {
    return settings.ground && !input.scene.bounds().empty() && drawnMode(input, settings) == ViewMode::Final;
}

bool isGuessed(const PictureInput& input, const PictureSettings& settings) {
    const bool wanted = input.probes == nullptr || hasGround(input, settings);
    return wanted && drawnMode(input, settings) == ViewMode::Final;
}

glm::uvec3 groupsFor(std::uint32_t width, std::uint32_t height) {
    const std::uint32_t edge = shared::kViewGroupEdge;
    return {(width + edge - 1) / edge, (height + edge - 1) / edge, 1};
}

Result<void> SeenBuffers::ensure(gpu::Device& device, const PictureInput& input,
                                 const PictureSettings& settings, std::uint64_t pixelCount) {
    const ViewMode mode = drawnMode(input, settings);
    const auto fit = [&](std::optional<gpu::Buffer>& buffer, bool needed, std::uint64_t bytes,
                         std::string_view name) -> Result<void> {
        if (!needed || (buffer && buffer->sizeBytes() < bytes)) buffer.reset();
        if (!needed || buffer) return {};
        PFVOX_TRY(gpu::Buffer, made, device.createBuffer(bytes, name));
        buffer.emplace(std::move(made));
        return {};
    };
    PFVOX_CHECK(fit(seen_, isLit(mode), sizeof(shared::SeenPixel) * pixelCount, "seen pixels"));
    return fit(shine_, shines(input, mode), sizeof(shared::SeenShine) * pixelCount, "shine of pixels");
}

Result<const gpu::Program*> ViewPasses::program(gpu::Device& device, const Key& key) {
    const auto found = programs_.find(key);
    if (found != programs_.end()) return &found->second;
    const auto [pass, probes, glass, faces] = key;
    const std::array<std::uint32_t, 2> constants{glass, faces};
    PFVOX_TRY(gpu::Program, made,
              device.createProgram(codeOf(pass, probes), sizeof(shared::ViewPushConstants),
                                   "view " + std::string(toString(pass)), constants));
    return &programs_.emplace(key, std::move(made)).first->second;
}

Result<void> ViewPasses::add(gpu::Device& device, const PictureInput& input, const PictureSettings& settings,
                             const PassTargets& targets, PassList& list) {
    const bool probes = asksProbes(input);
    const bool faces = input.faces() != nullptr;
    const bool glass = input.scene.statistics().hasGlass;
    const glm::uvec3 groups = groupsFor(settings.width, targets.rowCount);
    shared::ViewPushConstants push{.scene = input.scene.address(),
                                   .parameters = targets.parameters,
                                   .colors = targets.colors,
                                   .counters = targets.counters,
                                   .seen = targets.buffers->seen(),
                                   .shine = targets.buffers->shine(),
                                   .sampleIndex = 0,
                                   .firstRow = targets.firstRow,
                                   .rowCount = targets.rowCount,
                                   .reserved0 = 0};
    for (; push.sampleIndex < settings.samplesPerPixel; ++push.sampleIndex) {
        for (const Pass pass : passesOf(input, settings)) {
            PFVOX_TRY(const gpu::Program* const, made, program(device, {pass, probes, glass, faces}));
            list.add(pass, *made, push, groups);
        }
    }
    return {};
}

}  // namespace pfvox::viewer

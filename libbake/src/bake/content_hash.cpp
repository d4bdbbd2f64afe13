#include "bake/content_hash.hpp"

#include <pfvox/assert.hpp>
#include <pfvox_shaders/shaders.hpp>
#include <type_traits>

#include "bake/placed_models.hpp"
#include "bake/probe_tracer.hpp"
#include "io/hash.hpp"

namespace pfvox {

namespace {

/// Raised when the same inputs give another result for a reason that is not in the shaders.
constexpr std::uint32_t kBakeVersion = 5;
/// Raised when the filter does something else to the same maps; files keep it.
constexpr std::uint32_t kFilterRevision = 2;

class Hasher {
  public:
    template <class T>
    Hasher& add(const T& value) {
        static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>);
        hash_.update(std::as_bytes(std::span(&value, 1)));
        return *this;
    }
    template <class T>
    Hasher& addAll(std::span<const T> values) {
        add(std::uint64_t{values.size()});
        hash_.update(std::as_bytes(values));
        return *this;
    }
    template <int N, class T>
    Hasher& add(const glm::vec<N, T>& v) {
        for (int i = 0; i < N; ++i) add(v[i]);
        return *this;
    }
    Hasher& add(std::string_view text) {
        hash_.update(text);
        return *this;
    }
    Hasher& add(const ContentKey& key) {
        hash_.update(std::as_bytes(std::span(key.bytes)));
        return *this;
    }
    ContentKey key() const { return {hash_.digest()}; }

  private:
    io::Xxh3_128 hash_;
};

void addMaterial(Hasher& hasher, const Material& m) {
    hasher.add(m.baseColor).add(static_cast<std::uint8_t>(m.type));
    for (const MaterialField& field : kMaterialFields) hasher.add(m.*field.value);
}

void addModel(Hasher& hasher, const OctreeModel& model) {
    hasher.add(model.depth).add(model.originVoxels).add(std::uint64_t{model.regions.size()});
    for (const OctreeRegion& region : model.regions) {
        hasher.add(region.originVoxels).add(region.tree.depth);
        hasher.addAll(std::span<const std::uint32_t>(region.tree.nodes));
        hasher.addAll(std::span<const std::uint32_t>(region.tree.farTable));
        hasher.addAll(std::span<const std::uint32_t>(region.lookup));
        hasher.addAll(std::span<const std::uint8_t>(region.values));
        hasher.addAll(std::span<const MaterialIndex>(region.palette));
    }
}

ContentKey assetHash(const OctreeAsset& asset) {
    Hasher hasher;
    hasher.add(std::uint64_t{asset.materials.size()});
    for (const Material& material : asset.materials) addMaterial(hasher, material);
    for (const OctreeModel& model : asset.models) addModel(hasher, model);
    return hasher.key();
}

}  // namespace

ContentKey sceneContentHash(const LoadedScene& scene) {
    Hasher hasher;
    const Sun& sun = scene.scene.sun;
    const Sky& sky = scene.scene.sky;
    for (const glm::dvec3& v : {sun.direction, sun.irradiance, sky.zenith, sky.horizon, sky.ground})
        hasher.add(v);
    std::vector<std::pair<const OctreeAsset*, ContentKey>> known;
    for (const bake::PlacedModel& placed : bake::placedModels(scene)) {
        if (known.empty() || known.back().first != placed.asset)
            known.emplace_back(placed.asset, assetHash(*placed.asset));
        hasher.add(known.back().second);
        hasher.add(static_cast<std::uint64_t>(placed.model - placed.asset->models.data()));
        for (int column = 0; column < 4; ++column) hasher.add(glm::dvec3(placed.worldFromModel[column]));
    }
    return hasher.key();
}

ContentKey bakeContentKey(const LoadedScene& scene, const BakeSettings& settings,
                          const gpu::DeviceInfo& device) {
    const ProbeFieldInfo info = bake::fieldInfo(scene, settings, device);
    Hasher hasher;
    hasher.add(bake::fieldHash(info, settings));
    hasher.add(scene.scene.probes.proximityCells)
        .add(std::uint8_t{settings.proximity})
        .add(std::string_view(settings.toolName));
    return hasher.key();
}

namespace bake {

ContentKey shaderHash() {
    Hasher hasher;
    for (const auto& shader :
         {shaders::kBakeGeometry, shaders::kBakeTiles, shaders::kBakeBegin, shaders::kBakeCast,
          shaders::kBakeScatter, shaders::kBakeQueue, shaders::kBakeGather, shaders::kBakeFinish,
          shaders::kBakeFaces, shaders::kFaceSun, shaders::kFaceGather, shaders::kFaceSweep,
          shaders::kFaceNoise, shaders::kFaceDivide})
        hasher.addAll(shader);
    return hasher.key();
}

std::string deviceName(const gpu::DeviceInfo& device) {
    return device.name + ", " + device.driver;
}

ContentKey fieldHash(const ProbeFieldInfo& info, const BakeSettings& settings) {
    Hasher hasher;
    hasher.add(kBakeVersion).add(info.sceneHash).add(info.shaderHash).add(std::string_view(info.deviceName));
    if (info.grid.origin != glm::dvec3(0.0)) hasher.add(info.grid.origin);
    hasher.add(info.grid.start).add(info.grid.step).add(info.grid.counts);
    const ProbeResolution& r = info.resolution;
    hasher.add(r.depth).add(r.light).add(r.irradiance).add(r.moments);
    hasher.add(info.depth.scale).add(info.depth.farMetres);
    const auto addSetting = [&](const ProbeSetting&, const auto& value) {
        if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>> ||
                      std::is_enum_v<std::decay_t<decltype(value)>>) {
            hasher.add(value);
        } else {
            PFVOX_ASSERT(value.has_value());  // fieldInfo() knows all of them
            hasher.add(*value);
        }
    };
    forEachProbeSetting(addSetting, info.settings);
    if (settings.faces) {
        const FaceBakeSettings faces = faceBakeSettings(settings);
        forEachFaceSetting(addSetting, faces);
    }
    return hasher.key();
}

ContentKey chunkHash(const ContentKey& field, std::uint32_t chunk) {
    return Hasher{}.add(field).add(std::string_view("faces")).add(chunk).key();
}

FaceBakeSettings faceBakeSettings(const BakeSettings& settings) {
    const FaceSettings& faces = *settings.faces;
    return {
        .seed = settings.seed,
        .baseRays = faces.baseRays,
        .sweeps = std::min(settings.maxBounces.value_or(shared::kMaxPathBounces), shared::kMaxPathBounces),
        .minRays = faces.minRays,
        .maxRays = faces.maxRays,
        .noiseTarget = faces.noiseTarget,
        .maxBounces = settings.maxBounces.value_or(kUnlimitedBounces),
        .sampling = static_cast<std::uint32_t>(settings.sampling),
        .divide = faces.divide};
}

ContentKey probeHash(const ContentKey& field, std::uint32_t probe) {
    return Hasher{}.add(field).add(probe).key();
}

ProbeFieldInfo fieldInfo(const LoadedScene& scene, const BakeSettings& settings,
                         const gpu::DeviceInfo& device) {
    ProbeFieldInfo info;
    info.grid = scene.probes;
    const auto all = static_cast<std::uint32_t>(scene.probes.probeCount());
    info.range = settings.range.value_or(ProbeRange{0, all});
    info.resolution = settings.resolution;
    const glm::vec3 gridEnd = scene.probes.start + scene.probes.step * glm::vec3(scene.probes.counts - 1u);
    glm::vec3 low = scene.probes.start - 0.5f * scene.probes.step;
    glm::vec3 high = gridEnd + 0.5f * scene.probes.step;
    if (!scene.bounds.empty()) {
        low = glm::min(low, glm::vec3(scene.bounds.min - scene.origin()));
        high = glm::max(high, glm::vec3(scene.bounds.max - scene.origin()));
    }
    info.depth = depthEncodingFor(low, high);
    info.lightContent = kLightOfSky | kLightOfEmitters | kLightOfBouncedSun | kLightOfSpecular;
    info.settings = {.seed = settings.seed,
                     .tracedResolution = tracedResolution(settings.resolution).light,
                     .minSamples = settings.minSamples,
                     .maxSamples = settings.noiseTarget > 0.0f ? settings.maxSamples : settings.minSamples,
                     .maxBounces = settings.maxBounces.value_or(kUnlimitedBounces),
                     .noiseTarget = settings.noiseTarget,
                     .noiseFloor = settings.noiseFloor,
                     .sampling = static_cast<std::uint32_t>(settings.sampling),
                     .stratified = settings.stratified,
                     .relocate = settings.relocate,
                     .filter = settings.filter ? kFilterRevision : 0};
    info.sceneHash = sceneContentHash(scene);
    info.shaderHash = shaderHash();
    info.deviceName = deviceName(device);
    info.toolName = settings.toolName;
    return info;
}

}  // namespace bake

}  // namespace pfvox

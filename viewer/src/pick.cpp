#include "pick.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace pfvox::viewer {

namespace {

std::string numbered(std::size_t index, const std::string& name) {
    return name.empty() ? fmt::format("{}", index) : fmt::format("{} '{}'", index, name);
}

}  // namespace

gpu::GpuRay rayThrough(const ViewCamera& camera, glm::dvec2 parts, double aspect) {
    const CameraFrame frame = frameOf(camera);
    const double tanY = std::tan(glm::radians(0.5 * camera.fovYDegrees));
    const glm::dvec2 plane = 2.0 * parts - 1.0;
    const glm::dvec3 direction =
        frame.forward + plane.x * tanY * aspect * frame.right - plane.y * tanY * frame.up;
    return {.origin = camera.position, .direction = glm::vec3(glm::normalize(direction))};
}

std::optional<Pick> describePick(const LoadedScene& scene, const gpu::GpuRay& ray, const gpu::GpuHit& hit) {
    if (!hit.hit) return std::nullopt;
    // Instances of all parts are counted one after the other, materials of all files.
    std::size_t instance = hit.instance;
    std::map<const OctreeAsset*, std::size_t> firstMaterials;
    std::size_t materials = 0;
    for (const PlacedAsset& part : scene.parts) {
        const OctreeAsset& asset = *part.asset;
        const auto [first, isNew] = firstMaterials.try_emplace(&asset, materials);
        if (isNew) materials += asset.materials.size();
        if (instance < asset.instances.size()) {
            const std::size_t material = hit.material - first->second;
            if (material >= asset.materials.size()) return std::nullopt;
            const SceneModel& model = scene.scene.models[part.model];
            const Material& m = asset.materials[material];
            return Pick{.modelIndex = part.model,
                        .model = model.name.empty() ? model.path : model.name,
                        .instance = numbered(instance, asset.instances[instance].name),
                        .material = numbered(material, m.name) + ", " + toString(m.type),
                        .baseColor = m.baseColor,
                        .voxel = hit.voxel,
                        .distanceMetres = static_cast<double>(hit.t),
                        .point = ray.origin + static_cast<double>(hit.t) * glm::dvec3(ray.direction)};
        }
        instance -= asset.instances.size();
    }
    return std::nullopt;
}

std::uint32_t nearestProbe(const ProbeGrid& grid, const glm::dvec3& point) {
    const glm::dvec3 steps = glm::round((point - grid.worldOf(grid.start)) / glm::dvec3(grid.step));
    return grid.indexOf(glm::uvec3(glm::clamp(steps, glm::dvec3(0.0), glm::dvec3(grid.counts) - 1.0)));
}

}  // namespace pfvox::viewer

#include "pfvox/gpu_emitters.hpp"

#include <fmt/format.h>

#include <span>

#include "bake/emitters.hpp"

namespace pfvox {

namespace {

constexpr std::size_t kMostFaces = 1 << 22;  // 256 MiB

}  // namespace

Result<GpuEmitters> GpuEmitters::upload(gpu::Device& device, const LoadedScene& scene,
                                        Diagnostics& diagnostics) {
    GpuEmitters emitters;
    const bake::EmitterList list = bake::makeEmitters(bake::placedModels(scene, scene.origin()));
    if (list.faces.empty()) return emitters;
    if (list.faces.size() > kMostFaces) {
        diagnostics.warn(
            "emitters-too-many",
            fmt::format(
                "{} faces emit light, and {} are the most that are looked for without probes: their light "
                "is left out; bake probes to see it",
                list.faces.size(), kMostFaces));
        return emitters;
    }
    PFVOX_TRY(gpu::Buffer, faces,
              device.createBuffer(list.faces.size() * sizeof(shared::EmitterFace), "emitters"));
    PFVOX_CHECK(device.upload(faces, 0, std::as_bytes(std::span(list.faces))));
    emitters.faces_.emplace(std::move(faces));
    emitters.count_ = static_cast<std::uint32_t>(list.faces.size());
    emitters.power_ = list.power;
    return emitters;
}

}  // namespace pfvox

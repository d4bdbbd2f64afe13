#include "bake/bake_scene.hpp"

#include <algorithm>

namespace pfvox::bake {

Result<BakeSceneBuffers> BakeSceneBuffers::create(gpu::Device& device, const gpu::Scene& scene,
                                                  const Sun& sun, const Sky& sky, const EmitterList& list,
                                                  const BakeSettings& settings) {
    const std::uint64_t faces = std::max<std::uint64_t>(list.faces.size(), 1);
    PFVOX_TRY(gpu::Buffer, emitters, device.createBuffer(faces * sizeof(shared::EmitterFace), "emitters"));
    if (!list.faces.empty()) PFVOX_CHECK(device.upload(emitters, 0, std::as_bytes(std::span(list.faces))));
    const shared::BakeScene record{
        .scene = scene.address(),
        .emitters = emitters.addressWords(),
        .emitterCount = static_cast<std::uint32_t>(list.faces.size()),
        .emitterPower = list.power,
        .maxBounces =
            std::min(settings.maxBounces.value_or(shared::kMaxPathBounces), shared::kMaxPathBounces),
        .sampling = static_cast<std::uint32_t>(settings.sampling),
        .sunDirection = glm::vec3(glm::normalize(sun.direction)),
        .seedLow = static_cast<std::uint32_t>(settings.seed),
        .sunIrradiance = glm::vec3(sun.irradiance),
        .seedHigh = static_cast<std::uint32_t>(settings.seed >> 32),
        .skyZenith = glm::vec3(sky.zenith),
        .reserved0 = 0,
        .skyHorizon = glm::vec3(sky.horizon),
        .reserved1 = 0,
        .skyGround = glm::vec3(sky.ground),
        .reserved2 = 0};
    PFVOX_TRY(gpu::Buffer, buffer, device.createBuffer(sizeof(record), "bake scene"));
    PFVOX_CHECK(device.upload(buffer, 0, gpu::bytesOf(record)));
    return BakeSceneBuffers(std::move(buffer), std::move(emitters));
}

}  // namespace pfvox::bake

// What decides the content of a bake, as hashes.
#pragma once

#include <pfvox/bake.hpp>

namespace pfvox::bake {

/// Of the programs that see and light.
ContentKey shaderHash();

/// "NVIDIA H200, NVIDIA 550.54": equal bits are promised for equal names only.
std::string deviceName(const gpu::DeviceInfo& device);

/// Of all that the probes of a field have in common: scene, programs, device, sampling, grid, maps.
ContentKey fieldHash(const ProbeFieldInfo& info, const BakeSettings& settings);
/// Of a chunk of light on faces.
ContentKey chunkHash(const ContentKey& field, std::uint32_t chunk);
/// As files keep them. Precondition: there are faces.
FaceBakeSettings faceBakeSettings(const BakeSettings& settings);
/// Of one probe: fieldHash and its index.
ContentKey probeHash(const ContentKey& field, std::uint32_t probe);

/// Header of the file that a bake makes.
ProbeFieldInfo fieldInfo(const LoadedScene& scene, const BakeSettings& settings,
                         const gpu::DeviceInfo& device);

}  // namespace pfvox::bake

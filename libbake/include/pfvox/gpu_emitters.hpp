// GpuEmitters: the faces of emissive voxels of a scene in device memory, as light sources that rays look for.
//
//     LoadedScene -> [GpuEmitters::upload] -> device buffer -> shaders/emitters.glsl
#pragma once

#include <optional>
#include <pfvox/gpu.hpp>
#include <pfvox/scene.hpp>

namespace pfvox {

/// Immutable once made. Keeps its device alive; does not keep the scene.
class GpuEmitters {
  public:
    /// Of all visible models. More faces than 2^22 are left out, all of them, with the diagnostic
    /// "emitters-too-many". Errors: GpuOutOfMemory, GpuLost.
    static Result<GpuEmitters> upload(gpu::Device& device, const LoadedScene& scene,
                                      Diagnostics& diagnostics);

    /// Of the shared::EmitterFace array; 0 where there are none.
    glm::uvec2 address() const { return faces_ ? faces_->addressWords() : glm::uvec2(0); }
    std::uint32_t count() const { return count_; }
    float power() const { return power_; }  ///< sum of area (square meters) x mean radiance

  private:
    std::optional<gpu::Buffer> faces_;
    std::uint32_t count_ = 0;
    float power_ = 0.0f;
};

}  // namespace pfvox

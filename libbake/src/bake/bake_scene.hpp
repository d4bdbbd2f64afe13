// What the baker's programs are told of a scene: shared::BakeScene and the list of emitters, on the device.
#pragma once

#include <pfvox/bake.hpp>
#include <pfvox/gpu_scene.hpp>

#include "bake/emitters.hpp"
#include "shared/bake.glsl.h"

namespace pfvox::bake {

class BakeSceneBuffers {
  public:
    /// Errors: GpuOutOfMemory, GpuLost.
    static Result<BakeSceneBuffers> create(gpu::Device& device, const gpu::Scene& scene, const Sun& sun,
                                           const Sky& sky, const EmitterList& emitters,
                                           const BakeSettings& settings);

    /// Of the shared::BakeScene.
    glm::uvec2 address() const { return scene_.addressWords(); }

  private:
    BakeSceneBuffers(gpu::Buffer scene, gpu::Buffer emitters)
        : scene_(std::move(scene)), emitters_(std::move(emitters)) {}

    gpu::Buffer scene_;
    gpu::Buffer emitters_;
};

}  // namespace pfvox::bake

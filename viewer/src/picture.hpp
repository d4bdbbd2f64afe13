// Pictures: a scene seen by a camera, as 8-bit sRGB pixels.
//
//     gpu::Scene + ViewCamera -> [PictureRenderer] -> Picture -> png
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <pfvox/gpu.hpp>
#include <pfvox/gpu_scene.hpp>
#include <pfvox/scene.hpp>
#include <vector>

#include "camera.hpp"
#include "shown_probes.hpp"
#include "view_modes.hpp"

namespace pfvox::viewer {

/// 8-bit sRGB with alpha, rows from the top.
struct Picture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint32_t> pixels;  ///< bytes R, G, B, A in memory
};

/// Which maps the atlas views show.
struct AtlasChoice {
    std::int32_t probe = -1;  ///< this one alone, by index in the grid; < 0 = all, in pages
    std::uint32_t page = 0;   ///< of as many probes as fit; beyond the last page: the last
    bool operator==(const AtlasChoice&) const = default;
};

/// Light of the viewer: linear RGB.
struct Lighting {
    glm::vec3 sunDirection{-0.4f, -1.0f, -0.3f};  ///< where the light travels; any length
    glm::vec3 sunIrradiance{3.0f, 2.9f, 2.7f};    ///< at normal incidence
    glm::vec3 skyZenith{0.30f, 0.48f, 0.80f};     ///< radiance
    glm::vec3 skyHorizon{0.72f, 0.80f, 0.88f};
    glm::vec3 skyGround{0.24f, 0.23f, 0.22f};
    float exposure = 1.0f;
    bool operator==(const Lighting&) const = default;
};
Lighting lightingOf(const Scene& scene);

struct PictureSettings {
    std::uint32_t width = 1280;
    std::uint32_t height = 720;
    std::uint32_t samplesPerPixel = 4;
    ViewMode mode = ViewMode::Final;
    /// Levels of detail that are narrower than this many pixels stand for what is in them; 0 = not used.
    float lodPixels = 1.0f;
    ToneMap toneMap = ToneMap::Standard;
    AtlasChoice atlas;
    Lighting lighting;
    bool operator==(const PictureSettings&) const = default;
};

struct PictureStatistics {
    double gpuMs = 0.0;
    std::uint64_t cameraRays = 0;
    std::uint64_t steps = 0;       ///< octree iterations of all rays, shadows counted
    std::uint64_t hits = 0;        ///< camera rays that met a voxel
    std::uint64_t cappedRays = 0;  ///< given up after too many steps: a fault of ours or of the data
    PictureStatistics& operator+=(const PictureStatistics& other);
};

class PictureRenderer {
  public:
    /// Errors: those of Device::createProgram.
    static Result<PictureRenderer> create(gpu::Device& device);

    /// Errors: GpuOutOfMemory, GpuLost.
    Result<Picture> render(gpu::Device& device, const gpu::Scene& scene, const ViewCamera& camera,
                           const PictureSettings& settings, PictureStatistics& statistics) const;

  private:
    explicit PictureRenderer(gpu::Program program) : program_(std::move(program)) {}
    gpu::Program program_;
};

}  // namespace pfvox::viewer

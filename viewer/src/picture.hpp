// Pictures: a scene seen by a camera, as 8-bit sRGB pixels.
//
//     gpu::Scene (+ ShownProbes) + ViewCamera -> [PictureRenderer] -> Picture -> png
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <pfvox/gpu.hpp>
#include <pfvox/gpu_emitters.hpp>
#include <pfvox/gpu_probes.hpp>
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

/// PictureSettings::ambientRays of frames that follow one another.
inline constexpr std::uint32_t kFrameAmbientRays = 2;

struct PictureSettings {
    std::uint32_t width = 1280;
    std::uint32_t height = 720;
    std::uint32_t samplesPerPixel = 4;
    ViewMode mode = ViewMode::Final;
    /// Levels of detail that are narrower than this many pixels stand for what is in them; 0 = not used.
    float lodPixels = 1.0f;
    ToneMap toneMap = ToneMap::Standard;
    /// Rays of each sample that guess indirect light where no probes say it.
    std::uint32_t ambientRays = 16;
    /// Whether the scene stands on a ground; seen in the final picture alone.
    bool ground = false;
    AtlasChoice atlas;
    Lighting lighting;
    bool operator==(const PictureSettings&) const = default;
};

/// What is drawn; all of it outlives the call.
struct PictureInput {
    // Implicit: most pictures are of a scene alone.
    PictureInput(const gpu::Scene& drawn, const ShownProbes* light = nullptr,
                 const GpuEmitters* lamps = nullptr)
        : scene(drawn), probes(light), emitters(lamps) {}
    const gpu::Scene& scene;
    const ShownProbes* probes;  ///< null = none
    /// Light on faces; null = none. It goes before that of probes.
    const gpu::GpuFaces* faces() const {
        return probes != nullptr && probes->faces ? &*probes->faces : nullptr;
    }
    const GpuEmitters* emitters;  ///< what glows where no probes say it (isGuessed); null = nothing
};

/// The programs of a frame, each measured on its own.
enum class Pass : std::uint8_t { Scene, Geometry, Sun, Ambient, Reflections, Light, Field, Atlas, Resolve };
inline constexpr std::size_t kPasses = 9;
/// "scene", "geometry", ...
std::string_view toString(Pass pass);
/// Milliseconds on the device, by Pass.
using PassTimes = std::array<double, kPasses>;
double sumOf(const PassTimes& times);

/// Sums over all samples and frames.
struct PictureStatistics {
    double gpuMs = 0.0;
    PassTimes passMs{};
    std::uint64_t cameraRays = 0;
    std::uint64_t steps = 0;          ///< octree iterations of all rays, shadows counted
    std::uint64_t hits = 0;           ///< camera rays that met a voxel
    std::uint64_t stepLimitRays = 0;  ///< given up after too many steps: a fault of ours or of the data
    std::uint64_t sunRays = 0;
    std::uint64_t ambientRays = 0;     ///< that guess indirect light
    std::uint64_t reflectionRays = 0;  ///< shadow rays where they end counted
    std::array<std::uint64_t, gpu::kProbeTierCount>
        tiers{};                                 ///< surface samples by what gave their indirect light
    std::uint64_t withoutValue = 0;              ///< of these: none, or not finite
    std::array<std::uint64_t, 3> fieldStates{};  ///< camera rays through the probes: miss, hit, unknown
    std::uint64_t fieldAgrees = 0;  ///< of these, the octree says the same (view FieldDifference)
    PictureStatistics& operator+=(const PictureStatistics& other);
};

class ViewPasses;
class SeenBuffers;

class PictureRenderer {
  public:
    /// Errors: those of Device::createProgram.
    static Result<PictureRenderer> create(gpu::Device& device);
    PictureRenderer(PictureRenderer&&) noexcept;
    PictureRenderer& operator=(PictureRenderer&&) noexcept;
    ~PictureRenderer();

    /// A view that needs probes and has none is the final one (checkView tells before). Large pictures are
    /// drawn in bands of rows. Errors: GpuOutOfMemory, GpuLost.
    Result<Picture> render(gpu::Device& device, const PictureInput& input, const ViewCamera& camera,
                           const PictureSettings& settings, PictureStatistics& statistics) const;

  private:
    explicit PictureRenderer(gpu::Program resolve);
    struct Band;
    Result<void> drawBand(gpu::Device& device, const PictureInput& input, const PictureSettings& settings,
                          const Band& band, PictureStatistics& statistics) const;

    gpu::Program resolve_;
    std::unique_ptr<ViewPasses> passes_;  ///< programs made when first needed
    std::unique_ptr<SeenBuffers> seen_;
};

}  // namespace pfvox::viewer

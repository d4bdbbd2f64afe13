// Verify: a picture of the indirect light from a probe field beside one from path tracing, and how far they
// are apart.
//
//     scene, camera -> [ProbeVerifier::trace] -> ReferencePicture
//     that, probes  -> [ProbeVerifier::lookUp] -> VerifiedPicture -> [scoreOf] -> VerifyScore
//     too noisy for what it judges: ReferenceTarget::nextSamples, and on from the same ReferencePicture
//
// A reference does for every field of its scene. Both pictures show I = E / pi, not what materials make of
// it. Lengths are metres, light is linear RGB.
#pragma once

#include <array>
#include <pfvox/gpu_faces.hpp>
#include <pfvox/gpu_probes.hpp>
#include <pfvox/gpu_scene.hpp>
#include <pfvox/scene.hpp>
#include <vector>

namespace pfvox {

/// How pictures are taken and compared.
struct VerifySettings {
    std::uint32_t width = 320;       ///< pixels
    std::uint32_t height = 180;      ///< pixels
    std::uint32_t samples = 1024;    ///< paths a pixel of the reference, all together
    std::uint32_t maxBounces = 128;  ///< as the field was baked
    bool emitterSampling =
        true;  ///< else emissive voxels are found by running into them only: the same mean, far more noise
};

/// Sums of I over the samples of even and of odd number; w: how many. Rows from the top.
struct ReferencePicture {
    std::uint32_t width = 0;      ///< pixels
    std::uint32_t height = 0;     ///< pixels
    std::vector<glm::vec4> even;  ///< a sum a pixel
    std::vector<glm::vec4> odd;   ///< a sum a pixel
    std::uint32_t samples = 0;    ///< paths a pixel, all together; 0: nothing was traced yet
    double gpuMs = 0.0;           ///< of the device
};

/// One pixel, twice.
struct VerifiedPixel {
    glm::vec3 lookup{0.0f};     ///< I out of the probes
    glm::vec3 reference{0.0f};  ///< I by path tracing
    glm::vec3 noise{0.0f};      ///< half the difference of two halves of the reference's samples
    gpu::ProbeTier tier = gpu::ProbeTier::None;     ///< which lookup gave the value
    MaterialType material = MaterialType::Diffuse;  ///< of the surface
    bool surface = false;  ///< else the camera sees nothing here, and the rest is empty
};

/// What one camera sees.
struct VerifiedPicture {
    std::uint32_t width = 0;            ///< pixels
    std::uint32_t height = 0;           ///< pixels
    std::vector<VerifiedPixel> pixels;  ///< rows from the top
    double gpuMs = 0.0;                 ///< of both pictures
};

/// Some of the pixels of a picture. Fractions are of the mean of their reference, all channels.
struct VerifyPart {
    std::uint64_t pixels = 0;    ///< that it is about
    double meanReference = 0.0;  ///< of all channels
    double rmse = 0.0;           ///< of I, all channels
    double relativeRmse = 0.0;   ///< over the mean of the reference
    double relativeNoise = 0.0;  ///< of the reference, from its halves
    double relativeError = 0.0;  ///< of the probes alone: sqrt(RMSE^2 - noise^2), 0 where that is negative
    double relativeTrimmedRmse =
        0.0;  ///< as relativeRmse, without the pixels of the largest errors (kTrimmedFraction)
    double relativeBias = 0.0;  ///< mean of lookup - reference: brighter or darker as a whole
};

/// Of a part's pixels those that its trimmed RMSE leaves out: a few specks beside lamps may hold most of the
/// square.
inline constexpr double kTrimmedFraction = 0.005;

/// Of MaterialType.
inline constexpr std::size_t kMaterialTypeCount = 7;

/// How far the probes are from the reference, over the pixels with surface.
struct VerifyScore {
    std::uint64_t surfacePixels = 0;
    std::uint64_t withoutValue = 0;                            ///< of these: no tier, or not finite
    std::array<double, gpu::kProbeTierCount> tierFractions{};  ///< of surface pixels, by tier
    VerifyPart all;                                            ///< every pixel with surface
    std::array<VerifyPart, gpu::kProbeTierCount> byTier;       ///< those of one tier
    std::array<VerifyPart, kMaterialTypeCount> byMaterial;     ///< of the surface that is seen
    double exposure = 1.0;                                     ///< for PSNR and FLIP: 0.5 / mean
    double psnrDecibel = 0.0;  ///< of exposed values clamped to [0, 1]; 999 when they are equal
    double meanFlip = 0.0;     ///< over pixels with surface
    double noiseFlip = 0.0;    ///< what the noise of the reference alone makes of it
    std::vector<float> flip;   ///< of all pixels
    std::uint64_t tierPixels(gpu::ProbeTier tier) const;  ///< pixels whose value came from this tier
    /// Those of tier Texels.
    const VerifyPart& texels() const { return byTier[static_cast<std::size_t>(gpu::ProbeTier::Texels)]; }
};

/// What is looked at; all of it outlives the call.
struct VerifyInput {
    const LoadedScene& loaded;  ///< sun and sky
    const gpu::Scene& scene;
    const Camera& camera;
    const gpu::GpuProbes* probes = nullptr;  ///< baked from it; what is looked up, unless there are faces
    const gpu::GpuFaces* faces = nullptr;    ///< the same
};

/// Renders pictures both ways and compares them. Not thread-safe.
class ProbeVerifier {
  public:
    /// Errors: those of Device::createProgram.
    static Result<ProbeVerifier> create(gpu::Device& device);

    /// Adds paths to `begun`, which has the size of `settings` or is empty, until there are
    /// `settings.samples` a pixel: bit for bit the picture that one call would have traced. Does not look at
    /// the probes. Device work is cut into pieces of some rows and samples. Errors: GpuOutOfMemory, GpuLost.
    Result<ReferencePicture> trace(gpu::Device& device, const VerifyInput& input,
                                   const VerifySettings& settings, ReferencePicture begun = {}) const;

    /// The size of the picture is the reference's. Errors: GpuOutOfMemory, GpuLost.
    Result<VerifiedPicture> lookUp(gpu::Device& device, const VerifyInput& input,
                                   const ReferencePicture& reference) const;

    /// Both. Errors: theirs.
    Result<VerifiedPicture> render(gpu::Device& device, const VerifyInput& input,
                                   const VerifySettings& settings) const;

  private:
    explicit ProbeVerifier(gpu::Program program) : program_(std::move(program)) {}
    gpu::Program program_;
};

/// Over the pixels with surface; all zero without any.
VerifyScore scoreOf(const VerifiedPicture& picture);

/// VerifyScore::all alone, without the time that FLIP takes.
VerifyPart partOfAll(const VerifiedPicture& picture);

/// How good a reference has to be for what it judges.
struct ReferenceTarget {
    double noiseOfError =
        0.33;  ///< its noise over the error of the probes (VerifyPart::relativeError), at most
    std::uint32_t maxSamples = 16384;  ///< paths a pixel, all together, at most

    /// Whether figures of this part can be relied upon.
    bool isReached(const VerifyPart& part) const;
    /// How many paths a pixel it takes by what `samples` of them gave, at least twice and at most eight times
    /// as many, within maxSamples; `samples` itself when the target is reached or no more are allowed.
    std::uint32_t nextSamples(const VerifyPart& part, std::uint32_t samples) const;
};

}  // namespace pfvox

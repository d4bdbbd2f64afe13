#include <algorithm>
#include <cmath>
#include <pfvox/flip.hpp>
#include <pfvox/verify.hpp>
#include <pfvox_shaders/shaders.hpp>

#include "shared/bake.glsl.h"
#include "shared/verify.glsl.h"

namespace pfvox {

namespace {

/// Work of one dispatch: short enough on slow devices.
constexpr std::uint64_t kPathsPerDispatch = 1u << 16;

shared::VerifyView viewOf(const Camera& camera, const VerifySettings& settings) {
    const glm::dvec3 toTarget = camera.target - camera.position;
    const glm::dvec3 forward = glm::length(toTarget) > 0.0 ? glm::normalize(toTarget) : glm::dvec3{0, 0, -1};
    const bool vertical = std::abs(forward.y) > 1.0 - 1e-9;
    const glm::dvec3 about = vertical ? glm::dvec3{0, 0, -1} : glm::dvec3{0, 1, 0};
    const glm::dvec3 right = glm::normalize(glm::cross(forward, about));
    const double tanY = std::tan(glm::radians(camera.fovYDegrees) / 2.0);
    const double aspect = static_cast<double>(settings.width) / settings.height;
    return {.position = glm::vec3{camera.position},
            .width = settings.width,
            .forward = glm::vec3{forward},
            .height = settings.height,
            .right = glm::vec3{right * tanY * aspect},
            .reserved0 = 0,
            .up = glm::vec3{glm::cross(right, forward) * tanY},
            .reserved1 = 0};
}

shared::BakeScene bakeSceneOf(const VerifyInput& input, const VerifySettings& settings) {
    const Sun& sun = input.loaded.scene.sun;
    const Sky& sky = input.loaded.scene.sky;
    shared::BakeScene record{};
    record.scene = input.scene.address();
    record.maxBounces = settings.maxBounces;
    record.sampling = shared::kSampleDirections;
    record.sunDirection = glm::vec3{glm::normalize(sun.direction)};
    record.sunIrradiance = glm::vec3{sun.irradiance};
    record.skyZenith = glm::vec3{sky.zenith};
    record.skyHorizon = glm::vec3{sky.horizon};
    record.skyGround = glm::vec3{sky.ground};
    return record;
}

VerifiedPixel pixelOf(const shared::VerifyPixel& pixel) {
    VerifiedPixel result;
    result.surface = pixel.lookup.w >= 0.0f;
    if (!result.surface) return result;
    const glm::vec3 even = glm::vec3{pixel.even} / std::max(pixel.even.w, 1.0f);
    const glm::vec3 odd = glm::vec3{pixel.odd} / std::max(pixel.odd.w, 1.0f);
    result.lookup = glm::vec3{pixel.lookup};
    result.tier = static_cast<gpu::ProbeTier>(pixel.lookup.w);
    result.reference = glm::vec3{pixel.even + pixel.odd} / std::max(pixel.even.w + pixel.odd.w, 1.0f);
    result.noise = 0.5f * (even - odd);
    return result;
}

double squared(const glm::vec3& v) { return static_cast<double>(glm::dot(v, v)) / 3.0; }
double mean(const glm::vec3& v) { return static_cast<double>(v.x + v.y + v.z) / 3.0; }
bool isFinite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Sums over pixels with a value.
struct Sums {
    double pixels = 0.0;
    double reference = 0.0;
    double error = 0.0;
    double noise = 0.0;

    void add(const VerifiedPixel& pixel) {
        pixels += 1.0;
        reference += mean(pixel.reference);
        error += squared(pixel.lookup - pixel.reference);
        noise += squared(pixel.noise);
    }
    double rmse() const { return pixels > 0.0 ? std::sqrt(error / pixels) : 0.0; }
    double relative(double sum) const {
        return reference > 0.0 ? std::sqrt(sum / pixels) / (reference / pixels) : 0.0;
    }
};

/// What PSNR and FLIP look at: both pictures, exposed alike.
void compareExposed(const VerifiedPicture& picture, VerifyScore& score) {
    std::vector<glm::vec3> reference;
    std::vector<glm::vec3> test;
    double error = 0.0;
    for (const VerifiedPixel& pixel : picture.pixels) {
        const auto exposed = [&](const glm::vec3& light) {
            const glm::vec3 value = isFinite(light) ? light : glm::vec3{0.0f};
            return glm::clamp(static_cast<float>(score.exposure) * value, 0.0f, 1.0f);
        };
        reference.push_back(exposed(pixel.reference));
        test.push_back(exposed(pixel.lookup));
        if (pixel.surface) error += squared(reference.back() - test.back());
    }
    const auto surfaces = static_cast<double>(std::max<std::uint64_t>(score.surfacePixels, 1));
    score.psnrDecibel = error > 0.0 ? -10.0 * std::log10(error / surfaces) : 999.0;
    score.flip = flipOf({.width = picture.width, .height = picture.height, .reference = reference, .test = test});
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        if (picture.pixels[i].surface) score.meanFlip += static_cast<double>(score.flip[i]) / surfaces;
    }
}

}  // namespace

std::uint64_t VerifyScore::tierPixels(gpu::ProbeTier tier) const {
    return static_cast<std::uint64_t>(
        std::llround(tierShares[static_cast<std::size_t>(tier)] * static_cast<double>(surfacePixels)));
}

Result<ProbeVerifier> ProbeVerifier::create(gpu::Device& device) {
    const std::uint32_t hasGlass = 1;
    PFVOX_TRY(gpu::Program, program,
              device.createProgram(shaders::kVerifyProbes, sizeof(shared::VerifyPush), "verify probes", {&hasGlass, 1}));
    return ProbeVerifier(std::move(program));
}

Result<VerifiedPicture> ProbeVerifier::render(gpu::Device& device, const VerifyInput& input,
                                              const VerifySettings& settings) const {
    std::vector<shared::VerifyPixel> found(std::size_t{settings.width} * settings.height);
    PFVOX_TRY(const gpu::Buffer, scene, device.createBuffer(sizeof(shared::BakeScene), "verify scene"));
    PFVOX_TRY(const gpu::Buffer, view, device.createBuffer(sizeof(shared::VerifyView), "verify view"));
    PFVOX_TRY(const gpu::Buffer, pixels, device.createBuffer(std::span(found).size_bytes(), "verify pixels"));
    PFVOX_CHECK(device.upload(scene, 0, gpu::bytesOf(bakeSceneOf(input, settings))));
    PFVOX_CHECK(device.upload(view, 0, gpu::bytesOf(viewOf(input.camera, settings))));

    shared::VerifyPush push{.scene = scene.addressWords(),
                            .field = input.probes.address(),
                            .view = view.addressWords(),
                            .pixels = pixels.addressWords(),
                            .firstSample = 0,
                            .sampleCount = 0,
                            .firstRow = 0,
                            .reserved0 = 0};
    VerifiedPicture picture{.width = settings.width, .height = settings.height, .pixels = {}};
    const auto groups = [](std::uint32_t edge) { return (edge + shared::kVerifyGroupEdge - 1) / shared::kVerifyGroupEdge; };
    const auto launch = [&](std::uint32_t rows) -> Result<void> {
        const gpu::Dispatch dispatch{.program = &program_,
                                     .pushConstants = gpu::bytesOf(push),
                                     .groups = {groups(settings.width), groups(rows), 1}};
        PFVOX_TRY(const double, gpuMs, device.run({&dispatch, 1}));
        picture.gpuMs += gpuMs;
        return {};
    };
    PFVOX_CHECK(launch(settings.height));
    const std::uint64_t fitting = kPathsPerDispatch / settings.width / shared::kVerifyGroupEdge;
    const auto perDispatch = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(fitting, 1, settings.samples));
    for (push.firstSample = 0; push.firstSample < settings.samples; push.firstSample += perDispatch) {
        push.sampleCount = std::min(perDispatch, settings.samples - push.firstSample);
        for (push.firstRow = 0; push.firstRow < settings.height; push.firstRow += shared::kVerifyGroupEdge)
            PFVOX_CHECK(launch(shared::kVerifyGroupEdge));
    }
    PFVOX_CHECK(device.download(pixels, 0, std::as_writable_bytes(std::span(found))));
    picture.pixels.resize(found.size());
    std::ranges::transform(found, picture.pixels.begin(), pixelOf);
    return picture;
}

VerifyScore scoreOf(const VerifiedPicture& picture) {
    VerifyScore score;
    Sums all;
    Sums texels;
    for (const VerifiedPixel& pixel : picture.pixels) {
        if (!pixel.surface) continue;
        ++score.surfacePixels;
        score.tierShares[static_cast<std::size_t>(pixel.tier)] += 1.0;
        if (pixel.tier == gpu::ProbeTier::None || !isFinite(pixel.lookup) || !isFinite(pixel.reference)) {
            ++score.withoutValue;
            continue;
        }
        all.add(pixel);
        if (pixel.tier == gpu::ProbeTier::Texels) texels.add(pixel);
    }
    if (score.surfacePixels == 0) return score;
    for (double& share : score.tierShares) share /= static_cast<double>(score.surfacePixels);
    score.meanReference = all.pixels > 0.0 ? all.reference / all.pixels : 0.0;
    score.rmse = all.rmse();
    score.relativeRmse = all.relative(all.error);
    score.relativeNoise = all.relative(all.noise);
    score.relativeTexelRmse = texels.pixels > 0.0 ? texels.relative(texels.error) : 0.0;
    score.exposure = score.meanReference > 0.0 ? 0.5 / score.meanReference : 1.0;
    compareExposed(picture, score);
    return score;
}

}  // namespace pfvox

#include "picture.hpp"

#include <cmath>
#include <pfvox_shaders/shaders.hpp>
#include <utility>

#include "view_parameters.hpp"

namespace pfvox::viewer {

shared::ViewParameters viewParametersOf(const ViewCamera& camera, const PictureSettings& settings) {
    constexpr float kStepsAtHotEnd = 96.0f;
    const CameraFrame frame = frameOf(camera);
    const double tanY = std::tan(glm::radians(0.5 * camera.fovYDegrees));
    const double tanX = tanY * settings.width / settings.height;
    const Lighting& light = settings.lighting;
    return {.cameraPosition = glm::vec3(camera.position),
            .width = settings.width,
            .cameraForward = glm::vec3(frame.forward),
            .height = settings.height,
            .cameraRight = glm::vec3(frame.right * tanX),
            .samplesPerPixel = settings.samplesPerPixel,
            .cameraUp = glm::vec3(frame.up * tanY),
            .mode = static_cast<std::uint32_t>(settings.mode),
            .sunDirection = glm::normalize(light.sunDirection),
            .exposure = light.exposure,
            .sunIrradiance = light.sunIrradiance,
            .stepScale = kStepsAtHotEnd,
            .skyZenith = light.skyZenith,
            .cone = static_cast<float>(2.0 * tanY / settings.height) * settings.lodPixels,
            .skyHorizon = light.skyHorizon,
            .firstSample = 0,
            .skyGround = light.skyGround,
            .reserved2 = 0};
}

PictureStatistics& PictureStatistics::operator+=(const PictureStatistics& other) {
    gpuMs += other.gpuMs;
    cameraRays += other.cameraRays;
    steps += other.steps;
    hits += other.hits;
    cappedRays += other.cappedRays;
    return *this;
}

PictureStatistics statisticsOf(const shared::ViewCounters& counters, double gpuMs) {
    const auto join = [](std::uint32_t low, std::uint32_t high) { return std::uint64_t{high} << 32 | low; };
    return {.gpuMs = gpuMs,
            .cameraRays = join(counters.raysLow, counters.raysHigh),
            .steps = join(counters.stepsLow, counters.stepsHigh),
            .hits = counters.primaryHits,
            .cappedRays = counters.cappedRays};
}

glm::uvec3 groupsOf(const PictureSettings& settings) {
    const std::uint32_t edge = shared::kViewGroupEdge;
    return {(settings.width + edge - 1) / edge, (settings.height + edge - 1) / edge, 1};
}

Lighting lightingOf(const Scene& scene) {
    // Normalised here, in double: the length may be more than the square of a float holds.
    return {.sunDirection = glm::vec3(glm::normalize(scene.sun.direction)),
            .sunIrradiance = glm::vec3(scene.sun.irradiance),
            .skyZenith = glm::vec3(scene.sky.zenith),
            .skyHorizon = glm::vec3(scene.sky.horizon),
            .skyGround = glm::vec3(scene.sky.ground)};
}

Result<PictureRenderer> PictureRenderer::create(gpu::Device& device) {
    PFVOX_TRY(gpu::Program, program,
              device.createProgram(shaders::kViewScene, sizeof(shared::ViewPushConstants), "view scene"));
    return PictureRenderer(std::move(program));
}

Result<Picture> PictureRenderer::render(gpu::Device& device, const gpu::Scene& scene,
                                        const ViewCamera& camera, const PictureSettings& settings,
                                        PictureStatistics& statistics) const {
    Picture picture{.width = settings.width,
                    .height = settings.height,
                    .pixels = std::vector<std::uint32_t>(std::size_t{settings.width} * settings.height)};
    const shared::ViewParameters parameters = viewParametersOf(camera, settings);
    shared::ViewCounters counters{};
    PFVOX_TRY(const gpu::Buffer, parameterBuffer, device.createBuffer(sizeof parameters, "view parameters"));
    PFVOX_TRY(const gpu::Buffer, counterBuffer, device.createBuffer(sizeof counters, "view counters"));
    PFVOX_TRY(const gpu::Buffer, pixelBuffer, device.createBuffer(4 * picture.pixels.size(), "view pixels"));
    PFVOX_CHECK(device.upload(parameterBuffer, 0, gpu::bytesOf(parameters)));
    PFVOX_CHECK(device.upload(counterBuffer, 0, gpu::bytesOf(counters)));

    const shared::ViewPushConstants push{.scene = scene.address(),
                                         .parameters = parameterBuffer.addressWords(),
                                         .pixels = pixelBuffer.addressWords(),
                                         .counters = counterBuffer.addressWords(),
                                         .linear = {0, 0},
                                         .reserved0 = {0, 0}};
    const gpu::Dispatch dispatch{
        .program = &program_, .pushConstants = gpu::bytesOf(push), .groups = groupsOf(settings)};
    PFVOX_TRY(const double, gpuMs, device.run({&dispatch, 1}));
    PFVOX_CHECK(device.download(pixelBuffer, 0, std::as_writable_bytes(std::span(picture.pixels))));
    PFVOX_CHECK(device.download(counterBuffer, 0, std::as_writable_bytes(std::span(&counters, 1))));
    statistics = statisticsOf(counters, gpuMs);
    return picture;
}

}  // namespace pfvox::viewer

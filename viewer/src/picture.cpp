#include "picture.hpp"

#include <algorithm>
#include <numeric>
#include <pfvox_shaders/shaders.hpp>
#include <utility>

#include "view_parameters.hpp"
#include "view_passes.hpp"

namespace pfvox::viewer {

namespace {

constexpr std::uint64_t kPixelsOfBand = 1u << 22;

}  // namespace

double sumOf(const PassTimes& times) {
    return std::accumulate(times.begin(), times.end(), 0.0);
}

PictureStatistics& PictureStatistics::operator+=(const PictureStatistics& other) {
    const auto add = [](auto& sums, const auto& more) {
        for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += more[i];
    };
    gpuMs += other.gpuMs;
    add(passMs, other.passMs);
    cameraRays += other.cameraRays;
    steps += other.steps;
    hits += other.hits;
    stepLimitRays += other.stepLimitRays;
    sunRays += other.sunRays;
    ambientRays += other.ambientRays;
    reflectionRays += other.reflectionRays;
    add(tiers, other.tiers);
    withoutValue += other.withoutValue;
    add(fieldStates, other.fieldStates);
    fieldAgrees += other.fieldAgrees;
    return *this;
}

Lighting lightingOf(const Scene& scene) {
    // Normalised here, in double: the length may be more than the square of a float holds.
    return {.sunDirection = glm::vec3(glm::normalize(scene.sun.direction)),
            .sunIrradiance = glm::vec3(scene.sun.irradiance),
            .skyZenith = glm::vec3(scene.sky.zenith),
            .skyHorizon = glm::vec3(scene.sky.horizon),
            .skyGround = glm::vec3(scene.sky.ground)};
}

/// Rows of a picture, and the buffers that they are drawn with.
struct PictureRenderer::Band {
    const gpu::Buffer& parameters;
    const gpu::Buffer& resolveParameters;
    const gpu::Buffer& counters;
    const gpu::Buffer& colors;
    const gpu::Buffer& pixels;
    std::uint32_t firstRow = 0;
    std::uint32_t rowCount = 0;
};

PictureRenderer::PictureRenderer(gpu::Program resolve)
    : resolve_(std::move(resolve)),
      passes_(std::make_unique<ViewPasses>()),
      seen_(std::make_unique<SeenBuffers>()) {}
PictureRenderer::PictureRenderer(PictureRenderer&&) noexcept = default;
PictureRenderer& PictureRenderer::operator=(PictureRenderer&&) noexcept = default;
PictureRenderer::~PictureRenderer() = default;

Result<PictureRenderer> PictureRenderer::create(gpu::Device& device) {
    PFVOX_TRY(
        gpu::Program, resolve,
        device.createProgram(shaders::kViewResolve, sizeof(shared::ResolvePushConstants), "view resolve"));
    return PictureRenderer(std::move(resolve));
}

Result<void> PictureRenderer::drawBand(gpu::Device& device, const PictureInput& input,
                                       const PictureSettings& settings, const Band& band,
                                       PictureStatistics& statistics) const {
    PassList list;
    PFVOX_CHECK(passes_->add(device, input, settings,
                             {.parameters = band.parameters.addressWords(),
                              .colors = band.colors.addressWords(),
                              .counters = band.counters.addressWords(),
                              .buffers = seen_.get(),
                              .firstRow = band.firstRow,
                              .rowCount = band.rowCount},
                             list));
    shared::ResolveParameters resolve{};  // no history
    resolve.width = settings.width;
    resolve.height = band.rowCount;
    PFVOX_CHECK(device.upload(band.resolveParameters, 0, gpu::bytesOf(resolve)));
    const shared::ResolvePushConstants push{.parameters = band.resolveParameters.addressWords(),
                                            .frame = band.colors.addressWords(),
                                            .lastFrame = {0, 0},
                                            .history = {0, 0},
                                            .lastHistory = {0, 0},
                                            .pixels = band.pixels.addressWords()};
    list.add(Pass::Resolve, resolve_, push, groupsFor(settings.width, band.rowCount));
    PFVOX_TRY(const std::vector<double>, times, device.runTimed(list.dispatches()));
    for (std::size_t i = 0; i < times.size(); ++i) {
        statistics.passMs[static_cast<std::size_t>(list.passes()[i])] += times[i];
        statistics.gpuMs += times[i];
    }
    return {};
}

Result<Picture> PictureRenderer::render(gpu::Device& device, const PictureInput& input,
                                        const ViewCamera& camera, const PictureSettings& settings,
                                        PictureStatistics& statistics) const {
    Picture picture{.width = settings.width,
                    .height = settings.height,
                    .pixels = std::vector<std::uint32_t>(std::size_t{settings.width} * settings.height)};
    const auto bandRows = static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(kPixelsOfBand / settings.width, 1, settings.height));
    const std::uint64_t bandPixels = std::uint64_t{settings.width} * bandRows;
    PFVOX_TRY(const gpu::Buffer, parameters,
              device.createBuffer(sizeof(shared::ViewParameters), "view parameters"));
    PFVOX_TRY(const gpu::Buffer, resolve,
              device.createBuffer(sizeof(shared::ResolveParameters), "resolve parameters"));
    PFVOX_TRY(const gpu::Buffer, counters, device.createBuffer(sizeof(ViewCounts), "view counters"));
    PFVOX_TRY(const gpu::Buffer, colors, device.createBuffer(sizeof(glm::vec4) * bandPixels, "colors"));
    PFVOX_TRY(const gpu::Buffer, pixels, device.createBuffer(4 * bandPixels, "view pixels"));
    PFVOX_CHECK(seen_->ensure(device, input, settings, bandPixels));
    ViewCounts counts{};
    PFVOX_CHECK(device.upload(parameters, 0, gpu::bytesOf(viewParametersOf(camera, settings, input))));
    PFVOX_CHECK(device.upload(counters, 0, gpu::bytesOf(counts)));

    PictureStatistics times;
    for (std::uint32_t row = 0; row < settings.height; row += bandRows) {
        const Band band{.parameters = parameters,
                        .resolveParameters = resolve,
                        .counters = counters,
                        .colors = colors,
                        .pixels = pixels,
                        .firstRow = row,
                        .rowCount = std::min(bandRows, settings.height - row)};
        PFVOX_CHECK(drawBand(device, input, settings, band, times));
        const std::span<std::uint32_t> rows =
            std::span(picture.pixels)
                .subspan(std::size_t{row} * settings.width, std::size_t{band.rowCount} * settings.width);
        PFVOX_CHECK(device.download(pixels, 0, std::as_writable_bytes(rows)));
    }
    PFVOX_CHECK(device.download(counters, 0, std::as_writable_bytes(std::span(counts))));
    statistics = statisticsOf(counts, std::uint64_t{settings.samplesPerPixel} * picture.pixels.size());
    statistics.gpuMs = times.gpuMs;
    statistics.passMs = times.passMs;
    return picture;
}

}  // namespace pfvox::viewer

#include "frame_sequence.hpp"

#include <pfvox/assert.hpp>
#include <pfvox_shaders/shaders.hpp>

#include "view_parameters.hpp"

namespace pfvox::viewer {

namespace {

constexpr std::uint32_t kMovingFrames = 12;  // of which a moving picture is the mean

}  // namespace

Result<FrameSequence> FrameSequence::create(gpu::Device& device) {
    PFVOX_TRY(
        gpu::Program, resolve,
        device.createProgram(shaders::kViewResolve, sizeof(shared::ResolvePushConstants), "view resolve"));
    return FrameSequence(std::move(resolve));
}

Result<void> FrameSequence::ensureBuffers(gpu::Device& device, std::uint64_t pixelCount) {
    if (buffers_ && buffers_->pixelCount == pixelCount) return {};
    buffers_.reset();  // before the new ones take memory
    const std::uint64_t colorBytes = sizeof(glm::vec4) * pixelCount;
    PFVOX_TRY(gpu::Buffer, view,
              device.createBuffer(kMaxTogether * sizeof(shared::ViewParameters), "view parameters"));
    PFVOX_TRY(gpu::Buffer, resolve,
              device.createBuffer(kMaxTogether * sizeof(shared::ResolveParameters), "resolve parameters"));
    PFVOX_TRY(gpu::Buffer, counters, device.createBuffer(sizeof(ViewCounts), "view counters"));
    PFVOX_TRY(gpu::Buffer, pixels, device.createBuffer(4 * pixelCount, "view pixels"));
    PFVOX_TRY(gpu::Buffer, frame, device.createBuffer(colorBytes, "frame"));
    PFVOX_TRY(gpu::Buffer, lastFrame, device.createBuffer(colorBytes, "last frame"));
    PFVOX_TRY(gpu::Buffer, history, device.createBuffer(colorBytes, "history"));
    PFVOX_TRY(gpu::Buffer, lastHistory, device.createBuffer(colorBytes, "last history"));
    buffers_.emplace(Buffers{std::move(view), std::move(resolve), std::move(counters), std::move(pixels),
                             std::move(frame), std::move(lastFrame), std::move(history),
                             std::move(lastHistory), SeenBuffers{}, pixelCount});
    return {};
}

Result<void> FrameSequence::uploadParameters(gpu::Device& device, const PictureInput& input,
                                             const ViewCamera& camera, const PictureSettings& settings,
                                             std::uint32_t slot) const {
    shared::ViewParameters view = viewParametersOf(camera, settings, input);
    view.firstSample = (last_ ? last_->index : 0) * settings.samplesPerPixel;
    const shared::ViewParameters before = last_ ? viewParametersOf(last_->camera, settings, input) : view;
    const shared::ResolveParameters resolve{.position = view.cameraPosition,
                                            .width = view.width,
                                            .forward = view.cameraForward,
                                            .height = view.height,
                                            .right = view.cameraRight,
                                            .moved = last_ && last_->camera == camera ? 0u : 1u,
                                            .up = view.cameraUp,
                                            .frameLimit = kMovingFrames,
                                            .lastPosition = before.cameraPosition,
                                            .hasHistory = last_ ? 1u : 0u,
                                            .lastForward = before.cameraForward,
                                            .reserved0 = 0,
                                            .lastRight = before.cameraRight,
                                            .reserved1 = 0,
                                            .lastUp = before.cameraUp,
                                            .reserved2 = 0};
    PFVOX_CHECK(device.upload(buffers_->viewParameters, slot * sizeof view, gpu::bytesOf(view)));
    return device.upload(buffers_->resolveParameters, slot * sizeof resolve, gpu::bytesOf(resolve));
}

Result<void> FrameSequence::addFrame(gpu::Device& device, const PictureInput& input,
                                     const PictureSettings& settings, std::uint32_t slot, PassList& list) {
    std::swap(buffers_->frame, buffers_->lastFrame);
    std::swap(buffers_->history, buffers_->lastHistory);
    const Buffers& b = *buffers_;
    PFVOX_CHECK(
        passes_.add(device, input, settings,
                    {.parameters = b.viewParameters.addressWords(slot * sizeof(shared::ViewParameters)),
                     .colors = b.frame.addressWords(),
                     .counters = b.counters.addressWords(),
                     .buffers = &b.seen,
                     .firstRow = 0,
                     .rowCount = settings.height},
                    list));
    const shared::ResolvePushConstants push{
        .parameters = b.resolveParameters.addressWords(slot * sizeof(shared::ResolveParameters)),
        .frame = b.frame.addressWords(),
        .lastFrame = b.lastFrame.addressWords(),
        .history = b.history.addressWords(),
        .lastHistory = b.lastHistory.addressWords(),
        .pixels = b.pixels.addressWords()};
    list.add(Pass::Resolve, resolve_, push, groupsFor(settings.width, settings.height));
    return {};
}

void FrameSequence::advance(const ViewCamera& camera, const PictureSettings& settings) {
    const bool still = last_ && last_->camera == camera;
    last_ = Last{.camera = camera,
                 .settings = settings,
                 .still = still ? last_->still + 1 : 1,
                 .index = last_ ? last_->index + 1 : 1};
}

Result<DrawnFrames> FrameSequence::drawMany(gpu::Device& device, const PictureInput& input,
                                            const ViewCamera& camera, const PictureSettings& settings,
                                            std::uint32_t count) {
    PFVOX_ASSERT(count >= 1 && count <= kMaxTogether);
    if (last_ && !(last_->settings == settings)) last_.reset();
    const std::uint64_t pixelCount = std::uint64_t{settings.width} * settings.height;
    PFVOX_CHECK(ensureBuffers(device, pixelCount));
    PFVOX_CHECK(buffers_->seen.ensure(device, input, settings, pixelCount));
    ViewCounts counts{};
    PFVOX_CHECK(device.upload(buffers_->counters, 0, gpu::bytesOf(counts)));
    PassList list;
    for (std::uint32_t slot = 0; slot < count; ++slot) {
        PFVOX_CHECK(uploadParameters(device, input, camera, settings, slot));
        PFVOX_CHECK(addFrame(device, input, settings, slot, list));
        advance(camera, settings);
    }
    PFVOX_TRY(const std::vector<double>, times, device.runTimed(list.dispatches()));
    PFVOX_CHECK(device.download(buffers_->counters, 0, std::as_writable_bytes(std::span(counts))));

    DrawnFrames drawn{.statistics = statisticsOf(counts, count * settings.samplesPerPixel * pixelCount),
                      .times = std::vector<PassTimes>(count)};
    const std::size_t perFrame = times.size() / count;
    for (std::size_t i = 0; i < times.size(); ++i) {
        const auto pass = static_cast<std::size_t>(list.passes()[i]);
        drawn.times[i / perFrame][pass] += times[i];
        drawn.statistics.passMs[pass] += times[i];
        drawn.statistics.gpuMs += times[i];
    }
    return drawn;
}

Result<PictureStatistics> FrameSequence::draw(gpu::Device& device, const PictureInput& input,
                                              const ViewCamera& camera, const PictureSettings& settings) {
    PFVOX_TRY(const DrawnFrames, drawn, drawMany(device, input, camera, settings, 1));
    return drawn.statistics;
}

Result<Picture> FrameSequence::picture(gpu::Device& device) const {
    PFVOX_ASSERT(last_ && buffers_);
    Picture picture{.width = size().x, .height = size().y, .pixels = {}};
    picture.pixels.resize(buffers_->pixelCount);
    PFVOX_CHECK(device.download(buffers_->pixels, 0, std::as_writable_bytes(std::span(picture.pixels))));
    return picture;
}

}  // namespace pfvox::viewer

#include "frame_sequence.hpp"

#include <array>
#include <pfvox/assert.hpp>
#include <pfvox_shaders/shaders.hpp>

#include "view_parameters.hpp"

namespace pfvox::viewer {

namespace {

constexpr std::uint32_t kMovingFrames = 12;  // of which a moving picture is the mean

}  // namespace

Result<FrameSequence> FrameSequence::create(gpu::Device& device) {
    PFVOX_TRY(gpu::Program, view,
              device.createProgram(shaders::kViewScene, sizeof(shared::ViewPushConstants), "view scene"));
    PFVOX_TRY(gpu::Program, resolve,
              device.createProgram(shaders::kViewResolve, sizeof(shared::ResolvePushConstants), "view resolve"));
    return FrameSequence(std::move(view), std::move(resolve));
}

Result<void> FrameSequence::ensureBuffers(gpu::Device& device, std::uint64_t pixelCount) {
    if (buffers_ && buffers_->pixelCount == pixelCount) return {};
    buffers_.reset();  // before the new ones take memory
    const std::uint64_t colourBytes = sizeof(glm::vec4) * pixelCount;
    PFVOX_TRY(gpu::Buffer, view, device.createBuffer(sizeof(shared::ViewParameters), "view parameters"));
    PFVOX_TRY(gpu::Buffer, resolve, device.createBuffer(sizeof(shared::ResolveParameters), "resolve parameters"));
    PFVOX_TRY(gpu::Buffer, counters, device.createBuffer(sizeof(shared::ViewCounters), "view counters"));
    PFVOX_TRY(gpu::Buffer, pixels, device.createBuffer(4 * pixelCount, "view pixels"));
    PFVOX_TRY(gpu::Buffer, frame, device.createBuffer(colourBytes, "frame"));
    PFVOX_TRY(gpu::Buffer, lastFrame, device.createBuffer(colourBytes, "last frame"));
    PFVOX_TRY(gpu::Buffer, history, device.createBuffer(colourBytes, "history"));
    PFVOX_TRY(gpu::Buffer, lastHistory, device.createBuffer(colourBytes, "last history"));
    buffers_.emplace(Buffers{std::move(view), std::move(resolve), std::move(counters), std::move(pixels),
                             std::move(frame), std::move(lastFrame), std::move(history), std::move(lastHistory),
                             pixelCount});
    return {};
}

Result<void> FrameSequence::uploadParameters(gpu::Device& device, const ViewCamera& camera,
                                             const PictureSettings& settings) const {
    shared::ViewParameters view = viewParametersOf(camera, settings);
    view.firstSample = (last_ ? last_->index : 0) * settings.samplesPerPixel;
    const shared::ViewParameters before = last_ ? viewParametersOf(last_->camera, settings) : view;
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
    const shared::ViewCounters counters{};
    PFVOX_CHECK(device.upload(buffers_->viewParameters, 0, gpu::bytesOf(view)));
    PFVOX_CHECK(device.upload(buffers_->resolveParameters, 0, gpu::bytesOf(resolve)));
    return device.upload(buffers_->counters, 0, gpu::bytesOf(counters));
}

Result<PictureStatistics> FrameSequence::draw(gpu::Device& device, const gpu::Scene& scene,
                                              const ViewCamera& camera, const PictureSettings& settings) {
    if (last_ && !(last_->settings == settings)) last_.reset();
    PFVOX_CHECK(ensureBuffers(device, std::uint64_t{settings.width} * settings.height));
    PFVOX_CHECK(uploadParameters(device, camera, settings));
    std::swap(buffers_->frame, buffers_->lastFrame);
    std::swap(buffers_->history, buffers_->lastHistory);

    const Buffers& b = *buffers_;
    const shared::ViewPushConstants viewPush{.scene = scene.address(),
                                             .parameters = b.viewParameters.addressWords(),
                                             .pixels = b.pixels.addressWords(),
                                             .counters = b.counters.addressWords(),
                                             .linear = b.frame.addressWords(),
                                             .reserved0 = {0, 0}};
    const shared::ResolvePushConstants resolvePush{.parameters = b.resolveParameters.addressWords(),
                                                   .frame = b.frame.addressWords(),
                                                   .lastFrame = b.lastFrame.addressWords(),
                                                   .history = b.history.addressWords(),
                                                   .lastHistory = b.lastHistory.addressWords(),
                                                   .pixels = b.pixels.addressWords()};
    const glm::uvec3 groups = groupsOf(settings);
    const std::array dispatches{
        gpu::Dispatch{.program = &view_, .pushConstants = gpu::bytesOf(viewPush), .groups = groups},
        gpu::Dispatch{.program = &resolve_, .pushConstants = gpu::bytesOf(resolvePush), .groups = groups}};
    PFVOX_TRY(const double, gpuMs, device.run(dispatches));
    shared::ViewCounters counters{};
    PFVOX_CHECK(device.download(b.counters, 0, std::as_writable_bytes(std::span(&counters, 1))));

    const bool still = last_ && last_->camera == camera;
    last_ = Last{.camera = camera,
                 .settings = settings,
                 .still = still ? last_->still + 1 : 1,
                 .index = last_ ? last_->index + 1 : 1};
    return statisticsOf(counters, gpuMs);
}

Result<Picture> FrameSequence::picture(gpu::Device& device) const {
    PFVOX_ASSERT(last_ && buffers_);
    Picture picture{.width = size().x, .height = size().y, .pixels = {}};
    picture.pixels.resize(buffers_->pixelCount);
    PFVOX_CHECK(device.download(buffers_->pixels, 0, std::as_writable_bytes(std::span(picture.pixels))));
    return picture;
}

}  // namespace pfvox::viewer

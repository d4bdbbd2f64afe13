// FrameSequence: frames that follow one another become one picture (temporal anti-aliasing).
//
//     view_scene.comp -> colour and distance -> view_resolve.comp (with the history) -> pixels
//
// While camera, size and settings stay, the picture is the mean of all frames and gets ever smoother. When the camera
// moves the history moves along; when anything else changes, it starts anew.
#pragma once

#include <optional>
#include <utility>

#include "picture.hpp"

namespace pfvox::viewer {

class FrameSequence {
  public:
    /// Errors: those of Device::createProgram.
    static Result<FrameSequence> create(gpu::Device& device);

    /// Draws the next frame into pixels(). Errors: GpuOutOfMemory, GpuLost.
    Result<PictureStatistics> draw(gpu::Device& device, const gpu::Scene& scene, const ViewCamera& camera,
                                   const PictureSettings& settings);
    /// Forgets the frames so far: another scene.
    void restart() { last_.reset(); }

    /// Frames of the same camera and settings so far.
    std::uint32_t frames() const { return last_ ? last_->still : 0; }
    /// One RGBA8 word each, rows from the top; null before the first frame.
    const gpu::Buffer* pixels() const { return buffers_ ? &buffers_->pixels : nullptr; }
    glm::uvec2 size() const { return last_ ? glm::uvec2(last_->settings.width, last_->settings.height) : glm::uvec2(0); }
    /// The picture so far, on the CPU. Only after a frame was drawn. Errors: GpuOutOfMemory, GpuLost.
    Result<Picture> picture(gpu::Device& device) const;

  private:
    struct Buffers {
        gpu::Buffer viewParameters, resolveParameters, counters, pixels;
        gpu::Buffer frame, lastFrame;      ///< colour and distance
        gpu::Buffer history, lastHistory;  ///< mean and number of frames
        std::uint64_t pixelCount = 0;
    };
    struct Last {
        ViewCamera camera;
        PictureSettings settings;
        std::uint32_t still = 0;  ///< frames since the camera moved
        std::uint32_t index = 0;  ///< frames since the start
    };
    FrameSequence(gpu::Program view, gpu::Program resolve)
        : view_(std::move(view)), resolve_(std::move(resolve)) {}
    Result<void> ensureBuffers(gpu::Device& device, std::uint64_t pixelCount);
    Result<void> uploadParameters(gpu::Device& device, const ViewCamera& camera,
                                  const PictureSettings& settings) const;

    gpu::Program view_;
    gpu::Program resolve_;
    std::optional<Buffers> buffers_;
    std::optional<Last> last_;
};

}  // namespace pfvox::viewer

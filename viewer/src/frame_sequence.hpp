// FrameSequence: frames that follow one another become one picture (temporal anti-aliasing).
//
//     ViewPasses -> color and distance -> view_resolve.comp (with the history) -> pixels
//
// While camera, size and settings stay, the picture is the mean of all frames and gets ever smoother. When
// the camera moves the history moves along; when anything else changes, it starts anew.
#pragma once

#include <optional>
#include <utility>

#include "picture.hpp"
#include "view_passes.hpp"

namespace pfvox::viewer {

/// Frames drawn together.
struct DrawnFrames {
    PictureStatistics statistics;  ///< of all of them
    std::vector<PassTimes> times;  ///< of each
};

class FrameSequence {
  public:
    /// As many frames as drawMany() takes at once.
    static constexpr std::uint32_t kMaxTogether = 64;

    /// Errors: those of Device::createProgram.
    static Result<FrameSequence> create(gpu::Device& device);

    /// Draws the next frame into pixels(). Errors: GpuOutOfMemory, GpuLost.
    Result<PictureStatistics> draw(gpu::Device& device, const PictureInput& input, const ViewCamera& camera,
                                   const PictureSettings& settings);
    /// Draws 1 to kMaxTogether frames without waiting between them. Errors: as draw().
    Result<DrawnFrames> drawMany(gpu::Device& device, const PictureInput& input, const ViewCamera& camera,
                                 const PictureSettings& settings, std::uint32_t count);
    /// Forgets the frames so far: another scene.
    void restart() { last_.reset(); }

    /// Frames of the same camera and settings so far.
    std::uint32_t frames() const { return last_ ? last_->still : 0; }
    /// One RGBA8 word each, rows from the top; null before the first frame.
    const gpu::Buffer* pixels() const { return buffers_ ? &buffers_->pixels : nullptr; }
    glm::uvec2 size() const {
        return last_ ? glm::uvec2(last_->settings.width, last_->settings.height) : glm::uvec2(0);
    }
    /// The picture so far, on the CPU. Only after a frame was drawn. Errors: GpuOutOfMemory, GpuLost.
    Result<Picture> picture(gpu::Device& device) const;

  private:
    struct Buffers {
        gpu::Buffer viewParameters, resolveParameters;  ///< kMaxTogether of each
        gpu::Buffer counters, pixels;
        gpu::Buffer frame, lastFrame;      ///< color and distance
        gpu::Buffer history, lastHistory;  ///< mean and number of frames
        SeenBuffers seen;
        std::uint64_t pixelCount = 0;
    };
    struct Last {
        ViewCamera camera;
        PictureSettings settings;
        std::uint32_t still = 0;  ///< frames since the camera moved
        std::uint32_t index = 0;  ///< frames since the start
    };
    explicit FrameSequence(gpu::Program resolve) : resolve_(std::move(resolve)) {}
    Result<void> ensureBuffers(gpu::Device& device, std::uint64_t pixelCount);
    Result<void> uploadParameters(gpu::Device& device, const PictureInput& input, const ViewCamera& camera,
                                  const PictureSettings& settings, std::uint32_t slot) const;
    Result<void> addFrame(gpu::Device& device, const PictureInput& input, const PictureSettings& settings,
                          std::uint32_t slot, PassList& list);
    void advance(const ViewCamera& camera, const PictureSettings& settings);

    gpu::Program resolve_;
    ViewPasses passes_;
    std::optional<Buffers> buffers_;
    std::optional<Last> last_;
};

}  // namespace pfvox::viewer

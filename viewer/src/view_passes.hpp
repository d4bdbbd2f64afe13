// ViewPasses: the programs that make a frame, and in which order they run.
//
//     PictureInput, settings -> [ViewPasses::add] -> PassList -> Device::runTimed
//
// Light takes geometry, sun, ambient (without probes), reflections (of scenes that have any) and light; the
// other views one program. Programs with and without probes, and with and without glass, are different ones:
// what a scene lacks costs nothing.
#pragma once

#include <array>
#include <cstring>
#include <deque>
#include <map>
#include <pfvox/gpu.hpp>
#include <pfvox/gpu_scene.hpp>
#include <string_view>
#include <tuple>
#include <vector>

#include "picture.hpp"

namespace pfvox::viewer {

/// Dispatches of one or more frames and what each belongs to.
class PassList {
  public:
    template <class Push>
    void add(Pass pass, const gpu::Program& program, const Push& push, glm::uvec3 groups) {
        std::vector<std::byte>& bytes = pushes_.emplace_back(sizeof push);
        std::memcpy(bytes.data(), &push, sizeof push);
        dispatches_.push_back({.program = &program, .pushConstants = bytes, .groups = groups});
        passes_.push_back(pass);
    }
    std::span<const gpu::Dispatch> dispatches() const { return dispatches_; }
    std::span<const Pass> passes() const { return passes_; }

  private:
    std::deque<std::vector<std::byte>> pushes_;
    std::vector<gpu::Dispatch> dispatches_;
    std::vector<Pass> passes_;
};

/// What the passes of a frame write besides its colors. Made as large as the frame and as rich as the scene
/// needs.
class SeenBuffers {
  public:
    /// Errors: GpuOutOfMemory.
    Result<void> ensure(gpu::Device& device, const PictureInput& input, const PictureSettings& settings,
                        std::uint64_t pixelCount);
    glm::uvec2 seen() const { return seen_ ? seen_->addressWords() : glm::uvec2(0); }
    glm::uvec2 shine() const { return shine_ ? shine_->addressWords() : glm::uvec2(0); }

  private:
    std::optional<gpu::Buffer> seen_;
    std::optional<gpu::Buffer> shine_;
};

/// Device addresses, and the rows that the buffers hold.
struct PassTargets {
    glm::uvec2 parameters{0};
    glm::uvec2 colors{0};
    glm::uvec2 counters{0};
    const SeenBuffers* buffers = nullptr;
    std::uint32_t firstRow = 0;
    std::uint32_t rowCount = 0;
};

class ViewPasses {
  public:
    /// Adds what computes the colors of one frame. Programs are made when they are first needed. Errors:
    /// those of Device::createProgram.
    Result<void> add(gpu::Device& device, const PictureInput& input, const PictureSettings& settings,
                     const PassTargets& targets, PassList& list);

  private:
    using Key = std::tuple<Pass, bool, bool, bool>;  ///< with probes, with glass, with faces
    Result<const gpu::Program*> program(gpu::Device& device, const Key& key);
    std::map<Key, gpu::Program> programs_;
};

/// The mode that is drawn: the final picture where probes are needed and there are none.
ViewMode drawnMode(const PictureInput& input, const PictureSettings& settings);

/// Whether there is a ground in this picture.
bool hasGround(const PictureInput& input, const PictureSettings& settings);

/// Whether indirect light is guessed, if only that of the ground.
bool isGuessed(const PictureInput& input, const PictureSettings& settings);

/// Workgroups that cover so many pixels.
glm::uvec3 groupsFor(std::uint32_t width, std::uint32_t height);

}  // namespace pfvox::viewer

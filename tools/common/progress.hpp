// Progress: how far a run over many files has come, on one line that replaces itself.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "common/reporter.hpp"

namespace pfvox::tools {

/// Not thread-safe: the batch calls it from one thread at a time.
class Progress {
  public:
    Progress(Reporter& reporter, std::size_t fileCount);

    /// One more file is done. `voxels` that went through it, 0 where it was skipped or failed.
    void advance(std::uint64_t voxels);
    double elapsedSeconds() const;

  private:
    using Clock = std::chrono::steady_clock;

    Reporter& reporter_;
    std::size_t fileCount_;
    std::size_t filesDone_ = 0;
    std::uint64_t voxelsDone_ = 0;
    Clock::time_point start_ = Clock::now();
    Clock::time_point shown_;
};

}  // namespace pfvox::tools

#include "common/progress.hpp"

#include <fmt/format.h>

#include "common/text.hpp"

namespace pfvox::tools {

namespace {
constexpr std::chrono::milliseconds kMinInterval{80};
}

Progress::Progress(Reporter& reporter, std::size_t fileCount)
    : reporter_(reporter), fileCount_(fileCount), shown_(start_) {}

void Progress::advance(std::uint64_t voxels) {
    ++filesDone_;
    voxelsDone_ += voxels;
    const Clock::time_point now = Clock::now();
    if (!reporter_.showsProgress() || now - shown_ < kMinInterval || filesDone_ == fileCount_) return;
    shown_ = now;
    const double seconds = elapsedSeconds();
    const double left =
        seconds * static_cast<double>(fileCount_ - filesDone_) / static_cast<double>(filesDone_);
    reporter_.progress(fmt::format("{}/{} files, {} voxels/s, {} left", filesDone_, fileCount_,
                                   formatRoughly(static_cast<double>(voxelsDone_) / seconds),
                                   formatDuration(left)));
}

double Progress::elapsedSeconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
}

}  // namespace pfvox::tools

// SliceReader: slices of SVX channels by number, and where their pixels lie in the grid.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <string>

#include "import/svx/manifest.hpp"
#include "import/svx/png_image.hpp"
#include "import/svx/zip_archive.hpp"

namespace pfvox::import::svx {

/// How slices stack up to the grid. Column i and row j (0 = top row) of slice s are voxel
///     X: (s, i, j)    Y: (i, s, j)    Z: (i, j, s).
class SliceStack {
  public:
    SliceStack(glm::ivec3 gridSize, int axis)
        : gridSize_(gridSize), axis_(axis), columnAxis_(axis == 0 ? 1 : 0), rowAxis_(axis == 2 ? 1 : 2) {}

    std::uint32_t sliceCount() const { return static_cast<std::uint32_t>(gridSize_[axis_]); }
    ImageSize imageSize() const {
        return {.width = static_cast<std::uint32_t>(gridSize_[columnAxis_]),
                .height = static_cast<std::uint32_t>(gridSize_[rowAxis_])};
    }
    glm::ivec3 voxelAt(std::uint32_t slice, std::uint32_t column, std::uint32_t row) const {
        glm::ivec3 voxel;
        voxel[axis_] = static_cast<int>(slice);
        voxel[columnAxis_] = static_cast<int>(column);
        voxel[rowAxis_] = static_cast<int>(row);
        return voxel;
    }

  private:
    glm::ivec3 gridSize_;
    int axis_;
    int columnAxis_;
    int rowAxis_;
};

class SliceReader {
  public:
    /// References must outlive the reader.
    SliceReader(const ZipArchive& archive, SliceStack stack, const Limits& limits, Diagnostics& diagnostics)
        : archive_(archive), stack_(stack), limits_(limits), diagnostics_(diagnostics) {}

    const SliceStack& stack() const { return stack_; }

    /// Looks for every slice of the channel by name before any is read; reports slices beyond the last one.
    /// Errors: BadReference with the name of a missing slice, LimitExceeded when one slice takes more than
    /// maxMemoryBytes.
    Result<void> checkPresence(const Channel& channel);

    /// Errors: those of ZipArchive::read and decode...Png, with the entry's name as context.
    Result<ScalarImage> scalar(const Channel& channel, std::uint32_t slice);
    Result<ColorImage> color(const Channel& channel, std::uint32_t slice);

  private:
    struct Slice {
        std::string name;
        std::vector<std::byte> png;
    };
    Result<Slice> read(const Channel& channel, std::uint32_t slice);
    void reportExtraSlices(const Channel& channel);
    void reportBits(const Channel& channel, std::uint32_t bitDepth);

    const ZipArchive& archive_;
    SliceStack stack_;
    Limits limits_;
    Diagnostics& diagnostics_;
    bool bitsReported_ = false;
};

}  // namespace pfvox::import::svx

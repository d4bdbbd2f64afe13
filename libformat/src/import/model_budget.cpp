#include "import/model_budget.hpp"

#include <fmt/format.h>

namespace pfvox::import {

namespace {

// Both keep what may be written between two checks far below the limits: 16 MiB of bricks, 10 MiB of empty
// tables.
constexpr std::uint64_t kStepsPerCheck = 16384;
constexpr std::size_t kRegionsPerCheck = 64;

}  // namespace

void ModelBudget::close(const VoxelModel& model) {
    closedBytes_ += model.memoryBytes();
    regionsAtNextCheck_ = 0;
}

Result<void> ModelBudget::check(const VoxelModel& model) const {
    if (model.regions().size() > limits_.maxRegions) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("the model spreads over more than {} regions of 256^3 voxels (maxRegions)",
                                limits_.maxRegions));
    }
    if (closedBytes_ + model.memoryBytes() > limits_.maxMemoryBytes) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("the voxels take more than {} bytes of memory (maxMemoryBytes)",
                                limits_.maxMemoryBytes));
    }
    return {};
}

Result<void> ModelBudget::step(const VoxelModel& model) {
    if (++steps_ % kStepsPerCheck != 0 && model.regions().size() < regionsAtNextCheck_) return {};
    regionsAtNextCheck_ = model.regions().size() + kRegionsPerCheck;
    return check(model);
}

Result<void> ModelBudget::checkTile(const VoxelModel& model, int edgeLog2) const {
    if (edgeLog2 < kRegionEdgeLog2) return {};
    const int log2Regions = 3 * (edgeLog2 - kRegionEdgeLog2);
    const std::uint64_t present = model.regions().size();
    if (log2Regions >= 32 || present + (std::uint64_t{1} << log2Regions) > limits_.maxRegions) {
        return fail(
            ErrorCode::LimitExceeded,
            fmt::format("a solid cube of edge 2^{} needs more than {} regions of 256^3 voxels (maxRegions)",
                        edgeLog2, limits_.maxRegions));
    }
    return {};
}

}  // namespace pfvox::import

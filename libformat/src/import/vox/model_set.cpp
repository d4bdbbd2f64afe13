#include "import/vox/model_set.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <atomic>

namespace pfvox::import::vox {

namespace {

/// One kind of trouble over all models: reported once, with the first place.
void reportVoxels(const std::vector<ModelRecord>& records, const std::vector<ScatterReport>& reports,
                  std::uint64_t ScatterReport::*count, std::string_view id, std::string_view what,
                  Diagnostics& diagnostics) {
    std::uint64_t total = 0;
    std::optional<std::size_t> first;
    for (std::size_t model = 0; model < reports.size(); ++model) {
        if (reports[model].*count == 0) continue;
        total += reports[model].*count;
        if (!first) first = model;
    }
    if (!first) return;
    diagnostics.report({.severity = Severity::Warning,
                        .id = std::string(id),
                        .message = fmt::format("{} voxels {}; the first in model {}", total, what, *first),
                        .offsetBytes = records[*first].offsetBytes});
}

}  // namespace

Result<ModelSet> buildModels(const std::vector<ModelRecord>& records, const std::vector<bool>& wanted,
                             const Limits& limits, Diagnostics& diagnostics) {
    ModelSet set;
    set.models.resize(records.size());
    std::vector<ScatterReport> reports(records.size());
    // A sum is the same in any order, so whether the limit is exceeded does not depend on the threads.
    std::atomic<std::uint64_t> memoryBytes = 0;
    tbb::parallel_for(std::size_t{0}, records.size(), [&](std::size_t model) {
        if (!wanted[model] || memoryBytes.load(std::memory_order_relaxed) > limits.maxMemoryBytes) return;
        reports[model] = scatterVoxels(records[model], set.models[model]);
        memoryBytes += set.models[model].memoryBytes();
    });
    if (memoryBytes > limits.maxMemoryBytes) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("the voxel models take more than {} bytes (limit maxMemoryBytes)",
                                limits.maxMemoryBytes));
    }

    for (const ScatterReport& report : reports) {
        for (std::size_t v = 0; v < kPaletteSize; ++v)
            set.usedIndices[v] = set.usedIndices[v] || report.usedIndices[v];
    }
    reportVoxels(records, reports, &ScatterReport::outside, "vox-voxels-outside",
                 "lie outside SIZE and are dropped", diagnostics);
    reportVoxels(records, reports, &ScatterReport::colorless, "vox-voxels-without-color",
                 "have palette index 0, which is no color, and are dropped", diagnostics);
    reportVoxels(records, reports, &ScatterReport::duplicates, "vox-duplicate-voxels",
                 "lie where a later one does, which replaces them", diagnostics);
    return set;
}

}  // namespace pfvox::import::vox

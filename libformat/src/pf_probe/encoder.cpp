// encodePfProbe: a field that fits into memory.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "guarded.hpp"
#include "pf_probe/composer.hpp"

namespace pfvox {

namespace {

Result<std::vector<std::byte>> encode(const ProbeField& field, const ProbeEncodeSettings& settings) {
    PFVOX_CHECK(checkProbeInfo(field.info));
    if (field.probes.size() != field.info.range.size()) {
        return fail(ErrorCode::BadStructure, fmt::format("{} probes for the range {}:{}", field.probes.size(),
                                                         field.info.range.first, field.info.range.end));
    }
    std::vector<Result<probe::PackedProbe>> packed(field.probes.size());
    tbb::parallel_for(std::size_t{0}, field.probes.size(), [&](std::size_t i) {
        const auto index = field.info.range.first + static_cast<std::uint32_t>(i);
        const auto checked = checkProbeData(field.info, index, field.probes[i]);
        if (checked) {
            packed[i] = probe::packProbe(field.probes[i], settings.zstdLevel);
        } else {
            packed[i] = tl::make_unexpected(checked.error());
        }
    });
    probe::FilePlan plan{.info = field.info,
                         .contentKey = settings.contentKey,
                         .probes = {},
                         .proximity = field.proximity ? &*field.proximity : nullptr};
    for (const auto& probe : packed) {
        if (!probe) return tl::make_unexpected(probe.error());
        plan.probes.push_back(probe->entry);
    }
    PFVOX_TRY(auto, file, probe::composeHead(plan));
    for (const auto& probe : packed) file.insert(file.end(), probe->stored.begin(), probe->stored.end());
    return file;
}

}  // namespace

Result<std::vector<std::byte>> encodePfProbe(const ProbeField& field, const ProbeEncodeSettings& settings) {
    return guarded([&] { return encode(field, settings); });
}

}  // namespace pfvox

#include "pf_probe/probe_list.hpp"

#include <fmt/format.h>

namespace pfvox::probe {

std::vector<ProbeRange> rangesOf(std::span<const std::uint32_t> probes) {
    std::vector<ProbeRange> ranges;
    for (const std::uint32_t probe : probes) {
        if (ranges.empty() || ranges.back().end != probe) ranges.push_back({probe, probe});
        ++ranges.back().end;
    }
    return ranges;
}

std::string listProbes(std::span<const ProbeRange> ranges) {
    constexpr std::size_t kMaxRanges = 8;
    std::string text;
    std::uint64_t more = 0;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const ProbeRange range = ranges[i];
        if (i >= kMaxRanges) {
            more += range.size();
            continue;
        }
        if (i != 0) text += ", ";
        text +=
            range.size() == 1 ? fmt::format("{}", range.first) : fmt::format("{}:{}", range.first, range.end);
    }
    if (more != 0) text += fmt::format(" and {} more", more);
    return text;
}

}  // namespace pfvox::probe

#include "pf_probe/probe_list.hpp"

#include <fmt/format.h>

namespace pfvox::probe {

std::string listProbes(std::span<const std::uint32_t> probes) {
    constexpr int kMaxRanges = 8;
    std::string text;
    std::size_t i = 0;
    for (int range = 0; i < probes.size() && range < kMaxRanges; ++range) {
        std::size_t end = i + 1;
        while (end < probes.size() && probes[end] == probes[end - 1] + 1) ++end;
        if (range != 0) text += ", ";
        text += end - i == 1 ? fmt::format("{}", probes[i])
                             : fmt::format("{}:{}", probes[i], probes[end - 1] + 1);
        i = end;
    }
    if (i < probes.size()) text += fmt::format(" and {} more", probes.size() - i);
    return text;
}

}  // namespace pfvox::probe

// Probe indices in messages.
#pragma once

#include <cstdint>
#include <pfvox/pf_probe.hpp>
#include <span>
#include <string>
#include <vector>

namespace pfvox::probe {

/// Runs of probes, which ascend.
std::vector<ProbeRange> rangesOf(std::span<const std::uint32_t> probes);

/// "4, 7, 9:12 and 30 more": half-open ranges, as `--probes` takes them. They ascend and do not touch.
std::string listProbes(std::span<const ProbeRange> ranges);

}  // namespace pfvox::probe

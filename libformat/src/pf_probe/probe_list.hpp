// Probe indices in messages.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace pfvox::probe {

/// "4, 7, 9:12 and 30 more": half-open ranges, as `--probes` takes them. `probes` ascend.
std::string listProbes(std::span<const std::uint32_t> probes);

}  // namespace pfvox::probe

// Section BAKE: the settings that PF_PROBE 1.0 does not keep.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/probe_settings.hpp>
#include <span>
#include <vector>

#include "pf_probe/layout.hpp"

namespace pfvox::probe {

/// Known settings with an id, ascending. Empty = nothing to write.
std::vector<probe_layout::Setting> settingEntries(const ProbeBakeSettings& settings);

/// Into settings whose optional ones are unknown. Ids of later versions are left out. Errors: BadValue,
/// BadStructure.
Result<void> readSettingEntries(std::span<const probe_layout::Setting> entries, ProbeBakeSettings& settings);

/// What INFO says of the limit of bounces: 0 = no limit, or nothing known.
std::uint32_t bouncesOfInfo(const ProbeBakeSettings& settings);
/// The limit as far as INFO alone tells it: its 0 was written for --bounces 0, too.
std::optional<std::uint32_t> bouncesFromInfo(std::uint32_t stored);

}  // namespace pfvox::probe

// Which settings a bake can follow.
#pragma once

#include <pfvox/bake.hpp>

namespace pfvox::bake {

/// Errors: BadValue, with the name of the setting and what it may be.
Result<void> checkSettings(const BakeSettings& settings, const ProbeGrid& grid);

}  // namespace pfvox::bake

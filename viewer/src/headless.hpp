// pfview without a window: load, draw one picture, write it.
#pragma once

#include <pfvox/error.hpp>

#include "options.hpp"

namespace pfvox::viewer {

Result<void> runHeadless(const Options& options, Diagnostics& diagnostics);

}  // namespace pfvox::viewer

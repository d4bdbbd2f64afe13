// App: pfview with a window: device, window, session and overlay, and the loop that joins them.
#pragma once

#include <pfvox/error.hpp>

#include "options.hpp"

namespace pfvox::viewer {

/// Returns when the window is closed. Errors: GpuUnavailable, GpuLost, GpuOutOfMemory; Internal when the
/// validation layer, asked for, had complaints. Files that cannot be shown are no errors: the window tells.
Result<void> runWindow(const Options& options, Diagnostics& diagnostics);

}  // namespace pfvox::viewer

// Pipe: what comes out of one until its writers are done, as `/dev/stdin` or `<(command)` names it.
#pragma once

#include <pfvox/files.hpp>

namespace pfvox::io {

/// All of it, in memory. A pipe that nobody writes into is refused instead of waited for. Errors:
/// FileNotReadable, LimitExceeded.
Result<FileBytes> readPipe(const std::filesystem::path& file, std::uint64_t maxBytes);

}  // namespace pfvox::io

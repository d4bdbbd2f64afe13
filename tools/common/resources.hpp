// Resources: how much of threads and files the system leaves to this process. Where it is little, work goes
// on with less instead of ending in the middle.
#pragma once

#include <cstddef>

namespace pfvox::tools {

/// How many more threads, `wanted` at most, may be started. Where the system has fewer than that, half of
/// them: the rest needs memory, too.
int affordableThreads(int wanted);

/// How many more files may be open at once, at least 1; a reserve for libraries is left out.
std::size_t openableFiles();

}  // namespace pfvox::tools

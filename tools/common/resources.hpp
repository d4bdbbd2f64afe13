// Resources: how much of threads and files the system leaves to this process. Where it is little, work goes
// on with less instead of ending in the middle.
#pragma once

#include <cstddef>

namespace pfvox::tools {

/// How many more threads, `wanted` at most, may be started now. Where it is fewer than that, half of what
/// could be: the rest needs memory, too. TBB ends the program when one of its threads cannot be started.
int startableThreads(int wanted);

/// How many more files may be open at once, at least 1; a reserve for libraries is left out.
std::size_t openableFiles();

}  // namespace pfvox::tools

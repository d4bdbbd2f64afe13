// Threads: how many the system leaves to this process. Libraries below us end the program when one of theirs
// cannot be started, so whoever uses them asks before.
#pragma once

namespace pfvox {

/// How many more threads, `wanted` at most, can be started now: starts them, and lets them end.
int startableThreads(int wanted);

}  // namespace pfvox

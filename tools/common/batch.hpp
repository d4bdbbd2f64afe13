// Batch: runs the same work on many assets in parallel and hands the results out in order.
//
// Work may use TBB itself; it shares the threads of the batch, so that `-j` bounds a run as a whole. What is
// handed out does not depend on the number of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace pfvox::tools {

struct BatchSettings {
    int threads = 0;        ///< 0 = one for each processor
    bool failFast = false;  ///< start nothing new after the first failure
};

struct BatchItem {
    /// Does the work of asset `index`; returns false when it failed. Called from several threads, each index
    /// once.
    std::function<bool(std::size_t index)> work;
    /// The part of the work that waits for the disk, called where `work` returned true; returns false when it
    /// failed. Runs beside further work on threads of its own, more than there are processors: disks finish
    /// several syncs in the time of one. May be empty.
    std::function<bool(std::size_t index)> commit = {};
    /// Called for index 0, 1, 2 ... as soon as that asset and all before it are finished; never by two
    /// threads at once.
    std::function<void(std::size_t index)> finished;
    /// Called for every asset as soon as it is done, in any order; never by two threads at once. May be
    /// empty.
    std::function<void(std::size_t index)> progressed = {};
};

/// Runs assets 0 to count - 1. Returns how many were started; less than count only with failFast, and then
/// `finished` was called for those that ran.
std::size_t runBatch(std::size_t count, const BatchSettings& settings, const BatchItem& item);

}  // namespace pfvox::tools

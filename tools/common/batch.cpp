#include "common/batch.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <mutex>
#include <vector>

namespace pfvox::tools {

namespace {

/// Hands results out in the order of the assets, whatever the order in which they arrive.
class Sequencer {
  public:
    Sequencer(std::size_t count, const BatchItem& item) : done_(count, false), item_(item) {}

    void arrived(std::size_t index) {
        const std::scoped_lock lock(mutex_);
        done_[index] = true;
        for (; next_ < done_.size() && done_[next_]; ++next_) item_.finished(next_);
        if (item_.progressed) item_.progressed(index);
    }

    /// Hands out what is left after a run that ended early.
    void flush() {
        for (; next_ < done_.size(); ++next_) {
            if (done_[next_]) item_.finished(next_);
        }
    }

  private:
    std::mutex mutex_;
    std::vector<bool> done_;
    std::size_t next_ = 0;
    const BatchItem& item_;
};

}  // namespace

std::size_t runBatch(std::size_t count, const BatchSettings& settings, const BatchItem& item) {
    const int threads = settings.threads > 0 ? settings.threads : tbb::task_arena::automatic;
    // Lets -j ask for more threads than there are processors, which the determinism tests do.
    const tbb::global_control control(
        tbb::global_control::max_allowed_parallelism,
        settings.threads > 0 ? static_cast<std::size_t>(settings.threads)
                             : static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
    tbb::task_arena arena(threads);
    Sequencer sequencer(count, item);
    std::atomic<std::size_t> started{0};
    std::atomic<std::size_t> next{0};
    std::atomic<bool> stop{false};
    arena.execute([&] {
        tbb::parallel_for(
            std::size_t{0}, count,
            [&](std::size_t) {
                if (stop) return;
                // Assets start in their order, whichever part of the range a thread was given.
                const std::size_t index = next.fetch_add(1);
                started.fetch_add(1);
                bool good = false;
                // Isolated: a thread that waits inside an asset must not begin another one on top of it.
                tbb::this_task_arena::isolate([&] { good = item.work(index); });
                if (!good && settings.failFast) stop = true;
                sequencer.arrived(index);
            },
            tbb::simple_partitioner());
    });
    sequencer.flush();
    return started;
}

}  // namespace pfvox::tools

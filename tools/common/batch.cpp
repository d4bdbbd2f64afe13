#include "common/batch.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
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

/// Runs the commits of a batch on threads that wait for the disk most of the time.
class Committers {
  public:
    /// As many waits as a disk and its journal can join, and no more files than that which an interrupt has to wait for.
    static constexpr std::size_t kThreads = 16;
    static constexpr std::size_t kMaxWaiting = 32;

    Committers(std::size_t count, std::function<void(std::size_t)> commit) : commit_(std::move(commit)) {
        for (std::size_t i = 0; i < std::min(kThreads, count); ++i) threads_.emplace_back([this] { run(); });
    }
    Committers(const Committers&) = delete;
    Committers& operator=(const Committers&) = delete;
    /// Finishes what is waiting.
    ~Committers() {
        {
            const std::scoped_lock lock(mutex_);
            isClosed_ = true;
        }
        changed_.notify_all();
        for (std::thread& thread : threads_) thread.join();
    }

    void add(std::size_t index) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return waiting_.size() < kMaxWaiting; });
        waiting_.push_back(index);
        lock.unlock();
        changed_.notify_all();
    }

  private:
    void run() {
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [&] { return !waiting_.empty() || isClosed_; });
            if (waiting_.empty()) return;
            const std::size_t index = waiting_.front();
            waiting_.pop_front();
            lock.unlock();
            changed_.notify_all();
            commit_(index);
            lock.lock();
        }
    }

    std::function<void(std::size_t)> commit_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::size_t> waiting_;
    bool isClosed_ = false;
    std::vector<std::thread> threads_;
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
    const auto done = [&](std::size_t index, bool good) {
        if (!good && settings.failFast) stop = true;
        sequencer.arrived(index);
    };
    // One asset has nothing to overlap with.
    std::optional<Committers> committers;
    if (item.commit && count > 1)
        committers.emplace(count, [&](std::size_t index) { done(index, item.commit(index)); });
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
                if (good && committers) return committers->add(index);
                done(index, good && (!item.commit || item.commit(index)));
            },
            tbb::simple_partitioner());
    });
    committers.reset();
    sequencer.flush();
    return started;
}

}  // namespace pfvox::tools

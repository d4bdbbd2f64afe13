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
#include <system_error>
#include <thread>
#include <vector>

#include "common/resources.hpp"

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

/// What a batch may take of the system at once.
struct BatchRoom {
    /// As many waits as a disk and its journal can join.
    static constexpr std::size_t kMaxCommitters = 16;
    /// No more files than that are written and not yet in their places.
    static constexpr std::size_t kMaxWaiting = 32;

    int threads = 1;             ///< that compute, the caller's included
    std::size_t committers = 0;  ///< threads that wait for the disk; 0: those that compute do
    std::size_t waiting = kMaxWaiting;
};

BatchRoom roomFor(int threads, std::size_t commits) {
    BatchRoom room{.threads = std::max(threads, 1),
                   .committers = std::min(commits, BatchRoom::kMaxCommitters)};
    const int wanted = room.threads - 1 + static_cast<int>(room.committers);
    if (const int startable = affordableThreads(wanted); startable < wanted) {
        room.threads = 1 + std::min(room.threads - 1, (startable + 1) / 2);
        room.committers = std::min(room.committers, static_cast<std::size_t>(startable - (room.threads - 1)));
    }
    // An asset at work has its source open, or its output; each that waits has its output.
    const std::size_t files = openableFiles();
    room.threads =
        static_cast<int>(std::clamp<std::size_t>(files / 4, 1, static_cast<std::size_t>(room.threads)));
    const std::size_t left = files - std::min(files, 2 * static_cast<std::size_t>(room.threads));
    room.committers = std::min(room.committers, left / 2);
    room.waiting = std::clamp<std::size_t>(left / 2, 1, BatchRoom::kMaxWaiting);
    return room;
}

/// Runs the commits of a batch on threads that wait for the disk most of the time.
class Committers {
  public:
    Committers(const BatchRoom& room, std::function<void(std::size_t)> commit)
        : maxWaiting_(room.waiting), commit_(std::move(commit)) {
        try {
            for (std::size_t i = 0; i < room.committers; ++i) threads_.emplace_back([this] { run(); });
        } catch (const std::system_error&) {  // others took the threads that there were
        }
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
    }

    bool isRunning() const { return !threads_.empty(); }

    void add(std::size_t index) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return waiting_.size() < maxWaiting_; });
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

    std::size_t maxWaiting_;
    std::function<void(std::size_t)> commit_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::size_t> waiting_;
    bool isClosed_ = false;
    std::vector<std::jthread> threads_;  ///< last: they are joined before the rest goes
};

}  // namespace

std::size_t runBatch(std::size_t count, const BatchSettings& settings, const BatchItem& item) {
    const int wanted = settings.threads > 0 ? settings.threads : tbb::this_task_arena::max_concurrency();
    // One asset has nothing to overlap with.
    const BatchRoom room = roomFor(wanted, item.commit && count > 1 ? count : 0);
    // Lets -j ask for more threads than there are processors, which the determinism tests do.
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(room.threads));
    tbb::task_arena arena(room.threads);
    Sequencer sequencer(count, item);
    std::atomic<std::size_t> started{0};
    std::atomic<std::size_t> next{0};
    std::atomic<bool> stop{false};
    const auto done = [&](std::size_t index, bool good) {
        if (!good && settings.failFast) stop = true;
        sequencer.arrived(index);
    };
    std::optional<Committers> committers;
    if (room.committers > 0)
        committers.emplace(room, [&](std::size_t index) { done(index, item.commit(index)); });
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
                if (good && committers && committers->isRunning()) return committers->add(index);
                done(index, good && (!item.commit || item.commit(index)));
            },
            tbb::simple_partitioner());
    });
    committers.reset();
    sequencer.flush();
    return started;
}

}  // namespace pfvox::tools

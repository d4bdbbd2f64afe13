#include "common/interrupt.hpp"

#include <unistd.h>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <thread>
#include <utility>

#include "common/exit_code.hpp"

namespace pfvox::tools {

namespace {

/// Counts those who write. Once a signal came, new writers wait for the end of the process: they could keep it from
/// coming for ever.
struct Gate {
    std::mutex mutex;
    std::condition_variable changed;
    int writers = 0;
    bool isEnding = false;
};

Gate& writeGate() {
    // Never destroyed: the waiting thread may still use it while the process exits.
    static auto* gate = new Gate;
    return *gate;
}

}  // namespace

void exitOnInterrupt(std::function<void()> lastWords) {
    // Every thread inherits the mask, so only the waiting thread ever sees these signals.
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread([signals, lastWords = std::move(lastWords)] {
        int received = 0;
        sigwait(&signals, &received);
        Gate& gate = writeGate();
        std::unique_lock lock(gate.mutex);
        gate.isEnding = true;
        gate.changed.wait(lock, [&] { return gate.writers == 0; });
        lastWords();
        ::_exit(static_cast<int>(ExitCode::Interrupted));
    }).detach();
}

bool isInterrupted() {
    Gate& gate = writeGate();
    const std::scoped_lock lock(gate.mutex);
    return gate.isEnding;
}

WriteGuard::WriteGuard() {
    Gate& gate = writeGate();
    std::unique_lock lock(gate.mutex);
    gate.changed.wait(lock, [&] { return !gate.isEnding; });
    ++gate.writers;
}

WriteGuard::~WriteGuard() {
    if (!holds_) return;
    Gate& gate = writeGate();
    {
        const std::scoped_lock lock(gate.mutex);
        --gate.writers;
    }
    gate.changed.notify_all();
}

}  // namespace pfvox::tools

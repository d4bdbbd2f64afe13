#include "common/interrupt.hpp"

#include <unistd.h>
#include <atomic>
#include <csignal>
#include <mutex>
#include <thread>
#include <utility>

#include "common/exit_code.hpp"

namespace pfvox::tools {

namespace {

std::shared_mutex& writeGate() {
    // Never destroyed: the waiting thread may still use it while the process exits.
    static auto* gate = new std::shared_mutex;
    return *gate;
}

/// Set once a signal came: new writers wait for the end of the process, or they could keep the gate from it.
std::atomic<bool> isEnding{false};

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
        isEnding = true;
        const std::unique_lock lock(writeGate());
        lastWords();
        ::_exit(static_cast<int>(ExitCode::Interrupted));
    }).detach();
}

bool isInterrupted() { return isEnding; }

WriteGuard::WriteGuard() : lock_(writeGate(), std::defer_lock) {
    isEnding.wait(true);
    lock_.lock();
}

}  // namespace pfvox::tools

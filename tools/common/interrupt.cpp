#include "common/interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <mutex>
#include <pfvox/files.hpp>
#include <string_view>
#include <thread>

#include "common/exit_code.hpp"

namespace pfvox::tools {

namespace {

struct State {
    std::mutex mutex;
    int orderlyStops = 0;
    bool isInterrupted = false;
};

State& state() {
    // Never destroyed: the waiting thread may still use it while the process exits.
    static auto* all = new State;
    return *all;
}

/// The signals that end a program, without those that whoever started it wants to be ignored.
sigset_t endingSignals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction now {};
        if (::sigaction(signal, nullptr, &now) == 0 && now.sa_handler != SIG_IGN) sigaddset(&signals, signal);
    }
    return signals;
}

[[noreturn]] void endNow() {
    // Where a file system or a terminal hangs, the next signal ends the program without us.
    const sigset_t signals = endingSignals();
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
    io::abandonOutputs();
    // Not through stdio: another thread may hold its lock for ever.
    constexpr std::string_view kLastWords = "\ninterrupted; every output is either finished or as it was\n";
    [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, kLastWords.data(), kLastWords.size());
    ::_exit(static_cast<int>(ExitCode::Interrupted));
}

void waitForSignals(const sigset_t& signals) {
    while (true) {
        int received = 0;
        sigwait(&signals, &received);
        const std::scoped_lock lock(state().mutex);
        if (state().isInterrupted || state().orderlyStops == 0) endNow();
        state().isInterrupted = true;
    }
}

}  // namespace

void exitOnInterrupt() {
    // Every thread inherits the mask, so only the waiting thread ever sees these signals.
    const sigset_t signals = endingSignals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread(waitForSignals, signals).detach();
}

bool isInterrupted() {
    const std::scoped_lock lock(state().mutex);
    return state().isInterrupted;
}

OrderlyStop::OrderlyStop() {
    const std::scoped_lock lock(state().mutex);
    ++state().orderlyStops;
}

OrderlyStop::~OrderlyStop() {
    const std::scoped_lock lock(state().mutex);
    if (--state().orderlyStops == 0 && state().isInterrupted) endNow();
}

}  // namespace pfvox::tools

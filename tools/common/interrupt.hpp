// Interrupt: Ctrl-C and termination signals end a tool at once, with exit code 130 and no half-written file.
//
// A thread of its own waits for SIGINT, SIGTERM and SIGHUP. Whoever writes an output holds a WriteGuard; the
// process ends only when nobody does, so that neither a torn output nor a forgotten temporary file stays
// behind.
#pragma once

#include <functional>
#include <utility>

namespace pfvox::tools {

/// To be called once, before any other thread starts. `lastWords` runs in the waiting thread just before the
/// process ends; it may print.
void exitOnInterrupt(std::function<void()> lastWords);

/// Whether a signal has come. Whoever holds a WriteGuard for long asks, and comes to an end.
bool isInterrupted();

/// Keeps an interrupt from ending the process while it lives. May be handed from thread to thread.
class WriteGuard {
  public:
    WriteGuard();
    WriteGuard(WriteGuard&& other) noexcept : holds_(std::exchange(other.holds_, false)) {}
    WriteGuard& operator=(WriteGuard&&) = delete;
    ~WriteGuard();

  private:
    bool holds_ = true;
};

}  // namespace pfvox::tools

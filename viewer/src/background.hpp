// Background: work on a thread of its own whose result is taken over later, or by nobody.
//
// Unlike the future of std::async, neither giving the work up nor ending the program waits for it: the thread
// holds all that it needs by value, what it has to say is kept beside the result, and endProgram() leaves it
// behind.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <pfvox/error.hpp>
#include <system_error>
#include <thread>
#include <utility>

namespace pfvox::viewer {

/// Threads whose work has not ended.
inline std::atomic<int>& backgroundThreads() {
    static std::atomic<int> count = 0;
    return count;
}

template <typename T>
class Background {
  public:
    /// Nothing at work.
    Background() = default;
    /// `work` owns what it uses. Where the system gives no thread, it is done at once.
    explicit Background(std::function<T(Diagnostics&)> work) : state_(std::make_shared<State>()) {
        const auto run = [state = state_, work = std::move(work)] {
            std::optional<T> result;
            std::exception_ptr failure;
            try {
                result.emplace(work(state->said));
            } catch (...) {
                failure = std::current_exception();
            }
            const std::lock_guard lock(state->mutex);
            state->result = std::move(result);
            state->failure = failure;
        };
        ++backgroundThreads();
        try {
            std::thread([run] {
                run();
                --backgroundThreads();
            }).detach();
        } catch (const std::system_error&) {
            --backgroundThreads();
            run();
        }
    }

    /// Until take() has given the result.
    bool isAtWork() const { return state_ != nullptr; }
    /// The result, once, when it is there; what the work reported goes to `diagnostics`, what it threw comes
    /// from here.
    std::optional<T> take(Diagnostics& diagnostics) {
        if (state_ == nullptr) return std::nullopt;
        const std::shared_ptr<State> state = state_;
        const std::lock_guard lock(state->mutex);
        if (!state->result && state->failure == nullptr) return std::nullopt;
        state_.reset();
        if (state->failure != nullptr) std::rethrow_exception(state->failure);
        for (const Diagnostic& diagnostic : state->said.entries()) diagnostics.report(diagnostic);
        return std::move(state->result);
    }

  private:
    struct State {
        std::mutex mutex;
        std::optional<T> result;
        std::exception_ptr failure;
        DiagnosticList said;  ///< the thread's alone until one of the others is there
    };
    std::shared_ptr<State> state_;
};

}  // namespace pfvox::viewer

// Guarded: where memory that the system does not have becomes an Error. Every public function that reads,
// builds or writes runs inside it, so that no exception crosses a public header.
#pragma once

#include <new>
#include <pfvox/error.hpp>
#include <stdexcept>
#include <type_traits>

namespace pfvox {

/// LimitExceeded; is made without memory if need be.
inline Error outOfMemory() noexcept {
    Error error{.code = ErrorCode::LimitExceeded, .message = "out of memory"};
    try {
        error.message = "out of memory: fewer threads, or fewer programs beside this one, leave more of it";
    } catch (const std::bad_alloc&) {  // the short words need none
    }
    return error;
}

/// What `work` returns, a Result. Errors: LimitExceeded where it ran out of memory.
template <class Work>
std::invoke_result_t<Work> guarded(Work&& work) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
    } catch (const std::length_error&) {  // a vector that no memory could hold
    }
    return tl::make_unexpected(outOfMemory());
}

}  // namespace pfvox

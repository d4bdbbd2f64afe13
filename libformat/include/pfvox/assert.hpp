// PFVOX_ASSERT: a condition that only a fault of ours can break. On everywhere but in release builds; never
// used on anything that a file can decide.
#pragma once

namespace pfvox::detail {
[[noreturn]] void assertionFailed(const char* condition, const char* file, int line);
}

#ifdef PFVOX_ENABLE_ASSERTIONS
#define PFVOX_ASSERT(condition) \
    ((condition) ? static_cast<void>(0) : ::pfvox::detail::assertionFailed(#condition, __FILE__, __LINE__))
#else
#define PFVOX_ASSERT(condition) static_cast<void>(0)  ///< or ends the program and says where
#endif

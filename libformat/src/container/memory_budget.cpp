#include "container/memory_budget.hpp"

#include <fmt/format.h>

namespace pfvox::container {

Result<void> MemoryBudget::take(std::uint64_t count, std::uint64_t bytesEach) {
    std::uint64_t left = leftBytes_.load();
    do {
        if (bytesEach == 0 || count <= left / bytesEach) continue;
        return fail(
            ErrorCode::LimitExceeded,
            fmt::format("needs {} x {} bytes where {} are left of maxMemoryBytes = {}: raise that limit "
                        "if the file can be trusted",
                        count, bytesEach, left, limitBytes_));
    } while (!leftBytes_.compare_exchange_weak(left, left - count * bytesEach));
    return {};
}

}  // namespace pfvox::container

// What a piece of a test allocates, and what it does where memory ends. Programs that link allocations.cpp
// have its operators new and delete.
#pragma once

#include <cstdint>

namespace pfvox::test {

/// Measures the most that is allocated at once from its making on, by all threads.
class AllocationPeak {
  public:
    AllocationPeak();
    /// Beyond what was there at the start.
    std::uint64_t growthBytes() const;

  private:
    std::uint64_t start_;
};

/// While it lives one allocation of this thread fails: the one after `before` others.
class FailingAllocation {
  public:
    explicit FailingAllocation(std::uint64_t before);
    FailingAllocation(const FailingAllocation&) = delete;
    FailingAllocation& operator=(const FailingAllocation&) = delete;
    ~FailingAllocation();
    /// Whether there was such an allocation.
    bool happened() const;
};

}  // namespace pfvox::test

#include "support/allocations.hpp"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::uint64_t> liveBytes{0};
std::atomic<std::uint64_t> peakBytes{0};
thread_local std::uint64_t untilFailure = 0;  // 0 = none will fail

void* counted(void* memory) {
    if (memory == nullptr) return nullptr;
    const std::uint64_t live = liveBytes.fetch_add(malloc_usable_size(memory)) + malloc_usable_size(memory);
    std::uint64_t peak = peakBytes.load();
    while (live > peak && !peakBytes.compare_exchange_weak(peak, live)) {
    }
    return memory;
}

void* take(std::size_t bytes, std::size_t alignment) noexcept {
    if (untilFailure != 0 && --untilFailure == 0) return nullptr;
    const std::size_t size = bytes == 0 ? 1 : bytes;
    if (alignment <= __STDCPP_DEFAULT_NEW_ALIGNMENT__) return counted(std::malloc(size));
    return counted(std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment));
}

void* takeOrThrow(std::size_t bytes, std::size_t alignment) {
    void* const memory = take(bytes, alignment);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

void giveBack(void* memory) noexcept {
    if (memory != nullptr) liveBytes.fetch_sub(malloc_usable_size(memory));
    std::free(memory);
}

constexpr std::size_t kUsual = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

}  // namespace

void* operator new(std::size_t bytes) {
    return takeOrThrow(bytes, kUsual);
}
void* operator new[](std::size_t bytes) {
    return takeOrThrow(bytes, kUsual);
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
    return take(bytes, kUsual);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
    return take(bytes, kUsual);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
    return takeOrThrow(bytes, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
    return takeOrThrow(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
    giveBack(memory);
}
void operator delete[](void* memory) noexcept {
    giveBack(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    giveBack(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    giveBack(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    giveBack(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
    giveBack(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    giveBack(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
    giveBack(memory);
}

namespace pfvox::test {

AllocationPeak::AllocationPeak() : start_(liveBytes.load()) {
    peakBytes = start_;
}

std::uint64_t AllocationPeak::growthBytes() const {
    return peakBytes.load() - start_;
}

FailingAllocation::FailingAllocation(std::uint64_t before) {
    untilFailure = before + 1;
}

FailingAllocation::~FailingAllocation() {
    untilFailure = 0;
}

bool FailingAllocation::happened() const {
    return untilFailure == 0;
}

}  // namespace pfvox::test

// LargeArray: uninitialised memory for very many elements, on huge pages where the system has them.
//
// A list of ten million voxels takes 25,000 pages of 4 KiB; taking them from the system one by one costs as
// much as sorting the list.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace pfvox {

inline constexpr std::size_t kHugePageBytes = std::size_t{2} << 20;

/// Small blocks need no place of their own among huge pages.
constexpr std::align_val_t largeAlignment(std::size_t bytes) {
    return std::align_val_t{bytes >= kHugePageBytes ? kHugePageBytes : 64};
}

/// Uninitialised memory, to be given back with freeLarge() and the same number of bytes.
inline void* allocateLarge(std::size_t bytes) {
    void* memory = ::operator new(bytes, largeAlignment(bytes));
#if defined(__linux__)
    // Advice only: where it is not taken, the memory is as good as any.
    if (bytes >= kHugePageBytes) madvise(memory, bytes, MADV_HUGEPAGE);
#endif
    return memory;
}

inline void freeLarge(void* memory, std::size_t bytes) {
    ::operator delete(memory, largeAlignment(bytes));
}

template <class T>
class LargeArray {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  public:
    LargeArray() = default;
    explicit LargeArray(std::size_t count)
        : data_(static_cast<T*>(allocateLarge(count * sizeof(T))), Free{count * sizeof(T)}) {}

    T* data() { return data_.get(); }
    T& operator[](std::size_t i) { return data_.get()[i]; }

  private:
    struct Free {
        std::size_t bytes = 0;
        void operator()(T* p) const { freeLarge(p, bytes); }
    };

    std::unique_ptr<T, Free> data_;
};

}  // namespace pfvox

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

template <class T>
class LargeArray {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  public:
    LargeArray() = default;
    explicit LargeArray(std::size_t count) : data_(allocate(count * sizeof(T))) {}

    T* data() { return data_.get(); }
    T& operator[](std::size_t i) { return data_.get()[i]; }

  private:
    static constexpr std::align_val_t kHugePage{std::size_t{2} << 20};

    struct Free {
        void operator()(T* p) const { ::operator delete(static_cast<void*>(p), kHugePage); }
    };

    static T* allocate(std::size_t bytes) {
        void* memory = ::operator new(bytes, kHugePage);
#if defined(__linux__)
        // Advice only: where it is not taken, the memory is as good as any.
        if (bytes >= static_cast<std::size_t>(kHugePage)) madvise(memory, bytes, MADV_HUGEPAGE);
#endif
        return static_cast<T*>(memory);
    }

    std::unique_ptr<T, Free> data_;
};

}  // namespace pfvox

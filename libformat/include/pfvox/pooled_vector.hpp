// PooledVector: a std::vector for very many small numbers that come from a few large blocks of memory.
//
// The octrees of a model are tens of megabytes in hundreds of arrays. Taken one by one they cost a page fault
// for each 4 KiB and are set to zero before they are written; that takes longer than decoding them. So all
// arrays of an asset may share a MemoryPool, which lies on huge pages where the system has them.
//
// Unlike other vectors these leave new elements as they are: resize(n) gives n numbers of unknown value.
// A copy of a vector has memory of its own; a moved one keeps its place in the pool.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace pfvox {

/// Hands out memory and takes it back all at once, at its own end. May be used from several threads.
class MemoryPool {
  public:
    /// Takes a first block of `expectedBytes` now; further ones follow as they are needed. 0: blocks begin
    /// small and grow.
    explicit MemoryPool(std::size_t expectedBytes = 0);
    MemoryPool(const MemoryPool&) = delete;
    MemoryPool& operator=(const MemoryPool&) = delete;
    ~MemoryPool();

    /// Uninitialised memory, aligned to kAlignment. Throws std::bad_alloc.
    void* take(std::size_t bytes);

    static constexpr std::size_t kAlignment = 64;  ///< of every piece, bytes
    /// What take() uses up for this many bytes: sum it up for `expectedBytes`.
    static constexpr std::size_t rounded(std::size_t bytes) {
        return (bytes + kAlignment - 1) / kAlignment * kAlignment;
    }

  private:
    void addBlock(std::size_t bytes);

    std::mutex mutex_;
    struct Block {
        void* memory;
        std::size_t bytes;
    };
    std::vector<Block> blocks_;
    std::byte* next_ = nullptr;  ///< in the last block
    std::size_t left_ = 0;
};

/// Memory from a pool if there is one, else from the heap.
template <class T>
class PoolAllocator {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= MemoryPool::kAlignment);

  public:
    using value_type = T;
    using propagate_on_container_move_assignment = std::true_type;  ///< the pool goes with the memory
    using propagate_on_container_swap = std::true_type;             ///< the pool goes with the memory
    using is_always_equal = std::false_type;                        ///< pools differ

    PoolAllocator() = default;
    explicit PoolAllocator(std::shared_ptr<MemoryPool> pool)
        : pool_(std::move(pool)) {}  ///< Takes from this pool.
    template <class U>
    explicit PoolAllocator(const PoolAllocator<U>& other)
        : pool_(other.pool()) {}  ///< The same pool for another type.
    /// Throws std::bad_alloc, as allocators do.
    T* allocate(std::size_t count) {
        if (count > std::size_t(-1) / sizeof(T)) throw std::bad_array_new_length();
        const std::size_t bytes = count * sizeof(T);
        return static_cast<T*>(pool_ != nullptr ? pool_->take(bytes) : ::operator new(bytes));
    }
    void deallocate(T* p, std::size_t) {
        if (pool_ == nullptr) ::operator delete(p);
    }  ///< Does nothing: memory is returned with the pool.

    /// New elements stay as they are.
    template <class U>
    void construct(U* p) {
        ::new (static_cast<void*>(p)) U;
    }
    template <class U, class... Arguments>
    void construct(U* p, Arguments&&... arguments) {
        ::new (static_cast<void*>(p)) U(std::forward<Arguments>(arguments)...);
    }  ///< Default initialisation leaves numbers as they are.

    PoolAllocator select_on_container_copy_construction() const { return {}; }  ///< Copies use the heap.
    const std::shared_ptr<MemoryPool>& pool() const { return pool_; }           ///< null = the heap
    bool operator==(const PoolAllocator& other) const { return pool_ == other.pool_; }

  private:
    std::shared_ptr<MemoryPool> pool_;
};

template <class T>
using PooledVector = std::vector<T, PoolAllocator<T>>;  ///< A vector whose memory may come from a pool.

}  // namespace pfvox

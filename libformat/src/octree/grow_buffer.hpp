// GrowBuffer: a vector for writing very many small things: room is made once for several of them, which are
// then written without further checks.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <type_traits>

namespace pfvox::octree {

template <class T>
class GrowBuffer {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    /// Where the next `count` elements go. Write them, then advance() past the last one written.
    T* room(std::size_t count) {
        if (capacity_ - size_ < count) grow(size_ + count);
        return data_.get() + size_;
    }
    void advance(const T* end) { size_ = static_cast<std::size_t>(end - data_.get()); }

    std::size_t size() const { return size_; }
    const T* data() const { return data_.get(); }
    T& back() { return data_[size_ - 1]; }
    void popBack() { --size_; }
    void append(std::size_t count, T value) {
        T* out = room(count);
        for (std::size_t i = 0; i < count; ++i) *out++ = value;
        advance(out);
    }
    /// Empties, and keeps the memory.
    void clear() { size_ = 0; }

  private:
    void grow(std::size_t needed) {
        constexpr std::size_t kSmallest = 1024;
        std::size_t capacity = capacity_ < kSmallest ? kSmallest : capacity_;
        while (capacity < needed) capacity *= 2;
        auto larger = std::make_unique_for_overwrite<T[]>(capacity);
        if (size_ != 0) std::memcpy(larger.get(), data_.get(), size_ * sizeof(T));
        data_ = std::move(larger);
        capacity_ = capacity;
    }

    std::unique_ptr<T[]> data_;
    std::size_t size_ = 0;
    std::size_t capacity_ = 0;
};

}  // namespace pfvox::octree

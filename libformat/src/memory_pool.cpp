#include <algorithm>
#include <pfvox/pooled_vector.hpp>

#include "large_array.hpp"

namespace pfvox {

namespace {

/// A pool of a small model costs no more than its arrays would; one of a large model soon takes whole huge
/// pages.
constexpr std::size_t kSmallestBlock = std::size_t{64} << 10;
constexpr std::size_t kLargestGrowth = std::size_t{8} << 20;

}  // namespace

MemoryPool::MemoryPool(std::size_t expectedBytes) {
    if (expectedBytes != 0) addBlock(rounded(expectedBytes));
}

MemoryPool::~MemoryPool() {
    for (const Block& block : blocks_) freeLarge(block.memory, block.bytes);
}

void* MemoryPool::take(std::size_t bytes) {
    const std::size_t needed = rounded(std::max<std::size_t>(bytes, 1));
    const std::scoped_lock lock(mutex_);
    if (left_ < needed) {
        const std::size_t last = blocks_.empty() ? 0 : blocks_.back().bytes;
        addBlock(std::max(needed, std::clamp(2 * last, kSmallestBlock, kLargestGrowth)));
    }
    void* const result = next_;
    next_ += needed;
    left_ -= needed;
    return result;
}

void MemoryPool::addBlock(std::size_t bytes) {
    blocks_.reserve(blocks_.size() + 1);
    blocks_.push_back({.memory = allocateLarge(bytes), .bytes = bytes});
    next_ = static_cast<std::byte*>(blocks_.back().memory);
    left_ = bytes;
}

}  // namespace pfvox

// MemoryBudget: what one reading may allocate. Sections come out of a reader as arrays that have drawn from
// it, and vectors that stay in the result are made as long as it says: an allocation of a size that a file
// decides has no other way to its memory.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <pfvox/error.hpp>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace pfvox::container {

/// Thread-safe. Outlives all that has drawn from it.
class MemoryBudget {
  public:
    /// `limitBytes` is Limits::maxMemoryBytes.
    explicit MemoryBudget(std::uint64_t limitBytes) : limitBytes_(limitBytes), leftBytes_(limitBytes) {}
    MemoryBudget(const MemoryBudget&) = delete;
    MemoryBudget& operator=(const MemoryBudget&) = delete;

    /// For `count` things of `bytesEach`. Errors: LimitExceeded, and nothing is taken.
    Result<void> take(std::uint64_t count, std::uint64_t bytesEach = 1);
    void giveBack(std::uint64_t bytes) { leftBytes_.fetch_add(bytes); }

    /// Makes a vector longer that stays in the result: its memory is not given back. Errors: LimitExceeded.
    template <class T>
    Result<void> resize(std::vector<T>& vector, std::uint64_t count) {
        PFVOX_CHECK(reserve(vector, count));
        vector.resize(count);
        return {};
    }
    template <class T>
    Result<void> reserve(std::vector<T>& vector, std::uint64_t count) {
        PFVOX_CHECK(take(count, sizeof(T)));
        vector.reserve(count);
        return {};
    }

  private:
    std::uint64_t limitBytes_;
    std::atomic<std::uint64_t> leftBytes_;
};

/// A part of a budget that is given back when this goes.
class Charge {
  public:
    Charge() = default;
    /// Errors: LimitExceeded.
    static Result<Charge> take(MemoryBudget& budget, std::uint64_t count, std::uint64_t bytesEach) {
        PFVOX_CHECK(budget.take(count, bytesEach));
        return Charge(budget, count * bytesEach);
    }
    Charge(Charge&& other) noexcept { swap(other); }
    Charge& operator=(Charge&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Charge() {
        if (budget_ != nullptr) budget_->giveBack(bytes_);
    }

  private:
    Charge(MemoryBudget& budget, std::uint64_t bytes) : budget_(&budget), bytes_(bytes) {}
    void swap(Charge& other) noexcept {
        std::swap(budget_, other.budget_);
        std::swap(bytes_, other.bytes_);
    }

    MemoryBudget* budget_ = nullptr;
    std::uint64_t bytes_ = 0;
};

/// Numbers or records out of a file, uninitialized at first.
template <class T>
class Array {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    Array() = default;
    /// Errors: LimitExceeded.
    static Result<Array> make(MemoryBudget& budget, std::uint64_t count) {
        PFVOX_TRY(Charge, charge, Charge::take(budget, count, sizeof(T)));
        Array array;
        array.charge_ = std::move(charge);
        array.data_ = std::make_unique_for_overwrite<T[]>(count);
        array.size_ = count;
        return array;
    }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T* data() { return data_.get(); }
    const T* data() const { return data_.get(); }
    T* begin() { return data(); }
    T* end() { return data() + size_; }
    const T* begin() const { return data(); }
    const T* end() const { return data() + size_; }
    T& operator[](std::size_t i) { return data_[i]; }
    const T& operator[](std::size_t i) const { return data_[i]; }

  private:
    Charge charge_;
    std::unique_ptr<T[]> data_;
    std::size_t size_ = 0;
};

}  // namespace pfvox::container

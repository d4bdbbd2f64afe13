// ByteSource: the bytes of a probe file, from memory or from disk, so that there is one reader for both.
#pragma once

#include <algorithm>
#include <pfvox/error.hpp>
#include <span>

#include "io/random_file.hpp"

namespace pfvox::probe {

class ByteSource {
  public:
    ByteSource() = default;
    ByteSource(const ByteSource&) = delete;
    ByteSource& operator=(const ByteSource&) = delete;
    virtual ~ByteSource() = default;

    virtual std::uint64_t sizeBytes() const = 0;
    /// Precondition: inside the size. Errors: FileNotReadable, Truncated. Thread-safe.
    virtual Result<void> readAt(std::uint64_t offsetBytes, std::span<std::byte> bytes) const = 0;
};

class MemorySource final : public ByteSource {
  public:
    explicit MemorySource(std::span<const std::byte> bytes) : bytes_(bytes) {}
    std::uint64_t sizeBytes() const override { return bytes_.size(); }
    Result<void> readAt(std::uint64_t offsetBytes, std::span<std::byte> bytes) const override {
        std::ranges::copy(bytes_.subspan(offsetBytes, bytes.size()), bytes.begin());
        return {};
    }

  private:
    std::span<const std::byte> bytes_;
};

class FileSource final : public ByteSource {
  public:
    explicit FileSource(io::RandomFile file) : file_(std::move(file)) {}
    std::uint64_t sizeBytes() const override { return file_.sizeBytes(); }
    Result<void> readAt(std::uint64_t offsetBytes, std::span<std::byte> bytes) const override {
        return file_.readAt(offsetBytes, bytes);
    }

  private:
    io::RandomFile file_;
};

}  // namespace pfvox::probe

// ByteSource: the bytes of a file, from memory or from disk, so that there is one reader for both.
#pragma once

#include <algorithm>
#include <optional>
#include <pfvox/error.hpp>
#include <span>

#include "io/random_file.hpp"

namespace pfvox::container {

class ByteSource {
  public:
    ByteSource() = default;
    ByteSource(const ByteSource&) = delete;
    ByteSource& operator=(const ByteSource&) = delete;
    virtual ~ByteSource() = default;

    virtual std::uint64_t sizeBytes() const = 0;
    /// Precondition: inside the size. Errors: FileNotReadable, Truncated. Thread-safe.
    virtual Result<void> readAt(std::uint64_t offsetBytes, std::span<std::byte> bytes) const = 0;
    /// The bytes where they lie already, or nothing: then read them. Precondition: inside the size.
    virtual std::optional<std::span<const std::byte>> view(std::uint64_t offsetBytes,
                                                           std::uint64_t count) const = 0;
};

class MemorySource final : public ByteSource {
  public:
    explicit MemorySource(std::span<const std::byte> bytes) : bytes_(bytes) {}
    std::uint64_t sizeBytes() const override { return bytes_.size(); }
    Result<void> readAt(std::uint64_t offsetBytes, std::span<std::byte> bytes) const override {
        std::ranges::copy(bytes_.subspan(offsetBytes, bytes.size()), bytes.begin());
        return {};
    }
    std::optional<std::span<const std::byte>> view(std::uint64_t offsetBytes,
                                                   std::uint64_t count) const override {
        return bytes_.subspan(offsetBytes, count);
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
    std::optional<std::span<const std::byte>> view(std::uint64_t, std::uint64_t) const override {
        return std::nullopt;
    }

  private:
    io::RandomFile file_;
};

}  // namespace pfvox::container

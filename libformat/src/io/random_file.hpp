// RandomFile: a file that is read or written at any place. Reads and writes at different places may run at
// once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <pfvox/error.hpp>
#include <span>

#include "io/descriptor.hpp"

namespace pfvox::io {

class RandomFile {
  public:
    /// A regular file of at most `maxBytes`. Errors: FileNotFound, FileNotReadable, LimitExceeded.
    static Result<RandomFile> openForReading(const std::filesystem::path& file, std::uint64_t maxBytes);
    /// Opens or creates a file for reading and writing, for this process alone: whoever opens it for writing
    /// too is refused until it is closed, even by force. Creates missing parent folders. Errors:
    /// FileNotWritable.
    static Result<RandomFile> openForWriting(const std::filesystem::path& file);

    /// When it was opened, or after truncate().
    std::uint64_t sizeBytes() const { return sizeBytes_; }
    const std::filesystem::path& path() const { return path_; }

    /// Reads what the file has from there on; returns how many bytes that are. Errors: FileNotReadable.
    Result<std::size_t> readFrom(std::uint64_t offsetBytes, std::span<std::byte> bytes) const;
    /// Errors: FileNotReadable; Truncated when the file ends before.
    Result<void> readAt(std::uint64_t offsetBytes, std::span<std::byte> bytes) const;
    /// Errors: FileNotWritable.
    Result<void> writeAt(std::uint64_t offsetBytes, std::span<const std::byte> bytes);
    /// Errors: FileNotWritable.
    Result<void> truncate(std::uint64_t sizeBytes);
    /// Takes the name away; what is open stays readable. Errors: FileNotWritable.
    Result<void> remove();

  private:
    RandomFile(std::filesystem::path path, Descriptor fd, std::uint64_t sizeBytes)
        : path_(std::move(path)), fd_(std::move(fd)), sizeBytes_(sizeBytes) {}

    std::filesystem::path path_;
    Descriptor fd_;
    std::uint64_t sizeBytes_ = 0;
};

}  // namespace pfvox::io

// AtomicFile: an output that is written piece by piece and appears complete or not at all.
#pragma once

#include <filesystem>
#include <pfvox/error.hpp>
#include <span>

#include "io/descriptor.hpp"

namespace pfvox::io {

/// Writes to a temporary name in the folder of `file`; commit() syncs it and renames it into place, and
/// without commit() nothing stays.
class AtomicFile {
  public:
    /// Creates missing parent folders. Errors: FileNotWritable.
    static Result<AtomicFile> create(const std::filesystem::path& file);
    AtomicFile(AtomicFile&& other) noexcept = default;
    AtomicFile& operator=(AtomicFile&&) = delete;
    ~AtomicFile();

    /// Appends. Errors: FileNotWritable.
    Result<void> write(std::span<const std::byte> bytes);
    /// Errors: FileNotWritable; then `file` is what it was before.
    Result<void> commit();

  private:
    AtomicFile(std::filesystem::path file, std::filesystem::path temporary, Descriptor fd)
        : file_(std::move(file)), temporary_(std::move(temporary)), fd_(std::move(fd)) {}

    std::filesystem::path file_;
    std::filesystem::path temporary_;
    Descriptor fd_;  ///< valid until commit: then the temporary file is ours to remove
};

}  // namespace pfvox::io

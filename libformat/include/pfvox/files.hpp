// Files: reading a source whole, and writing an output so that it appears complete or not at all.
//
// Libraries and tools share these two functions: nothing else in pfvox opens a file for writing. Sources are
// read into memory rather than mapped: a file that another program shortens while we read it gives an error
// here, but a SIGBUS under a mapping (docs/decisions/002-read-not-map.md). Both functions may be called from
// several threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <pfvox/error.hpp>
#include <span>

namespace pfvox::io {

/// Bytes of a file, not zeroed before they are read.
class FileBytes {
  public:
    FileBytes() = default;
    explicit FileBytes(std::size_t size)
        : data_(std::make_unique_for_overwrite<std::byte[]>(size)), size_(size) {}  ///< Uninitialised bytes.
    std::span<std::byte> bytes() { return {data_.get(), size_}; }  ///< all of them
    std::span<const std::byte> bytes() const { return {data_.get(), size_}; }  ///< all of them
    void shrink(std::size_t size) { size_ = size; }  ///< Precondition: not larger than now.

  private:
    std::unique_ptr<std::byte[]> data_;
    std::size_t size_ = 0;
};

/// Reads a whole regular file. Errors, each with `file`: FileNotFound, FileNotReadable, LimitExceeded.
Result<FileBytes> readFile(const std::filesystem::path& file, std::uint64_t maxBytes);

/// An output that is written piece by piece under a temporary name in the folder of its target, and appears complete or
/// not at all. commit() mostly waits for the disk: a tool that writes many files waits for several at once
/// (docs/decisions/014-syncs.md). A symbolic link stays one, what it leads to is replaced; a device, pipe or socket is
/// written to as it is, piece by piece.
class AtomicFile {
  public:
    /// Creates missing parent folders. Errors: FileNotWritable.
    static Result<AtomicFile> create(const std::filesystem::path& file);
    /// create() and write().
    static Result<AtomicFile> createWith(const std::filesystem::path& file, std::span<const std::byte> bytes);

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&&) = delete;
    /// Removes the temporary file unless commit() has succeeded.
    ~AtomicFile();

    /// Appends. Errors: FileNotWritable.
    Result<void> write(std::span<const std::byte> bytes);
    /// Syncs the file and renames it to its target. To be called once. Errors: FileNotWritable; then the target is
    /// what it was before.
    Result<void> commit();

  private:
    AtomicFile(std::filesystem::path file, std::filesystem::path target, std::filesystem::path temporary, int descriptor)
        : file_(std::move(file)), target_(std::move(target)), temporary_(std::move(temporary)), descriptor_(descriptor) {}

    std::filesystem::path file_;       ///< as it was named
    std::filesystem::path target_;     ///< without links; empty: written to as it is
    std::filesystem::path temporary_;  ///< empty once there is nothing to remove
    int descriptor_;                   ///< -1 once closed
};

/// Writes to a temporary name in the same folder, syncs and renames: `file` holds either all of `bytes` or
/// what it held before. Creates missing parent folders. Errors: FileNotWritable.
Result<void> writeFileAtomically(const std::filesystem::path& file, std::span<const std::byte> bytes);

}  // namespace pfvox::io

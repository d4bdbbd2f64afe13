// Files: reading a source whole, and writing an output so that it appears complete or not at all.
//
// Libraries and tools share these functions: nothing else in pfvox opens a file for writing. Sources are
// read into memory rather than mapped: a file that another program shortens while we read it gives an error
// here, but a SIGBUS under a mapping (docs/decisions/002-read-not-map.md). All of them may be called from
// several threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <pfvox/error.hpp>
#include <span>
#include <string_view>

namespace pfvox::io {

/// Bytes of a file, not zeroed before they are read.
class FileBytes {
  public:
    FileBytes() = default;
    explicit FileBytes(std::size_t size)
        : data_(std::make_unique_for_overwrite<std::byte[]>(size)), size_(size) {}  ///< Uninitialised bytes.
    std::span<std::byte> bytes() { return {data_.get(), size_}; }                   ///< all of them
    std::span<const std::byte> bytes() const { return {data_.get(), size_}; }       ///< all of them
    void shrink(std::size_t size) { size_ = size; }  ///< Precondition: not larger than now.

  private:
    std::unique_ptr<std::byte[]> data_;
    std::size_t size_ = 0;
};

/// The path that a text from outside stands for: an entry of a list, a value of a file. The system ends names
/// at a NUL character, so that a text with one would name another file. Errors: BadValue for such a text and
/// for an empty one.
Result<std::filesystem::path> pathFromText(std::string_view text);

/// Reads a whole regular file, or what comes out of a pipe until its writers are done; a pipe without a
/// writer and devices are refused. Errors, each with `file`: FileNotFound, FileNotReadable, LimitExceeded.
Result<FileBytes> readFile(const std::filesystem::path& file, std::uint64_t maxBytes);

/// Whether a regular file of this size can be opened. Errors: as readFile.
Result<void> checkReadable(const std::filesystem::path& file, std::uint64_t maxBytes);
/// How an output takes the place of what is there.
struct WriteOptions {
    /// Replace an output that is read-only, too. Otherwise it is refused: somebody protects it.
    bool replaceReadOnly = false;
};

/// An output that is written piece by piece and appears complete or not at all. It has no name before
/// commit() where system and file system know unnamed files, else one of its own (`.pfvox-<16 hex
/// digits>.tmp`) in the folder of its target; what a killed program left of that kind is removed by the next
/// output into that folder (docs/decisions/035-unnamed-outputs.md). commit() mostly waits for the disk: a
/// tool that writes many files waits for several at once (docs/decisions/014-syncs.md). A symbolic link stays
/// one, what it leads to is replaced; a device, pipe or socket is written to as it is, piece by piece. What
/// is replaced passes on its permissions, and owner and group where the system permits; new files follow the
/// umask.
class AtomicFile {
  public:
    /// Creates missing parent folders. Errors: FileNotWritable.
    static Result<AtomicFile> create(const std::filesystem::path& file, WriteOptions options = {});
    /// create() and write().
    static Result<AtomicFile> createWith(const std::filesystem::path& file, std::span<const std::byte> bytes,
                                         WriteOptions options = {});

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&&) = delete;
    /// Leaves nothing behind unless commit() has succeeded.
    ~AtomicFile();

    /// Appends. Errors: FileNotWritable.
    Result<void> write(std::span<const std::byte> bytes);
    /// Syncs the file and puts it in its place. To be called once. Errors: FileNotWritable; then the target
    /// is what it was before.
    Result<void> commit();

  private:
    AtomicFile(std::filesystem::path file, std::filesystem::path target, std::filesystem::path temporary,
               int descriptor)
        : file_(std::move(file)),
          target_(std::move(target)),
          temporary_(std::move(temporary)),
          descriptor_(descriptor) {}

    std::filesystem::path file_;       ///< as it was named
    std::filesystem::path target_;     ///< without links; empty: written to as it is
    std::filesystem::path temporary_;  ///< empty where the file has no name
    int descriptor_;                   ///< -1 once closed
};

/// `file` holds either all of `bytes` or what it held before. Creates missing parent folders. Errors:
/// FileNotWritable.
Result<void> writeFileAtomically(const std::filesystem::path& file, std::span<const std::byte> bytes,
                                 WriteOptions options = {});

/// Whether AtomicFile would take this output, for those who work long before they write. Errors:
/// FileNotWritable: a folder, or read-only.
Result<void> checkReplaceable(const std::filesystem::path& file, WriteOptions options = {});

/// For a program that is about to end itself, as on Ctrl-C: outputs that are not in their places are given up
/// without a trace. Threads that go on writing wait from then on, until the program ends.
void abandonOutputs();

}  // namespace pfvox::io

#include "io/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

namespace pfvox::io {

namespace {

/// Owns a POSIX file descriptor.
class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    int get() const { return fd_; }
    bool valid() const { return fd_ >= 0; }

  private:
    int fd_;
};

tl::unexpected<Error> systemError(ErrorCode code, const std::filesystem::path& file,
                                  std::string_view action) {
    const std::string reason = std::generic_category().message(errno);
    return tl::make_unexpected(
        Error{.code = code, .message = fmt::format("{}: {}", action, reason), .file = file});
}

bool writeAll(int fd, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd, bytes.data(), bytes.size());
        if (n < 0) {
            if (errno == EINTR) continue;
            return false;
        }
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return true;
}

}  // namespace

Result<FileBytes> readFile(const std::filesystem::path& file, std::uint64_t maxBytes) {
    // Without O_NONBLOCK, opening a pipe would wait for a writer, perhaps for ever.
    const Descriptor fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (!fd.valid()) {
        return errno == ENOENT ? systemError(ErrorCode::FileNotFound, file, "cannot open")
                               : systemError(ErrorCode::FileNotReadable, file, "cannot open");
    }
    struct stat info {};
    if (::fstat(fd.get(), &info) != 0) return systemError(ErrorCode::FileNotReadable, file, "cannot stat");
    if (!S_ISREG(info.st_mode)) {
        return tl::make_unexpected(
            Error{.code = ErrorCode::FileNotReadable,
                  .message = S_ISDIR(info.st_mode) ? "is a folder" : "is not a regular file",
                  .file = file});
    }
    const auto size = static_cast<std::uint64_t>(info.st_size);
    if (size > maxBytes) {
        return tl::make_unexpected(
            Error{.code = ErrorCode::LimitExceeded,
                  .message = fmt::format("{} bytes, more than maxFileBytes = {}", size, maxBytes),
                  .file = file});
    }
    FileBytes contents(size);
    std::size_t done = 0;
    while (done < size) {
        const ssize_t n = ::read(fd.get(), contents.bytes().data() + done, size - done);
        if (n < 0) {
            if (errno == EINTR) continue;
            return systemError(ErrorCode::FileNotReadable, file, "cannot read");
        }
        if (n == 0) break;
        done += static_cast<std::size_t>(n);
    }
    contents.shrink(done);
    return contents;
}

Result<PendingFile> PendingFile::write(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    if (file.has_parent_path()) {
        std::error_code error;
        std::filesystem::create_directories(file.parent_path(), error);
        if (error) {
            return tl::make_unexpected(Error{
                .code = ErrorCode::FileNotWritable,
                .message =
                    fmt::format("cannot create folder {}: {}", file.parent_path().string(), error.message()),
                .file = file});
        }
    }
    if (std::error_code error; std::filesystem::is_directory(file, error)) {
        return tl::make_unexpected(
            Error{.code = ErrorCode::FileNotWritable, .message = "is a folder, not a file", .file = file});
    }

    static std::atomic<unsigned> serial{0};
    std::filesystem::path temporary = file;
    temporary += fmt::format(".tmp-{}-{}", ::getpid(), serial.fetch_add(1));
    const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0) return systemError(ErrorCode::FileNotWritable, file, "cannot write");
    PendingFile pending(fd, file, std::move(temporary));
    if (!writeAll(fd, bytes)) return systemError(ErrorCode::FileNotWritable, file, "cannot write");
    return pending;
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      file_(std::move(other.file_)),
      temporary_(std::exchange(other.temporary_, {})) {}

PendingFile::~PendingFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

Result<void> PendingFile::commit() {
    const auto failed = [&](std::string_view action) {
        return systemError(ErrorCode::FileNotWritable, file_, action);
    };
    if (::fsync(descriptor_) != 0) return failed("cannot sync");
    // The kernel may report a delayed write error only here.
    if (::close(std::exchange(descriptor_, -1)) != 0) return failed("cannot close");
    if (::rename(temporary_.c_str(), file_.c_str()) != 0)
        return failed("cannot rename the finished file into place");
    temporary_.clear();
    return {};
}

Result<void> writeFileAtomically(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    PFVOX_TRY(PendingFile, pending, PendingFile::write(file, bytes));
    return pending.commit();
}

}  // namespace pfvox::io

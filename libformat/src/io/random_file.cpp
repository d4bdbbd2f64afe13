#include "io/random_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

namespace pfvox::io {

Result<RandomFile> RandomFile::openForReading(const std::filesystem::path& file, std::uint64_t maxBytes) {
    // Without O_NONBLOCK, opening a pipe would wait for a writer, perhaps for ever.
    Descriptor fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
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
    return RandomFile(file, std::move(fd), size);
}

Result<RandomFile> RandomFile::openForWriting(const std::filesystem::path& file) {
    if (file.has_parent_path()) {
        std::error_code ignored;  // open() says what is wrong
        std::filesystem::create_directories(file.parent_path(), ignored);
    }
    Descriptor fd(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666));
    if (!fd.valid()) return systemError(ErrorCode::FileNotWritable, file, "cannot write");
    const auto refuse = [&](const char* why) {
        return tl::make_unexpected(Error{.code = ErrorCode::FileNotWritable, .message = why, .file = file});
    };
    if (::flock(fd.get(), LOCK_EX | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK) return refuse("another process is writing it: wait for it, or stop it");
        return systemError(ErrorCode::FileNotWritable, file, "cannot lock");
    }
    struct stat info {};
    if (::fstat(fd.get(), &info) != 0) return systemError(ErrorCode::FileNotWritable, file, "cannot stat");
    if (!S_ISREG(info.st_mode)) return refuse("is not a regular file");
    if (info.st_nlink == 0) return refuse("another process has just removed it: try again");
    return RandomFile(file, std::move(fd), static_cast<std::uint64_t>(info.st_size));
}

Result<std::size_t> RandomFile::readFrom(std::uint64_t offsetBytes, std::span<std::byte> bytes) const {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t n = ::pread(fd_.get(), bytes.data() + done, bytes.size() - done,
                                  static_cast<off_t>(offsetBytes + done));
        if (n < 0) {
            if (errno == EINTR) continue;
            return systemError(ErrorCode::FileNotReadable, path_, "cannot read");
        }
        if (n == 0) break;
        done += static_cast<std::size_t>(n);
    }
    return done;
}

Result<void> RandomFile::readAt(std::uint64_t offsetBytes, std::span<std::byte> bytes) const {
    PFVOX_TRY(const std::size_t, present, readFrom(offsetBytes, bytes));
    if (present == bytes.size()) return {};
    return tl::make_unexpected(Error{.code = ErrorCode::Truncated,
                                     .message = "the file has become shorter",
                                     .file = path_,
                                     .offsetBytes = offsetBytes + present});
}

Result<void> RandomFile::writeAt(std::uint64_t offsetBytes, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::pwrite(fd_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offsetBytes));
        if (n < 0) {
            if (errno == EINTR) continue;
            return systemError(ErrorCode::FileNotWritable, path_, "cannot write");
        }
        bytes = bytes.subspan(static_cast<std::size_t>(n));
        offsetBytes += static_cast<std::uint64_t>(n);
    }
    return {};
}

Result<void> RandomFile::truncate(std::uint64_t sizeBytes) {
    if (::ftruncate(fd_.get(), static_cast<off_t>(sizeBytes)) != 0)
        return systemError(ErrorCode::FileNotWritable, path_, "cannot truncate");
    sizeBytes_ = sizeBytes;
    return {};
}

Result<void> RandomFile::remove() {
    if (::unlink(path_.c_str()) != 0) return systemError(ErrorCode::FileNotWritable, path_, "cannot remove");
    return {};
}

}  // namespace pfvox::io

#include "io/atomic_file.hpp"

#include <fcntl.h>

#include <atomic>

namespace pfvox::io {

namespace {

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

Result<AtomicFile> AtomicFile::create(const std::filesystem::path& file) {
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
    Descriptor fd(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (!fd.valid()) return systemError(ErrorCode::FileNotWritable, file, "cannot write");
    return AtomicFile(file, std::move(temporary), std::move(fd));
}

AtomicFile::~AtomicFile() {
    if (fd_.valid()) ::unlink(temporary_.c_str());
}

Result<void> AtomicFile::write(std::span<const std::byte> bytes) {
    if (!writeAll(fd_.get(), bytes)) return systemError(ErrorCode::FileNotWritable, file_, "cannot write");
    return {};
}

Result<void> AtomicFile::commit() {
    if (::fsync(fd_.get()) != 0) return systemError(ErrorCode::FileNotWritable, file_, "cannot sync");
    if (::rename(temporary_.c_str(), file_.c_str()) != 0)
        return systemError(ErrorCode::FileNotWritable, file_, "cannot rename the finished file into place");
    // What close() could report, fsync has reported.
    fd_.close();
    return {};
}

}  // namespace pfvox::io

#include <fcntl.h>

#include <atomic>
#include <pfvox/files.hpp>
#include <utility>

#include "io/descriptor.hpp"

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
    return AtomicFile(file, std::move(temporary), fd.release());
}

Result<AtomicFile> AtomicFile::createWith(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    PFVOX_TRY(AtomicFile, output, create(file));
    PFVOX_CHECK(output.write(bytes));
    return output;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : file_(std::move(other.file_)),
      temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

Result<void> AtomicFile::write(std::span<const std::byte> bytes) {
    if (!writeAll(descriptor_, bytes)) return systemError(ErrorCode::FileNotWritable, file_, "cannot write");
    return {};
}

Result<void> AtomicFile::commit() {
    if (::fsync(descriptor_) != 0) return systemError(ErrorCode::FileNotWritable, file_, "cannot sync");
    // The kernel may report a delayed write error only here.
    if (::close(std::exchange(descriptor_, -1)) != 0)
        return systemError(ErrorCode::FileNotWritable, file_, "cannot close");
    if (::rename(temporary_.c_str(), file_.c_str()) != 0)
        return systemError(ErrorCode::FileNotWritable, file_, "cannot rename the finished file into place");
    temporary_.clear();
    return {};
}

}  // namespace pfvox::io

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

/// What links lead to in the end, which need not be there.
Result<std::filesystem::path> withoutLinks(const std::filesystem::path& file) {
    constexpr int kMaxLinks = 40;  // as the kernel has it
    std::filesystem::path target = file;
    std::error_code error;
    for (int i = 0; i < kMaxLinks; ++i) {
        if (!std::filesystem::is_symlink(target, error)) return target;
        target = target.parent_path() / std::filesystem::read_symlink(target, error);
        if (error) break;
    }
    return tl::make_unexpected(
        Error{.code = ErrorCode::FileNotWritable, .message = "cannot follow the link", .file = file});
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
    std::error_code error;
    if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error)) {
        Descriptor fd(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
        if (!fd.valid()) return systemError(ErrorCode::FileNotWritable, file, "cannot write");
        return AtomicFile(file, {}, {}, fd.release());
    }
    PFVOX_TRY(std::filesystem::path, target, withoutLinks(file));
    static std::atomic<unsigned> serial{0};
    std::filesystem::path temporary = target;
    temporary += fmt::format(".tmp-{}-{}", ::getpid(), serial.fetch_add(1));
    Descriptor fd(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (!fd.valid()) return systemError(ErrorCode::FileNotWritable, file, "cannot write");
    return AtomicFile(file, std::move(target), std::move(temporary), fd.release());
}

Result<AtomicFile> AtomicFile::createWith(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    PFVOX_TRY(AtomicFile, output, create(file));
    PFVOX_CHECK(output.write(bytes));
    return output;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : file_(std::move(other.file_)),
      target_(std::move(other.target_)),
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
    const bool replaces = !target_.empty();
    if (replaces && ::fsync(descriptor_) != 0)
        return systemError(ErrorCode::FileNotWritable, file_, "cannot sync");
    // The kernel may report a delayed write error only here.
    if (::close(std::exchange(descriptor_, -1)) != 0)
        return systemError(ErrorCode::FileNotWritable, file_, "cannot close");
    if (replaces && ::rename(temporary_.c_str(), target_.c_str()) != 0)
        return systemError(ErrorCode::FileNotWritable, file_, "cannot rename the finished file into place");
    temporary_.clear();
    return {};
}

}  // namespace pfvox::io

#include <fcntl.h>
#include <sys/stat.h>

#include <pfvox/files.hpp>
#include <utility>

#include "io/descriptor.hpp"
#include "io/temporary.hpp"

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

tl::unexpected<Error> refuse(const std::filesystem::path& file, std::string why) {
    return tl::make_unexpected(
        Error{.code = ErrorCode::FileNotWritable, .message = std::move(why), .file = file});
}

Result<void> createParent(const std::filesystem::path& file) {
    if (!file.has_parent_path()) return {};
    std::error_code error;
    std::filesystem::create_directories(file.parent_path(), error);
    if (!error) return {};
    return refuse(file,
                  fmt::format("cannot create folder {}: {}", file.parent_path().string(), error.message()));
}

/// No permission to write for anybody, or for us. The first holds for root, too, who is permitted everything.
bool isReadOnly(const struct stat& info, const std::filesystem::path& target) {
    constexpr mode_t kAnyWrite = S_IWUSR | S_IWGRP | S_IWOTH;
    return (info.st_mode & kAnyWrite) == 0 ||
           (::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0 && errno == EACCES);
}

/// Gives the new file what the old one was given by people. Owner and group come first: a change of them
/// takes permissions away.
void inherit(int fd, const struct stat& old) {
    struct stat now {};
    if (::fstat(fd, &now) != 0) return;
    const bool isOurs = now.st_uid == old.st_uid && now.st_gid == old.st_gid;
    if (!isOurs && ::fchown(fd, old.st_uid, old.st_gid) != 0 && now.st_gid != old.st_gid) {
        // Only root may give files away; to a group of theirs, everybody.
        [[maybe_unused]] const int ignored = ::fchown(fd, static_cast<uid_t>(-1), old.st_gid);
    }
    ::fchmod(fd, old.st_mode & (S_IRWXU | S_IRWXG | S_IRWXO));
}

std::filesystem::path folderOf(const std::filesystem::path& target) {
    return target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
}

}  // namespace

Result<void> checkReplaceable(const std::filesystem::path& file, WriteOptions options) {
    struct stat info {};
    if (::stat(file.c_str(), &info) != 0) return {};
    if (S_ISDIR(info.st_mode)) return refuse(file, "is a folder, not a file");
    if (!S_ISREG(info.st_mode) || options.replaceReadOnly || !isReadOnly(info, file)) return {};
    return refuse(file, "is read-only: make it writable (chmod u+w), or choose another output");
}

Result<AtomicFile> AtomicFile::create(const std::filesystem::path& file, WriteOptions options) {
    PFVOX_CHECK(createParent(file));
    PFVOX_CHECK(checkReplaceable(file, options));
    struct stat info {};
    const bool replaces = ::stat(file.c_str(), &info) == 0;
    if (replaces && !S_ISREG(info.st_mode)) {
        Descriptor fd(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
        if (!fd.valid()) return systemError(ErrorCode::FileNotWritable, file, "cannot write");
        return AtomicFile(file, {}, {}, fd.release());
    }
    PFVOX_TRY(std::filesystem::path, target, withoutLinks(file));
    removeLeftovers(folderOf(target));
    Temporary temporary = createTemporary(folderOf(target));
    if (!temporary.descriptor.valid()) return systemError(ErrorCode::FileNotWritable, file, "cannot write");
    if (replaces) inherit(temporary.descriptor.get(), info);
    return AtomicFile(file, std::move(target), std::move(temporary.name), temporary.descriptor.release());
}

Result<AtomicFile> AtomicFile::createWith(const std::filesystem::path& file, std::span<const std::byte> bytes,
                                          WriteOptions options) {
    PFVOX_TRY(AtomicFile, output, create(file, options));
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
    if (temporary_.empty()) return;
    const auto naming = enterNaming();
    removeTemporary(temporary_);
}

Result<void> AtomicFile::write(std::span<const std::byte> bytes) {
    if (!writeAll(descriptor_, bytes)) return systemError(ErrorCode::FileNotWritable, file_, "cannot write");
    return {};
}

Result<void> AtomicFile::commit() {
    Descriptor fd(std::exchange(descriptor_, -1));
    if (target_.empty()) {
        // The kernel may report a delayed write error only here.
        if (!fd.close()) return systemError(ErrorCode::FileNotWritable, file_, "cannot close");
        return {};
    }
    if (::fsync(fd.get()) != 0) return systemError(ErrorCode::FileNotWritable, file_, "cannot sync");
    const auto naming = enterNaming();
    if (temporary_.empty()) {
        if (linkTo(fd, target_)) return {};
        // A link replaces nothing, a rename does, but needs a name to begin with.
        if (errno == EEXIST) temporary_ = nameTemporary(folderOf(target_), fd);
        if (temporary_.empty())
            return systemError(ErrorCode::FileNotWritable, file_, "cannot put the finished file into place");
    }
    const bool isPlaced = ::rename(temporary_.c_str(), target_.c_str()) == 0;
    const int reason = errno;
    isPlaced ? forgetTemporary(temporary_) : removeTemporary(temporary_);
    temporary_.clear();
    errno = reason;
    if (!isPlaced)
        return systemError(ErrorCode::FileNotWritable, file_, "cannot rename the finished file into place");
    return {};
}

}  // namespace pfvox::io

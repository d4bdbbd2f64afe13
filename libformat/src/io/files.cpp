#include "io/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>

#include "io/descriptor.hpp"

namespace pfvox::io {

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

Result<void> writeFileAtomically(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    PFVOX_TRY(AtomicFile, output, AtomicFile::createWith(file, bytes));
    return output.commit();
}

}  // namespace pfvox::io

#include "io/pipe.hpp"

#include <fcntl.h>
#include <poll.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "io/descriptor.hpp"

namespace pfvox::io {

namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

/// Up to `bytes.size()`; waits for the first. 0: the writers are done.
Result<std::size_t> readPiece(const Descriptor& fd, const std::filesystem::path& file,
                              std::span<std::byte> bytes) {
    for (;;) {
        const ssize_t n = ::read(fd.get(), bytes.data(), bytes.size());
        if (n >= 0) return static_cast<std::size_t>(n);
        if (errno == EAGAIN) {
            pollfd waiting{.fd = fd.get(), .events = POLLIN, .revents = 0};
            ::poll(&waiting, 1, -1);
        } else if (errno != EINTR) {
            return systemError(ErrorCode::FileNotReadable, file, "cannot read");
        }
    }
}

}  // namespace

Result<FileBytes> readPipe(const std::filesystem::path& file, std::uint64_t maxBytes) {
    // Without O_NONBLOCK, opening would wait for a writer, perhaps for ever.
    const Descriptor fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (!fd.valid()) return systemError(ErrorCode::FileNotReadable, file, "cannot open");
    std::vector<std::byte> all;
    for (std::size_t used = 0;;) {
        all.resize(std::max(2 * used, used + kPieceBytes));
        PFVOX_TRY(const std::size_t, piece, readPiece(fd, file, std::span(all).subspan(used)));
        used += piece;
        if (used > maxBytes) {
            return tl::make_unexpected(Error{
                .code = ErrorCode::LimitExceeded,
                .message = fmt::format("more bytes come out of this pipe than maxFileBytes = {}", maxBytes),
                .file = file});
        }
        if (piece != 0) continue;
        if (used == 0) {
            return tl::make_unexpected(Error{
                .code = ErrorCode::FileNotReadable,
                .message = "nothing comes out of this pipe: start what writes into it first, or name a file",
                .file = file});
        }
        FileBytes contents(used);
        std::memcpy(contents.bytes().data(), all.data(), used);
        return contents;
    }
}

}  // namespace pfvox::io

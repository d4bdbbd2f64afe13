// Descriptor: owns a POSIX file descriptor. Shared by the sources of io/ and by nothing else.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <pfvox/error.hpp>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

namespace pfvox::io {

class Descriptor {
  public:
    explicit Descriptor(int fd = -1) : fd_(fd) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }
    ~Descriptor() { close(); }
    int get() const { return fd_; }
    bool valid() const { return fd_ >= 0; }
    /// Gives the descriptor up: the caller closes it.
    int release() { return std::exchange(fd_, -1); }
    /// False when the kernel reports a delayed write error.
    bool close() {
        const int fd = std::exchange(fd_, -1);
        return fd < 0 || ::close(fd) == 0;
    }

  private:
    int fd_;
};

/// An Error with what errno says.
inline tl::unexpected<Error> systemError(ErrorCode code, const std::filesystem::path& file,
                                         std::string_view action) {
    const std::string reason = std::generic_category().message(errno);
    return tl::make_unexpected(
        Error{.code = code, .message = fmt::format("{}: {}", action, reason), .file = file});
}

}  // namespace pfvox::io

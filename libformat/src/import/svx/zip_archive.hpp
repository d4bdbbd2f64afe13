// ZipArchive: the entries of a zip file in memory, through libzip.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <pfvox/error.hpp>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

struct zip;

namespace pfvox::import::svx {

class ZipArchive {
  public:
    /// `bytes` must outlive the archive. Errors: Truncated or BadStructure when libzip cannot read the
    /// directory.
    static Result<ZipArchive> open(std::span<const std::byte> bytes);

    struct Entry {
        std::uint64_t index = 0;
        bool exactName = true;  ///< false: found only after "./", "\\" and letter case were put right
    };
    /// The entry of this name, if there is one; an exact match wins.
    std::optional<Entry> find(std::string_view name) const;

    /// Every name as the archive has it.
    const std::vector<std::string>& names() const { return names_; }

    /// Inflates one entry. Errors, with the entry as context: LimitExceeded when it announces more than
    /// `maxBytes`, BadStructure when it announces more than deflate can make of its bytes, ChecksumMismatch,
    /// Truncated, UnsupportedFeature (encryption, other compression).
    Result<std::vector<std::byte>> read(std::uint64_t index, std::uint64_t maxBytes) const;

  private:
    struct Discard {
        void operator()(zip* archive) const noexcept;
    };

    std::unique_ptr<zip, Discard> archive_;
    std::vector<std::string> names_;
    std::unordered_map<std::string, std::uint64_t> indexOfName_;
    std::unordered_map<std::string, std::uint64_t> indexOfLenientName_;
};

/// "./Density\\Slice0.PNG" -> "density/slice0.png".
std::string lenientName(std::string_view name);

}  // namespace pfvox::import::svx

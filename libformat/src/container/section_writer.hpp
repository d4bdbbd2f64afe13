// SectionWriter: compresses sections, in parallel where there are many, and lays them out into one file.
#pragma once

#include <cstdint>
#include <optional>
#include <pfvox/error.hpp>
#include <pfvox/pf_vox.hpp>
#include <string_view>
#include <type_traits>
#include <vector>

#include "container/file_head.hpp"
#include "container/frame.hpp"

namespace pfvox::container {

/// A section before it has its place.
struct SectionContent {
    std::string_view fourcc;  ///< four characters
    std::uint32_t region = layout::kNoRegion;
    bool mustUnderstand = true;
    std::uint64_t count = 0;
    bool compress = true;
    Texture texture = Texture::General;
    std::vector<std::uint8_t> raw = {};
    /// Of the last sections alone: the caller writes so many bytes behind the others, zeros before each that
    /// does not begin at a multiple of 64 (gapBefore). They have hashes of their own.
    std::optional<std::uint64_t> announcedBytes = {};
};

template <class Record>
void appendBytes(std::vector<std::uint8_t>& bytes, std::span<const Record> records) {
    static_assert(std::is_trivially_copyable_v<Record>);
    // Not insert(): at -O3 GCC 12 warns falsely that it overflows.
    const std::size_t at = bytes.size();
    bytes.resize(at + records.size_bytes());
    std::ranges::copy(std::as_bytes(records),
                      std::as_writable_bytes(std::span(bytes)).begin() + static_cast<std::ptrdiff_t>(at));
}

/// A table.
template <class Record>
SectionContent recordSection(std::string_view fourcc, const std::vector<Record>& records) {
    SectionContent section{.fourcc = fourcc, .count = records.size()};
    appendBytes(section.raw, std::span(records));
    return section;
}

/// What the header says about the file as a whole, and how sections are stored.
struct FileTraits {
    const Format& format;
    std::uint16_t versionMinor = 0;
    std::uint32_t requiredFeatures = 0;
    std::uint32_t optionalFeatures = 0;
    ContentKey contentKey;
    int zstdLevel = 3;
};

/// Zeros between something that ends here and the next section.
constexpr std::size_t gapBefore(std::uint64_t offset) {
    return static_cast<std::size_t>(-offset % layout::kAlignment);
}

/// The bytes of a whole file, or of all but the announced ones. A section is stored compressed only where
/// that is smaller. Errors: LimitExceeded when the section table outgrows its fields; Internal when zstd
/// fails.
Result<std::vector<std::byte>> writeSections(std::vector<SectionContent> sections, const FileTraits& traits);

}  // namespace pfvox::container

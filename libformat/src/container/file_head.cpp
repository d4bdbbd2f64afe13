#include "container/file_head.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "io/hash.hpp"

namespace pfvox::container {

namespace {

using layout::Header;
using layout::Section;

tl::unexpected<Error> failInHeader(ErrorCode code, std::uint64_t offset, std::string message) {
    return failAt(code, offset, "header", std::move(message));
}

/// What a file without the magic of `format` is instead, as far as it is ours.
std::string otherFormat(std::span<const std::byte> begin, const Format& format) {
    for (const Format& other : {kPfVox, kPfProbe}) {
        if (begin.size() >= other.magic.size() &&
            std::memcmp(begin.data(), other.magic.data(), other.magic.size()) == 0)
            return fmt::format("not a {} file but {}, which {} reads", format.name, other.name, other.reader);
    }
    return fmt::format("not a {} file", format.name);
}

Result<void> checkHeader(const Header& header, const Format& format, std::uint64_t size) {
    if (header.endianTag != layout::kEndianTag)
        return failInHeader(ErrorCode::BadValue, offsetof(Header, endianTag), "wrong byte order");
    if (header.versionMajor != format.versionMajor) {
        return failInHeader(
            ErrorCode::UnsupportedVersion, offsetof(Header, versionMajor),
            fmt::format("{} {}.{}; this program reads {}.x: {}", format.name, header.versionMajor,
                        header.versionMinor, format.versionMajor, format.remedy));
    }
    if (const std::uint32_t unknown = header.requiredFeatures & ~format.requiredFeatures; unknown != 0) {
        return failInHeader(
            ErrorCode::UnsupportedFeature, offsetof(Header, requiredFeatures),
            fmt::format("needs unknown features 0x{:x}: a newer pfvox made this file", unknown));
    }
    if (header.fileBytes > size) {
        return failInHeader(ErrorCode::Truncated, size,
                            fmt::format("the file should have {} bytes and has {}: copy it again, or {}",
                                        header.fileBytes, size, format.remedy));
    }
    if (header.fileBytes < size) {
        return failInHeader(ErrorCode::BadStructure, header.fileBytes,
                            fmt::format("{} bytes follow the end of the file", size - header.fileBytes));
    }
    return {};
}

Result<Header> readHeader(const ByteSource& source, const Format& format) {
    std::array<std::byte, sizeof(Header)> bytes{};
    const auto present = std::span(bytes).first(std::min<std::uint64_t>(source.sizeBytes(), bytes.size()));
    PFVOX_CHECK(source.readAt(0, present));
    const std::size_t magicBytes = std::min(present.size(), format.magic.size());
    if (magicBytes == 0 || std::memcmp(bytes.data(), format.magic.data(), magicBytes) != 0)
        return failInHeader(ErrorCode::BadMagic, 0, otherFormat(present, format));
    if (present.size() < bytes.size())
        return failInHeader(ErrorCode::Truncated, present.size(), "the file ends inside its header");
    Header header;
    std::memcpy(&header, bytes.data(), sizeof header);
    PFVOX_CHECK(checkHeader(header, format, source.sizeBytes()));
    return header;
}

Result<Array<Section>> readTable(const ByteSource& source, const Header& header, const Format& format,
                                 MemoryBudget& budget) {
    const std::uint64_t tableBytes = std::uint64_t{header.sectionCount} * sizeof(Section);
    if (header.tableOffset != sizeof header || tableBytes > source.sizeBytes() - sizeof header) {
        return failInHeader(ErrorCode::BadStructure, offsetof(Header, tableOffset),
                            fmt::format("a table of {} sections does not fit the file", header.sectionCount));
    }
    PFVOX_TRY(auto, hashed, Array<std::byte>::make(budget, sizeof header + tableBytes));
    PFVOX_CHECK(source.readAt(0, std::span(hashed)));
    std::memset(hashed.data() + offsetof(Header, headHash), 0, sizeof header.headHash);
    if (io::xxh3_64(hashed) != header.headHash) {
        return failInHeader(ErrorCode::ChecksumMismatch, 0,
                            fmt::format("header or section table is damaged: {}", format.remedy));
    }
    PFVOX_TRY(auto, sections, Array<Section>::make(budget, header.sectionCount));
    if (!sections.empty()) std::memcpy(sections.data(), hashed.data() + sizeof header, tableBytes);
    return sections;
}

/// What lies between sections must be too short for another one, and zero.
Result<void> checkGap(const ByteSource& source, const Section& section, std::uint64_t from) {
    std::array<std::byte, layout::kAlignment> gap{};
    const std::uint64_t bytes = section.offset - from;
    const bool isShort = bytes < gap.size();
    if (isShort) PFVOX_CHECK(source.readAt(from, std::span(gap).first(bytes)));
    if (!isShort || std::ranges::any_of(gap, [](std::byte b) { return b != std::byte{0}; }))
        return failInSection(section, ErrorCode::BadStructure, "foreign bytes before the section");
    return {};
}

Result<void> checkPlaces(const ByteSource& source, const Array<Section>& sections) {
    const std::uint64_t size = source.sizeBytes();
    std::uint64_t end = sizeof(Header) + sections.size() * sizeof(Section);
    for (const Section& section : sections) {
        if (section.offset % layout::kAlignment != 0)
            return failInSection(section, ErrorCode::BadStructure, "not aligned to 64 bytes");
        if (section.offset < end)
            return failInSection(section, ErrorCode::BadStructure, "overlaps what stands before");
        if (section.offset > size || section.storedBytes > size - section.offset)
            return failInSection(section, ErrorCode::BadStructure, "ends behind the end of the file");
        PFVOX_CHECK(checkGap(source, section, end));
        end = section.offset + section.storedBytes;
    }
    if (end != size)
        return failAt(ErrorCode::BadStructure, end, "section table", "foreign bytes behind the last section");
    return {};
}

}  // namespace

Result<FileHead> readHead(const ByteSource& source, const Format& format, MemoryBudget& budget) {
    PFVOX_TRY(const Header, header, readHeader(source, format));
    PFVOX_TRY(auto, sections, readTable(source, header, format, budget));
    PFVOX_CHECK(checkPlaces(source, sections));
    return FileHead{.header = header, .sections = std::move(sections)};
}

std::string_view nameOf(const Section& section) {
    return {section.fourcc.data(), section.fourcc.size()};
}

std::string describe(const Section& section) {
    std::string name = "section ";
    for (const char c : section.fourcc) name += c >= 32 && c < 127 ? c : '?';
    if (section.region != layout::kNoRegion) name += fmt::format(" of region {}", section.region);
    return name;
}

tl::unexpected<Error> failInSection(const Section& section, ErrorCode code, std::string message) {
    return failAt(code, section.offset, describe(section), std::move(message));
}

Result<void> inSection(const Section& section, Result<void> result) {
    if (result) return result;
    return failInSection(section, result.error().code, pfvox::describe(result.error()));
}

}  // namespace pfvox::container

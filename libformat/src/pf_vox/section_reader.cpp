#include "pf_vox/section_reader.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <zstd.h>

#include <fmt/format.h>
#include <algorithm>
#include <cstring>
#include <memory>
#include <pfvox/pf_vox.hpp>

#include "io/hash.hpp"

namespace pfvox {

namespace {

/// More than zstd can shrink anything: its smallest block of 4 bytes stands for at most 128 KiB.
constexpr std::uint64_t kMaxCompressionRatio = 1u << 16;

Result<layout::Header> readHeader(std::span<const std::byte> file) {
    layout::Header header;
    const std::size_t magicBytes = std::min(file.size(), layout::kMagic.size());
    if (file.empty() || std::memcmp(file.data(), layout::kMagic.data(), magicBytes) != 0) {
        return failAt(ErrorCode::BadMagic, 0, "header", "not a PF_VOX file");
    }
    if (file.size() < sizeof header) {
        return failAt(ErrorCode::Truncated, file.size(), "header", "the file ends inside its header");
    }
    std::memcpy(&header, file.data(), sizeof header);
    if (header.endianTag != layout::kEndianTag) {
        return failAt(ErrorCode::BadValue, offsetof(layout::Header, endianTag), "header", "wrong byte order");
    }
    if (header.versionMajor != kPfVoxVersionMajor) {
        return failAt(ErrorCode::UnsupportedVersion, offsetof(layout::Header, versionMajor), "header",
                      fmt::format("PF_VOX {}.{}; this program reads {}.x: convert the source again",
                                  header.versionMajor, header.versionMinor, kPfVoxVersionMajor));
    }
    if (const std::uint32_t unknown = header.requiredFeatures & ~layout::kKnownRequiredFeatures;
        unknown != 0) {
        return failAt(ErrorCode::UnsupportedFeature, offsetof(layout::Header, requiredFeatures), "header",
                      fmt::format("needs unknown features 0x{:x}: a newer pfvox made this file", unknown));
    }
    if (header.fileBytes > file.size()) {
        return failAt(
            ErrorCode::Truncated, file.size(), "header",
            fmt::format(
                "the file should have {} bytes and has {}: copy it again, or convert the source again",
                header.fileBytes, file.size()));
    }
    if (header.fileBytes < file.size()) {
        return failAt(ErrorCode::BadStructure, header.fileBytes, "header",
                      fmt::format("{} bytes follow the end of the file", file.size() - header.fileBytes));
    }
    return header;
}

Result<void> checkPlaces(std::span<const std::byte> file, const FileHead& head) {
    std::uint64_t end = sizeof(layout::Header) + head.sections.size() * sizeof(layout::Section);
    for (const layout::Section& section : head.sections) {
        if (section.offset % layout::kAlignment != 0) {
            return failInSection(section, ErrorCode::BadStructure, "not aligned to 64 bytes");
        }
        if (section.offset < end)
            return failInSection(section, ErrorCode::BadStructure, "overlaps what stands before");
        if (section.offset > file.size() || section.storedBytes > file.size() - section.offset) {
            return failInSection(section, ErrorCode::BadStructure, "ends behind the end of the file");
        }
        const auto gap = file.subspan(end, section.offset - end);
        if (gap.size() >= layout::kAlignment ||
            std::ranges::any_of(gap, [](std::byte b) { return b != std::byte{0}; })) {
            return failInSection(section, ErrorCode::BadStructure, "foreign bytes before the section");
        }
        end = section.offset + section.storedBytes;
    }
    if (end != file.size()) {
        return failAt(ErrorCode::BadStructure, end, "section table", "foreign bytes behind the last section");
    }
    return {};
}

struct FreeContext {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

ZSTD_DCtx* decompressContext() {
    thread_local const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
    return context.get();
}

}  // namespace

std::string sectionName(const layout::Section& section) {
    std::string name = "section ";
    for (const char c : section.fourcc) name += c >= 32 && c < 127 ? c : '?';
    if (section.region != layout::kNoRegion) name += fmt::format(" of region {}", section.region);
    return name;
}

tl::unexpected<Error> failInSection(const layout::Section& section, ErrorCode code, std::string message) {
    return failAt(code, section.offset, sectionName(section), std::move(message));
}

Result<FileHead> readHead(std::span<const std::byte> file) {
    PFVOX_TRY(layout::Header, header, readHeader(file));
    FileHead head{.header = header, .sections = {}};
    const std::uint64_t tableBytes = std::uint64_t{header.sectionCount} * sizeof(layout::Section);
    if (header.tableOffset != sizeof header || tableBytes > file.size() - sizeof header) {
        return failAt(ErrorCode::BadStructure, offsetof(layout::Header, tableOffset), "header",
                      fmt::format("a table of {} sections does not fit the file", header.sectionCount));
    }
    std::vector<std::byte> hashed(file.begin(),
                                  file.begin() + static_cast<std::ptrdiff_t>(sizeof header + tableBytes));
    std::memset(hashed.data() + offsetof(layout::Header, headHash), 0, sizeof header.headHash);
    if (io::xxh3_64(hashed) != header.headHash) {
        return failAt(ErrorCode::ChecksumMismatch, 0, "header",
                      "header or section table is damaged: convert the source again");
    }
    head.sections.resize(header.sectionCount);
    if (tableBytes != 0) std::memcpy(head.sections.data(), file.data() + sizeof header, tableBytes);
    PFVOX_CHECK(checkPlaces(file, head));
    return head;
}

Result<void> checkSectionSize(std::span<const std::byte> file, const layout::Section& section,
                              std::uint64_t expectedBytes) {
    if (section.rawBytes != expectedBytes) {
        return failInSection(
            section, ErrorCode::BadStructure,
            fmt::format("holds {} bytes, the tables say {}", section.rawBytes, expectedBytes));
    }
    if (section.codec == layout::Codec::Raw) {
        if (section.storedBytes == section.rawBytes) return {};
        return failInSection(section, ErrorCode::BadStructure,
                             "stored and raw size differ without compression");
    }
    if (section.codec != layout::Codec::Zstd) {
        return failInSection(section, ErrorCode::UnsupportedFeature,
                             fmt::format("unknown codec {}", static_cast<std::uint32_t>(section.codec)));
    }
    const auto stored = file.subspan(section.offset, section.storedBytes);
    const unsigned long long frameBytes = ZSTD_getFrameContentSize(stored.data(), stored.size());
    if (frameBytes != section.rawBytes || section.rawBytes / kMaxCompressionRatio > section.storedBytes) {
        return failInSection(section, ErrorCode::BadStructure,
                             "the zstd frame does not have the announced size");
    }
    return {};
}

Result<void> fillFromSection(std::span<const std::byte> file, const layout::Section& section,
                             std::span<std::byte> raw) {
    const auto stored = file.subspan(section.offset, section.storedBytes);
    if (section.codec == layout::Codec::Raw) {
        std::ranges::copy(stored, raw.begin());
    } else {
        const std::size_t size =
            ZSTD_decompressDCtx(decompressContext(), raw.data(), raw.size(), stored.data(), stored.size());
        if (ZSTD_isError(size) != 0 || size != raw.size()) {
            return failInSection(
                section, ErrorCode::ChecksumMismatch,
                fmt::format("cannot be decompressed: {}",
                            ZSTD_isError(size) != 0 ? ZSTD_getErrorName(size) : "short frame"));
        }
    }
    if (io::xxh3_64(raw) != section.rawHash) {
        return failInSection(section, ErrorCode::ChecksumMismatch,
                             "the bytes do not have the stored hash: damaged");
    }
    return {};
}

}  // namespace pfvox

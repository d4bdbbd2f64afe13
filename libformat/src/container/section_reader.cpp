#include "container/section_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "container/frame.hpp"
#include "io/hash.hpp"

namespace pfvox::container {

using layout::Section;

Result<void> SectionReader::checkSize(const Section& section, std::uint64_t rawBytes) const {
    if (section.rawBytes != rawBytes) {
        return failInSection(section, ErrorCode::BadStructure,
                             fmt::format("holds {} bytes, the tables say {}", section.rawBytes, rawBytes));
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
    std::array<std::byte, kMaxFrameHeadBytes> head{};
    const auto present = std::span(head).first(std::min<std::uint64_t>(section.storedBytes, head.size()));
    PFVOX_CHECK(source_.readAt(section.offset, present));
    return inSection(section, checkFrame(present, section.storedBytes, rawBytes));
}

Result<void> SectionReader::fill(const Section& section, std::span<std::byte> raw) const {
    if (section.codec == layout::Codec::Raw) {
        PFVOX_CHECK(source_.readAt(section.offset, raw));
    } else if (const auto stored = source_.view(section.offset, section.storedBytes)) {
        PFVOX_CHECK(inSection(section, decompressFrame(*stored, raw)));
    } else {
        auto bytes = Array<std::byte>::make(budget_, section.storedBytes);
        if (!bytes) return failInSection(section, bytes.error().code, std::move(bytes.error().message));
        PFVOX_CHECK(source_.readAt(section.offset, std::span(*bytes)));
        PFVOX_CHECK(inSection(section, decompressFrame(std::span(*bytes), raw)));
    }
    if (io::xxh3_64(raw) != section.rawHash) {
        return failInSection(section, ErrorCode::ChecksumMismatch,
                             "the bytes do not have the stored hash: damaged");
    }
    return {};
}

}  // namespace pfvox::container

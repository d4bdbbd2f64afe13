#include "container/section_writer.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <span>

#include "io/hash.hpp"

namespace pfvox::container {

namespace {

/// A section with its final bytes, still without an offset.
struct Stored {
    layout::Section entry{};
    std::vector<std::uint8_t> bytes;
    bool isAnnounced = false;
};

std::uint64_t alignUp(std::uint64_t value) {
    return value + gapBefore(value);
}

Result<Stored> store(SectionContent section, int level) {
    const auto raw = std::as_bytes(std::span(section.raw));
    Stored stored;
    std::ranges::copy(section.fourcc, stored.entry.fourcc.begin());
    stored.entry.flags = section.mustUnderstand ? layout::kSectionMustUnderstand : 0;
    stored.entry.region = section.region;
    stored.entry.count = section.count;
    stored.entry.rawBytes = section.announcedBytes.value_or(raw.size());
    stored.entry.storedBytes = stored.entry.rawBytes;
    stored.isAnnounced = section.announcedBytes.has_value();
    if (stored.isAnnounced) return stored;
    stored.entry.rawHash = io::xxh3_64(raw);
    if (section.compress) {
        PFVOX_TRY(auto, frame, compressFrame(raw, level, section.texture, raw.size()));
        if (frame) {
            stored.entry.codec = layout::Codec::Zstd;
            section.raw = *std::move(frame);
        }
    }
    stored.bytes = std::move(section.raw);
    stored.entry.storedBytes = stored.bytes.size();
    return stored;
}

Result<std::vector<Stored>> storeAll(std::vector<SectionContent> sections, int level) {
    std::vector<Stored> stored(sections.size());
    std::vector<std::optional<Error>> errors(sections.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sections.size(), 1), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            auto result = store(std::move(sections[i]), level);
            if (result) {
                stored[i] = *std::move(result);
            } else {
                errors[i] = std::move(result).error();
            }
        }
    });
    for (std::optional<Error>& error : errors) {
        if (error) return tl::make_unexpected(*std::move(error));
    }
    return stored;
}

}  // namespace

Result<std::vector<std::byte>> writeSections(std::vector<SectionContent> sections, const FileTraits& traits) {
    PFVOX_TRY(const auto, stored, storeAll(std::move(sections), traits.zstdLevel));
    if (stored.size() > 0xffffffffu / sizeof(layout::Section) - 1) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("{} sections do not fit a section table", stored.size()));
    }
    layout::Header header{.magic = traits.format.magic,
                          .versionMajor = traits.format.versionMajor,
                          .versionMinor = traits.versionMinor,
                          .endianTag = layout::kEndianTag,
                          .requiredFeatures = traits.requiredFeatures,
                          .optionalFeatures = traits.optionalFeatures,
                          .tableOffset = sizeof(layout::Header),
                          .sectionCount = static_cast<std::uint32_t>(stored.size()),
                          .fileBytes = 0,
                          .headHash = 0,
                          .contentKey = traits.contentKey.bytes};
    const std::uint64_t headBytes = sizeof header + stored.size() * sizeof(layout::Section);
    std::uint64_t end = headBytes;
    std::uint64_t ours = end;  // without announced bytes
    bool isOurs = true;
    std::vector<layout::Section> table;
    table.reserve(stored.size());
    for (const Stored& section : stored) {
        table.push_back(section.entry);
        table.back().offset = alignUp(end);
        end = table.back().offset + section.entry.storedBytes;
        if (isOurs) ours = table.back().offset + section.bytes.size();
        isOurs = isOurs && !section.isAnnounced;
    }
    header.fileBytes = end;

    std::vector<std::byte> file(ours);
    std::memcpy(file.data(), &header, sizeof header);
    if (!table.empty())
        std::memcpy(file.data() + sizeof header, table.data(), table.size() * sizeof table[0]);
    header.headHash = io::xxh3_64(std::span(file).first(headBytes));
    std::memcpy(file.data(), &header, sizeof header);
    for (std::size_t i = 0; i < stored.size(); ++i) {
        if (!stored[i].bytes.empty())
            std::memcpy(file.data() + table[i].offset, stored[i].bytes.data(), stored[i].bytes.size());
    }
    return file;
}

}  // namespace pfvox::container

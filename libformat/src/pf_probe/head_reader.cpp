#include "pf_probe/head_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <limits>

#include "io/hash.hpp"
#include "pf_probe/probe_settings.hpp"
#include "pf_vox/section_reader.hpp"

namespace pfvox::probe {

namespace {

using layout::Section;
using probe_layout::Frame;
using probe_layout::Record;

/// More than later versions will have.
constexpr std::uint64_t kMaxSettings = 1024;

/// The section table and what is checked before any section is read.
class Container {
  public:
    explicit Container(const ByteSource& source) : source_(source) {}

    const layout::Header& header() const { return header_; }
    const std::vector<Section>& sections() const { return sections_; }

    Result<void> read() {
        PFVOX_CHECK(readHeader());
        PFVOX_CHECK(readTable());
        return checkPlaces();
    }

  private:
    Result<void> readHeader();
    Result<void> readTable();
    Result<void> checkPlaces() const;
    Result<void> checkGap(const Section& section, std::uint64_t from) const;

    const ByteSource& source_;
    layout::Header header_{};
    std::vector<Section> sections_;
};

Result<void> Container::readHeader() {
    const std::uint64_t size = source_.sizeBytes();
    std::array<std::byte, sizeof header_> bytes{};
    const auto present = std::span(bytes).first(std::min<std::uint64_t>(size, bytes.size()));
    PFVOX_CHECK(source_.readAt(0, present));
    const std::size_t magicBytes = std::min(present.size(), probe_layout::kMagic.size());
    if (magicBytes == 0 || std::memcmp(bytes.data(), probe_layout::kMagic.data(), magicBytes) != 0) {
        const bool isPfVox = std::memcmp(bytes.data(), layout::kMagic.data(), layout::kMagic.size()) == 0;
        return failAt(ErrorCode::BadMagic, 0, "header",
                      isPfVox ? "not a PF_PROBE file but PF_VOX, which vox2pf reads" : "not a PF_PROBE file");
    }
    if (present.size() < bytes.size())
        return failAt(ErrorCode::Truncated, size, "header", "the file ends inside its header");
    std::memcpy(&header_, bytes.data(), sizeof header_);
    if (header_.endianTag != layout::kEndianTag)
        return failAt(ErrorCode::BadValue, offsetof(layout::Header, endianTag), "header", "wrong byte order");
    if (header_.versionMajor != kPfProbeVersionMajor) {
        return failAt(ErrorCode::UnsupportedVersion, offsetof(layout::Header, versionMajor), "header",
                      fmt::format("PF_PROBE {}.{}; this program reads {}.x: bake again", header_.versionMajor,
                                  header_.versionMinor, kPfProbeVersionMajor));
    }
    if (header_.requiredFeatures != 0) {
        return failAt(ErrorCode::UnsupportedFeature, offsetof(layout::Header, requiredFeatures), "header",
                      fmt::format("needs unknown features 0x{:x}: a newer pfvox made this file",
                                  header_.requiredFeatures));
    }
    if (header_.fileBytes > size) {
        return failAt(ErrorCode::Truncated, size, "header",
                      fmt::format("the file should have {} bytes and has {}: copy it again, or bake again",
                                  header_.fileBytes, size));
    }
    if (header_.fileBytes < size) {
        return failAt(ErrorCode::BadStructure, header_.fileBytes, "header",
                      fmt::format("{} bytes follow the end of the file", size - header_.fileBytes));
    }
    return {};
}

Result<void> Container::readTable() {
    const std::uint64_t tableBytes = std::uint64_t{header_.sectionCount} * sizeof(Section);
    if (header_.tableOffset != sizeof header_ || tableBytes > source_.sizeBytes() - sizeof header_) {
        return failAt(ErrorCode::BadStructure, offsetof(layout::Header, tableOffset), "header",
                      fmt::format("a table of {} sections does not fit the file", header_.sectionCount));
    }
    sections_.resize(header_.sectionCount);
    const auto table = std::as_writable_bytes(std::span(sections_));
    PFVOX_CHECK(source_.readAt(sizeof header_, table));
    layout::Header hashedHeader = header_;
    hashedHeader.headHash = 0;
    std::vector<std::byte> hashed(sizeof hashedHeader + table.size());
    std::memcpy(hashed.data(), &hashedHeader, sizeof hashedHeader);
    std::ranges::copy(table, hashed.begin() + sizeof hashedHeader);
    if (io::xxh3_64(hashed) != header_.headHash)
        return failAt(ErrorCode::ChecksumMismatch, 0, "header",
                      "header or section table is damaged: bake again");
    return {};
}

Result<void> Container::checkGap(const Section& section, std::uint64_t from) const {
    std::array<std::byte, layout::kAlignment> gap{};
    const std::uint64_t bytes = section.offset - from;
    const bool isShort = bytes < layout::kAlignment;
    if (isShort) PFVOX_CHECK(source_.readAt(from, std::span(gap).first(bytes)));
    if (!isShort || std::ranges::any_of(gap, [](std::byte b) { return b != std::byte{0}; }))
        return failInSection(section, ErrorCode::BadStructure, "foreign bytes before the section");
    return {};
}

Result<void> Container::checkPlaces() const {
    const std::uint64_t size = source_.sizeBytes();
    std::uint64_t end = sizeof header_ + sections_.size() * sizeof(Section);
    for (const Section& section : sections_) {
        if (section.offset % layout::kAlignment != 0)
            return failInSection(section, ErrorCode::BadStructure, "not aligned to 64 bytes");
        if (section.offset < end)
            return failInSection(section, ErrorCode::BadStructure, "overlaps what stands before");
        if (section.offset > size || section.storedBytes > size - section.offset)
            return failInSection(section, ErrorCode::BadStructure, "ends behind the end of the file");
        PFVOX_CHECK(checkGap(section, end));
        end = section.offset + section.storedBytes;
    }
    if (end != size)
        return failAt(ErrorCode::BadStructure, end, "section table", "foreign bytes behind the last section");
    return {};
}

/// Reads the sections one after the other, each checked against those before.
class HeadReading {
  public:
    HeadReading(const ByteSource& source, const Limits& limits) : source_(source), limits_(limits) {}

    Result<FileHead> run(Diagnostics& diagnostics) {
        Container container(source_);
        PFVOX_CHECK(container.read());
        head_.header = container.header();
        PFVOX_CHECK(index(container.sections(), diagnostics));
        PFVOX_CHECK(readInfoSection());
        PFVOX_CHECK(readSettings());
        PFVOX_CHECK(readProbes());
        PFVOX_CHECK(readFrames());
        PFVOX_CHECK(placeFrames());
        PFVOX_CHECK(readProximitySection());
        return std::move(head_);
    }

  private:
    enum Name : std::size_t { kInfo, kBake, kProb, kInpt, kFram, kProx, kData, kNameCount };
    static constexpr std::array<std::string_view, kNameCount> kNames{"INFO", "BAKE", "PROB", "INPT",
                                                                     "FRAM", "PROX", "DATA"};

    Result<void> index(const std::vector<Section>& sections, Diagnostics& diagnostics);
    Result<std::vector<std::byte>> readBytes(const Section& section, std::uint64_t expectedBytes) const;
    template <class T>
    Result<std::vector<T>> readTable(Name name, std::uint64_t count) const;
    Result<void> readInfoSection();
    Result<void> readSettings();
    Result<void> readProbes();
    Result<void> readFrames();
    Result<void> placeFrames();
    Result<void> readProximitySection();
    static Result<void> inSection(const Section& section, Result<void> result) {
        if (result || result.error().offsetBytes) return result;
        return failInSection(section, result.error().code, std::move(result.error().message));
    }

    const ByteSource& source_;
    const Limits& limits_;
    FileHead head_;
    std::array<std::optional<Section>, kNameCount> sections_;
};

Result<void> HeadReading::index(const std::vector<Section>& sections, Diagnostics& diagnostics) {
    for (const Section& section : sections) {
        const std::string_view name(section.fourcc.data(), section.fourcc.size());
        const auto place = static_cast<std::size_t>(std::ranges::find(kNames, name) - kNames.begin());
        if (place < kNames.size()) {
            if (sections_[place]) return failInSection(section, ErrorCode::BadStructure, "occurs twice");
            sections_[place] = section;
        } else if ((section.flags & layout::kSectionMustUnderstand) != 0) {
            return failInSection(section, ErrorCode::UnsupportedFeature,
                                 "unknown but required: a newer pfvox made this file");
        } else {
            diagnostics.note("pfprobe-unknown-section",
                             fmt::format("{} is unknown and was skipped", sectionName(section)));
        }
    }
    for (const Name name : {kInfo, kProb, kInpt, kFram, kData}) {
        if (!sections_[name])
            return fail(ErrorCode::BadStructure, fmt::format("section {} is missing", kNames[name]));
    }
    return {};
}

/// The stored bytes alone are handed to the section reader of PF_VOX, which then sees them at offset 0.
Result<std::vector<std::byte>> HeadReading::readBytes(const Section& section,
                                                      std::uint64_t expectedBytes) const {
    const auto tooLarge = [&](std::uint64_t bytes) {
        return failInSection(
            section, ErrorCode::LimitExceeded,
            fmt::format("{} bytes, more than maxMemoryBytes = {}", bytes, limits_.maxMemoryBytes));
    };
    if (section.storedBytes > limits_.maxMemoryBytes) return tooLarge(section.storedBytes);
    if (expectedBytes > limits_.maxMemoryBytes) return tooLarge(expectedBytes);
    std::vector<std::byte> stored(section.storedBytes);
    PFVOX_CHECK(source_.readAt(section.offset, stored));
    Section local = section;
    local.offset = 0;
    const auto place = [&](Result<void> result) {
        if (!result) result.error().offsetBytes = section.offset;
        return result;
    };
    PFVOX_CHECK(place(checkSectionSize(stored, local, expectedBytes)));
    std::vector<std::byte> raw(expectedBytes);
    PFVOX_CHECK(place(fillFromSection(stored, local, raw)));
    return raw;
}

template <class T>
Result<std::vector<T>> HeadReading::readTable(Name name, std::uint64_t count) const {
    const Section& section = *sections_[name];
    if (section.count != count) {
        return failInSection(section, ErrorCode::BadStructure,
                             fmt::format("{} entries where {} are needed", section.count, count));
    }
    PFVOX_TRY(const auto, raw, readBytes(section, count * sizeof(T)));
    std::vector<T> table(count);
    std::memcpy(table.data(), raw.data(), raw.size());
    return table;
}

Result<void> HeadReading::readInfoSection() {
    const Section& section = *sections_[kInfo];
    if (section.rawBytes > sizeof(probe_layout::Info) + 2 * kMaxNameBytes)
        return failInSection(section, ErrorCode::BadStructure, "is too long");
    PFVOX_TRY(const auto, raw, readBytes(section, section.rawBytes));
    auto info = readInfo(raw);
    if (!info) return failInSection(section, info.error().code, std::move(info.error().message));
    head_.info = *std::move(info);
    if (const std::uint64_t bytes = head_.info.resolution.bytesPerProbe(); bytes > limits_.maxMemoryBytes) {
        return failInSection(
            section, ErrorCode::LimitExceeded,
            fmt::format("{} bytes a probe, more than maxMemoryBytes = {}", bytes, limits_.maxMemoryBytes));
    }
    return {};
}

Result<void> HeadReading::readSettings() {
    if (!sections_[kBake]) return {};
    const Section& section = *sections_[kBake];
    if (section.count > kMaxSettings) return failInSection(section, ErrorCode::BadStructure, "is too long");
    PFVOX_TRY(const auto, entries, readTable<probe_layout::Setting>(kBake, section.count));
    return inSection(section, readSettingEntries(entries, head_.info.settings));
}

Result<void> HeadReading::readProbes() {
    const std::uint64_t count = head_.info.range.size();
    PFVOX_TRY(const auto, records, readTable<Record>(kProb, count));
    PFVOX_TRY(const auto, inputs, readTable<ContentKey>(kInpt, count));
    head_.probes.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        auto record = fromRecord(records[i]);
        if (!record) {
            return failInSection(
                *sections_[kProb], record.error().code,
                fmt::format("probe {}: {}", head_.info.range.first + i, record.error().message));
        }
        head_.probes[i].record = *record;
        head_.probes[i].inputHash = inputs[i];
    }
    return {};
}

Result<void> HeadReading::readFrames() {
    const Section& section = *sections_[kFram];
    std::uint64_t layers = 0;
    for (const ProbeLayer layer : kAllLayers) layers += head_.info.resolution.has(layer) ? 1u : 0u;
    PFVOX_TRY(const auto, frames, readTable<Frame>(kFram, layers * head_.probes.size()));
    std::size_t next = 0;
    for (std::size_t i = 0; i < head_.probes.size(); ++i) {
        StoredProbe& probe = head_.probes[i];
        for (const ProbeLayer layer : kAllLayers) {
            if (head_.info.resolution.has(layer))
                probe.frames[static_cast<std::size_t>(layer)] = frames[next++];
        }
        Result<void> checked = checkFrames(head_.info.resolution, probe.record, probe.frames);
        if (checked && hashOf(probe.record, probe.frames) != probe.record.hash)
            checked = fail(ErrorCode::ChecksumMismatch, "its hash is not that of its record and layers");
        if (!checked) {
            return failInSection(
                section, checked.error().code,
                fmt::format("probe {}: {}", head_.info.range.first + i, checked.error().message));
        }
    }
    return {};
}

Result<void> HeadReading::placeFrames() {
    const Section& data = *sections_[kData];
    std::uint64_t offset = data.offset;
    const std::uint64_t end = data.offset + data.storedBytes;
    for (const StoredProbe& probe : head_.probes) {
        head_.frameOffsets.push_back(offset);
        // No overflow: at most 2^32 probes of 5 frames below 4 GiB each, and the sum is checked as it grows.
        offset += probe.storedBytes();
        if (offset > end)
            return failInSection(data, ErrorCode::BadStructure, "is shorter than the frames in it");
    }
    if (offset != end) return failInSection(data, ErrorCode::BadStructure, "is longer than the frames in it");
    if (data.codec != layout::Codec::Raw || data.rawBytes != data.storedBytes || data.rawHash != 0 ||
        data.count != head_.probes.size()) {
        return failInSection(data, ErrorCode::BadStructure, "the entry is not that of raw frames");
    }
    return {};
}

Result<void> HeadReading::readProximitySection() {
    if (!sections_[kProx]) return {};
    const Section& section = *sections_[kProx];
    // Not larger than 32-bit lists of all cells that 32 bits can count, whatever the section says.
    PFVOX_TRY(const auto, raw, readBytes(section, section.rawBytes));
    auto grid = readProximity(head_.info, raw);
    if (!grid) return failInSection(section, grid.error().code, std::move(grid.error().message));
    if (section.count != grid->cellCount())
        return failInSection(section, ErrorCode::BadStructure, "holds another number of cells");
    PFVOX_CHECK(inSection(section, checkProximityStates(head_.info, *grid, head_.probes)));
    head_.proximity = *std::move(grid);
    return {};
}

}  // namespace

Result<FileHead> readHead(const ByteSource& source, const Limits& limits, Diagnostics& diagnostics) {
    return HeadReading(source, limits).run(diagnostics);
}

std::string frameName(std::uint32_t probe, ProbeLayer layer) {
    return fmt::format("{} of probe {}", toString(layer), probe);
}

}  // namespace pfvox::probe

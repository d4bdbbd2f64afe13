#include "pf_probe/head_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "container/section_table.hpp"
#include "pf_probe/composer.hpp"
#include "pf_probe/probe_settings.hpp"

namespace pfvox::probe {

namespace {

using container::failInSection;
using container::inSection;
using container::SectionTable;
using layout::Section;
using probe_layout::Frame;
using probe_layout::Record;

/// More than later versions will have.
constexpr std::uint64_t kMaxSettings = 1024;

constexpr std::array<std::string_view, 10> kSections{"INFO", "ORIG", "BAKE", "PROB", "INPT",
                                                     "FRAM", "PROX", "FACE", "DATA", "FDAT"};

/// Reads the sections one after the other, each checked against those before.
class HeadReading {
  public:
    HeadReading(const container::ByteSource& source, container::MemoryBudget& budget)
        : source_(source), budget_(budget), reader_(source, budget) {}

    Result<FileHead> run(Diagnostics& diagnostics) {
        PFVOX_TRY(const auto, file, container::readHead(source_, container::kPfProbe, budget_));
        PFVOX_TRY(auto, table,
                  SectionTable::make(file, container::kPfProbe, {.whole = kSections}, budget_, diagnostics));
        head_.header = file.header;
        table_ = std::move(table);
        for (const std::string_view name : {"INFO", "PROB", "INPT", "FRAM", "DATA"})
            PFVOX_CHECK(table_.require(name));
        PFVOX_CHECK(readInfoSection());
        PFVOX_CHECK(readOrigin());
        PFVOX_CHECK(readSettings());
        PFVOX_CHECK(readProbes());
        PFVOX_CHECK(readFrames());
        PFVOX_CHECK(placeFrames());
        PFVOX_CHECK(readProximitySection());
        PFVOX_CHECK(readFaces());
        return std::move(head_);
    }

  private:
    template <class T>
    Result<container::Array<T>> readTable(const Section& section, std::uint64_t count) const;
    Result<void> readInfoSection();
    Result<void> readOrigin();
    Result<void> readSettings();
    Result<void> readProbes();
    Result<void> readFrames();
    Result<void> placeFrames();
    Result<void> readProximitySection();
    Result<void> readFaces();
    Result<void> checkFrameData(const Section& data, std::uint64_t end, std::uint64_t count) const;
    tl::unexpected<Error> failInProbe(const Section& section, std::size_t i, const Error& error) const {
        return failInSection(section, error.code,
                             fmt::format("probe {}: {}", head_.info.range.first + i, error.message));
    }

    const container::ByteSource& source_;
    container::MemoryBudget& budget_;
    container::SectionReader reader_;
    SectionTable table_;
    FileHead head_;
};

template <class T>
Result<container::Array<T>> HeadReading::readTable(const Section& section, std::uint64_t count) const {
    if (section.count == count) return reader_.read<T>(section, count);
    return failInSection(section, ErrorCode::BadStructure,
                         fmt::format("{} entries where {} are needed", section.count, count));
}

Result<void> HeadReading::readInfoSection() {
    const Section& section = *table_.find("INFO");
    if (section.rawBytes > sizeof(probe_layout::Info) + 2 * kMaxNameBytes)
        return failInSection(section, ErrorCode::BadStructure, "is too long");
    PFVOX_TRY(const auto, raw, reader_.read<std::byte>(section, section.rawBytes));
    auto info = readInfo(raw);
    if (!info) return failInSection(section, info.error().code, std::move(info.error().message));
    head_.info = *std::move(info);
    PFVOX_CHECK(inSection(section, checkHasContent(head_.info, table_.find("FACE") != nullptr)));
    // Of one probe that is read, whoever gets it.
    return inSection(section, budget_.take(head_.info.resolution.bytesPerProbe()));
}

Result<void> HeadReading::readOrigin() {
    const Section* const section = table_.find("ORIG");
    if (section == nullptr) return {};
    PFVOX_TRY(const auto, entries, readTable<probe_layout::Origin>(*section, 1));
    const auto& o = entries[0].origin;
    head_.info.grid.origin = {o[0], o[1], o[2]};
    for (const double v : o)
        if (!(std::abs(v) < 1e30)) return failInSection(*section, ErrorCode::BadValue, "is out of range");
    return {};
}

Result<void> HeadReading::readSettings() {
    const Section* const section = table_.find("BAKE");
    if (section == nullptr) return {};
    if (section->count > kMaxSettings) return failInSection(*section, ErrorCode::BadStructure, "is too long");
    PFVOX_TRY(const auto, entries, readTable<probe_layout::Setting>(*section, section->count));
    return inSection(*section, readSettingEntries(entries, head_.info.settings));
}

Result<void> HeadReading::readProbes() {
    const std::uint64_t count = head_.info.range.size();
    const Section& section = *table_.find("PROB");
    PFVOX_TRY(const auto, records, readTable<Record>(section, count));
    PFVOX_TRY(const auto, inputs, readTable<ContentKey>(*table_.find("INPT"), count));
    PFVOX_CHECK(inSection(section, budget_.resize(head_.probes, count)));
    for (std::size_t i = 0; i < count; ++i) {
        const auto record = fromRecord(records[i]);
        if (!record) return failInProbe(section, i, record.error());
        head_.probes[i].record = *record;
        head_.probes[i].inputHash = inputs[i];
    }
    return {};
}

Result<void> HeadReading::readFrames() {
    const Section& section = *table_.find("FRAM");
    std::uint64_t layers = 0;
    for (const ProbeLayer layer : kAllLayers) layers += head_.info.resolution.has(layer) ? 1u : 0u;
    PFVOX_TRY(const auto, frames, readTable<Frame>(section, layers * head_.probes.size()));
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
        if (!checked) return failInProbe(section, i, checked.error());
    }
    return {};
}

Result<void> HeadReading::placeFrames() {
    const Section& data = *table_.find("DATA");
    PFVOX_CHECK(inSection(data, budget_.reserve(head_.frameOffsets, head_.probes.size())));
    std::uint64_t offset = data.offset;
    const std::uint64_t end = data.offset + data.storedBytes;
    for (const StoredProbe& probe : head_.probes) {
        head_.frameOffsets.push_back(offset);
        // No overflow: at most 2^32 probes of 5 frames below 4 GiB each, and the sum is checked as it grows.
        offset += probe.storedBytes();
        if (offset > end)
            return failInSection(data, ErrorCode::BadStructure, "is shorter than the frames in it");
    }
    return checkFrameData(data, offset, head_.probes.size());
}

/// Whether a section is that of `count` things whose frames end at `end`.
Result<void> HeadReading::checkFrameData(const Section& data, std::uint64_t end, std::uint64_t count) const {
    if (end != data.offset + data.storedBytes)
        return failInSection(data, ErrorCode::BadStructure, "is longer than the frames in it");
    if (data.codec != layout::Codec::Raw || data.rawBytes != data.storedBytes || data.rawHash != 0 ||
        data.count != count)
        return failInSection(data, ErrorCode::BadStructure, "the entry is not that of raw frames");
    return {};
}

Result<void> HeadReading::readProximitySection() {
    const Section* const section = table_.find("PROX");
    if (section == nullptr) return {};
    PFVOX_TRY(const auto, raw, reader_.read<std::byte>(*section, section->rawBytes));
    auto grid = readProximity(head_.info, raw, budget_);
    if (!grid) return failInSection(*section, grid.error().code, std::move(grid.error().message));
    if (section->count != grid->cellCount())
        return failInSection(*section, ErrorCode::BadStructure, "holds another number of cells");
    PFVOX_CHECK(inSection(*section, checkProximityStates(head_.info, *grid, head_.probes)));
    head_.proximity = *std::move(grid);
    return {};
}

Result<void> HeadReading::readFaces() {
    const Section* const section = table_.find("FACE");
    const Section* const data = table_.find("FDAT");
    if (section == nullptr && data == nullptr) return {};
    PFVOX_CHECK(table_.require("FACE"));
    PFVOX_CHECK(table_.require("FDAT"));
    PFVOX_TRY(const auto, raw, reader_.read<std::byte>(*section, section->rawBytes));
    auto faces = readFaceSection(raw, budget_);
    if (!faces) return failInSection(*section, faces.error().code, std::move(faces.error().message));
    if (section->count != faces->chunks.size())
        return failInSection(*section, ErrorCode::BadStructure, "holds another number of chunks");
    std::uint64_t offset = data->offset;
    for (faces::StoredChunk& chunk : faces->chunks) {
        chunk.frames.offsetBytes = offset;
        offset += chunk.record.storedBytes;
        if (offset > data->offset + data->storedBytes)
            return failInSection(*data, ErrorCode::BadStructure, "is shorter than the frames in it");
    }
    PFVOX_CHECK(checkFrameData(*data, offset, faces->chunks.size()));
    head_.faces = std::move(faces->info);
    head_.facePlaces = std::move(faces->places);
    head_.faceChunks = std::move(faces->chunks);
    return {};
}

}  // namespace

Result<FileHead> readHead(const container::ByteSource& source, container::MemoryBudget& budget,
                          Diagnostics& diagnostics) {
    return HeadReading(source, budget).run(diagnostics);
}

std::string chunkName(std::uint32_t chunk) {
    return fmt::format("chunk {} of light on faces", chunk);
}

std::string frameName(std::uint32_t probe, ProbeLayer layer) {
    return fmt::format("{} of probe {}", toString(layer), probe);
}

}  // namespace pfvox::probe

#include "pf_probe/composer.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "io/hash.hpp"
#include "pf_probe/frame_codec.hpp"
#include "pf_probe/probe_settings.hpp"

namespace pfvox::probe {

namespace {

/// Of the tables; frames have the level that the user chose. A merged file thus has the bytes of a whole one.
constexpr int kTableZstdLevel = 3;

template <class T>
std::vector<std::byte> toBytes(const std::vector<T>& table) {
    const auto bytes = std::as_bytes(std::span(table));
    return {bytes.begin(), bytes.end()};
}

std::uint64_t alignUp(std::uint64_t value) {
    return (value + layout::kAlignment - 1) & ~(layout::kAlignment - 1);
}

/// Sections one behind the other; DATA comes last and is only announced.
class HeadWriter {
  public:
    Result<void> add(std::string_view fourcc, std::uint64_t count, const std::vector<std::byte>& raw,
                     std::uint32_t flags = layout::kSectionMustUnderstand) {
        PFVOX_TRY(PackedBytes, packed, packBytes(raw, kTableZstdLevel));
        sections_.push_back({.fourcc = name(fourcc),
                             .flags = flags,
                             .codec = packed.codec,
                             .region = layout::kNoRegion,
                             .offset = 0,
                             .storedBytes = packed.bytes.size(),
                             .rawBytes = raw.size(),
                             .count = count,
                             .rawHash = io::xxh3_64(raw),
                             .reserved = 0});
        contents_.push_back(std::move(packed.bytes));
        return {};
    }

    std::vector<std::byte> finish(std::uint64_t probes, std::uint64_t dataBytes, const ContentKey& key) {
        sections_.push_back({.fourcc = name("DATA"),
                             .flags = layout::kSectionMustUnderstand,
                             .codec = layout::Codec::Raw,
                             .region = layout::kNoRegion,
                             .offset = 0,
                             .storedBytes = dataBytes,
                             .rawBytes = dataBytes,
                             .count = probes,
                             .rawHash = 0,
                             .reserved = 0});
        contents_.emplace_back();
        const std::uint64_t tableBytes = sections_.size() * sizeof(layout::Section);
        std::uint64_t end = sizeof(layout::Header) + tableBytes;
        for (layout::Section& section : sections_) {
            section.offset = alignUp(end);
            end = section.offset + section.storedBytes;
        }
        layout::Header header{.magic = probe_layout::kMagic,
                              .versionMajor = kPfProbeVersionMajor,
                              .versionMinor = kPfProbeVersionMinor,
                              .endianTag = layout::kEndianTag,
                              .requiredFeatures = 0,
                              .optionalFeatures = 0,
                              .tableOffset = sizeof(layout::Header),
                              .sectionCount = static_cast<std::uint32_t>(sections_.size()),
                              .fileBytes = end,
                              .headHash = 0,
                              .contentKey = key.bytes};
        std::vector<std::byte> head(end - dataBytes);
        std::memcpy(head.data(), &header, sizeof header);
        std::memcpy(head.data() + sizeof header, sections_.data(), tableBytes);
        header.headHash = io::xxh3_64(std::span(head).first(sizeof header + tableBytes));
        std::memcpy(head.data(), &header, sizeof header);
        for (std::size_t i = 0; i < contents_.size(); ++i)
            std::ranges::copy(contents_[i], head.begin() + static_cast<std::ptrdiff_t>(sections_[i].offset));
        return head;
    }

  private:
    static std::array<char, 4> name(std::string_view fourcc) {
        return {fourcc[0], fourcc[1], fourcc[2], fourcc[3]};
    }

    std::vector<layout::Section> sections_;
    std::vector<std::vector<std::byte>> contents_;
};

}  // namespace

Result<std::vector<std::byte>> composeHead(FilePlan& plan) {
    std::vector<probe_layout::Record> records;
    std::vector<ContentKey> inputs;
    std::vector<probe_layout::Frame> frames;
    std::uint64_t dataBytes = 0;
    for (StoredProbe& probe : plan.probes) {
        probe.record.hash = hashOf(probe.record, probe.frames);
        records.push_back(toRecord(probe.record));
        inputs.push_back(probe.inputHash);
        for (const ProbeLayer layer : kAllLayers) {
            if (plan.info.resolution.has(layer))
                frames.push_back(probe.frames[static_cast<std::size_t>(layer)]);
        }
        dataBytes += probe.storedBytes();
    }
    HeadWriter writer;
    PFVOX_CHECK(writer.add("INFO", 1, infoBytes(plan.info)));
    // Readers of 1.0 may skip it.
    if (const auto settings = settingEntries(plan.info.settings); !settings.empty())
        PFVOX_CHECK(writer.add("BAKE", settings.size(), toBytes(settings), 0));
    PFVOX_CHECK(writer.add("PROB", records.size(), toBytes(records)));
    PFVOX_CHECK(writer.add("INPT", inputs.size(), toBytes(inputs)));
    PFVOX_CHECK(writer.add("FRAM", frames.size(), toBytes(frames)));
    if (plan.proximity != nullptr) {
        PFVOX_CHECK(checkProximityGrid(plan.info, *plan.proximity));
        PFVOX_CHECK(checkProximityStates(plan.info, *plan.proximity, plan.probes));
        PFVOX_CHECK(
            writer.add("PROX", plan.proximity->cellCount(), proximityBytes(plan.info, *plan.proximity)));
    }
    return writer.finish(plan.probes.size(), dataBytes, plan.contentKey);
}

Result<PackedProbe> packProbe(const ProbeData& data, int zstdLevel) {
    PackedProbe packed{.entry = {.record = data.record, .inputHash = data.inputHash}};
    for (const ProbeLayer layer : kAllLayers) {
        const auto words = data.bytesOf(layer);
        if (words.empty()) continue;
        PFVOX_TRY(const auto, frame, packFrame(layer, words, zstdLevel, packed.stored));
        packed.entry.frames[static_cast<std::size_t>(layer)] = frame;
    }
    return packed;
}

}  // namespace pfvox::probe

#include "pf_probe/composer.hpp"

#include <fmt/format.h>

#include "container/section_writer.hpp"
#include "pf_probe/face_section.hpp"
#include "pf_probe/frame_codec.hpp"
#include "pf_probe/probe_settings.hpp"

namespace pfvox::probe {

namespace {

using container::recordSection;
using container::SectionContent;

/// Of the tables; frames have the level that the user chose. A merged file thus has the bytes of a whole one.
constexpr int kTableZstdLevel = 3;

}  // namespace

std::uint64_t FilePlan::probeFrameBytes() const {
    std::uint64_t bytes = 0;
    for (const StoredProbe& probe : probes) bytes += probe.storedBytes();
    return bytes;
}

std::vector<std::byte> FilePlan::gapBeforeFaces(std::span<const std::byte> head) const {
    return std::vector<std::byte>(faces == nullptr ? 0
                                                   : container::gapBefore(head.size() + probeFrameBytes()));
}

Result<void> checkHasContent(const ProbeFieldInfo& info, bool hasFaces) {
    if (info.range.size() != 0 || hasFaces) return {};
    return fail(ErrorCode::BadValue, fmt::format("probes {}:{} of a grid of {}, and no light on faces",
                                                 info.range.first, info.range.end, info.grid.probeCount()));
}

Result<std::vector<std::byte>> composeHead(FilePlan& plan) {
    std::vector<probe_layout::Record> records;
    std::vector<ContentKey> inputs;
    std::vector<probe_layout::Frame> frames;
    for (StoredProbe& probe : plan.probes) {
        probe.record.hash = hashOf(probe.record, probe.frames);
        records.push_back(toRecord(probe.record));
        inputs.push_back(probe.inputHash);
        for (const ProbeLayer layer : kAllLayers) {
            if (plan.info.resolution.has(layer))
                frames.push_back(probe.frames[static_cast<std::size_t>(layer)]);
        }
    }
    std::vector<SectionContent> sections;
    sections.push_back({.fourcc = "INFO", .count = 1, .raw = infoBytes(plan.info)});
    if (const glm::dvec3& o = plan.info.grid.origin; o != glm::dvec3(0.0))
        sections.push_back(recordSection("ORIG", std::vector{probe_layout::Origin{{o.x, o.y, o.z}}}));
    if (const auto settings = settingEntries(plan.info.settings); !settings.empty()) {
        sections.push_back(recordSection("BAKE", settings));
        sections.back().mustUnderstand = false;  // readers of 1.0 may skip it
    }
    sections.push_back(recordSection("PROB", records));
    sections.push_back(recordSection("INPT", inputs));
    sections.push_back(recordSection("FRAM", frames));
    if (plan.proximity != nullptr) {
        PFVOX_CHECK(checkProximityGrid(plan.info, *plan.proximity));
        PFVOX_CHECK(checkProximityStates(plan.info, *plan.proximity, plan.probes));
        sections.push_back({.fourcc = "PROX",
                            .count = plan.proximity->cellCount(),
                            .raw = proximityBytes(plan.info, *plan.proximity)});
    }
    // Readers of 1.1 may skip light on faces.
    if (plan.faces != nullptr)
        sections.push_back({.fourcc = "FACE",
                            .mustUnderstand = false,
                            .count = plan.chunks.size(),
                            .raw = faceSectionBytes(*plan.faces, plan.chunks)});
    sections.push_back({.fourcc = "DATA",
                        .count = plan.probes.size(),
                        .compress = false,
                        .announcedBytes = plan.probeFrameBytes()});
    if (plan.faces != nullptr) {
        std::uint64_t bytes = 0;
        for (const faces::StoredChunk& chunk : plan.chunks) bytes += chunk.record.storedBytes;
        sections.push_back({.fourcc = "FDAT",
                            .mustUnderstand = false,
                            .count = plan.chunks.size(),
                            .compress = false,
                            .announcedBytes = bytes});
    }
    return container::writeSections(
        std::move(sections),
        {.format = container::kPfProbe,
         .versionMinor = plan.faces == nullptr ? kPfProbePlainMinor : kPfProbeVersionMinor,
         .contentKey = plan.contentKey,
         .zstdLevel = kTableZstdLevel});
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

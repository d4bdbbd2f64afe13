#include "pf_probe/composer.hpp"

#include "container/section_writer.hpp"
#include "pf_probe/frame_codec.hpp"
#include "pf_probe/probe_settings.hpp"

namespace pfvox::probe {

namespace {

using container::recordSection;
using container::SectionContent;

/// Of the tables; frames have the level that the user chose. A merged file thus has the bytes of a whole one.
constexpr int kTableZstdLevel = 3;

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
    sections.push_back(
        {.fourcc = "DATA", .count = plan.probes.size(), .compress = false, .announcedBytes = dataBytes});
    return container::writeSections(std::move(sections), {.format = container::kPfProbe,
                                                          .versionMinor = kPfProbeVersionMinor,
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

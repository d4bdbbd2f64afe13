// Surgery on PF_PROBE bytes: as pf_vox_surgery.hpp, with the hashes that only probe files have.
#pragma once

#include "pf_probe/records.hpp"
#include "support/lit_faces.hpp"
#include "support/pf_vox_surgery.hpp"
#include "support/probe_fields.hpp"

namespace pfvox::test {

/// A small file with a feature of every kind: inactive and relocated probes, all layers, a proximity grid.
inline const Bytes& probeSample() {
    static const Bytes file = encodePfProbe(probeField(probeInfo({3, 2, 2}, {16, 4, 2, 2})), {}).value();
    return file;
}

/// The same with light on faces, and few probes.
inline const Bytes& faceSample() {
    static const Bytes file = [] {
        ProbeField field = probeField(probeInfo({2, 1, 1}, {16, 4, 2, 2}), false);
        field.faces = faceLight();
        return encodePfProbe(field, {}).value();
    }();
    return file;
}

/// Makes the hash of each probe right for its record and its frames, as far as these are there.
inline void repairProbeHashes(OpenFile& open) {
    const auto find = [&](const char* fourcc) -> OpenFile::Part* {
        for (OpenFile::Part& part : open.parts)
            if (std::string(part.entry.fourcc.data(), 4) == fourcc) return &part;
        return nullptr;
    };
    OpenFile::Part* const records = find("PROB");
    const OpenFile::Part* const frames = find("FRAM");
    if (records == nullptr || frames == nullptr) return;
    constexpr std::size_t kFramesBytes = sizeof(probe::Frames);
    for (std::size_t i = 0; (i + 1) * sizeof(probe_layout::Record) <= records->raw.size() &&
                            (i + 1) * kFramesBytes <= frames->raw.size();
         ++i) {
        probe_layout::Record record;
        probe::Frames ofProbe;
        std::memcpy(&record, records->raw.data() + i * sizeof record, sizeof record);
        std::memcpy(&ofProbe, frames->raw.data() + i * kFramesBytes, kFramesBytes);
        record.hash = 0;
        if (const auto value = probe::fromRecord(record)) record.hash = probe::hashOf(*value, ofProbe);
        std::memcpy(records->raw.data() + i * sizeof record, &record, sizeof record);
    }
}

inline Bytes closeProbeFile(OpenFile open) {
    repairProbeHashes(open);
    return closeFile(std::move(open));
}

}  // namespace pfvox::test

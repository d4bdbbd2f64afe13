// HeadReader: everything of a probe file but its maps, out of bytes that are not trusted.
#pragma once

#include <optional>
#include <pfvox/error.hpp>
#include <vector>

#include "container/section_reader.hpp"
#include "pf_probe/face_section.hpp"
#include "pf_probe/records.hpp"

namespace pfvox::probe {

struct FileHead {
    layout::Header header{};
    ProbeFieldInfo info;
    std::vector<StoredProbe> probes;          ///< probe info.range.first and those behind it
    std::vector<std::uint64_t> frameOffsets;  ///< of each probe's first frame, in the file
    std::optional<ProximityGrid> proximity;
    std::optional<FaceLightInfo> faces;
    std::vector<FaceChunkPlace> facePlaces;      ///< of all chunks of the scene
    std::vector<faces::StoredChunk> faceChunks;  ///< of faces->range
};

/// Errors: BadMagic, Truncated, UnsupportedVersion, UnsupportedFeature, ChecksumMismatch, BadStructure,
/// BadValue, BadReference, LimitExceeded; those of the source.
Result<FileHead> readHead(const container::ByteSource& source, container::MemoryBudget& budget,
                          Diagnostics& diagnostics);

/// "light of probe 12", for messages.
std::string frameName(std::uint32_t probe, ProbeLayer layer);
/// "chunk 3 of light on faces".
std::string chunkName(std::uint32_t chunk);

}  // namespace pfvox::probe

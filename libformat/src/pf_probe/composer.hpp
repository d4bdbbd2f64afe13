// Composer: the tables of a probe file whose frames are known already. The frames follow them, probe by
// probe, then those of light on faces, chunk by chunk.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/pf_probe.hpp>
#include <vector>

#include "faces/chunk_codec.hpp"
#include "pf_probe/records.hpp"

namespace pfvox::probe {

struct FilePlan {
    ProbeFieldInfo info;
    ContentKey contentKey;
    std::vector<StoredProbe> probes;  ///< all of info.range; hashes of the records are computed here
    const ProximityGrid* proximity = nullptr;
    const FaceLightInfo* faces = nullptr;    ///< null: no light on faces
    std::vector<faces::StoredChunk> chunks;  ///< all of faces->range

    std::uint64_t probeFrameBytes() const;
    /// Zeros between the frames of probes and those of faces in a file that begins with this head.
    std::vector<std::byte> gapBeforeFaces(std::span<const std::byte> head) const;
};

/// A file without faces has probes, one with them need not. Errors: BadValue.
Result<void> checkHasContent(const ProbeFieldInfo& info, bool hasFaces);

/// All bytes up to the first frame. Preconditions: info and records were checked. Errors: those of
/// checkProximityGrid; BadReference where it names an inactive probe; Internal when zstd fails.
Result<std::vector<std::byte>> composeHead(FilePlan& plan);

/// The entry and stored frames of a probe. Errors: Internal when zstd fails.
struct PackedProbe {
    StoredProbe entry;
    std::vector<std::byte> stored;
};
Result<PackedProbe> packProbe(const ProbeData& data, int zstdLevel);

}  // namespace pfvox::probe

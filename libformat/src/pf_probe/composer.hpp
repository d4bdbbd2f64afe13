// Composer: the tables of a probe file whose frames are known already. The frames follow them, probe by
// probe.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/pf_probe.hpp>
#include <vector>

#include "pf_probe/records.hpp"

namespace pfvox::probe {

struct FilePlan {
    ProbeFieldInfo info;
    ContentKey contentKey;
    std::vector<StoredProbe> probes;  ///< all of info.range; hashes of the records are computed here
    const ProximityGrid* proximity = nullptr;
};

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

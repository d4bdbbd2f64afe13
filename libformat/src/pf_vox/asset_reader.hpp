// AssetReader: sections -> OctreeAsset. Serves the decoder, which stops at the first fault, and the
// validator, which wants them all.
#pragma once

#include <pfvox/pf_vox.hpp>
#include <span>
#include <vector>

namespace pfvox {

enum class FaultPolicy {
    StopAtFirst,
    CollectAll,  ///< go on with every part that does not depend on the faulty one, and check contents too
};

struct ReadOutcome {
    OctreeAsset asset;          ///< complete only if there are no faults
    std::vector<Error> faults;  ///< in file order of what was read
};

/// Throws std::bad_alloc.
ReadOutcome readAsset(std::span<const std::byte> file, const Limits& limits, FaultPolicy policy,
                      Diagnostics& diagnostics);

}  // namespace pfvox

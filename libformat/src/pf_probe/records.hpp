// Records: the tables of a file <-> the value types.
#pragma once

#include <array>
#include <pfvox/pf_probe.hpp>
#include <span>
#include <vector>

#include "container/memory_budget.hpp"
#include "pf_probe/layout.hpp"

namespace pfvox::probe {

inline constexpr std::array<ProbeLayer, kProbeLayerCount> kAllLayers{
    ProbeLayer::DepthNormal, ProbeLayer::Light, ProbeLayer::MinDepth, ProbeLayer::Irradiance,
    ProbeLayer::Moments};
inline constexpr std::size_t kMaxNameBytes = 4096;

using Frames = std::array<probe_layout::Frame, kProbeLayerCount>;  ///< by layer; absent ones are zero

/// A probe as a file knows it: everything but the bytes of its frames.
struct StoredProbe {
    ProbeRecord record;
    ContentKey inputHash;
    Frames frames{};

    std::uint64_t storedBytes() const;
};

/// ProbeRecord::hash.
std::uint64_t hashOf(const ProbeRecord& record, const Frames& frames);

/// Domains of the values of a record, which is a file's or a baker's. Errors: BadValue.
Result<void> checkRecord(const ProbeRecord& record);

std::vector<std::uint8_t> infoBytes(const ProbeFieldInfo& info);
/// Errors: BadStructure, BadValue.
Result<ProbeFieldInfo> readInfo(std::span<const std::byte> bytes);

probe_layout::Record toRecord(const ProbeRecord& record);
/// Errors: BadValue.
Result<ProbeRecord> fromRecord(const probe_layout::Record& record);

/// Whether frames are what this resolution asks of a probe in this state. Errors: BadStructure,
/// UnsupportedFeature.
Result<void> checkFrames(const ProbeResolution& resolution, const ProbeRecord& record, const Frames& frames);

std::vector<std::uint8_t> proximityBytes(const ProbeFieldInfo& info, const ProximityGrid& grid);
/// Errors: BadStructure, BadValue, BadReference, LimitExceeded.
Result<ProximityGrid> readProximity(const ProbeFieldInfo& info, std::span<const std::byte> bytes,
                                    container::MemoryBudget& budget);

/// No cell may name an inactive probe of this file. Errors: BadReference.
Result<void> checkProximityStates(const ProbeFieldInfo& info, const ProximityGrid& grid,
                                  std::span<const StoredProbe> probes);

}  // namespace pfvox::probe

// The proximity grid of a bake that was done in shards: no shard can make it, since it needs all probes.
//
//     scene, shards -> [proximityOfShards] -> mergeProbeFields (pfvox/probe_file.hpp)
//
// Works on the CPU; the result is the one of an unsharded bake, bit for bit.
#pragma once

#include <pfvox/bake.hpp>
#include <pfvox/probe_file.hpp>
#include <span>

namespace pfvox {

/// Whether the shards hold every probe of their grid once.
bool isWholeGrid(std::span<const ProbeFileReader> shards);

/// `shards` in any order; precondition: isWholeGrid(shards). Memory holds the maps of as many probes as there
/// are threads. Errors: BadStructure (the shards were baked from another scene, or have no depth maps), those
/// of ProbeFileReader::readProbe.
Result<ProximityBuild> proximityOfShards(const LoadedScene& scene, std::span<const ProbeFileReader> shards);

}  // namespace pfvox

#include <algorithm>
#include <pfvox/shard_proximity.hpp>

#include "bake/placed_models.hpp"
#include "bake/surface_samples.hpp"

namespace pfvox {

namespace {

using Order = std::vector<const ProbeFileReader*>;

Order sorted(std::span<const ProbeFileReader> shards) {
    Order order;
    for (const ProbeFileReader& shard : shards) order.push_back(&shard);
    std::ranges::sort(order, {}, [](const ProbeFileReader* shard) { return shard->info().range.first; });
    return order;
}

}  // namespace

bool isWholeGrid(std::span<const ProbeFileReader> shards) {
    std::uint64_t next = 0;
    for (const ProbeFileReader* shard : sorted(shards)) {
        if (shard->info().range.first != next) return false;
        next = shard->info().range.end;
    }
    return !shards.empty() && next == shards.front().info().grid.probeCount();
}

Result<ProximityBuild> proximityOfShards(const LoadedScene& scene, std::span<const ProbeFileReader> shards) {
    const Order order = sorted(shards);
    std::vector<ProbeRecord> records;
    for (const ProbeFileReader* shard : order) {
        if (shard->info().sceneHash != sceneContentHash(scene))
            return fail(ErrorCode::BadStructure,
                        "the shards were baked from another scene, or from this one before it changed");
        for (std::uint32_t probe = shard->info().range.first; probe < shard->info().range.end; ++probe)
            records.push_back(shard->record(probe));
    }
    const auto depthNormal = [&](std::uint32_t probe) -> Result<std::vector<std::uint32_t>> {
        const auto shard = std::ranges::find_if(
            order, [&](const ProbeFileReader* candidate) { return candidate->info().range.contains(probe); });
        PFVOX_TRY(ProbeData, data, (*shard)->readProbe(probe));
        return std::move(data.depthNormal);
    };
    const ProbeFieldInfo& info = order.front()->info();
    const ProximityGrid shape =
        bake::proximityShape(info.grid, scene.scene.probes.proximityCells, scene.bounds);
    const CellSurfaces surfaces =
        sortIntoCells(bake::surfaceSamples(bake::placedModels(scene, info.grid.origin), shape), shape);
    return buildProximityGrid(
        {.info = info, .records = records, .depthNormal = depthNormal, .shape = shape, .surfaces = surfaces});
}

}  // namespace pfvox

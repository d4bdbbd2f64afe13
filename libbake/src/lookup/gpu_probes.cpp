#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <pfvox/gpu_probes.hpp>

#include "shared/probes.glsl.h"

namespace pfvox::gpu {

namespace {

constexpr std::uint64_t kAlignment = 16;
constexpr std::uint64_t kBlockBytes = 256u << 20;
constexpr std::array kLayers{ProbeLayer::DepthNormal, ProbeLayer::Light, ProbeLayer::MinDepth,
                             ProbeLayer::Irradiance, ProbeLayer::Moments};

std::uint64_t aligned(std::uint64_t bytes) {
    return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

bool wanted(ProbeLayer layer, const GpuProbeSettings& settings) {
    return !settings.compactOnly || layer == ProbeLayer::Irradiance || layer == ProbeLayer::Moments;
}

std::uint64_t mapBytesPerProbe(const ProbeFileReader& reader, const GpuProbeSettings& settings) {
    std::uint64_t bytes = 0;
    for (const ProbeLayer layer : kLayers) {
        if (wanted(layer, settings)) bytes += aligned(reader.info().resolution.bytesOf(layer));
    }
    return bytes;
}

std::uint32_t activeCount(const ProbeFileReader& reader) {
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < reader.info().grid.probeCount(); ++i)
        count += reader.record(i).isActive() ? 1u : 0u;
    return count;
}

glm::uvec2& addressIn(shared::ProbeEntry& entry, ProbeLayer layer) {
    switch (layer) {
        case ProbeLayer::DepthNormal:
            return entry.depthNormal;
        case ProbeLayer::Light:
            return entry.light;
        case ProbeLayer::MinDepth:
            return entry.minDepth;
        case ProbeLayer::Irradiance:
            return entry.irradiance;
        case ProbeLayer::Moments:
            break;
    }
    return entry.moments;
}

/// For every probe the nearest active one, found by spreading from the active ones over the grid: exact
/// enough for a value that is read only where there is nothing better, and linear in the number of probes.
void setNearestActive(const ProbeGrid& grid, std::vector<shared::ProbeEntry>& entries) {
    std::vector<std::uint32_t> front;
    for (std::uint32_t i = 0; i < entries.size(); ++i) {
        entries[i].nearestActive = entries[i].isActive != 0 ? i : shared::kNoProbeIndex;
        if (entries[i].isActive != 0) front.push_back(i);
    }
    while (!front.empty()) {
        std::vector<std::uint32_t> next;
        for (const std::uint32_t from : front) {
            const glm::ivec3 at{grid.placeOf(from)};
            for (int side = 0; side < 6; ++side) {
                glm::ivec3 neighbor = at;
                neighbor[side / 2] += side % 2 == 0 ? -1 : 1;
                if (glm::any(glm::lessThan(neighbor, glm::ivec3{0})) ||
                    glm::any(glm::greaterThanEqual(neighbor, glm::ivec3{grid.counts})))
                    continue;
                const std::uint32_t index = grid.indexOf(glm::uvec3{neighbor});
                if (entries[index].nearestActive != shared::kNoProbeIndex) continue;
                entries[index].nearestActive = entries[from].nearestActive;
                next.push_back(index);
            }
        }
        front = std::move(next);
    }
}

/// Hands out room for the maps of one probe after the other.
class MapArena {
  public:
    MapArena(Device& device, std::uint64_t bytesPerProbe, std::uint32_t probes) : device_(device) {
        const std::uint64_t room = std::max(std::min(device.maxBufferBytes(), kBlockBytes), bytesPerProbe);
        const std::uint64_t perBlock = bytesPerProbe == 0 ? 0 : room / bytesPerProbe;
        blockBytes_ =
            std::max<std::uint64_t>(std::min<std::uint64_t>(perBlock, probes) * bytesPerProbe, kAlignment);
        bytesPerProbe_ = bytesPerProbe;
    }

    Result<void> beginProbe() {
        if (!blocks.empty() && used_ + bytesPerProbe_ <= blockBytes_) return {};
        PFVOX_TRY(Buffer, block, device_.createBuffer(blockBytes_, "probe maps"));
        blocks.push_back(std::move(block));
        used_ = 0;
        return {};
    }

    /// Reads a map straight into staging memory; returns its device address.
    Result<glm::uvec2> add(const ProbeFileReader& reader, std::uint32_t probe, ProbeLayer layer) {
        const std::uint64_t bytes = reader.info().resolution.bytesOf(layer);
        PFVOX_TRY(const std::span<std::byte>, room, device_.stage(blocks.back(), used_, (bytes + 3) / 4 * 4));
        if (room.size() != bytes) std::memset(room.data() + bytes, 0, room.size() - bytes);
        PFVOX_CHECK(reader.readLayer(probe, layer, room.first(bytes)));
        const glm::uvec2 address = blocks.back().addressWords(used_);
        used_ += aligned(bytes);
        return address;
    }

    std::vector<Buffer> blocks;

  private:
    Device& device_;
    std::uint64_t bytesPerProbe_ = 0;
    std::uint64_t blockBytes_ = 0;
    std::uint64_t used_ = 0;
};

shared::ProbeFieldRecord recordOf(const ProbeFileReader& reader, const GpuProbeSettings& settings) {
    const ProbeFieldInfo& info = reader.info();
    const ProbeResolution& resolution = info.resolution;
    shared::ProbeFieldRecord record{};
    const glm::vec3 moved(info.grid.origin - settings.origin);
    record.start = info.grid.start + moved;
    record.step = info.grid.step;
    record.counts = glm::ivec3{info.grid.counts};
    record.depthResolution = settings.compactOnly ? 0 : resolution.depth;
    record.lightResolution = settings.compactOnly ? 0 : resolution.light;
    record.irradianceResolution = resolution.irradiance;
    record.momentsResolution = resolution.moments;
    record.momentRange = info.grid.momentRange();
    record.voxelMetres = settings.voxelMetres;
    record.farMetres = info.depth.farMetres;
    record.depthScaleAndLogRange = {info.depth.scale,
                                    std::log(info.depth.scale * info.depth.farMetres + 1.0f)};
    if (const auto& proximity = reader.proximity(); proximity && !settings.compactOnly) {
        record.cellStart = proximity->start + moved;
        record.cellStep = proximity->step;
        record.cellCounts = glm::ivec3{proximity->counts};
    }
    return record;
}

Result<std::vector<shared::ProbeEntry>> uploadMaps(MapArena& arena, const ProbeFileReader& reader,
                                                   const GpuProbeSettings& settings) {
    std::vector<shared::ProbeEntry> entries(reader.info().grid.probeCount());
    for (std::uint32_t i = 0; i < entries.size(); ++i) {
        shared::ProbeEntry& entry = entries[i];
        entry.position = glm::vec3(reader.info().grid.worldOf(reader.positionOf(i)) - settings.origin);
        entry.isActive = reader.record(i).isActive() ? 1 : 0;
        if (entry.isActive == 0) continue;
        PFVOX_CHECK(arena.beginProbe());
        for (const ProbeLayer layer : kLayers) {
            if (!wanted(layer, settings) || !reader.has(i, layer)) continue;
            PFVOX_TRY(const glm::uvec2, address, arena.add(reader, i, layer));
            addressIn(entry, layer) = address;
        }
    }
    setNearestActive(reader.info().grid, entries);
    return entries;
}

Error withNeed(Error error, std::uint64_t neededBytes) {
    if (error.code != ErrorCode::GpuOutOfMemory) return error;
    error.message +=
        fmt::format("; the probe field needs {:.1f} MiB of device memory: bake with a smaller profile",
                    static_cast<double>(neededBytes) / (1 << 20));
    return error;
}

}  // namespace

std::string_view toString(ProbeTier tier) {
    switch (tier) {
        case ProbeTier::None:
            return "none";
        case ProbeTier::Texels:
            return "texels";
        case ProbeTier::Traced:
            return "traced";
        case ProbeTier::Compact:
            return "compact";
        case ProbeTier::Faces:
            return "faces";
        case ProbeTier::Nearest:
            return "nearest";
    }
    return "unknown";
}

std::uint64_t GpuProbes::bytesOf(const ProbeFileReader& reader, const GpuProbeSettings& settings) {
    std::uint64_t bytes =
        sizeof(shared::ProbeFieldRecord) + reader.info().grid.probeCount() * sizeof(shared::ProbeEntry);
    bytes += activeCount(reader) * mapBytesPerProbe(reader, settings);
    if (reader.proximity()) bytes += reader.proximity()->probes.size() * sizeof(std::uint32_t);
    return bytes;
}

Result<GpuProbes> GpuProbes::upload(Device& device, const ProbeFileReader& reader,
                                    const GpuProbeSettings& settings) {
    if (!reader.info().isWhole())
        return fail(ErrorCode::BadStructure,
                    "the file is a shard of its grid: join all shards with `probe-bake merge`");
    const std::uint32_t active = activeCount(reader);
    const auto uploadAll = [&]() -> Result<GpuProbes> {
        MapArena arena(device, mapBytesPerProbe(reader, settings), active);
        PFVOX_TRY(const std::vector<shared::ProbeEntry>, entries, uploadMaps(arena, reader, settings));
        shared::ProbeFieldRecord record = recordOf(reader, settings);
        const std::span<const std::uint32_t> cells =
            record.cellCounts.x != 0 ? std::span<const std::uint32_t>(reader.proximity()->probes)
                                     : std::span<const std::uint32_t>();

        const std::uint64_t entriesAt = sizeof record;
        const std::uint64_t cellsAt = entriesAt + entries.size() * sizeof(shared::ProbeEntry);
        const std::uint64_t tableBytes = cellsAt + aligned(cells.size_bytes());
        PFVOX_TRY(Buffer, table, device.createBuffer(tableBytes, "probe table"));
        record.probes = table.addressWords(entriesAt);
        record.cells = table.addressWords(cellsAt);
        PFVOX_CHECK(device.upload(table, 0, gpu::bytesOf(record)));
        PFVOX_CHECK(device.upload(table, entriesAt, std::as_bytes(std::span(entries))));
        if (!cells.empty()) PFVOX_CHECK(device.upload(table, cellsAt, std::as_bytes(cells)));
        PFVOX_CHECK(device.flush());
        GpuProbes probes(std::move(table), std::move(arena.blocks));
        probes.statistics_ = {.probes = static_cast<std::uint32_t>(entries.size()),
                              .active = active,
                              .mapBytes = active * mapBytesPerProbe(reader, settings),
                              .tableBytes = tableBytes};
        return probes;
    };
    auto probes = uploadAll();
    if (!probes) return tl::make_unexpected(withNeed(std::move(probes).error(), bytesOf(reader, settings)));
    return probes;
}

}  // namespace pfvox::gpu

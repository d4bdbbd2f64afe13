#include "pf_probe/records.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "container/section_writer.hpp"
#include "io/byte_cursor.hpp"
#include "io/hash.hpp"
#include "pf_probe/probe_settings.hpp"

namespace pfvox::probe {

namespace {

using container::appendBytes;
using probe_layout::Frame;
using probe_layout::FrameCodec;

/// More probes need 32-bit indices in the proximity grid.
constexpr std::uint64_t kMaxProbesOf16Bits = 65534;

std::array<float, 3> toArray(glm::vec3 v) {
    return {v.x, v.y, v.z};
}
glm::vec3 toVec(const std::array<float, 3>& a) {
    return {a[0], a[1], a[2]};
}
std::array<std::uint32_t, 3> toArray(glm::uvec3 v) {
    return {v.x, v.y, v.z};
}
glm::uvec3 toVec(const std::array<std::uint32_t, 3>& a) {
    return {a[0], a[1], a[2]};
}

std::string toText(std::span<const std::byte> bytes) {
    return std::string(io::asText(bytes));
}

template <class Index>
void appendIndices(std::vector<std::uint8_t>& bytes, std::span<const std::uint32_t> probes) {
    std::vector<Index> indices(probes.size());
    for (std::size_t i = 0; i < probes.size(); ++i) indices[i] = static_cast<Index>(probes[i]);
    appendBytes(bytes, std::span<const Index>(indices));
}

/// Precondition: bytes for all of `probes`.
template <class Index>
void readIndices(std::span<const std::byte> bytes, std::vector<std::uint32_t>& probes) {
    for (std::size_t i = 0; i < probes.size(); ++i) {
        Index index;
        std::memcpy(&index, bytes.data() + i * sizeof index, sizeof index);
        probes[i] = index == static_cast<Index>(~Index{0}) ? kNoProbe : index;
    }
}

}  // namespace

std::uint64_t StoredProbe::storedBytes() const {
    std::uint64_t sum = 0;
    for (const Frame& frame : frames) sum += frame.storedBytes;
    return sum;
}

std::uint64_t hashOf(const ProbeRecord& record, const Frames& frames) {
    probe_layout::Record hashed = toRecord(record);
    hashed.hash = 0;
    std::array<std::byte, sizeof hashed + kProbeLayerCount * sizeof(std::uint64_t)> bytes;
    std::memcpy(bytes.data(), &hashed, sizeof hashed);
    for (std::size_t i = 0; i < frames.size(); ++i)
        std::memcpy(bytes.data() + sizeof hashed + i * sizeof(std::uint64_t), &frames[i].rawHash,
                    sizeof(std::uint64_t));
    return io::xxh3_64(bytes);
}

Result<void> checkRecord(const ProbeRecord& record) {
    const auto bad = [](const char* message) { return fail(ErrorCode::BadValue, message); };
    if (record.state > ProbeState::Relocated) return bad("unknown state");
    if (!std::isfinite(record.offset.x) || !std::isfinite(record.offset.y) || !std::isfinite(record.offset.z))
        return bad("the offset is not a finite number");
    if (record.state != ProbeState::Relocated && record.offset != glm::vec3{0.0f})
        return bad("has an offset and is not relocated");
    if (record.flags != 0) return bad("unknown flags");
    const auto isFraction = [](float v) { return v >= 0 && std::isfinite(v); };
    if (!isFraction(record.error.value_or(0.0f)) || !isFraction(record.noisyTileFraction) ||
        record.noisyTileFraction > 1)
        return bad("error or fraction of noisy tiles are out of range");
    return {};
}

std::vector<std::uint8_t> infoBytes(const ProbeFieldInfo& info) {
    const probe_layout::Info fixed{.gridStart = toArray(info.grid.start),
                                   .gridStep = toArray(info.grid.step),
                                   .gridCounts = toArray(info.grid.counts),
                                   .rangeFirst = info.range.first,
                                   .rangeEnd = info.range.end,
                                   .depthResolution = info.resolution.depth,
                                   .lightResolution = info.resolution.light,
                                   .irradianceResolution = info.resolution.irradiance,
                                   .momentsResolution = info.resolution.moments,
                                   .depthScale = info.depth.scale,
                                   .depthFarMetres = info.depth.farMetres,
                                   .lightContent = info.lightContent,
                                   .seed = info.settings.seed,
                                   .tracedResolution = info.settings.tracedResolution,
                                   .minSamples = info.settings.minSamples,
                                   .maxSamples = info.settings.maxSamples,
                                   .maxBounces = bouncesOfInfo(info.settings),
                                   .noiseTarget = info.settings.noiseTarget,
                                   .reserved = 0,
                                   .sceneHash = info.sceneHash.bytes,
                                   .shaderHash = info.shaderHash.bytes,
                                   .deviceNameBytes = static_cast<std::uint32_t>(info.deviceName.size()),
                                   .toolNameBytes = static_cast<std::uint32_t>(info.toolName.size())};
    std::vector<std::uint8_t> bytes;
    appendBytes(bytes, std::span(&fixed, 1));
    appendBytes(bytes, std::span<const char>(info.deviceName));
    appendBytes(bytes, std::span<const char>(info.toolName));
    return bytes;
}

Result<ProbeFieldInfo> readInfo(std::span<const std::byte> bytes) {
    io::ByteCursor cursor(bytes);
    const auto fixed = cursor.read<probe_layout::Info>();
    if (!fixed) return fail(ErrorCode::BadStructure, "is too short");
    const auto device = cursor.take(fixed->deviceNameBytes);
    const auto tool = device ? cursor.take(fixed->toolNameBytes) : std::nullopt;
    if (!tool || cursor.remaining() != 0)
        return fail(ErrorCode::BadStructure, "the names do not have the announced lengths");
    if (fixed->reserved != 0) return fail(ErrorCode::BadValue, "a reserved field is not 0");
    ProbeFieldInfo info{.grid = {toVec(fixed->gridStart), toVec(fixed->gridStep), toVec(fixed->gridCounts)},
                        .range = {fixed->rangeFirst, fixed->rangeEnd},
                        .resolution = {fixed->depthResolution, fixed->lightResolution,
                                       fixed->irradianceResolution, fixed->momentsResolution},
                        .depth = {fixed->depthScale, fixed->depthFarMetres},
                        .lightContent = fixed->lightContent,
                        .settings = {.seed = fixed->seed,
                                     .tracedResolution = fixed->tracedResolution,
                                     .minSamples = fixed->minSamples,
                                     .maxSamples = fixed->maxSamples,
                                     .maxBounces = bouncesFromInfo(fixed->maxBounces),
                                     .noiseTarget = fixed->noiseTarget,
                                     .noiseFloor = {},
                                     .sampling = {},
                                     .stratified = {},
                                     .relocate = {},
                                     .filter = {}},
                        .sceneHash = {fixed->sceneHash},
                        .shaderHash = {fixed->shaderHash},
                        .deviceName = toText(*device),
                        .toolName = toText(*tool)};
    PFVOX_CHECK(checkProbeInfo(info));
    return info;
}

probe_layout::Record toRecord(const ProbeRecord& record) {
    // -0 and 0 are equal and must hash alike.
    const glm::vec3 offset = record.offset + glm::vec3{0.0f};
    return {.offset = toArray(offset),
            .state = static_cast<std::uint8_t>(record.state),
            .reserved = 0,
            .flags = record.flags,
            .hash = record.hash,
            .error = record.isActive() ? record.error.value_or(probe_layout::kUnknownError) + 0.0f : 0.0f,
            .noisyTileFraction = record.noisyTileFraction + 0.0f};
}

Result<ProbeRecord> fromRecord(const probe_layout::Record& record) {
    ProbeRecord result{.offset = toVec(record.offset),
                       .state = static_cast<ProbeState>(record.state),
                       .flags = record.flags,
                       .error = {},
                       .noisyTileFraction = record.noisyTileFraction,
                       .hash = record.hash};
    if (record.reserved != 0) return fail(ErrorCode::BadValue, "a reserved field is not 0");
    // Checked even where it is not taken: an inactive probe has no error.
    result.error = record.error;
    PFVOX_CHECK(checkRecord(result));
    if (!result.isActive() || record.error == probe_layout::kUnknownError) result.error.reset();
    return result;
}

Result<void> checkFrames(const ProbeResolution& resolution, const ProbeRecord& record, const Frames& frames) {
    for (const ProbeLayer layer : kAllLayers) {
        const Frame& frame = frames[static_cast<std::size_t>(layer)];
        const std::uint64_t rawBytes = record.isActive() ? resolution.bytesOf(layer) : 0;
        if (frame.codec > FrameCodec::Predicted) {
            return fail(ErrorCode::UnsupportedFeature, fmt::format("{}: unknown codec {}", toString(layer),
                                                                   static_cast<std::uint32_t>(frame.codec)));
        }
        const bool isRaw = frame.codec == FrameCodec::Raw;
        if (rawBytes == 0 && (frame.storedBytes != 0 || frame.rawHash != 0 || !isRaw))
            return fail(ErrorCode::BadStructure,
                        fmt::format("{}: an inactive probe has it", toString(layer)));
        if (!isRaw && container::leastFrameBytes(rawBytes) > frame.storedBytes)
            return fail(ErrorCode::BadStructure, fmt::format("{}: no frame is so small", toString(layer)));
        if (isRaw ? frame.storedBytes != rawBytes : frame.storedBytes >= rawBytes) {
            return fail(ErrorCode::BadStructure, fmt::format("{}: {} bytes are stored for {}",
                                                             toString(layer), frame.storedBytes, rawBytes));
        }
    }
    return {};
}

std::vector<std::uint8_t> proximityBytes(const ProbeFieldInfo& info, const ProximityGrid& grid) {
    const bool isNarrow = info.grid.probeCount() <= kMaxProbesOf16Bits;
    const probe_layout::Proximity fixed{.start = toArray(grid.start),
                                        .step = toArray(grid.step),
                                        .counts = toArray(grid.counts),
                                        .indexBits = isNarrow ? 16u : 32u};
    std::vector<std::uint8_t> bytes;
    appendBytes(bytes, std::span(&fixed, 1));
    if (isNarrow) {
        appendIndices<std::uint16_t>(bytes, grid.probes);
    } else {
        appendIndices<std::uint32_t>(bytes, grid.probes);
    }
    return bytes;
}

Result<ProximityGrid> readProximity(const ProbeFieldInfo& info, std::span<const std::byte> bytes,
                                    container::MemoryBudget& budget) {
    io::ByteCursor cursor(bytes);
    const auto fixed = cursor.read<probe_layout::Proximity>();
    if (!fixed) return fail(ErrorCode::BadStructure, "is too short");
    const std::uint32_t expectedBits = info.grid.probeCount() <= kMaxProbesOf16Bits ? 16 : 32;
    if (fixed->indexBits != expectedBits)
        return fail(ErrorCode::BadValue, fmt::format("indices of {} bits", fixed->indexBits));
    const auto indices = cursor.take(cursor.remaining());
    if (indices->size() % (expectedBits / 8) != 0)
        return fail(ErrorCode::BadStructure, "ends inside an index");
    ProximityGrid grid{.start = toVec(fixed->start),
                       .step = toVec(fixed->step),
                       .counts = toVec(fixed->counts),
                       .probes = {}};
    PFVOX_CHECK(budget.resize(grid.probes, indices->size() / (expectedBits / 8)));
    if (expectedBits == 16) {
        readIndices<std::uint16_t>(*indices, grid.probes);
    } else {
        readIndices<std::uint32_t>(*indices, grid.probes);
    }
    PFVOX_CHECK(checkProximityGrid(info, grid));
    return grid;
}

Result<void> checkProximityStates(const ProbeFieldInfo& info, const ProximityGrid& grid,
                                  std::span<const StoredProbe> probes) {
    for (const std::uint32_t index : grid.probes) {
        if (info.range.contains(index) && !probes[index - info.range.first].record.isActive())
            return fail(ErrorCode::BadReference, fmt::format("names probe {}, which is inactive", index));
    }
    return {};
}

}  // namespace pfvox::probe

// The value types of light on faces: names, keys, chunks, and whether they can be written.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <pfvox/face_index.hpp>
#include <pfvox/face_light.hpp>
#include <tuple>

#include "faces/chunk_codec.hpp"
#include "faces/face_code.hpp"
#include "io/hash.hpp"
#include "pf_probe/setting_values.hpp"

namespace pfvox {

namespace {

constexpr std::uint32_t kMaxRegionFaces = 6u << 24;  ///< of 256^3 voxels
constexpr std::uint32_t kMaxFacesPerChunk = 1u << 31;
constexpr std::uint64_t kMaxChunkValues = 0xffffffffu;

tl::unexpected<Error> bad(std::string message) {
    return fail(ErrorCode::BadValue, "light on faces: " + std::move(message));
}

}  // namespace

namespace faces {

Result<void> checkChunkRecord(const FaceChunkRecord& record) {
    const auto isFraction = [](float v) { return v >= 0 && std::isfinite(v); };
    if (!isFraction(record.noise.value_or(0.0f)) || !isFraction(record.cappedFraction) ||
        record.cappedFraction > 1)
        return bad("noise or fraction of values at the most rays are out of range");
    return {};
}

}  // namespace faces

std::string_view toString(FaceCodec codec) {
    return codec == FaceCodec::Quantized ? "quantized" : "lossless";
}

std::uint32_t storedFaceValue(FaceCodec codec, std::uint32_t value) {
    return codec == FaceCodec::Quantized ? faces::dequantize(faces::quantize(value)) : value;
}

std::vector<ProbeSettingDifference> differencesOf(const FaceBakeSettings& first,
                                                  const FaceBakeSettings& second) {
    const auto walk = [](const auto& visit, auto&... settings) { forEachFaceSetting(visit, settings...); };
    return probe::settingDifferences(walk, first, second);
}

bool FaceChunkRecord::operator==(const FaceChunkRecord& other) const {
    const auto content = [](const FaceChunkRecord& r) {
        return std::tie(r.valueCount, r.noise, r.cappedFraction, r.inputHash.bytes, r.hash);
    };
    return content(*this) == content(other);
}

std::uint64_t hashOf(const FaceChunk& chunk) {
    const std::array<std::uint64_t, 2> hashes{io::xxh3_64(std::as_bytes(std::span(chunk.levels))),
                                              io::xxh3_64(std::as_bytes(std::span(chunk.values)))};
    return io::xxh3_64(std::as_bytes(std::span(hashes)));
}

ContentKey keyOf(const FaceIndex& index) {
    io::Xxh3_128 hash;
    const auto add = [&](std::uint32_t word) { hash.update(std::as_bytes(std::span(&word, 1))); };
    add(static_cast<std::uint32_t>(index.regions.size()));
    for (const FaceRegion& region : index.regions) {
        for (int axis = 0; axis < 3; ++axis) add(static_cast<std::uint32_t>(region.originVoxels[axis]));
        add(region.endBrick - region.firstBrick);
        for (std::uint32_t i = region.firstBrick; i < region.endBrick; ++i)
            add(index.bricks[i].path << 6 | index.bricks[i].directions);
    }
    hash.update(std::as_bytes(std::span(index.masks)));
    return {hash.digest()};
}

FaceInstance faceInstanceOf(const FaceIndex& index) {
    FaceInstance instance{.index = keyOf(index), .faceCounts = {}};
    for (const FaceRegion& region : index.regions)
        instance.faceCounts.push_back(region.endFace - region.firstFace);
    return instance;
}

std::vector<FaceChunkPlace> faceChunkPlaces(const FaceLightInfo& info) {
    std::vector<FaceChunkPlace> places;
    std::size_t most = 0;  // so that it takes no more memory than a reader has drawn for it
    for (const FaceInstance& instance : info.instances) most += instance.faceCounts.size();
    places.reserve(most);
    for (std::uint32_t i = 0; i < info.instances.size(); ++i) {
        const auto& counts = info.instances[i].faceCounts;
        for (std::uint32_t r = 0; r < counts.size(); ++r) {
            if (counts[r] == 0) continue;
            if (places.empty() || places.back().faceCount >= info.facesPerChunk)
                places.push_back({.instance = i, .region = r, .faceCount = 0});
            places.back().faceCount += counts[r];
        }
    }
    return places;
}

Result<void> checkFaceLightInfo(const FaceLightInfo& info) {
    if (info.facesPerChunk == 0 || info.facesPerChunk > kMaxFacesPerChunk)
        return bad(fmt::format("chunks of {} faces", info.facesPerChunk));
    if (!(info.settings.noiseTarget >= 0) || !std::isfinite(info.settings.noiseTarget))
        return bad("the noise target is no number from 0 up");
    std::uint64_t regions = 0;
    for (const FaceInstance& instance : info.instances) {
        regions += instance.faceCounts.size();
        for (const std::uint32_t count : instance.faceCounts)
            if (count > kMaxRegionFaces) return bad(fmt::format("a region of {} faces", count));
    }
    if (regions > 0xffffffffu || info.instances.size() > 0xffffffffu) return bad("more than 2^32 regions");
    const std::size_t chunks = faceChunkPlaces(info).size();
    if (info.range.first > info.range.end || info.range.end > chunks)
        return bad(fmt::format("chunks {}:{} of {}", info.range.first, info.range.end, chunks));
    for (const FaceChunkRecord& record : info.chunks) PFVOX_CHECK(faces::checkChunkRecord(record));
    return {};
}

Result<void> checkFaceChunk(std::uint32_t faceCount, const FaceChunk& chunk, const FaceChunkRecord& record) {
    if (chunk.levels.size() != faceCount)
        return fail(ErrorCode::BadStructure,
                    fmt::format("light on faces: {} levels for {} faces", chunk.levels.size(), faceCount));
    std::uint64_t values = 0;
    for (const std::uint8_t level : chunk.levels) {
        if (level > kMaxStoredFaceLevel && level != kNoFaceValue)
            return bad(fmt::format("unknown level {}", level));
        values += faceValuesOf(level);
    }
    if (chunk.values.size() != values || values > kMaxChunkValues) {
        return fail(ErrorCode::BadStructure, fmt::format("light on faces: {} values where the levels need {}",
                                                         chunk.values.size(), values));
    }
    const auto escape = std::ranges::find_if(chunk.values, [](std::uint32_t v) { return v >> 27 == 31; });
    if (escape != chunk.values.end())
        return bad(fmt::format("value {} has exponent 31", escape - chunk.values.begin()));
    return faces::checkChunkRecord(record);
}

}  // namespace pfvox

#include "faces/chunk_codec.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "container/frame.hpp"
#include "faces/level_runs.hpp"
#include "faces/value_planes.hpp"
#include "io/hash.hpp"

namespace pfvox::faces {

namespace {

/// Appends a stream: one zstd frame, or as it is where that is not smaller. Which of the two, its size says.
Result<std::uint32_t> appendStream(std::span<const std::uint8_t> raw, int zstdLevel,
                                   std::vector<std::byte>& stored) {
    const auto bytes = std::as_bytes(raw);
    PFVOX_TRY(const auto, frame,
              container::compressFrame(bytes, zstdLevel, container::Texture::General, bytes.size()));
    const auto kept = frame ? std::as_bytes(std::span(*frame)) : bytes;
    stored.insert(stored.end(), kept.begin(), kept.end());
    return static_cast<std::uint32_t>(kept.size());
}

Result<void> takeStream(std::span<const std::byte> stored, std::span<std::byte> raw) {
    if (stored.size() == raw.size()) {
        std::ranges::copy(stored, raw.begin());
        return {};
    }
    PFVOX_CHECK(container::checkFrame(stored, stored.size(), raw.size()));
    return container::decompressFrame(stored, raw);
}

Result<void> checkSize(std::uint64_t storedBytes, std::uint64_t rawBytes) {
    if (storedBytes <= rawBytes && container::leastFrameBytes(rawBytes) <= storedBytes &&
        (rawBytes == 0 || storedBytes != 0))
        return {};
    return fail(ErrorCode::BadStructure, fmt::format("{} bytes are stored for {}", storedBytes, rawBytes));
}

}  // namespace

Result<PackedChunk> packChunk(FaceCodec codec, const FaceChunk& chunk, const FaceChunkRecord& record,
                              int zstdLevel) {
    PackedChunk packed{.entry = {.record = record, .frames = {}}, .stored = {}};
    const std::vector<std::uint8_t> runs = toRuns(chunk.levels);
    packed.entry.frames.levelBytes = static_cast<std::uint32_t>(runs.size());
    PFVOX_TRY(const std::uint32_t, levelBytes, appendStream(runs, zstdLevel, packed.stored));
    packed.entry.frames.storedBytes[0] = levelBytes;
    const std::vector<std::uint8_t> planes = toPlanes(codec, chunk.values);
    for (std::size_t i = 0; i < planeCount(codec); ++i) {
        const auto plane = std::span(planes).subspan(i * chunk.values.size(), chunk.values.size());
        PFVOX_TRY(const std::uint32_t, bytes, appendStream(plane, zstdLevel, packed.stored));
        packed.entry.frames.storedBytes[i + 1] = bytes;
    }
    FaceChunk read{.levels = chunk.levels, .values = std::vector<std::uint32_t>(chunk.values.size())};
    PFVOX_CHECK(fromPlanes(codec, std::as_bytes(std::span(planes)), read.values));
    packed.entry.record.valueCount = read.values.size();
    packed.entry.record.storedBytes = packed.stored.size();
    packed.entry.record.hash = hashOf(read);
    return packed;
}

Result<void> checkStoredChunk(FaceCodec codec, std::uint32_t faceCount, const StoredChunk& chunk) {
    const FaceFrames& frames = chunk.frames;
    const std::uint64_t values = chunk.record.valueCount;
    if (frames.levelBytes == 0 || frames.levelBytes > faceCount)
        return fail(ErrorCode::BadStructure,
                    fmt::format("{} bytes of levels for {} faces", frames.levelBytes, faceCount));
    if (values > std::uint64_t{faceCount} * faceValuesOf(kMaxStoredFaceLevel))
        return fail(ErrorCode::BadStructure, fmt::format("{} values for {} faces", values, faceCount));
    PFVOX_CHECK(checkSize(frames.storedBytes[0], frames.levelBytes));
    for (std::size_t i = 1; i < frames.storedBytes.size(); ++i)
        PFVOX_CHECK(checkSize(frames.storedBytes[i], i <= planeCount(codec) ? values : 0));
    return {};
}

std::uint64_t chunkBytes(std::uint32_t faceCount, const FaceChunkRecord& record) {
    return faceCount + record.valueCount * sizeof(std::uint32_t);
}

std::uint64_t unpackBytes(FaceCodec codec, const StoredChunk& chunk) {
    return chunk.record.storedBytes + chunk.frames.levelBytes + planeCount(codec) * chunk.record.valueCount;
}

Result<FaceChunk> unpackChunk(FaceCodec codec, std::uint32_t faceCount, const StoredChunk& chunk,
                              std::span<const std::byte> stored, container::MemoryBudget& budget) {
    PFVOX_TRY(const auto, charge, container::Charge::take(budget, 1, chunkBytes(faceCount, chunk.record)));
    const auto take = [&stored](std::uint32_t bytes) {
        const auto part = stored.first(bytes);
        stored = stored.subspan(bytes);
        return part;
    };
    FaceChunk result;
    PFVOX_TRY(auto, runs, container::Array<std::byte>::make(budget, chunk.frames.levelBytes));
    PFVOX_CHECK(takeStream(take(chunk.frames.storedBytes[0]), runs));
    result.levels.resize(faceCount);
    PFVOX_CHECK(fromRuns(runs, result.levels));
    std::uint64_t values = 0;
    for (const std::uint8_t level : result.levels) values += faceValuesOf(level);
    if (values != chunk.record.valueCount)
        return fail(ErrorCode::BadStructure,
                    fmt::format("its levels need {} values and it has {}", values, chunk.record.valueCount));
    PFVOX_TRY(auto, planes, container::Array<std::byte>::make(budget, planeCount(codec) * values));
    for (std::size_t i = 0; i < planeCount(codec); ++i)
        PFVOX_CHECK(
            takeStream(take(chunk.frames.storedBytes[i + 1]), std::span(planes.data() + i * values, values)));
    result.values.resize(values);
    PFVOX_CHECK(fromPlanes(codec, planes, result.values));
    if (hashOf(result) != chunk.record.hash)
        return fail(ErrorCode::ChecksumMismatch, "the light does not have the stored hash: damaged");
    return result;
}

}  // namespace pfvox::faces

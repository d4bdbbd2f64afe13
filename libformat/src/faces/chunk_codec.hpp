// ChunkCodec: the light of one chunk <-> its frames.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/face_light.hpp>
#include <pfvox/probe_file.hpp>
#include <span>
#include <vector>

#include "container/memory_budget.hpp"

namespace pfvox::faces {

/// A chunk as a file knows it: everything but the bytes of its frames.
struct StoredChunk {
    FaceChunkRecord record;
    FaceFrames frames;  ///< without their place
};

struct PackedChunk {
    StoredChunk entry;
    std::vector<std::byte> stored;
};
/// Precondition: checkFaceChunk(). Errors: Internal when zstd fails.
Result<PackedChunk> packChunk(FaceCodec codec, const FaceChunk& chunk, const FaceChunkRecord& record,
                              int zstdLevel);

/// Domains of what is known about a chunk. Errors: BadValue.
Result<void> checkChunkRecord(const FaceChunkRecord& record);

/// Whether sizes are possible for a chunk of so many faces, before anything is allocated for them. Errors:
/// BadStructure, BadValue.
Result<void> checkStoredChunk(FaceCodec codec, std::uint32_t faceCount, const StoredChunk& chunk);

/// Bytes of the chunk in memory, and those that unpacking it needs beside them.
std::uint64_t chunkBytes(std::uint32_t faceCount, const FaceChunkRecord& record);
std::uint64_t unpackBytes(FaceCodec codec, const StoredChunk& chunk);

/// Precondition: checkStoredChunk(); `stored` has its bytes. Errors: BadStructure, BadValue,
/// ChecksumMismatch, LimitExceeded.
Result<FaceChunk> unpackChunk(FaceCodec codec, std::uint32_t faceCount, const StoredChunk& chunk,
                              std::span<const std::byte> stored, container::MemoryBudget& budget);

}  // namespace pfvox::faces

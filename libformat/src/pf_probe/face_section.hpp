// Section FACE: everything about light on faces but the light.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/face_light.hpp>
#include <span>
#include <vector>

#include "container/memory_budget.hpp"
#include "faces/chunk_codec.hpp"
#include "pf_probe/layout.hpp"

namespace pfvox::probe {

/// What a file has of light on faces, without its frames.
struct FaceHead {
    FaceLightInfo info;
    std::vector<FaceChunkPlace> places;      ///< of all chunks of the scene
    std::vector<faces::StoredChunk> chunks;  ///< of info.range, without their places in the file
};

probe_layout::FaceChunk toFaceChunk(const faces::StoredChunk& chunk);
/// Errors: BadStructure, BadValue.
Result<faces::StoredChunk> fromFaceChunk(FaceCodec codec, std::uint32_t faceCount,
                                         const probe_layout::FaceChunk& chunk);

/// In memory.
std::uint64_t bytesOf(const FaceLightInfo& info);

/// All of it, or what stands before the chunks: equal for bakes whose chunks fit together.
std::vector<std::uint8_t> faceSectionBytes(const FaceLightInfo& info,
                                           std::span<const faces::StoredChunk> chunks);

/// Errors: BadStructure, BadValue, LimitExceeded.
Result<FaceHead> readFaceSection(std::span<const std::byte> bytes, container::MemoryBudget& budget);

}  // namespace pfvox::probe

// Limits: what pfvox is willing to read and build. Nothing taken from a file reaches an allocator before it
// was checked against the bytes that are really there and against these figures.
#pragma once

#include <cstdint>

namespace pfvox {

/// Every figure can be raised by the user (`--limit name=value`); the message of ErrorCode::LimitExceeded
/// names the figure that was hit.
struct Limits {
    std::uint64_t maxFileBytes = 16ull << 30;  ///< size of one source or asset file
    /// All that reading an asset or probe file allocates beside the file itself, and the voxel model built
    /// from a source.
    std::uint64_t maxMemoryBytes = 16ull << 30;
    std::uint32_t maxModels = 1u << 20;     ///< models in one file
    std::uint32_t maxInstances = 1u << 22;  ///< instances after the scene graph is expanded
    std::uint32_t maxGraphDepth = 256;      ///< nesting of a scene graph
    std::uint32_t maxMaterials = 65535;     ///< materials in one file
    std::uint32_t maxRegions = 1u << 20;    ///< 256^3 regions in one model
    std::uint32_t maxModelDepth = 23;       ///< octree levels of one model: edge 2^23 voxels
};

}  // namespace pfvox

// Octree: the sparse voxel octree of Laine and Karras ("Efficient Sparse Voxel Octrees", 2010) with 32-bit
// child descriptors, as it lies in memory and on the GPU.
//
//     VoxelAsset -> [buildOctrees] -> OctreeAsset -> PF_VOX encoder
//     PF_VOX decoder -> [OctreeAsset] -> GPU scene, reference ray caster, export
//
// Child descriptor (one u32):
//     bits  0-7   leaf mask    child slot k is a leaf (a subset of valid)
//     bits  8-15  valid mask   child slot k exists
//     bit   16    far          the pointer is an index into the far table
//     bits 17-31  pointer      first inner child, in nodes, relative to this node, always forward; the others
//     follow
//                              in slot order; leaf children have no node
// Slot k = x + 2y + 4z, each bit 1 for the upper half of its axis.
//
// Attribute lookup (one u32 beside every node):
//     bits  0-7   mask     child slots that carry a value
//     bits  8-31  pointer  index of the node's first value
// A value is a palette index. It belongs to a leaf of any size, or to an inner child whose whole subtree has
// one material ("hoisted"): the nodes below it carry none.
//
// Nodes are in depth-first order of sibling blocks: the block of a node's inner children, then each child's
// subtree.
#pragma once

#include <cstdint>
#include <optional>
#include <pfvox/asset.hpp>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <pfvox/pooled_vector.hpp>
#include <pfvox/voxel_model.hpp>
#include <span>
#include <string>
#include <vector>

namespace pfvox {

namespace node {
inline constexpr std::uint32_t kFarBit = 1u << 16;  ///< set: the pointer is an index into the far table
inline constexpr std::uint32_t kPointerShift = 17;  ///< position of the pointer
inline constexpr std::uint32_t kMaxNearPointer =
    (1u << 15) - 1;  ///< nodes; what is further needs the far table
/// Child slots that are leaves.
constexpr std::uint32_t leafMask(std::uint32_t descriptor) {
    return descriptor & 0xffu;
}
constexpr std::uint32_t validMask(std::uint32_t descriptor) {
    return (descriptor >> 8) & 0xffu;
}  ///< Child slots that exist.
constexpr std::uint32_t innerMask(std::uint32_t descriptor) {
    return validMask(descriptor) & ~leafMask(descriptor);
}  ///< Child slots that are nodes.
constexpr bool isFar(std::uint32_t descriptor) {
    return (descriptor & kFarBit) != 0;
}  ///< Whether the pointer is an index into the far table.
constexpr std::uint32_t pointer(std::uint32_t descriptor) {
    return descriptor >> kPointerShift;
}  ///< First inner child, relative, in nodes; or the index into the far table.
}  // namespace node

/// A tree of child descriptors. Node 0 is the root, a cube of edge 2^depth.
struct NodeTree {
    std::uint32_t depth = 0;  ///< levels below the root; a leaf at level depth has edge 1
    PooledVector<std::uint32_t>
        nodes;  ///< child descriptors; none only in the top tree of a one-region model
    PooledVector<std::uint32_t> farTable;  ///< distances in nodes, for descriptors with the far bit

    /// Index of the first inner child of node `index`. Precondition: the node has one.
    std::uint32_t firstChild(std::uint32_t index) const {
        const std::uint32_t d = nodes[index];
        return index + (node::isFar(d) ? farTable[node::pointer(d)] : node::pointer(d));
    }
};

/// What stands for a whole node when it covers less than a pixel: one entry for each node, the root included,
/// in node order. Only what can be seen counts: faces of voxels that no opaque neighbor in the same model
/// covers.
struct NodeLod {
    /// R, G, B (sRGB encoded) and coverage, R in the low byte. The color is the mean of the linear base
    /// colors, weighted by the area of their visible faces; 0 where nothing is visible. Coverage x 255,
    /// rounded up: the fraction of the node's columns of voxels that are not empty, mean of the three axes.
    std::vector<std::uint32_t> colors;
    /// Palette index of the material with the largest visible area, of equals the first; 0 where nothing is
    /// visible.
    std::vector<std::uint16_t> materials;

    bool empty() const { return colors.empty(); }
    bool operator==(const NodeLod&) const = default;
};

/// At most 256^3 voxels of a model: its own tree, values and palette.
struct OctreeRegion {
    glm::ivec3 originVoxels{0};  ///< lower corner in model voxels
    NodeTree tree;
    PooledVector<std::uint32_t> lookup;  ///< one word for each node
    PooledVector<std::uint8_t> values;   ///< palette indices of valueBytes() each, little endian
    std::vector<MaterialIndex> palette;  ///< palette index -> material of the asset, ascending
    NodeLod lod;                         ///< empty unless asked for
    std::uint64_t voxelCount = 0;        ///< solid ones
    VoxelBox bounds;                     ///< tight, in model voxels

    /// Has the arrays take their memory from a pool. Precondition: they are empty.
    void usePool(const std::shared_ptr<MemoryPool>& pool);

    std::size_t valueBytes() const { return palette.size() <= 256 ? 1 : 2; }
    std::size_t valueCount() const { return values.size() / valueBytes(); }
    std::uint32_t value(std::size_t index) const {
        return valueBytes() == 1
                   ? values[index]
                   : static_cast<std::uint32_t>(values[2 * index] | (values[2 * index + 1] << 8));
    }
};

/// One model: a top tree whose leaves are regions, in node order then slot order. A model of at most 256^3
/// has an empty top tree and one region. An empty model has no region.
struct OctreeModel {
    Name name;                                  ///< of the source
    std::uint32_t depth = 0;                    ///< levels in all; the octree cube has edge 2^depth
    glm::ivec3 originVoxels{0};                 ///< lower corner of the octree cube in model voxels
    NodeTree topTree;                           ///< depth = max(0, OctreeModel::depth - 8)
    std::vector<std::uint32_t> topFirstRegion;  ///< for each top node, the region of its first leaf slot
    std::vector<OctreeRegion> regions;          ///< in Morton order of their places
    std::uint64_t voxelCount = 0;               ///< solid ones
    VoxelBox bounds;                            ///< of its solid voxels

    /// Makes topFirstRegion from topTree.
    void indexRegions();

    /// The material at a voxel by descending from the root: the oracle of all other ways to read an octree.
    std::optional<MaterialIndex> at(glm::ivec3 voxel) const;
};

/// What the builder and the PF_VOX decoder return.
struct OctreeAsset : AssetInfo {
    std::vector<OctreeModel> models;  ///< what instances refer to by index
};
/// How trees are built.
struct BuildSettings {
    bool lod = false;  ///< make OctreeRegion::lod
};

/// Builds the octrees of every model, exactly minimised: eight full children of one material become one leaf,
/// recursively; no voxel changes its material. Materials, instances and the rest are taken over.
/// Regions are built in parallel in the calling TBB arena; the result does not depend on the number of
/// threads. Errors: LimitExceeded (depth, regions, materials), BadReference (a voxel's material does not
/// exist).
Result<OctreeAsset> buildOctrees(const VoxelAsset& asset, const Limits& limits,
                                 const BuildSettings& settings = {});

/// A model as a list of voxels: what generators and simulations have.
struct VoxelList {
    std::span<const PackedVoxel> voxels;  ///< in any order; of several in one place the last one wins
    glm::ivec3 origin{0};                 ///< the model voxel that (0, 0, 0) of the list is
    std::string name = {};
};

/// Builds one octree straight from a list. The result is that of VoxelModel::insert() and buildOctrees(), but
/// bricks exist for a few regions at a time only, which takes less time and a fraction of the memory. Errors
/// as there.
Result<OctreeModel> buildOctree(const VoxelList& list, std::size_t materialCount, const Limits& limits);

/// Every voxel of the octree back in a sparse grid; leaves larger than a voxel become tiles.
VoxelModel toVoxelModel(const OctreeModel& model);
/// Counts over all trees of an asset.
struct OctreeStatistics {
    std::uint64_t voxels = 0;       ///< solid ones, each model once
    std::uint64_t nodes = 0;        ///< child descriptors, top tree included
    std::uint64_t leaves = 0;       ///< of any size
    std::uint64_t values = 0;       ///< of all attribute lookups
    std::uint64_t farPointers = 0;  ///< entries of all far tables
    std::uint64_t gpuBytes =
        0;  ///< nodes + lookup + far table (4 B each) + values (1 B, 2 B past 256 palette entries)
    std::vector<std::uint64_t> voxelsOfMaterial;  ///< by material index of the asset
};
OctreeStatistics statistics(const OctreeModel& model, std::size_t materialCount);

}  // namespace pfvox

// VoxelModel: the sparse voxel grid between importers and the octree builder (the IR).
//
//     source file -> importer -> [VoxelAsset] -> octree builder -> ...
//
// A model is a sparse set of regions of 256^3 voxels. A region is either one material throughout, or a table
// of 32^3 cells of 8^3 voxels, each empty, uniform, or a brick with its own occupancy mask. This maps one to
// one onto OpenVDB's leaf nodes and tiles; other importers scatter voxels into it. Bits and materials of a
// brick are in Morton order, so that the bytes of its mask are the child masks of the octree's lowest nodes.
//
// A VoxelModel is changed by one thread at a time; several threads may read it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <pfvox/asset.hpp>
#include <pfvox/math.hpp>
#include <span>
#include <unordered_map>
#include <vector>

namespace pfvox {

/// Index into AssetInfo::materials.
using MaterialIndex = std::uint16_t;

inline constexpr int kBrickEdgeLog2 = 3;
inline constexpr int kBrickEdge = 1 << kBrickEdgeLog2;
inline constexpr int kBrickVoxels = kBrickEdge * kBrickEdge * kBrickEdge;
inline constexpr int kRegionEdgeLog2 = 8;
inline constexpr int kRegionEdge = 1 << kRegionEdgeLog2;
inline constexpr int kRegionCells = 1 << (3 * (kRegionEdgeLog2 - kBrickEdgeLog2));

/// 8^3 voxels. Bit m of the mask and material m belong to the voxel whose local coordinates interleave to
/// Morton code m. Materials of empty voxels are unspecified.
struct Brick {
    std::array<std::uint64_t, 8> occupancy;             ///< one bit a voxel, by Morton code
    std::array<MaterialIndex, kBrickVoxels> materials;  ///< of solid voxels, by Morton code
    /// Whether the voxel is solid.
    bool occupied(std::uint32_t morton) const { return (occupancy[morton >> 6] >> (morton & 63u)) & 1u; }
    void set(std::uint32_t morton, MaterialIndex material) {
        occupancy[morton >> 6] |= std::uint64_t{1} << (morton & 63u);
        materials[morton] = material;
    }
    void clear(std::uint32_t morton) { occupancy[morton >> 6] &= ~(std::uint64_t{1} << (morton & 63u)); }
};

/// A voxel of a list: 8 bytes. Where the list begins is told beside it.
struct PackedVoxel {
    std::uint16_t x, y, z;  ///< within its region
    MaterialIndex material;
};  ///< from where the list begins

/// A voxel in a region. Address: the Morton code of its coordinates in the region; bits 9 to 23 are the code
/// of the cell, bits 0 to 8 that in the brick.
struct RegionVoxel {
    std::uint32_t address;  ///< Morton code within its region
    MaterialIndex material;
};

/// 256^3 voxels: see the head of this file.
class VoxelRegion {
  public:
    /// `coord`: position in the model, in regions: the region begins at voxel 256 * coord.
    explicit VoxelRegion(glm::ivec3 coord) : coord_(coord) {}

    glm::ivec3 coord() const { return coord_; }  ///< of the region, in regions

    /// The material of the whole region, if it is one solid cube.
    std::optional<MaterialIndex> uniform() const { return uniform_; }

    /// What the 8^3 cell with this Morton code (of its position in the 32^3 table) holds.
    struct Cell {
        const Brick* brick = nullptr;           ///< not null: voxels of their own
        std::optional<MaterialIndex> material;  ///< set: one solid cube
        bool empty() const { return brick == nullptr && !material; }
    };
    Cell cell(std::uint32_t cellMorton) const {
        if (uniform_) return {.brick = nullptr, .material = uniform_};
        if (cellMorton >= table_.size()) return {};
        const std::uint32_t entry = table_[cellMorton];
        if (entry == kEmpty) return {};
        if ((entry & kUniformFlag) != 0)
            return {.brick = nullptr, .material = static_cast<MaterialIndex>(entry & 0xffffu)};
        return {.brick = &brick(entry), .material = std::nullopt};
    }

    /// Bit i = whether cell 64 * block + i holds something of its own (4^3 cells are a block; a brick that
    /// was cleared to nothing counts). Most cells of most regions are empty, so walks that ask for each of
    /// them spend their time on nothing. Not for uniform regions.
    std::uint64_t usedCells(std::uint32_t block) const { return block < used_.size() ? used_[block] : 0; }

    /// Cells with this Morton code and above hold nothing of their own: walks may stop here. Morton order
    /// puts a small model in the low corner into the first few codes. kRegionCells for a uniform region.
    std::uint32_t cellEnd() const {
        return uniform_ ? static_cast<std::uint32_t>(kRegionCells)
                        : static_cast<std::uint32_t>(table_.size());
    }

    /// The brick at this cell for writing; an empty or uniform cell becomes a brick first.
    Brick& brickAt(std::uint32_t cellMorton);
    /// Makes the cell one solid cube, replacing what it held.
    void fillCell(std::uint32_t cellMorton, MaterialIndex material);
    /// Makes the whole region one solid cube, replacing what it held.
    void fill(MaterialIndex material);
    /// Inserts or replaces voxels in the order given.
    void insert(std::span<const RegionVoxel> voxels);
    /// Empties the region and moves it elsewhere; memory is kept for what comes next.
    void reset(glm::ivec3 coord);

    std::size_t brickCount() const { return brickCount_; }
    std::uint64_t memoryBytes() const;

  private:
    static constexpr std::uint32_t kEmpty = 0xffffffffu;
    static constexpr std::uint32_t kUniformFlag = 0x80000000u;
    static constexpr std::size_t kChunkBricks = 32;

    Brick& brick(std::uint32_t index) { return chunks_[index / kChunkBricks][index % kChunkBricks]; }
    const Brick& brick(std::uint32_t index) const {
        return chunks_[index / kChunkBricks][index % kChunkBricks];
    }
    std::uint32_t& entryAt(std::uint32_t cellMorton);

    glm::ivec3 coord_;
    std::optional<MaterialIndex> uniform_;
    std::vector<std::uint32_t>
        table_;                        ///< by cell Morton code; a power of eight long, cells behind are empty
    std::vector<std::uint64_t> used_;  ///< a bit for each entry of table_ that is not empty
    std::vector<std::unique_ptr<Brick[]>> chunks_;
    std::size_t brickCount_ = 0;
};

/// A sparse grid of voxels with materials. Coordinates may be any int32, negative too.
class VoxelModel {
  public:
    Name name;  ///< of the source

    /// Inserts or replaces one voxel.
    void set(glm::ivec3 voxel, MaterialIndex material);
    /// Inserts or replaces many voxels, given relative to `origin`, in any order; of several in one place the
    /// last one wins. Regions are filled in parallel in the calling TBB arena: much faster than set() for
    /// long lists.
    void insert(std::span<const PackedVoxel> voxels, glm::ivec3 origin = glm::ivec3{0});
    /// Empties one voxel; returns whether it was occupied.
    bool clear(glm::ivec3 voxel);
    /// The voxel's material, or nothing where it is empty.
    std::optional<MaterialIndex> at(glm::ivec3 voxel) const;
    /// Fills the aligned cube [corner, corner + 2^edgeLog2)^3 without expanding it into voxels. `edgeLog2` is
    /// 3 to 15, `corner` a multiple of the edge. This is how OpenVDB tiles come in.
    void fillTile(glm::ivec3 corner, int edgeLog2, MaterialIndex material);

    /// The region that holds this region coordinate, made when absent.
    VoxelRegion& regionAt(glm::ivec3 regionCoord);
    /// Every region, in the order of its creation; the builder sorts.
    const std::vector<std::unique_ptr<VoxelRegion>>& regions() const { return regions_; }

    /// Number of occupied voxels and their tight box: a walk over all bricks.
    std::uint64_t voxelCount() const;
    VoxelBox bounds() const;  ///< of solid voxels
    std::uint64_t memoryBytes() const;

  private:
    struct CoordHash {
        std::size_t operator()(glm::ivec3 c) const noexcept;
    };
    VoxelRegion* findRegion(glm::ivec3 regionCoord) const;

    std::vector<std::unique_ptr<VoxelRegion>> regions_;
    std::unordered_map<glm::ivec3, std::size_t, CoordHash> indexOf_;
    VoxelRegion* last_ = nullptr;  ///< the region used last: importers write in runs
};

/// What an importer returns: the content of one source file.
struct VoxelAsset : AssetInfo {
    std::vector<VoxelModel> models;  ///< what instances refer to by index
};

/// Drops materials that no voxel uses and makes equal ones one, in the order of their first index. Voxels,
/// bricks and tiles are renumbered. Afterwards materials are compared as a file keeps them (see quantised()).
void compactMaterials(VoxelAsset& asset);

}  // namespace pfvox

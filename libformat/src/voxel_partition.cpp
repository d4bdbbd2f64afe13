#include "voxel_partition.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>

namespace pfvox {

namespace {

constexpr std::size_t kSmallestList = 4096;
constexpr std::size_t kVoxelsPerSlice = std::size_t{1} << 17;
constexpr std::size_t kMaxGridRegions = std::size_t{1} << 16;

constexpr std::array<std::uint32_t, kRegionEdge> kSpread = [] {
    std::array<std::uint32_t, kRegionEdge> spread{};
    for (std::uint32_t i = 0; i < kRegionEdge; ++i) spread[i] = mortonEncode({i, 0, 0});
    return spread;
}();

/// The regions that a list can touch: a grid of them, numbered x fastest.
struct RegionGrid {
    glm::ivec3 firstRegion{0};
    glm::uvec3 offset{0};  ///< of the list's origin in the first region, in voxels
    glm::uvec3 size{0};    ///< in regions

    std::size_t count() const { return std::size_t{size.x} * size.y * size.z; }
    glm::uvec3 local(const PackedVoxel& v) const { return {v.x + offset.x, v.y + offset.y, v.z + offset.z}; }
    std::uint32_t regionOf(glm::uvec3 p) const {
        return (p.x >> kRegionEdgeLog2) +
               size.x * ((p.y >> kRegionEdgeLog2) + size.y * (p.z >> kRegionEdgeLog2));
    }
    glm::ivec3 coordOf(std::size_t region) const {
        const auto r = static_cast<std::uint32_t>(region);
        return firstRegion + glm::ivec3{glm::uvec3{r % size.x, r / size.x % size.y, r / size.x / size.y}};
    }
};

std::uint32_t addressOf(glm::uvec3 p) {
    return kSpread[p.x % kRegionEdge] | (kSpread[p.y % kRegionEdge] << 1) | (kSpread[p.z % kRegionEdge] << 2);
}

/// The list in equal slices, each worked on by one task.
class Slices {
  public:
    explicit Slices(std::span<const PackedVoxel> voxels)
        : voxels_(voxels), count_((voxels.size() + kVoxelsPerSlice - 1) / kVoxelsPerSlice) {}

    std::size_t count() const { return count_; }

    template <class Work>
    void forEach(const Work& work) const {
        tbb::parallel_for(std::size_t{0}, count_, [&](std::size_t i) {
            const std::size_t first = i * kVoxelsPerSlice;
            work(i, voxels_.subspan(first, std::min(kVoxelsPerSlice, voxels_.size() - first)));
        });
    }

  private:
    std::span<const PackedVoxel> voxels_;
    std::size_t count_;
};

/// For each axis a number that no coordinate exceeds, of the form 2^n - 1: the bits that occur.
glm::uvec3 occurringBits(const Slices& slices) {
    std::vector<glm::uvec3> bits(slices.count(), glm::uvec3{0});
    slices.forEach([&](std::size_t i, std::span<const PackedVoxel> voxels) {
        glm::uvec3 all{0};
        for (const PackedVoxel& v : voxels) all |= glm::uvec3{v.x, v.y, v.z};
        bits[i] = all;
    });
    glm::uvec3 all{0};
    for (const glm::uvec3& b : bits) all |= b;
    for (int axis = 0; axis < 3; ++axis) all[axis] = (1u << std::bit_width(all[axis])) - 1;
    return all;
}

RegionGrid gridAround(const Slices& slices, glm::ivec3 origin) {
    RegionGrid grid;
    const glm::uvec3 highest = occurringBits(slices);
    for (int axis = 0; axis < 3; ++axis) {
        grid.firstRegion[axis] = origin[axis] >> kRegionEdgeLog2;
        grid.offset[axis] = static_cast<std::uint32_t>(origin[axis]) % kRegionEdge;
        grid.size[axis] = ((highest[axis] + grid.offset[axis]) >> kRegionEdgeLog2) + 1;
    }
    return grid;
}

/// How many voxels each slice has in each region: counts[slice * regions + region].
std::vector<std::uint32_t> countVoxels(const Slices& slices, const RegionGrid& grid) {
    std::vector<std::uint32_t> counts(slices.count() * grid.count(), 0);
    slices.forEach([&](std::size_t i, std::span<const PackedVoxel> voxels) {
        std::uint32_t* mine = &counts[i * grid.count()];
        for (const PackedVoxel& v : voxels) ++mine[grid.regionOf(grid.local(v))];
    });
    return counts;
}

}  // namespace

std::optional<VoxelPartition> VoxelPartition::make(std::span<const PackedVoxel> voxels, glm::ivec3 origin) {
    if (voxels.size() < kSmallestList) return std::nullopt;
    const Slices slices(voxels);
    const RegionGrid grid = gridAround(slices, origin);
    if (grid.count() > kMaxGridRegions || grid.count() * slices.count() > voxels.size()) return std::nullopt;

    // Counts become positions: region by region, and in a region slice by slice, which keeps the order of the
    // list.
    std::vector<std::uint32_t> counts = countVoxels(slices, grid);
    std::vector<std::size_t> positions(counts.size());
    VoxelPartition partition;
    partition.voxels_ = std::make_unique_for_overwrite<RegionVoxel[]>(voxels.size());
    std::size_t position = 0;
    for (std::size_t region = 0; region < grid.count(); ++region) {
        const std::size_t first = position;
        for (std::size_t i = region; i < counts.size(); i += grid.count()) {
            positions[i] = position;
            position += counts[i];
        }
        if (position == first) continue;
        partition.parts_.push_back({grid.coordOf(region), {&partition.voxels_[first], position - first}});
    }

    slices.forEach([&](std::size_t i, std::span<const PackedVoxel> slice) {
        std::size_t* next = &positions[i * grid.count()];
        for (const PackedVoxel& v : slice) {
            const glm::uvec3 p = grid.local(v);
            partition.voxels_[next[grid.regionOf(p)]++] = {addressOf(p), v.material};
        }
    });
    return partition;
}

}  // namespace pfvox

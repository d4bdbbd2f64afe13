#include "voxel_partition.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace pfvox {

namespace {

/// A slice and its sorted copy are 512 KiB together: they stay in a core's cache.
constexpr std::size_t kVoxelsPerSlice = std::size_t{1} << 15;

constexpr std::array<std::uint32_t, kRegionEdge> kSpread = [] {
    std::array<std::uint32_t, kRegionEdge> spread{};
    for (std::uint32_t i = 0; i < kRegionEdge; ++i) spread[i] = mortonEncode({i, 0, 0});
    return spread;
}();

std::uint32_t addressOf(glm::uvec3 p) {
    return kSpread[p.x % kRegionEdge] | (kSpread[p.y % kRegionEdge] << 1) | (kSpread[p.z % kRegionEdge] << 2);
}

/// The regions that a slice touches: a small grid, numbered x fastest.
struct RegionGrid {
    glm::ivec3 origin{0};  ///< first region
    glm::uvec3 offset{0};  ///< what takes a coordinate of the list to one from the first region's corner
    glm::uvec3 size{0};    ///< in regions

    std::size_t count() const { return std::size_t{size.x} * size.y * size.z; }
    glm::uvec3 local(const PackedVoxel& v) const {
        return glm::uvec3{v.x, v.y, v.z} + offset;  // modulo 2^32, so that the offset may be negative
    }
    std::uint32_t regionOf(glm::uvec3 p) const {
        return (p.x >> kRegionEdgeLog2) +
               size.x * ((p.y >> kRegionEdgeLog2) + size.y * (p.z >> kRegionEdgeLog2));
    }
    glm::ivec3 coordOf(std::size_t region) const {
        const auto r = static_cast<std::uint32_t>(region);
        return origin + glm::ivec3{glm::uvec3{r % size.x, r / size.x % size.y, r / size.x / size.y}};
    }
};

RegionGrid gridAround(std::span<const PackedVoxel> voxels, glm::ivec3 origin) {
    glm::ivec3 low{std::numeric_limits<int>::max()};
    glm::ivec3 high{0};
    for (const PackedVoxel& v : voxels) {
        const glm::ivec3 p{v.x, v.y, v.z};
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    RegionGrid grid;
    grid.origin = (origin + low) >> kRegionEdgeLog2;
    grid.size = glm::uvec3{((origin + high) >> kRegionEdgeLog2) - grid.origin} + 1u;
    grid.offset = glm::uvec3{origin - grid.origin * kRegionEdge};
    return grid;
}

/// Sorts slices of the list; one for each thread.
class SliceSorter {
  public:
    using Piece = VoxelPartition::Piece;

    /// Writes the sorted slice to `out` and appends its pieces.
    void sort(std::span<const PackedVoxel> slice, glm::ivec3 origin, RegionVoxel* out,
              std::vector<Piece>& pieces) {
        const RegionGrid grid = gridAround(slice, origin);
        // Counting the regions of a widely spread slice would take longer than sorting its halves.
        if (grid.count() > kVoxelsPerSlice && slice.size() > 1) {
            const std::size_t half = slice.size() / 2;
            sort(slice.first(half), origin, out, pieces);
            sort(slice.subspan(half), origin, out + half, pieces);
            return;
        }
        // Neighbors in a list mostly go to the same region, and a counter that was just written is slow to
        // read again: so both halves of the slice are worked on in turns, with counters of their own.
        const std::size_t count = slice.size();
        std::uint16_t* const regions = regions_.data();
        for (std::size_t i = 0; i < count; ++i)
            regions[i] = static_cast<std::uint16_t>(grid.regionOf(grid.local(slice[i])));
        next_.assign(2 * grid.count(), 0);
        std::uint32_t* const next = next_.data();
        inTurns(count, [&](std::size_t i, std::size_t lane) { ++next[2 * std::size_t{regions[i]} + lane]; });
        std::uint32_t position = 0;
        for (std::size_t region = 0; region < grid.count(); ++region) {
            const std::uint32_t first = position;
            for (std::size_t lane = 0; lane < 2; ++lane)
                position += std::exchange(next[2 * region + lane], position);
            if (position != first) pieces.push_back({grid.coordOf(region), {out + first, position - first}});
        }
        inTurns(count, [&](std::size_t i, std::size_t lane) {
            const PackedVoxel v = slice[i];
            out[next[2 * std::size_t{regions[i]} + lane]++] = {addressOf(grid.local(v)), v.material};
        });
    }

  private:
    /// Calls visit(place, lane) for every place in the slice, for both of its halves in turns.
    template <class Visit>
    static void inTurns(std::size_t count, const Visit& visit) {
        const std::size_t half = count / 2;
        for (std::size_t i = 0; i < half; ++i) {
            visit(i, 0);
            visit(half + i, 1);
        }
        if (count % 2 != 0) visit(count - 1, 1);
    }

    std::vector<std::uint16_t> regions_ = std::vector<std::uint16_t>(kVoxelsPerSlice);  ///< of each voxel
    std::vector<std::uint32_t> next_;
};

}  // namespace

VoxelPartition::VoxelPartition(std::span<const PackedVoxel> voxels, glm::ivec3 origin)
    : voxels_(voxels.size()) {
    const std::size_t sliceCount = (voxels.size() + kVoxelsPerSlice - 1) / kVoxelsPerSlice;
    std::vector<std::vector<Piece>> piecesOfSlice(sliceCount);
    tbb::enumerable_thread_specific<SliceSorter> sorters;
    tbb::parallel_for(std::size_t{0}, sliceCount, [&](std::size_t i) {
        const std::size_t first = i * kVoxelsPerSlice;
        const auto slice = voxels.subspan(first, std::min(kVoxelsPerSlice, voxels.size() - first));
        sorters.local().sort(slice, origin, voxels_.data() + first, piecesOfSlice[i]);
    });

    for (const auto& pieces : piecesOfSlice) pieces_.insert(pieces_.end(), pieces.begin(), pieces.end());
    const auto key = [](const Piece& p) {
        return std::tuple(p.regionCoord.z, p.regionCoord.y, p.regionCoord.x);
    };
    std::ranges::stable_sort(pieces_, {}, key);
    for (std::size_t first = 0; first < pieces_.size();) {
        std::size_t end = first;
        while (end < pieces_.size() && pieces_[end].regionCoord == pieces_[first].regionCoord) ++end;
        parts_.emplace_back(&pieces_[first], end - first);
        first = end;
    }
}

}  // namespace pfvox

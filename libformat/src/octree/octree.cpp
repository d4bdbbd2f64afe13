#include <bit>
#include <pfvox/octree_walk.hpp>

namespace pfvox {

namespace {

/// Child slot of the point in the cube whose children have edge 2^childLog2, both relative to the cube's
/// corner.
std::uint32_t slotOf(glm::i64vec3 local, std::uint32_t childLog2) {
    const auto bit = [&](std::int64_t c) { return static_cast<std::uint32_t>((c >> childLog2) & 1); };
    return bit(local.x) | (bit(local.y) << 1) | (bit(local.z) << 2);
}

std::optional<std::uint32_t> regionIndexAt(const OctreeModel& model, glm::i64vec3 local) {
    if (model.topTree.nodes.empty()) return 0;
    std::uint32_t index = 0;
    for (std::uint32_t level = model.topTree.depth; level-- > 0;) {
        const auto child = childAt(model.topTree, index, slotOf(local, level + kRegionEdgeLog2));
        if (!child) return std::nullopt;
        if (child->isLeaf) return model.topFirstRegion[index] + child->index;
        index = child->index;
    }
    return std::nullopt;
}

std::optional<MaterialIndex> materialInRegion(const OctreeRegion& region, glm::i64vec3 local) {
    std::uint32_t index = 0;
    std::uint32_t value = kNoValue;
    for (std::uint32_t level = region.tree.depth; level-- > 0;) {
        const auto child = childAt(region.tree, index, slotOf(local, level));
        if (!child) return std::nullopt;
        value = childValue(region, index, child->slot, value);
        if (child->isLeaf) return region.palette[value];
        index = child->index;
    }
    return std::nullopt;
}

}  // namespace

void OctreeRegion::usePool(const std::shared_ptr<MemoryPool>& pool) {
    const PoolAllocator<std::uint32_t> words(pool);
    tree.nodes = PooledVector<std::uint32_t>(words);
    tree.farTable = PooledVector<std::uint32_t>(words);
    lookup = PooledVector<std::uint32_t>(words);
    values = PooledVector<std::uint8_t>(PoolAllocator<std::uint8_t>(pool));
}

void OctreeModel::indexRegions() {
    topFirstRegion.clear();
    topFirstRegion.reserve(topTree.nodes.size());
    std::uint32_t count = 0;
    for (const std::uint32_t descriptor : topTree.nodes) {
        topFirstRegion.push_back(count);
        count += static_cast<std::uint32_t>(std::popcount(node::leafMask(descriptor)));
    }
}

std::optional<MaterialIndex> OctreeModel::at(glm::ivec3 voxel) const {
    if (regions.empty()) return std::nullopt;
    const glm::i64vec3 local = glm::i64vec3{voxel} - glm::i64vec3{originVoxels};
    const std::int64_t edge = std::int64_t{1} << depth;
    if (glm::any(glm::lessThan(local, glm::i64vec3{0})) ||
        glm::any(glm::greaterThanEqual(local, glm::i64vec3{edge}))) {
        return std::nullopt;
    }
    const auto region = regionIndexAt(*this, local);
    if (!region) return std::nullopt;
    return materialInRegion(regions[*region], local);
}

VoxelModel toVoxelModel(const OctreeModel& model) {
    VoxelModel voxels;
    voxels.name = model.name;
    for (const OctreeRegion& region : model.regions) {
        forEachLeaf(region, [&](const Leaf& leaf) {
            const glm::ivec3 at = leaf.corner;
            const int n = leaf.edge();
            const bool alignedTile = leaf.edgeLog2 >= kBrickEdgeLog2 && ((at.x | at.y | at.z) & (n - 1)) == 0;
            if (alignedTile) {
                voxels.fillTile(at, static_cast<int>(leaf.edgeLog2), leaf.material);
                return;
            }
            for (int z = 0; z < n; ++z)
                for (int y = 0; y < n; ++y)
                    for (int x = 0; x < n; ++x) voxels.set(at + glm::ivec3{x, y, z}, leaf.material);
        });
    }
    return voxels;
}

OctreeStatistics statistics(const OctreeModel& model, std::size_t materialCount) {
    OctreeStatistics s;
    s.voxels = model.voxelCount;
    s.nodes = model.topTree.nodes.size();
    s.farPointers = model.topTree.farTable.size();
    s.gpuBytes = 8 * model.topTree.nodes.size() + 4 * model.topTree.farTable.size();
    s.voxelsOfMaterial.assign(materialCount, 0);
    for (const OctreeRegion& region : model.regions) {
        s.nodes += region.tree.nodes.size();
        s.farPointers += region.tree.farTable.size();
        s.values += region.valueCount();
        s.gpuBytes += 8 * region.tree.nodes.size() + 4 * region.tree.farTable.size() + region.values.size();
        forEachLeaf(region, [&](const Leaf& leaf) {
            ++s.leaves;
            s.voxelsOfMaterial[leaf.material] += std::uint64_t{1} << (3 * leaf.edgeLog2);
        });
    }
    return s;
}

}  // namespace pfvox

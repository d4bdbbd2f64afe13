#include "export/vdb_grids.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <pfvox/octree_walk.hpp>
#include "import/vdb/pfvox_metadata.hpp"
#include "shared/color.glsl.h"

namespace pfvox::vdb_export {

namespace {

using import::vdb::labelOfMaterial;
using openvdb::Coord;

/// As far as the importer goes, for the same reason: sums of coordinates must fit int32.
constexpr int kLargestCoordinate = 1 << 30;

Coord coordOf(glm::ivec3 p) {
    return {p.x, p.y, p.z};
}

/// Level of the tile of VDB that is a cube of this edge, 0 where there is none.
openvdb::Index tileLevel(glm::ivec3 corner, std::uint32_t edgeLog2) {
    if (((corner.x | corner.y | corner.z) & ((1 << edgeLog2) - 1)) != 0) return 0;
    if (edgeLog2 == 3) return 1;
    return edgeLog2 == 7 ? 2 : 0;
}

class TreeWriter {
  public:
    explicit TreeWriter(openvdb::Int32Tree& tree) : accessor_(tree), tree_(tree) {}

    void write(glm::ivec3 corner, std::uint32_t edgeLog2, std::int32_t label) {
        if (const openvdb::Index level = tileLevel(corner, edgeLog2); level != 0) {
            accessor_.addTile(level, coordOf(corner), label, /*state=*/true);
        } else if (edgeLog2 >= kBrickEdgeLog2) {
            tree_.fill(openvdb::CoordBBox::createCube(coordOf(corner), 1 << edgeLog2), label,
                       /*active=*/true);
        } else {
            const int edge = 1 << edgeLog2;
            for (int x = 0; x < edge; ++x)
                for (int y = 0; y < edge; ++y)
                    for (int z = 0; z < edge; ++z)
                        accessor_.setValueOn(coordOf(corner).offsetBy(x, y, z), label);
        }
    }

  private:
    openvdb::tree::ValueAccessor<openvdb::Int32Tree> accessor_;
    openvdb::Int32Tree& tree_;
};

/// Of the three trees together, from the nodes of one.
std::uint64_t memoryOf(const openvdb::Int32Tree& tree) {
    constexpr std::uint64_t kBytesPerVoxel = sizeof(std::int32_t) + sizeof(float) + sizeof(openvdb::Vec3s);
    constexpr std::uint64_t kBytesPerTile = 8 + 8 + 16;  // a pointer or a value, whichever is larger
    constexpr std::uint64_t kLeafValues = 512, kLowerValues = 4096, kUpperValues = 32768;
    const std::vector<openvdb::Index32> nodes = tree.nodeCount();
    return nodes[0] * kLeafValues * kBytesPerVoxel +
           (nodes[1] * kLowerValues + nodes[2] * kUpperValues) * kBytesPerTile;
}

Result<void> fillMaterials(const OctreeModel& model, const Limits& limits, openvdb::Int32Tree& tree,
                           std::set<MaterialIndex>& materials, std::uint64_t& memoryBytes) {
    const VoxelBox box = model.bounds;
    if (glm::any(glm::lessThan(box.min, glm::ivec3{-kLargestCoordinate})) ||
        glm::any(glm::greaterThan(box.max, glm::ivec3{kLargestCoordinate}))) {
        return fail(
            ErrorCode::LimitExceeded,
            fmt::format("model \"{}\" has voxels beyond 2^30, which a .vdb file cannot place", model.name));
    }
    TreeWriter writer(tree);
    for (const OctreeRegion& region : model.regions) {
        forEachLeaf(region, [&](const Leaf& leaf) {
            writer.write(leaf.corner, leaf.edgeLog2, labelOfMaterial(leaf.material));
        });
        materials.insert(region.palette.begin(), region.palette.end());
        if (memoryBytes + memoryOf(tree) > limits.maxMemoryBytes) {
            return fail(ErrorCode::LimitExceeded,
                        fmt::format("the grids take more than {} bytes of memory (maxMemoryBytes)",
                                    limits.maxMemoryBytes));
        }
    }
    tree.prune();
    memoryBytes += memoryOf(tree);
    return {};
}

openvdb::Vec3STree::Ptr colorTree(const openvdb::Int32Tree& labels,
                                  const std::vector<openvdb::Vec3s>& colors) {
    auto tree = std::make_shared<openvdb::Vec3STree>(labels, openvdb::Vec3s(0.0f), openvdb::TopologyCopy());
    const auto colorOf = [&](std::int32_t label) { return colors[static_cast<std::size_t>(label - 1)]; };
    for (auto leaf = tree->beginLeaf(); leaf; ++leaf) {
        const auto* source = labels.probeConstLeaf(leaf->origin());
        for (auto voxel = leaf->beginValueOn(); voxel; ++voxel) {
            voxel.setValue(colorOf(source->getValue(voxel.pos())));
        }
    }
    auto tile = tree->beginValueOn();
    tile.setMaxDepth(openvdb::Vec3STree::ValueOnIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) tile.setValue(colorOf(labels.getValue(tile.getCoord())));
    return tree;
}

}  // namespace

float linearOf(std::uint8_t srgb) {
    return static_cast<float>(shared::linearFromSrgb(srgb / 255.0));
}

Result<ModelGrids> makeGrids(const OctreeModel& model, const std::vector<Material>& materials,
                             const Limits& limits, std::uint64_t& memoryBytes) {
    ModelGrids grids;
    if (model.voxelCount == 0) return grids;
    auto labels = std::make_shared<openvdb::Int32Tree>(0);
    PFVOX_CHECK(fillMaterials(model, limits, *labels, grids.materials, memoryBytes));

    std::vector<openvdb::Vec3s> colors;
    for (const Material& m : materials) {
        colors.emplace_back(linearOf(m.baseColor.r), linearOf(m.baseColor.g), linearOf(m.baseColor.b));
    }
    grids.color = openvdb::Vec3SGrid::create(colorTree(*labels, colors));
    grids.density = openvdb::FloatGrid::create(
        std::make_shared<openvdb::FloatTree>(*labels, 0.0f, 1.0f, openvdb::TopologyCopy()));
    grids.density->setGridClass(openvdb::GRID_FOG_VOLUME);
    grids.material = openvdb::Int32Grid::create(std::move(labels));
    return grids;
}

}  // namespace pfvox::vdb_export

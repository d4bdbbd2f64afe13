#include "pf_vox/top_tree_reader.hpp"

#include <fmt/format.h>

#include <limits>
#include <pfvox/octree_walk.hpp>

#include "octree/plane_linker.hpp"
#include "octree/tree_check.hpp"

namespace pfvox {

namespace {

using container::Array;
using container::MemoryBudget;

constexpr std::int64_t kNoOrigin = std::numeric_limits<std::int64_t>::min();

/// Where each leaf of the top tree lies, in region order. Computed in 64 bits: nothing is known about the
/// tree but that its cube is one of int32.
Result<Array<glm::i64vec3>> topLeafOrigins(const OctreeModel& model, std::size_t leafCount,
                                           MemoryBudget& budget) {
    const PooledVector<std::uint32_t>& nodes = model.topTree.nodes;
    PFVOX_TRY(auto, corner, Array<glm::i64vec3>::make(budget, nodes.size()));
    PFVOX_TRY(auto, level, Array<std::uint32_t>::make(budget, nodes.size()));
    PFVOX_TRY(auto, origins, Array<glm::i64vec3>::make(budget, leafCount));
    corner[0] = glm::i64vec3{model.originVoxels};
    level[0] = model.topTree.depth;
    std::size_t leaves = 0;
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        const std::uint32_t childLevel = level[i] - 1;
        forEachChild(model.topTree, i, [&](const NodeChild& child) {
            const glm::i64vec3 at =
                corner[i] + glm::i64vec3{cornerOfSlot(child.slot)} *
                                (std::int64_t{1} << (childLevel + layout::kMaxRegionDepth));
            if (!child.isLeaf) {
                corner[child.index] = at;
                level[child.index] = childLevel;
            } else if (leaves++ < leafCount) {
                // A leaf above the last level would be larger than a region.
                origins[leaves - 1] = childLevel == 0 ? at : glm::i64vec3{kNoOrigin};
            }
        });
    }
    if (leaves != leafCount)
        return fail(ErrorCode::BadStructure, fmt::format("{} leaves for {} regions", leaves, leafCount));
    return origins;
}

}  // namespace

Result<TopTreeReader> TopTreeReader::make(const PfVoxSections& sections,
                                          std::span<const layout::Model> models) {
    TopTreeReader reader(sections.reader.budget());
    reader.profile_ = sections.profile;
    std::uint64_t nodes = 0;
    std::uint64_t words = 0;
    for (const layout::Model& m : models) {
        nodes += m.topNodeCount;
        words += std::uint64_t{m.topNodeCount} + m.topFarCount;
    }
    const bool isPacked = reader.profile_ == Profile::Packed;
    if (sections.table.find(isPacked ? "TOPN" : "TOPT") != nullptr)
        return fail(ErrorCode::BadStructure, "the top trees are those of the other profile");
    if (nodes == 0) return reader;
    PFVOX_TRY(const layout::Section*, section, sections.table.require(isPacked ? "TOPT" : "TOPN"));
    reader.section_ = section;
    if (isPacked) {
        PFVOX_TRY(auto, planes,
                  sections.reader.read<std::uint8_t>(*section, octree::planeBytes(nodes, 0, false)));
        reader.planes_ = std::move(planes);
    } else {
        PFVOX_TRY(auto, raw, sections.reader.read<std::uint32_t>(*section, words));
        reader.words_ = std::move(raw);
    }
    return reader;
}

Result<void> TopTreeReader::readTree(const layout::Model& record, NodeTree& tree) {
    const std::size_t n = record.topNodeCount;
    if (profile_ == Profile::Packed) {
        const auto planes =
            std::span<const std::uint8_t>(planes_).subspan(next_, octree::planeBytes(n, 0, false));
        octree::PlaneLinker linker;
        PFVOX_CHECK(linker.linkTree(octree::cutPlanes(planes, n, record.topBranchCount, false), tree));
        if (tree.farTable.size() != record.topFarCount)
            return fail(ErrorCode::BadStructure, "wrong number of far pointers");
        return {};
    }
    const auto nodes = std::span<const std::uint32_t>(words_).subspan(next_, n);
    const auto farTable = std::span<const std::uint32_t>(words_).subspan(next_ + n, record.topFarCount);
    tree.nodes.assign(nodes.begin(), nodes.end());
    tree.farTable.assign(farTable.begin(), farTable.end());
    PFVOX_CHECK(octree::checkTree(tree));
    if (octree::countBranches(tree) != record.topBranchCount)
        return fail(ErrorCode::BadStructure, "the announced number of nodes with inner children is wrong");
    return {};
}

Result<void> TopTreeReader::readRegions(const layout::Model& record, std::span<const layout::Region> regions,
                                        OctreeModel& model) {
    model.topTree.depth = record.depth - layout::kMaxRegionDepth;
    // The tree and its index; far pointers and what the linker remembers of each node.
    constexpr std::uint64_t kBytesPerNode = 2 * sizeof(std::uint32_t) + 2;
    PFVOX_CHECK(budget_->take(record.topNodeCount, kBytesPerNode));
    PFVOX_CHECK(budget_->take(record.topFarCount, sizeof(std::uint32_t)));
    PFVOX_CHECK(readTree(record, model.topTree));
    model.indexRegions();
    PFVOX_TRY(const auto, origins, topLeafOrigins(model, regions.size(), *budget_));
    for (std::size_t i = 0; i < origins.size(); ++i) {
        const auto& o = regions[i].origin;
        if (glm::i64vec3{o[0], o[1], o[2]} != origins[i] || regions[i].depth != layout::kMaxRegionDepth)
            return fail(ErrorCode::BadStructure, fmt::format("region {} does not lie in its leaf", i));
    }
    return {};
}

Result<void> TopTreeReader::readNext(const layout::Model& record, std::span<const layout::Region> regions,
                                     OctreeModel& model) {
    const std::size_t first = next_;
    auto result = readRegions(record, regions, model);
    const std::uint64_t n = record.topNodeCount;
    next_ = first + (profile_ == Profile::Packed ? octree::planeBytes(n, 0, false) : n + record.topFarCount);
    return container::inSection(*section_, std::move(result));
}

}  // namespace pfvox

#include "pf_vox/top_tree_reader.hpp"

#include <fmt/format.h>

#include "octree/plane_linker.hpp"
#include "octree/tree_check.hpp"

namespace pfvox {

namespace {

/// Where each leaf of the top tree lies, in region order.
std::vector<glm::ivec3> topLeafOrigins(const OctreeModel& model) {
    std::vector<glm::ivec3> corner(model.topTree.nodes.size());
    std::vector<std::uint32_t> level(model.topTree.nodes.size(), model.topTree.depth);
    corner[0] = model.originVoxels;
    std::vector<glm::ivec3> origins;
    for (std::uint32_t i = 0; i < model.topTree.nodes.size(); ++i) {
        const std::uint32_t d = model.topTree.nodes[i];
        const std::uint32_t childLevel = level[i] - 1;
        std::uint32_t child = node::innerMask(d) != 0 ? model.topTree.firstChild(i) : 0;
        for (std::uint32_t slot = 0; slot < 8; ++slot) {
            if (((node::validMask(d) >> slot) & 1u) == 0) continue;
            const glm::ivec3 at =
                corner[i] + glm::ivec3{mortonDecode(slot)} * (1 << (childLevel + layout::kMaxRegionDepth));
            if (((node::leafMask(d) >> slot) & 1u) != 0) {
                // A leaf above the last level would be larger than a region: told apart by an impossible
                // origin.
                origins.push_back(childLevel == 0 ? at : glm::ivec3{std::numeric_limits<int>::min()});
            } else {
                corner[child] = at;
                level[child++] = childLevel;
            }
        }
    }
    return origins;
}

}  // namespace

Result<TopTreeReader> TopTreeReader::make(std::span<const std::byte> file, const SectionIndex& index,
                                          const std::vector<layout::Model>& models) {
    TopTreeReader reader;
    reader.profile_ = index.profile();
    std::uint64_t nodes = 0;
    std::uint64_t words = 0;
    for (const layout::Model& m : models) {
        nodes += m.topNodeCount;
        words += std::uint64_t{m.topNodeCount} + m.topFarCount;
    }
    const bool isPacked = reader.profile_ == Profile::Packed;
    const char* const name = isPacked ? "TOPT" : "TOPN";
    if (index.find(isPacked ? "TOPN" : "TOPT") != nullptr)
        return fail(ErrorCode::BadStructure, "the top trees are those of the other profile");
    if (nodes == 0) return reader;
    reader.section_ = index.find(name);
    if (reader.section_ == nullptr)
        return fail(ErrorCode::BadStructure, fmt::format("section {} is missing", name));
    if (isPacked) {
        PFVOX_TRY(auto, planes, readSection(file, *reader.section_, octree::planeBytes(nodes, 0, false)));
        reader.planes_ = std::move(planes);
    } else {
        PFVOX_TRY(auto, raw, readSection<std::uint32_t>(file, *reader.section_, words));
        reader.words_ = std::move(raw);
    }
    return reader;
}

Result<void> TopTreeReader::readTree(const layout::Model& record, NodeTree& tree) {
    const std::size_t n = record.topNodeCount;
    if (profile_ == Profile::Packed) {
        const auto planes = std::span(planes_).subspan(next_, octree::planeBytes(n, 0, false));
        octree::PlaneLinker linker;
        PFVOX_CHECK(linker.linkTree(octree::cutPlanes(planes, n, record.topBranchCount, false), tree));
        if (tree.farTable.size() != record.topFarCount)
            return fail(ErrorCode::BadStructure, "wrong number of far pointers");
        return {};
    }
    const auto nodes = std::span(words_).subspan(next_, n);
    const auto farTable = std::span(words_).subspan(next_ + n, record.topFarCount);
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
    PFVOX_CHECK(readTree(record, model.topTree));
    model.indexRegions();
    const std::vector<glm::ivec3> origins = topLeafOrigins(model);
    if (origins.size() != regions.size()) {
        return fail(ErrorCode::BadStructure,
                    fmt::format("{} leaves for {} regions", origins.size(), regions.size()));
    }
    for (std::size_t i = 0; i < origins.size(); ++i) {
        const auto& o = regions[i].origin;
        if (glm::ivec3{o[0], o[1], o[2]} != origins[i] || regions[i].depth != layout::kMaxRegionDepth) {
            return fail(ErrorCode::BadStructure, fmt::format("region {} does not lie in its leaf", i));
        }
    }
    return {};
}

Result<void> TopTreeReader::readNext(const layout::Model& record, std::span<const layout::Region> regions,
                                     OctreeModel& model) {
    const std::size_t first = next_;
    auto result = readRegions(record, regions, model);
    const std::uint64_t n = record.topNodeCount;
    next_ = first + (profile_ == Profile::Packed ? octree::planeBytes(n, 0, false) : n + record.topFarCount);
    if (!result) return failInSection(*section_, result.error().code, describe(result.error()));
    return {};
}

}  // namespace pfvox

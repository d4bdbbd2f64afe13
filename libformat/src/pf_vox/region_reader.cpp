#include "pf_vox/region_reader.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>

#include "octree/node_planes.hpp"
#include "octree/tree_check.hpp"
#include "pf_vox/lod_codec.hpp"

namespace pfvox {

namespace {

/// An error found in what a section decodes to, at the section's place.
Result<void> inSection(const layout::Section& section, const Result<void>& result) {
    if (result) return {};
    return failInSection(section, result.error().code, describe(result.error()));
}

}  // namespace

Result<const layout::Section*> RegionReader::require(RegionPart part, std::size_t id) const {
    if (const layout::Section* section = index_.find(part, id)) return section;
    return fail(ErrorCode::BadStructure, fmt::format("section {} of region {} is missing",
                                                     kRegionSections[static_cast<std::size_t>(part)], id));
}

Result<void> RegionReader::readPackedTree(std::size_t id, const layout::Region& record,
                                          OctreeRegion& region) const {
    PFVOX_TRY(const layout::Section*, section, require(RegionPart::Masks, id));
    const std::size_t n = record.nodeCount;
    PFVOX_TRY(const auto, planes,
              readSection(file_, *section, octree::planeBytes(n, record.branchCount, true)));
    PFVOX_CHECK(inSection(*section, octree::linkPlanes(octree::cutPlanes(planes, n, record.branchCount, true),
                                                       region.tree, &region.lookup)));
    const std::uint32_t last = region.lookup.back();
    const std::uint64_t values = (last >> 8) + static_cast<std::uint64_t>(std::popcount(last & 0xffu));
    if (region.tree.farTable.size() != record.farCount || values != record.valueCount) {
        return failInSection(*section, ErrorCode::BadStructure, "the masks do not have the announced counts");
    }
    return {};
}

Result<std::vector<std::uint32_t>> RegionReader::readWords(RegionPart part, std::size_t id,
                                                           std::uint64_t count) const {
    PFVOX_TRY(const layout::Section*, section, require(part, id));
    return readSection<std::uint32_t>(file_, *section, count);
}

Result<void> RegionReader::readResidentTree(std::size_t id, const layout::Region& record,
                                            OctreeRegion& region) const {
    PFVOX_TRY(auto, nodes, readWords(RegionPart::Nodes, id, record.nodeCount));
    region.tree.nodes = std::move(nodes);
    PFVOX_TRY(auto, lookup, readWords(RegionPart::Lookup, id, record.nodeCount));
    region.lookup = std::move(lookup);
    if (record.farCount != 0 || index_.find(RegionPart::FarTable, id) != nullptr) {
        PFVOX_TRY(auto, farTable, readWords(RegionPart::FarTable, id, record.farCount));
        region.tree.farTable = std::move(farTable);
    }
    const layout::Section& nodeSection = *index_.find(RegionPart::Nodes, id);
    PFVOX_CHECK(inSection(nodeSection, octree::checkTree(region.tree)));
    const auto values = octree::checkLookup(region.tree, region.lookup);
    if (!values) return inSection(*index_.find(RegionPart::Lookup, id), tl::make_unexpected(values.error()));
    if (octree::countBranches(region.tree) != record.branchCount || *values != record.valueCount) {
        return failInSection(nodeSection, ErrorCode::BadStructure,
                             "the nodes do not have the announced counts");
    }
    return {};
}

Result<void> RegionReader::readValues(std::size_t id, const layout::Region& record,
                                      OctreeRegion& region) const {
    PFVOX_TRY(const layout::Section*, section,
              require(isPacked() ? RegionPart::Values : RegionPart::ValueBytes, id));
    PFVOX_TRY(auto, bytes,
              readSection(file_, *section, region.valueBytes() * std::uint64_t{record.valueCount}));
    region.values = std::move(bytes);
    std::uint32_t largest = 0;
    for (std::size_t i = 0; i < record.valueCount; ++i) largest = std::max(largest, region.value(i));
    if (largest >= region.palette.size()) {
        return failInSection(*section, ErrorCode::BadReference,
                             fmt::format("value {} in a palette of {}", largest, region.palette.size()));
    }
    return {};
}

Result<void> RegionReader::readLod(std::size_t id, OctreeRegion& region) const {
    const layout::Section* section = index_.find(isPacked() ? RegionPart::Lod : RegionPart::LodWords, id);
    if (section == nullptr) return {};
    const std::size_t n = region.tree.nodes.size();
    const std::uint64_t size = isPacked() ? packedLodBytes(n, region.valueBytes()) : residentLodBytes(n);
    PFVOX_TRY(const auto, bytes, readSection(file_, *section, size));
    return inSection(*section,
                     isPacked() ? unpackLod(bytes, materials_, region) : readResidentLod(bytes, region));
}

Result<OctreeRegion> RegionReader::read(std::size_t id, const layout::Region& record,
                                        std::span<const std::uint16_t> palettes) const {
    OctreeRegion region;
    region.originVoxels = {record.origin[0], record.origin[1], record.origin[2]};
    region.tree.depth = record.depth;
    const auto palette = palettes.subspan(record.paletteFirst, record.paletteCount);
    region.palette.assign(palette.begin(), palette.end());
    PFVOX_CHECK(isPacked() ? readPackedTree(id, record, region) : readResidentTree(id, record, region));
    PFVOX_CHECK(readValues(id, record, region));
    PFVOX_CHECK(readLod(id, region));
    region.voxelCount = record.voxelCount;
    region.bounds = {
        region.originVoxels + glm::ivec3{record.boundsMin[0], record.boundsMin[1], record.boundsMin[2]},
        region.originVoxels + glm::ivec3{record.boundsMax[0], record.boundsMax[1], record.boundsMax[2]}};
    return region;
}

}  // namespace pfvox

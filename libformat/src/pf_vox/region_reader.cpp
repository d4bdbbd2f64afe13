#include "pf_vox/region_reader.hpp"

#include <fmt/format.h>
#include <algorithm>

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

std::uint32_t largestValue(const OctreeRegion& region) {
    std::uint32_t largest = 0;
    if (region.valueBytes() == 1) {
        std::uint8_t largestByte = 0;  // a byte, so that sixteen are compared at once
        for (const std::uint8_t value : region.values) largestByte = std::max(largestByte, value);
        return largestByte;
    }
    for (std::size_t i = 0; i < region.valueCount(); ++i) largest = std::max(largest, region.value(i));
    return largest;
}

}  // namespace

Result<const layout::Section*> RegionReader::require(RegionPart part, std::size_t id) const {
    if (const layout::Section* section = index_.find(part, id)) return section;
    return fail(ErrorCode::BadStructure, fmt::format("section {} of region {} is missing",
                                                     kRegionSections[static_cast<std::size_t>(part)], id));
}

Result<void> RegionReader::checkSize(RegionPart part, std::size_t id, std::uint64_t bytes) const {
    PFVOX_TRY(const layout::Section*, section, require(part, id));
    return checkSectionSize(file_, *section, bytes);
}

Result<std::size_t> RegionReader::poolBytes(std::size_t id, const layout::Region& record) const {
    const std::size_t words = std::size_t{record.nodeCount} * sizeof(std::uint32_t);
    const std::size_t farBytes = std::size_t{record.farCount} * sizeof(std::uint32_t);
    const std::size_t values = (record.paletteCount <= 256 ? 1u : 2u) * std::size_t{record.valueCount};
    PFVOX_CHECK(checkSize(valuesPart(), id, values));
    if (isPacked()) {
        // The far table follows from the masks and has at most an entry for each node with inner children.
        if (record.farCount > record.branchCount)
            return fail(ErrorCode::BadStructure, "more far pointers than nodes with inner children");
        PFVOX_CHECK(
            checkSize(RegionPart::Masks, id, octree::planeBytes(record.nodeCount, record.branchCount, true)));
    } else {
        PFVOX_CHECK(checkSize(RegionPart::Nodes, id, words));
        PFVOX_CHECK(checkSize(RegionPart::Lookup, id, words));
        if (record.farCount != 0) PFVOX_CHECK(checkSize(RegionPart::FarTable, id, farBytes));
    }
    return 2 * MemoryPool::rounded(words) + MemoryPool::rounded(farBytes) + MemoryPool::rounded(values);
}

Result<void> RegionReader::readPackedTree(std::size_t id, const layout::Region& record, OctreeRegion& region,
                                          Scratch& scratch) const {
    PFVOX_TRY(const layout::Section*, section, require(RegionPart::Masks, id));
    const std::size_t n = record.nodeCount;
    const std::uint64_t bytes = octree::planeBytes(n, record.branchCount, true);
    PFVOX_CHECK(checkSectionSize(file_, *section, bytes));
    const std::span planes(scratch.planes.room(bytes), bytes);
    PFVOX_CHECK(fillFromSection(file_, *section, std::as_writable_bytes(planes)));
    const auto values = scratch.linker.linkRegion(octree::cutPlanes(planes, n, record.branchCount, true),
                                                  region.tree, region.lookup);
    if (!values) return inSection(*section, tl::make_unexpected(values.error()));
    if (region.tree.farTable.size() != record.farCount || *values != record.valueCount) {
        return failInSection(*section, ErrorCode::BadStructure, "the masks do not have the announced counts");
    }
    return {};
}

Result<void> RegionReader::readWords(RegionPart part, std::size_t id, std::size_t count,
                                     PooledVector<std::uint32_t>& words) const {
    PFVOX_CHECK(checkSize(part, id, std::uint64_t{count} * sizeof(std::uint32_t)));
    words.resize(count);
    return fillFromSection(file_, *index_.find(part, id), std::as_writable_bytes(std::span(words)));
}

Result<void> RegionReader::readResidentTree(std::size_t id, const layout::Region& record,
                                            OctreeRegion& region) const {
    PFVOX_CHECK(readWords(RegionPart::Nodes, id, record.nodeCount, region.tree.nodes));
    PFVOX_CHECK(readWords(RegionPart::Lookup, id, record.nodeCount, region.lookup));
    if (record.farCount != 0 || index_.find(RegionPart::FarTable, id) != nullptr)
        PFVOX_CHECK(readWords(RegionPart::FarTable, id, record.farCount, region.tree.farTable));
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
    PFVOX_TRY(const layout::Section*, section, require(valuesPart(), id));
    const std::uint64_t bytes = region.valueBytes() * std::uint64_t{record.valueCount};
    PFVOX_CHECK(checkSectionSize(file_, *section, bytes));
    region.values.resize(bytes);
    PFVOX_CHECK(fillFromSection(file_, *section, std::as_writable_bytes(std::span(region.values))));
    const std::uint32_t largest = largestValue(region);
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
                                        std::span<const std::uint16_t> palettes,
                                        const std::shared_ptr<MemoryPool>& pool, Scratch& scratch) const {
    OctreeRegion region;
    region.usePool(pool);
    region.originVoxels = {record.origin[0], record.origin[1], record.origin[2]};
    region.tree.depth = record.depth;
    const auto palette = palettes.subspan(record.paletteFirst, record.paletteCount);
    region.palette.assign(palette.begin(), palette.end());
    PFVOX_CHECK(isPacked() ? readPackedTree(id, record, region, scratch)
                           : readResidentTree(id, record, region));
    PFVOX_CHECK(readValues(id, record, region));
    PFVOX_CHECK(readLod(id, region));
    region.voxelCount = record.voxelCount;
    region.bounds = {
        region.originVoxels + glm::ivec3{record.boundsMin[0], record.boundsMin[1], record.boundsMin[2]},
        region.originVoxels + glm::ivec3{record.boundsMax[0], record.boundsMax[1], record.boundsMax[2]}};
    return region;
}

}  // namespace pfvox

#include "pf_vox/region_reader.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "octree/node_planes.hpp"
#include "octree/tree_check.hpp"
#include "pf_vox/lod_codec.hpp"

namespace pfvox {

namespace {

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

std::uint64_t RegionReader::lodBytes(std::size_t id, const layout::Region& record) const {
    if (sections_.find(lodPart(), id) == nullptr) return 0;
    const std::size_t valueBytes = record.paletteCount <= 256 ? 1 : 2;
    return isPacked() ? packedLodBytes(record.nodeCount, valueBytes) : residentLodBytes(record.nodeCount);
}

Result<void> RegionReader::checkSize(RegionPart part, std::size_t id, std::uint64_t bytes) const {
    PFVOX_TRY(const layout::Section*, section, sections_.require(part, id));
    return sections_.reader.checkSize(*section, bytes);
}

Result<void> RegionReader::fill(RegionPart part, std::size_t id, std::span<std::byte> raw) const {
    return sections_.reader.fill(*sections_.find(part, id), raw);
}

Result<RegionReader::Sizes> RegionReader::sizesOf(std::size_t id, const layout::Region& record) const {
    const std::uint64_t n = record.nodeCount;
    const std::uint64_t words = n * sizeof(std::uint32_t);
    const std::uint64_t farBytes = std::uint64_t{record.farCount} * sizeof(std::uint32_t);
    const std::uint64_t values = (record.paletteCount <= 256 ? 1u : 2u) * std::uint64_t{record.valueCount};
    const std::uint64_t planes = isPacked() ? octree::planeBytes(n, record.branchCount, true) : 0;
    const std::uint64_t lod = lodBytes(id, record);
    PFVOX_CHECK(checkSize(valuesPart(), id, values));
    if (isPacked()) {
        // The far table follows from the masks and has at most an entry for each node with inner children.
        if (record.farCount > record.branchCount)
            return fail(ErrorCode::BadStructure, "more far pointers than nodes with inner children");
        PFVOX_CHECK(checkSize(RegionPart::Masks, id, planes));
    } else {
        PFVOX_CHECK(checkSize(RegionPart::Nodes, id, words));
        PFVOX_CHECK(checkSize(RegionPart::Lookup, id, words));
        if (record.farCount != 0 || sections_.find(RegionPart::FarTable, id) != nullptr)
            PFVOX_CHECK(checkSize(RegionPart::FarTable, id, farBytes));
    }
    if (lod != 0) PFVOX_CHECK(checkSize(lodPart(), id, lod));
    constexpr std::uint64_t kGrowth = 3;  // of a buffer: twice what is needed, and the one before
    constexpr std::uint64_t kFarPointers = 64u << 10;
    return Sizes{.pooled = 2 * MemoryPool::rounded(words) + MemoryPool::rounded(farBytes) +
                           MemoryPool::rounded(values),
                 .beside = record.paletteCount * sizeof(MaterialIndex) +
                           (lod != 0 ? n * (sizeof(std::uint32_t) + sizeof(std::uint16_t)) : 0),
                 .scratch = kGrowth * (std::max(planes, lod) + n) +
                            record.paletteCount * sizeof(std::uint32_t) + kFarPointers};
}

Result<void> RegionReader::readPackedTree(std::size_t id, const layout::Region& record, OctreeRegion& region,
                                          Scratch& scratch) const {
    const layout::Section& section = *sections_.find(RegionPart::Masks, id);
    const std::size_t n = record.nodeCount;
    const std::uint64_t bytes = octree::planeBytes(n, record.branchCount, true);
    const std::span planes(scratch.bytes.room(bytes), bytes);
    PFVOX_CHECK(fill(RegionPart::Masks, id, std::as_writable_bytes(planes)));
    const auto values = scratch.linker.linkRegion(octree::cutPlanes(planes, n, record.branchCount, true),
                                                  region.tree, region.lookup);
    if (!values) return container::inSection(section, tl::make_unexpected(values.error()));
    if (region.tree.farTable.size() != record.farCount || *values != record.valueCount) {
        return container::failInSection(section, ErrorCode::BadStructure,
                                        "the masks do not have the announced counts");
    }
    return {};
}

Result<void> RegionReader::readWords(RegionPart part, std::size_t id, std::size_t count,
                                     PooledVector<std::uint32_t>& words) const {
    words.resize(count);
    return fill(part, id, std::as_writable_bytes(std::span(words)));
}

Result<void> RegionReader::readResidentTree(std::size_t id, const layout::Region& record,
                                            OctreeRegion& region) const {
    PFVOX_CHECK(readWords(RegionPart::Nodes, id, record.nodeCount, region.tree.nodes));
    PFVOX_CHECK(readWords(RegionPart::Lookup, id, record.nodeCount, region.lookup));
    if (sections_.find(RegionPart::FarTable, id) != nullptr)
        PFVOX_CHECK(readWords(RegionPart::FarTable, id, record.farCount, region.tree.farTable));
    const layout::Section& nodeSection = *sections_.find(RegionPart::Nodes, id);
    PFVOX_CHECK(container::inSection(nodeSection, octree::checkTree(region.tree)));
    const auto values = octree::checkLookup(region.tree, region.lookup);
    if (!values) {
        return container::inSection(*sections_.find(RegionPart::Lookup, id),
                                    tl::make_unexpected(values.error()));
    }
    if (octree::countBranches(region.tree) != record.branchCount || *values != record.valueCount) {
        return container::failInSection(nodeSection, ErrorCode::BadStructure,
                                        "the nodes do not have the announced counts");
    }
    return {};
}

Result<void> RegionReader::readValues(std::size_t id, const layout::Region& record,
                                      OctreeRegion& region) const {
    region.values.resize(region.valueBytes() * std::uint64_t{record.valueCount});
    PFVOX_CHECK(fill(valuesPart(), id, std::as_writable_bytes(std::span(region.values))));
    const std::uint32_t largest = largestValue(region);
    if (largest >= region.palette.size()) {
        return container::failInSection(
            *sections_.find(valuesPart(), id), ErrorCode::BadReference,
            fmt::format("value {} in a palette of {}", largest, region.palette.size()));
    }
    return {};
}

Result<void> RegionReader::readLod(std::size_t id, const layout::Region& record, OctreeRegion& region,
                                   Scratch& scratch) const {
    // Without materials the asset is faulty already, and colors cannot be made.
    const std::uint64_t size = lodBytes(id, record);
    if (size == 0 || materials_.empty()) return {};
    const std::span bytes(scratch.bytes.room(size), size);
    PFVOX_CHECK(fill(lodPart(), id, std::as_writable_bytes(bytes)));
    return container::inSection(*sections_.find(lodPart(), id), isPacked()
                                                                    ? unpackLod(bytes, materials_, region)
                                                                    : readResidentLod(bytes, region));
}

Result<OctreeRegion> RegionReader::read(std::size_t id, const layout::Region& record,
                                        const std::shared_ptr<MemoryPool>& pool, Scratch& scratch) const {
    OctreeRegion region;
    region.usePool(pool);
    region.originVoxels = {record.origin[0], record.origin[1], record.origin[2]};
    region.tree.depth = record.depth;
    const auto palette = palettes_.subspan(record.paletteFirst, record.paletteCount);
    region.palette.assign(palette.begin(), palette.end());
    PFVOX_CHECK(isPacked() ? readPackedTree(id, record, region, scratch)
                           : readResidentTree(id, record, region));
    PFVOX_CHECK(readValues(id, record, region));
    PFVOX_CHECK(readLod(id, record, region, scratch));
    region.voxelCount = record.voxelCount;
    region.bounds = {
        region.originVoxels + glm::ivec3{record.boundsMin[0], record.boundsMin[1], record.boundsMin[2]},
        region.originVoxels + glm::ivec3{record.boundsMax[0], record.boundsMax[1], record.boundsMax[2]}};
    return region;
}

}  // namespace pfvox

#include "pf_vox/region_writer.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>

#include "octree/node_planes.hpp"
#include "pf_vox/lod_codec.hpp"

namespace pfvox {

namespace {

using container::SectionContent;
using container::Texture;

std::vector<std::uint8_t> bytesOf(std::span<const std::uint32_t> words) {
    std::vector<std::uint8_t> bytes;
    container::appendBytes(bytes, words);
    return bytes;
}

/// What cannot be computed, for the compressor.
std::vector<SectionContent> packRegion(const OctreeRegion& region, std::uint32_t id,
                                       const std::vector<Material>& materials) {
    std::vector<SectionContent> sections;
    sections.push_back({.fourcc = "MASK",
                        .region = id,
                        .count = region.tree.nodes.size(),
                        .raw = octree::splitPlanes(region.tree, region.lookup)});
    sections.push_back({.fourcc = "ATTR",
                        .region = id,
                        .count = region.valueCount(),
                        .texture = Texture::LocalSymbols,
                        .raw = {region.values.begin(), region.values.end()}});
    if (!region.lod.empty()) {
        sections.push_back({.fourcc = "LODA",
                            .region = id,
                            .mustUnderstand = false,
                            .count = region.lod.colors.size(),
                            .raw = packLod(region, materials)});
    }
    return sections;
}

/// Everything as it lies in memory.
std::vector<SectionContent> layOutRegion(const OctreeRegion& region, std::uint32_t id) {
    std::vector<SectionContent> sections;
    const auto add = [&](std::string_view fourcc, std::uint64_t count, std::vector<std::uint8_t> raw) {
        sections.push_back({.fourcc = fourcc,
                            .region = id,
                            .mustUnderstand = fourcc != "LODR",
                            .count = count,
                            .compress = false,
                            .raw = std::move(raw)});
    };
    add("NODE", region.tree.nodes.size(), bytesOf(region.tree.nodes));
    add("LOOK", region.lookup.size(), bytesOf(region.lookup));
    if (!region.tree.farTable.empty())
        add("FARP", region.tree.farTable.size(), bytesOf(region.tree.farTable));
    add("VALU", region.valueCount(), {region.values.begin(), region.values.end()});
    if (!region.lod.empty()) add("LODR", region.lod.colors.size(), residentLod(region));
    return sections;
}

}  // namespace

SectionContent emptyTopTrees(Profile profile) {
    if (profile == Profile::Packed) return {.fourcc = "TOPT"};
    return {.fourcc = "TOPN", .compress = false};
}

void appendTopTree(const NodeTree& tree, Profile profile, SectionContent& section) {
    if (profile == Profile::Packed) {
        container::appendBytes(section.raw, std::span<const std::uint8_t>(octree::splitPlanes(tree, {})));
    } else {
        container::appendBytes(section.raw, std::span<const std::uint32_t>(tree.nodes));
        container::appendBytes(section.raw, std::span<const std::uint32_t>(tree.farTable));
    }
    section.count += tree.nodes.size();
}

void addRegionSections(const std::vector<const OctreeRegion*>& regions,
                       const std::vector<Material>& materials, Profile profile,
                       std::vector<SectionContent>& sections) {
    std::vector<std::vector<SectionContent>> ofRegions(regions.size());
    tbb::parallel_for(std::size_t{0}, ofRegions.size(), [&](std::size_t i) {
        const auto id = static_cast<std::uint32_t>(i);
        ofRegions[i] = profile == Profile::Packed ? packRegion(*regions[i], id, materials)
                                                  : layOutRegion(*regions[i], id);
    });
    for (auto& ofRegion : ofRegions) std::ranges::move(ofRegion, std::back_inserter(sections));
}

}  // namespace pfvox

// walk-octree <file.pf_vox>: loads an asset and walks its octrees: nodes and leaves on each level, and the
// voxels of each material. pfvox/octree.hpp tells what the words mean.
#include <pfvox/pf_vox.hpp>

#include <bit>
#include <cstdio>
#include <map>

namespace {

struct Level {
    std::uint64_t nodes = 0;
    std::uint64_t leaves = 0;
};

/// Visits node `index` and what is below it. Leaves of the last level are single voxels.
void walk(const pfvox::NodeTree& tree, std::uint32_t index, std::uint32_t level,
          std::map<std::uint32_t, Level>& levels) {
    const std::uint32_t descriptor = tree.nodes[index];
    const std::uint32_t inner = pfvox::node::innerMask(descriptor);
    levels[level].nodes += 1;
    levels[level + 1].leaves += static_cast<std::uint64_t>(std::popcount(pfvox::node::leafMask(descriptor)));
    if (inner == 0) return;
    const std::uint32_t first =
        tree.firstChild(index);  // inner children lie side by side, leaves have no node
    for (std::uint32_t child = 0; child < static_cast<std::uint32_t>(std::popcount(inner)); ++child)
        walk(tree, first + child, level + 1, levels);
}

void printModel(const pfvox::OctreeAsset& asset, const pfvox::OctreeModel& model) {
    std::printf("model \"%s\": %llu voxels, %zu regions, %u levels\n", model.name.str().c_str(),
                static_cast<unsigned long long>(model.voxelCount), model.regions.size(), model.depth);
    std::map<std::uint32_t, Level> levels;
    for (const pfvox::OctreeRegion& region : model.regions) {
        if (!region.tree.nodes.empty()) walk(region.tree, 0, model.depth - region.tree.depth, levels);
    }
    for (const auto& [level, count] : levels) {
        std::printf("  level %2u: %8llu nodes %8llu leaves of edge %u\n", level,
                    static_cast<unsigned long long>(count.nodes),
                    static_cast<unsigned long long>(count.leaves), 1u << (model.depth - level));
    }
    const pfvox::OctreeStatistics sums = pfvox::statistics(model, asset.materials.size());
    for (std::size_t i = 0; i < asset.materials.size(); ++i) {
        if (sums.voxelsOfMaterial[i] == 0) continue;
        const pfvox::Material& material = asset.materials[i];
        std::printf("  #%02x%02x%02x %-8s %8llu voxels\n", material.baseColor.r, material.baseColor.g,
                    material.baseColor.b, toString(material.type),
                    static_cast<unsigned long long>(sums.voxelsOfMaterial[i]));
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: walk-octree <file.pf_vox>\n", stderr);
        return 2;
    }
    pfvox::DiagnosticList diagnostics;
    const auto asset = pfvox::loadPfVox(argv[1], pfvox::Limits{}, diagnostics);
    if (!asset) {
        std::fprintf(stderr, "walk-octree: %s\n", describe(asset.error()).c_str());
        return 1;
    }
    for (const pfvox::OctreeModel& model : asset->models) printModel(*asset, model);
    return 0;
}

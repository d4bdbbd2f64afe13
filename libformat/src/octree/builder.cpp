// buildOctrees and buildOctree: every region of every model is one task; the top trees follow.
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <pfvox/octree.hpp>
#include <span>

#include "guarded.hpp"
#include "octree/lod_builder.hpp"
#include "octree/region_builder.hpp"
#include "voxel_partition.hpp"

namespace pfvox {

namespace {

/// The content of one region: bricks, or the voxels to fill some with.
struct RegionSource {
    glm::ivec3 coord;
    const VoxelRegion* bricks = nullptr;
    std::span<const VoxelPartition::Piece> pieces = {};
};

/// One region to build and where the result goes.
struct RegionTask {
    RegionSource source;
    OctreeRegion* target;
    octree::RegionBuilder::Extent extent;
};

/// Interleaves 21 bits of each coordinate.
std::uint64_t morton63(glm::uvec3 p) {
    std::uint64_t code = 0;
    for (unsigned group = 0; group < 3; ++group) {
        const unsigned shift = 10 * group;
        code |= static_cast<std::uint64_t>(mortonEncode(p >> shift)) << (3 * shift);
    }
    return code;
}

/// The model's regions that hold voxels.
std::vector<RegionSource> sourcesOf(const VoxelModel& model) {
    std::vector<RegionSource> sources;
    for (const auto& region : model.regions()) {
        if (!octree::isEmpty(*region)) sources.push_back({.coord = region->coord(), .bricks = region.get()});
    }
    return sources;
}

std::vector<RegionSource> sourcesOf(const VoxelPartition& partition) {
    std::vector<RegionSource> sources;
    for (const auto& pieces : partition.parts()) {
        sources.push_back({.coord = pieces.front().regionCoord, .pieces = pieces});
    }
    return sources;
}

/// Sorts by Morton code from the lowest coordinates, which are returned.
glm::ivec3 sortRegions(std::vector<RegionSource>& regions) {
    glm::ivec3 minCoord{std::numeric_limits<int>::max()};
    for (const RegionSource& region : regions) minCoord = glm::min(minCoord, region.coord);
    std::ranges::sort(regions, {},
                      [&](const RegionSource& r) { return morton63(glm::uvec3{r.coord - minCoord}); });
    return minCoord;
}

/// Builds the tree over regions[first, last), which all lie in the cube of this level; leaves carry no value.
octree::Slot buildTop(octree::NodeWriter& writer, std::span<const std::uint64_t> codes,
                      std::uint32_t levelsBelow) {
    if (codes.empty()) return {};
    // Leaves are told apart by their order alone; never uniform, so that two regions are not merged.
    if (levelsBelow == 0) return {.kind = octree::Slot::Kind::Leaf};
    std::array<octree::Slot, 8> children;
    for (std::uint64_t k = 8; k-- > 0;) {
        const auto begins = [&](std::uint64_t slot) {
            return std::ranges::partition_point(
                codes, [&](std::uint64_t code) { return ((code >> (3 * (levelsBelow - 1))) & 7u) < slot; });
        };
        children[k] = buildTop(writer, {begins(k), begins(k + 1)}, levelsBelow - 1);
    }
    return writer.combine(children);
}

Result<NodeTree> buildTopTree(std::span<const RegionSource> regions, glm::ivec3 minCoord,
                              std::uint32_t depth) {
    std::vector<std::uint64_t> codes;
    codes.reserve(regions.size());
    for (const RegionSource& region : regions) codes.push_back(morton63(glm::uvec3{region.coord - minCoord}));
    octree::NodeWriter writer;
    writer.finish(buildTop(writer, codes, depth));
    NodeTree tree;
    tree.depth = depth;
    PFVOX_CHECK(writer.writeTree(tree));
    return tree;
}

/// Everything of a model but the content of its regions, for which it adds tasks.
Result<OctreeModel> planModel(const Name& name, std::vector<RegionSource> regions, const Limits& limits,
                              std::vector<RegionTask>& tasks) {
    OctreeModel model;
    model.name = name;
    const glm::ivec3 minCoord = sortRegions(regions);
    if (regions.size() > limits.maxRegions) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("model '{}' has {} regions of 256^3 voxels, more than "
                                "maxRegions = {}",
                                name, regions.size(), limits.maxRegions));
    }
    model.regions.resize(regions.size());
    using Extent = octree::RegionBuilder::Extent;
    const Extent extent = regions.size() == 1 ? Extent::Shrink : Extent::Full;
    for (std::size_t i = 0; i < regions.size(); ++i) tasks.push_back({regions[i], &model.regions[i], extent});
    if (regions.size() <= 1) return model;

    std::uint64_t edgeRegions = 0;
    for (const RegionSource& region : regions) {
        const glm::i64vec3 offset = glm::i64vec3{region.coord} - glm::i64vec3{minCoord};
        edgeRegions =
            std::max({edgeRegions, static_cast<std::uint64_t>(offset.x) + 1,
                      static_cast<std::uint64_t>(offset.y) + 1, static_cast<std::uint64_t>(offset.z) + 1});
    }
    const auto topDepth = static_cast<std::uint32_t>(std::bit_width(edgeRegions - 1));
    model.depth = topDepth + kRegionEdgeLog2;
    if (model.depth > limits.maxModelDepth) {
        return fail(
            ErrorCode::LimitExceeded,
            fmt::format("model '{}' is {} voxels wide: {} octree levels, more than maxModelDepth = {}", name,
                        edgeRegions * kRegionEdge, model.depth, limits.maxModelDepth));
    }
    model.originVoxels = minCoord * kRegionEdge;
    PFVOX_TRY(NodeTree, topTree, buildTopTree(regions, minCoord, topDepth));
    model.topTree = std::move(topTree);
    model.indexRegions();
    return model;
}

/// What a thread builds regions with. Voxels of a list become bricks in one region that is used again and
/// again, so that its bricks stay in the cache and cost no fresh memory.
class RegionWorker {
  public:
    Result<OctreeRegion> build(const RegionTask& task, std::size_t materialCount,
                               const std::shared_ptr<MemoryPool>& pool) {
        const RegionSource& source = task.source;
        if (source.bricks != nullptr) return builder_.build(*source.bricks, task.extent, materialCount, pool);
        bricks_.reset(source.coord);
        for (const VoxelPartition::Piece& piece : source.pieces) bricks_.insert(piece.voxels);
        return builder_.build(bricks_, task.extent, materialCount, pool);
    }

  private:
    octree::RegionBuilder builder_;
    VoxelRegion bricks_{glm::ivec3{0}};
};

Result<void> runTasks(const std::vector<RegionTask>& tasks, std::size_t materialCount) {
    const auto pool = std::make_shared<MemoryPool>();
    tbb::enumerable_thread_specific<RegionWorker> workers;
    std::vector<std::optional<Error>> errors(tasks.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tasks.size(), 1), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            auto region = workers.local().build(tasks[i], materialCount, pool);
            if (region) {
                *tasks[i].target = *std::move(region);
            } else {
                errors[i] = std::move(region).error();
            }
        }
    });
    for (std::optional<Error>& error : errors) {
        if (error) return tl::make_unexpected(*std::move(error));
    }
    return {};
}

void summarise(OctreeModel& model) {
    for (const OctreeRegion& region : model.regions) {
        model.voxelCount += region.voxelCount;
        model.bounds.include(region.bounds);
    }
    if (model.regions.size() == 1) {
        model.depth = model.regions[0].tree.depth;
        model.originVoxels = model.regions[0].originVoxels;
    }
}

Result<OctreeModel> buildModel(const Name& name, std::vector<RegionSource> sources, std::size_t materialCount,
                               const Limits& limits) {
    std::vector<RegionTask> tasks;
    PFVOX_TRY(OctreeModel, model, planModel(name, std::move(sources), limits, tasks));
    PFVOX_CHECK(runTasks(tasks, materialCount));
    summarise(model);
    return model;
}

Result<OctreeAsset> buildAll(const VoxelAsset& asset, const Limits& limits, const BuildSettings& settings) {
    if (asset.materials.size() > limits.maxMaterials) {
        return fail(ErrorCode::LimitExceeded, fmt::format("{} materials, more than maxMaterials = {}",
                                                          asset.materials.size(), limits.maxMaterials));
    }
    OctreeAsset built{{static_cast<const AssetInfo&>(asset)}, {}};
    built.models.reserve(asset.models.size());
    std::vector<RegionTask> tasks;
    for (const VoxelModel& source : asset.models) {
        PFVOX_TRY(OctreeModel, model, planModel(source.name, sourcesOf(source), limits, tasks));
        built.models.push_back(std::move(model));  // moving keeps the regions where the tasks point
    }
    PFVOX_CHECK(runTasks(tasks, asset.materials.size()));
    for (OctreeModel& model : built.models) summarise(model);
    if (settings.lod) {
        for (std::size_t i = 0; i < built.models.size(); ++i)
            octree::addLod(asset.models[i], asset.materials, built.models[i]);
    }
    for (Material& material : built.materials) material = quantised(material);
    return built;
}

}  // namespace

Result<OctreeModel> buildOctree(const VoxelList& list, std::size_t materialCount, const Limits& limits) {
    return guarded([&] {
        const VoxelPartition partition(list.voxels, list.origin);
        return buildModel(list.name, sourcesOf(partition), materialCount, limits);
    });
}

Result<OctreeAsset> buildOctrees(const VoxelAsset& asset, const Limits& limits,
                                 const BuildSettings& settings) {
    return guarded([&] { return buildAll(asset, limits, settings); });
}

}  // namespace pfvox

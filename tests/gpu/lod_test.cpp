// Levels of detail on the GPU: which nodes stand for what lies below them, and with which color.
#include <bit>
#include <cmath>
#include <pfvox/gpu_scene.hpp>
#include <pfvox/ray_query.hpp>

#include "support/gpu_fixture.hpp"
#include "support/procedural.hpp"

namespace pfvox::test {
namespace {

constexpr double kVoxelMetres = 0.1;

class LodTest : public GpuTest {
  protected:
    static OctreeAsset detailed(VoxelModel model, int materials, bool lod = true) {
        VoxelAsset asset;
        for (int i = 0; i < materials; ++i)
            asset.materials.push_back(material(static_cast<std::uint8_t>(40 * i), 90, 200));
        asset.models.push_back(std::move(model));
        asset.instances.push_back({.model = 0, .worldFromModel = Affine(kVoxelMetres)});
        Result<OctreeAsset> built = buildOctrees(asset, Limits{}, {.lod = lod});
        EXPECT_TRUE(built);
        return std::move(*built);
    }

    static std::vector<gpu::GpuHit> cast(const OctreeAsset& asset, const std::vector<gpu::GpuRay>& rays) {
        DiagnosticList diagnostics;
        const gpu::ScenePart part{.asset = &asset};
        const auto hits = [&]() -> Result<std::vector<gpu::GpuHit>> {
            PFVOX_TRY(const gpu::Scene, scene, gpu::Scene::build(device(), {&part, 1}, diagnostics));
            PFVOX_TRY(const gpu::RayQuery, query, gpu::RayQuery::create(device()));
            PFVOX_TRY(gpu::RayBatch, batch, query.cast(device(), scene, rays, gpu::RayMode::ClosestHit));
            return std::move(batch.hits);
        }();
        EXPECT_TRUE(hits);
        return hits ? *hits : std::vector<gpu::GpuHit>{};
    }

    /// From all around towards all over the model, of that cone.
    static std::vector<gpu::GpuRay> raysAt(const OctreeAsset& asset, float cone, int count) {
        Random random(7);
        const VoxelBox& box = asset.models[0].bounds;
        const glm::dvec3 center = 0.5 * kVoxelMetres * glm::dvec3(box.min + box.max);
        const double radius = 0.5 * kVoxelMetres * glm::length(glm::dvec3(box.max - box.min));
        std::vector<gpu::GpuRay> rays;
        for (int i = 0; i < count; ++i) {
            const glm::dvec3 from = center + random.uniform(1.5, 6.0) * radius * random.direction();
            const glm::dvec3 to = center + 0.6 * radius * random.direction();
            rays.push_back({.origin = from, .direction = glm::normalize(to - from), .cone = cone});
        }
        return rays;
    }
};

/// The node with an edge of 2^log2 voxels around a voxel.
std::optional<std::pair<const OctreeRegion*, std::uint32_t>> nodeAround(const OctreeModel& model,
                                                                        glm::ivec3 voxel, int log2) {
    for (const OctreeRegion& region : model.regions) {
        const glm::ivec3 local = voxel - region.originVoxels;
        const int edge = 1 << region.tree.depth;
        if (glm::any(glm::lessThan(local, glm::ivec3(0))) ||
            glm::any(glm::greaterThanEqual(local, glm::ivec3(edge))))
            continue;
        std::uint32_t index = 0;
        for (int level = static_cast<int>(region.tree.depth); level > log2; --level) {
            const glm::ivec3 bit = (local >> (level - 1)) & 1;
            const auto slot = static_cast<std::uint32_t>(bit.x + 2 * bit.y + 4 * bit.z);
            const std::uint32_t inner = node::innerMask(region.tree.nodes[index]);
            if ((inner >> slot & 1u) == 0) return std::nullopt;
            index = region.tree.firstChild(index) +
                    static_cast<std::uint32_t>(std::popcount(inner & ((1u << slot) - 1)));
        }
        return std::pair{&region, index};
    }
    return std::nullopt;
}

TEST_F(LodTest, NodesNarrowerThanTheConeStandForWhatIsBelow) {
    Random random(3);
    const OctreeAsset asset = detailed(randomModel(random, 120, 0.05, 6), 6);
    const OctreeModel& model = asset.models[0];
    int levels = 0;
    for (const float cone : {0.01f, 0.03f, 0.1f}) {
        const std::vector<gpu::GpuRay> rays = raysAt(asset, cone, 2000);
        const std::vector<gpu::GpuHit> hits = cast(asset, rays);
        ASSERT_EQ(hits.size(), rays.size());
        for (std::size_t i = 0; i < hits.size(); ++i) {
            const gpu::GpuHit& hit = hits[i];
            if (!hit.hit) continue;
            const double width = cone * hit.t;
            const double edge = kVoxelMetres * std::exp2(hit.cellLog2);
            if (hit.lodColor == 0) {
                // A brick of 4^3 voxels that is as wide as the cone, where the ray comes in, is told apart.
                const double brick = 4.0 * edge;
                EXPECT_GE(1.0001 * brick, width - cone * std::sqrt(3.0) * brick) << i;
                continue;
            }
            ++levels;
            EXPECT_LT(edge, 1.0001 * width) << i;
            const auto node = nodeAround(model, hit.voxel, hit.cellLog2);
            ASSERT_TRUE(node.has_value()) << i;
            EXPECT_EQ(hit.lodColor, node->first->lod.colors[node->second]) << i;
            EXPECT_EQ(hit.material, node->first->palette[node->first->lod.materials[node->second]]) << i;
        }
    }
    EXPECT_GT(levels, 1000);
}

TEST_F(LodTest, WhatIsHitInDetailIsHitByTheCone) {
    Random random(4);
    const OctreeAsset asset = detailed(largeModel(5), 5);
    std::vector<gpu::GpuRay> rays = raysAt(asset, 0.05f, 2000);
    const std::vector<gpu::GpuHit> coarse = cast(asset, rays);
    for (gpu::GpuRay& ray : rays) ray.cone = 0.0f;
    const std::vector<gpu::GpuHit> fine = cast(asset, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(fine[i].lodColor, 0u) << i;
        if (!fine[i].hit) continue;
        ASSERT_TRUE(coarse[i].hit) << i;
        EXPECT_LE(coarse[i].t, fine[i].t * 1.0001f) << i;
    }
}

TEST_F(LodTest, WithoutLevelsOfDetailTheConeChangesNothing) {
    Random random(5);
    const OctreeAsset asset = detailed(randomModel(random, 40, 0.1, 4), 4, false);
    std::vector<gpu::GpuRay> rays = raysAt(asset, 0.1f, 500);
    const std::vector<gpu::GpuHit> wide = cast(asset, rays);
    for (gpu::GpuRay& ray : rays) ray.cone = 0.0f;
    const std::vector<gpu::GpuHit> thin = cast(asset, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(wide[i].hit, thin[i].hit);
        EXPECT_EQ(wide[i].voxel, thin[i].voxel);
        EXPECT_EQ(wide[i].lodColor, 0u);
    }
}

}  // namespace
}  // namespace pfvox::test

// Scene: what goes to the device, what is left out, and what the statistics say.
#include <bit>
#include <cmath>
#include <pfvox/gpu_scene.hpp>
#include <pfvox/ray_query.hpp>

#include "support/gpu_fixture.hpp"
#include "support/procedural.hpp"

namespace pfvox::test {
namespace {

class SceneTest : public GpuTest {
  protected:
    static Result<gpu::Scene> buildScene(std::span<const gpu::ScenePart> parts) {
        diagnostics_ = std::make_unique<DiagnosticList>();
        return gpu::Scene::build(device(), parts, *diagnostics_);
    }
    static gpu::GpuHit castOne(const gpu::Scene& scene, const gpu::GpuRay& ray,
                               gpu::RayMode mode = gpu::RayMode::ClosestHit) {
        Result<gpu::RayQuery> query = gpu::RayQuery::create(device());
        EXPECT_TRUE(query);
        Result<gpu::RayBatch> batch = query->cast(device(), scene, {&ray, 1}, mode);
        EXPECT_TRUE(batch && batch->hits.size() == 1);
        return batch->hits.front();
    }
    static inline std::unique_ptr<DiagnosticList> diagnostics_;
};

/// One voxel at (0, 0, 0).
VoxelAsset oneVoxel() {
    VoxelAsset asset;
    asset.materials = {material(255, 0, 0)};
    asset.models.emplace_back().set({0, 0, 0}, 0);
    asset.instances.emplace_back();
    return asset;
}

constexpr gpu::GpuRay kDownZ{.origin = {0.5f, 0.5f, 9.0f}, .direction = {0.0f, 0.0f, -2.0f}};

TEST_F(SceneTest, CountsWhatItHolds) {
    const OctreeAsset asset = build(demoRoom());
    const gpu::ScenePart part{.asset = &asset};
    PFVOX_ASSERT_VALUE(const gpu::Scene, scene, buildScene({&part, 1}));
    const gpu::SceneStatistics& s = scene.statistics();
    EXPECT_EQ(s.models, 1u);
    EXPECT_EQ(s.instances, 1u);
    EXPECT_EQ(s.regions, 1u);
    EXPECT_EQ(s.materials, 6u);
    EXPECT_EQ(s.voxels, asset.models[0].voxelCount);
    EXPECT_GT(s.nodeBytes, 0u);
    EXPECT_EQ(s.paletteBytes, 4 * asset.models[0].regions[0].palette.size());
    EXPECT_NEAR(scene.bounds().max.x, 6.4, 1e-9);
}

TEST_F(SceneTest, ClosestHitGivesEverything) {
    const OctreeAsset asset = build(oneVoxel());
    const gpu::ScenePart part{.asset = &asset};
    PFVOX_ASSERT_VALUE(const gpu::Scene, scene, buildScene({&part, 1}));
    const gpu::GpuHit hit = castOne(scene, kDownZ);
    ASSERT_TRUE(hit.hit);
    EXPECT_FLOAT_EQ(hit.t, 4.0f);
    EXPECT_EQ(hit.voxel, glm::ivec3(0));
    EXPECT_EQ(hit.face, 5);
    EXPECT_EQ(hit.normal, glm::vec3(0.0f, 0.0f, 1.0f));
}

TEST_F(SceneTest, RaysEndAtTMax) {
    const OctreeAsset asset = build(oneVoxel());
    const gpu::ScenePart part{.asset = &asset};
    PFVOX_ASSERT_VALUE(const gpu::Scene, scene, buildScene({&part, 1}));
    for (const gpu::RayMode mode : {gpu::RayMode::ClosestHit, gpu::RayMode::AnyHit}) {
        gpu::GpuRay ray = kDownZ;
        ray.tMax = 3.9f;
        EXPECT_FALSE(castOne(scene, ray, mode).hit);
        ray.tMax = 4.1f;
        EXPECT_TRUE(castOne(scene, ray, mode).hit);
    }
}

// Any finite ray ends, with a finite answer, however absurd.
TEST_F(SceneTest, EveryFiniteRayEnds) {
    const OctreeAsset asset = build(demoRoom());
    const gpu::ScenePart part{.asset = &asset};
    PFVOX_ASSERT_VALUE(const gpu::Scene, scene, buildScene({&part, 1}));
    PFVOX_ASSERT_VALUE(const gpu::RayQuery, query, gpu::RayQuery::create(device()));
    Random random(11);
    const auto anyFloat = [&] {
        for (;;) {
            const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random.next()));
            if (std::isfinite(value)) return value;
        }
    };
    const auto anyOf = [&](float usual) {
        switch (random.integer(0, 4)) {
            case 0:
                return 0.0f;
            case 1:
                return anyFloat();
            case 2:
                return std::nextafter(usual, 1e9f);
            default:
                return usual;
        }
    };
    std::vector<gpu::GpuRay> rays;
    for (int i = 0; i < 50'000; ++i) {
        gpu::GpuRay ray;
        for (int axis = 0; axis < 3; ++axis) {
            ray.origin[axis] = anyOf(static_cast<float>(random.integer(-10, 70)) * 0.1f);
            ray.direction[axis] = anyOf(static_cast<float>(random.uniform(-1.0, 1.0)));
        }
        if (ray.direction == glm::vec3(0.0f)) ray.direction.x = 1.0f;
        rays.push_back(ray);
    }
    for (const gpu::RayMode mode : {gpu::RayMode::ClosestHit, gpu::RayMode::AnyHit}) {
        PFVOX_ASSERT_VALUE(const gpu::RayBatch, batch, query.cast(device(), scene, rays, mode));
        std::size_t hits = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const gpu::GpuHit& hit = batch.hits[i];
            EXPECT_FALSE(hit.stepLimitReached) << i;
            if (!hit.hit) continue;
            ++hits;
            if (mode == gpu::RayMode::AnyHit) continue;
            EXPECT_TRUE(std::isfinite(hit.t)) << i;
            EXPECT_NEAR(glm::length(hit.normal), 1.0f, 1e-4f) << i;
            EXPECT_TRUE(asset.models[0].at(hit.voxel).has_value()) << i;
        }
        EXPECT_GT(hits, 5'000u);
    }
}

// What an editor does again and again: models stay on the device, only where they stand is new.
TEST_F(SceneTest, AModelThatIsOnTheDeviceIsTakenFromThere) {
    const OctreeAsset room = build(demoRoom());
    const OctreeAsset voxel = build(oneVoxel());
    std::vector<gpu::ScenePart> parts{{.asset = &room}};
    PFVOX_ASSERT_VALUE(const gpu::Scene, first, buildScene(parts));
    const std::uint64_t before = device().memory().currentBytes;
    parts[0].worldFromAsset[3] = {0, 0, -50};
    parts.push_back({.asset = &voxel});
    DiagnosticList diagnostics;
    PFVOX_ASSERT_VALUE(gpu::Scene, second,
                       gpu::Scene::build(device(), parts, diagnostics, {.known = &first}));
    PFVOX_ASSERT_VALUE(const gpu::Scene, fresh, buildScene(parts));
    EXPECT_EQ(second.statistics().totalBytes(), fresh.statistics().totalBytes());
    EXPECT_EQ(second.statistics().voxels, fresh.statistics().voxels);
    EXPECT_EQ(second.statistics().materials, 7u);
    const gpu::GpuHit hit = castOne(second, kDownZ);
    EXPECT_TRUE(hit.hit);
    EXPECT_EQ(hit.voxel, glm::ivec3(0));
    Random random(21);
    for (int i = 0; i < 40; ++i) {
        const gpu::GpuRay ray{.origin = {3, 2, 5}, .direction = glm::vec3(random.direction())};
        const gpu::GpuHit a = castOne(second, ray);
        const gpu::GpuHit b = castOne(fresh, ray);
        EXPECT_EQ(a.hit, b.hit);
        EXPECT_TRUE(!a.hit || (a.t == b.t && a.material == b.material && a.voxel == b.voxel));
    }
    // Its blocks live on when the scene they were made for is gone; and materials that move are written anew.
    std::swap(parts[0], parts[1]);
    PFVOX_ASSERT_VALUE(gpu::Scene, third,
                       gpu::Scene::build(device(), parts, diagnostics, {.known = &second}));
    second = std::move(third);
    EXPECT_EQ(castOne(second, kDownZ).material, 0u);
    const gpu::GpuRay intoRoom{.origin = {3, 2, -10}, .direction = {0, 0, -1}};
    EXPECT_GE(castOne(second, intoRoom).material, 1u);
    EXPECT_LT(before, device().memory().currentBytes);
}

TEST_F(SceneTest, OnlyTheTableIsNewWhenAModelMoves) {
    const OctreeAsset room = build(demoRoom());
    std::vector<gpu::ScenePart> parts{{.asset = &room}};
    PFVOX_ASSERT_VALUE(const gpu::Scene, first, buildScene(parts));
    parts[0].worldFromAsset[3].x = 1.0;
    DiagnosticList diagnostics;
    for (int i = 0; i < 4; ++i) {  // staging memory grows at first and stays
        PFVOX_ASSERT_VALUE(const gpu::Scene, warm,
                           gpu::Scene::build(device(), parts, diagnostics, {.known = &first}));
    }
    const std::uint64_t before = device().memory().currentBytes;
    PFVOX_ASSERT_VALUE(const gpu::Scene, second,
                       gpu::Scene::build(device(), parts, diagnostics, {.known = &first}));
    const std::uint64_t more = device().memory().currentBytes - before;
    EXPECT_LT(more, first.statistics().nodeBytes + first.statistics().instanceBytes);
    EXPECT_GE(more, second.statistics().instanceBytes);
}

TEST_F(SceneTest, EmptyScenesAreMissed) {
    const OctreeAsset nothing;
    const gpu::ScenePart part{.asset = &nothing};
    PFVOX_ASSERT_VALUE(const gpu::Scene, scene, buildScene({&part, 1}));
    EXPECT_TRUE(scene.bounds().empty());
    EXPECT_FALSE(castOne(scene, kDownZ).hit);
}

TEST_F(SceneTest, LeavesHiddenAndFlatInstancesOut) {
    VoxelAsset voxels = oneVoxel();
    voxels.instances[0].hidden = true;
    Instance flat;
    flat.name = "flat";
    flat.worldFromModel[1] = glm::dvec3(0.0);
    voxels.instances.push_back(flat);
    const OctreeAsset asset = build(voxels);
    const gpu::ScenePart part{.asset = &asset};
    PFVOX_ASSERT_VALUE(const gpu::Scene, scene, buildScene({&part, 1}));
    EXPECT_EQ(scene.statistics().instances, 0u);
    ASSERT_EQ(diagnostics_->entries().size(), 1u);
    EXPECT_EQ(diagnostics_->entries()[0].id, "scene-flat-instance");
}

TEST_F(SceneTest, PartsAreCountedOn) {
    // Two assets beside each other: instance and material numbers of the second follow those of the first.
    const OctreeAsset first = build(demoRoom());
    const OctreeAsset second = build(oneVoxel());
    Affine aside = identityAffine();
    aside[3] = glm::dvec3(100.0, 0.0, 0.0);
    const std::array parts{gpu::ScenePart{.asset = &first},
                           gpu::ScenePart{.asset = &second, .worldFromAsset = aside}};
    PFVOX_ASSERT_VALUE(const gpu::Scene, scene, buildScene(parts));
    const gpu::GpuHit hit =
        castOne(scene, {.origin = {100.5f, 0.5f, 9.0f}, .direction = {0.0f, 0.0f, -1.0f}});
    ASSERT_TRUE(hit.hit);
    EXPECT_EQ(hit.instance, 1u);
    EXPECT_EQ(hit.material, 6u);
}

TEST_F(SceneTest, InstanceOfAMissingModelIsAnError) {
    OctreeAsset asset = build(oneVoxel());
    asset.instances[0].model = 7;
    const gpu::ScenePart part{.asset = &asset};
    const auto scene = buildScene({&part, 1});
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().code, ErrorCode::BadReference);
}

}  // namespace
}  // namespace pfvox::test

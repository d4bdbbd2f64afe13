// Where probes can stand.
#include "bake/probe_placement.hpp"

#include "bake_fixture.hpp"

namespace pfvox::test {
namespace {

LoadedScene slabScene(const Affine& world = identityAffine()) {
    VoxelModel slab;
    fillBox(slab, {{0, 0, 0}, {20, 4, 20}}, [](glm::ivec3) { return MaterialIndex{0}; });
    return sceneOf(assetOf(std::move(slab), {gray(100)}), world);
}

TEST(SolidQuery, DistancesAreThoseToTheBox) {
    Affine world{glm::dmat4x3(1.0)};
    world[0] = glm::dvec3(0.0, 2.0, 0.0);  // turned, and stretched along the axes
    world[1] = glm::dvec3(-0.5, 0.0, 0.0);
    world[2] = glm::dvec3(0.0, 0.0, 3.0);
    world[3] = glm::dvec3(1.0, -2.0, 0.5);
    Random random(8);
    for (const Affine& m : {identityAffine(), world}) {
        const LoadedScene scene = slabScene(m);
        const auto models = bake::placedModels(scene);
        const bake::SolidQuery query(models);
        for (int i = 0; i < 500; ++i) {
            const glm::dvec3 p =
                scene.bounds.min + (scene.bounds.max - scene.bounds.min) *
                                       glm::dvec3(random.uniform(-0.5, 1.5), random.uniform(-2.0, 3.0),
                                                  random.uniform(-0.5, 1.5));
            const double expected = glm::length(p - glm::clamp(p, scene.bounds.min, scene.bounds.max));
            EXPECT_NEAR(query.nearest(p, 100.0).metres, expected, 1e-9);
        }
    }
}

class PlaceProbe : public ::testing::Test {
  protected:
    bake::Placement place(const glm::vec3& at, float step, bool relocate = true) {
        const bake::SolidQuery query(models_);
        return bake::placeProbe(query, {.start = at, .step = glm::vec3(step), .counts = glm::uvec3(1)}, 0,
                                relocate);
    }
    LoadedScene scene_ = slabScene();
    std::vector<bake::PlacedModel> models_ = bake::placedModels(scene_);
};

TEST_F(PlaceProbe, FreeOnesStay) {
    EXPECT_EQ(place({1.0f, 0.6f, 1.0f}, 1.0f).state, ProbeState::Active);
    EXPECT_EQ(place({50.0f, 0.6f, 1.0f}, 1.0f).state, ProbeState::Active);
}

TEST_F(PlaceProbe, ThoseInOrNearASolidMoveOutOfIt) {
    for (const float y : {0.35f, 0.45f}) {  // inside, and half a voxel above
        const bake::Placement placed = place({1.0f, y, 1.0f}, 1.0f);
        ASSERT_EQ(placed.state, ProbeState::Relocated);
        EXPECT_GE(y + placed.offset.y, 0.5f);
        EXPECT_LE(glm::length(placed.offset), 0.45f);
        EXPECT_EQ(placed.offset.x, 0.0f);
    }
}

TEST_F(PlaceProbe, WithoutAFreePlaceTheyAreInactive) {
    EXPECT_EQ(place({1.0f, 0.2f, 1.0f}, 0.2f).state, ProbeState::Inactive);
    EXPECT_EQ(place({1.0f, 0.35f, 1.0f}, 1.0f, false).state, ProbeState::Inactive);
}

}  // namespace
}  // namespace pfvox::test

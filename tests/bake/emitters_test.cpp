// Exposed faces and the list of emitters.
#include "bake/emitters.hpp"
#include <pfvox/octree_walk.hpp>

#include "bake_fixture.hpp"

namespace pfvox::test {
namespace {

std::size_t exposedFaces(const OctreeAsset& asset) {
    const std::vector<bool> all(asset.materials.size(), true);
    std::size_t count = 0;
    forEachExposedFace(asset.models[0], {.wanted = all, .hides = all}, [&](const VoxelFace&) { ++count; });
    return count;
}

TEST(ExposedFaces, AreThoseWithoutNeighbor) {
    Random random(5);
    for (const double density : {0.05, 0.5, 0.95}) {
        const OctreeAsset asset =
            build(assetOf(randomModel(random, 20, density, 3), {gray(1), gray(2), gray(3)}));
        const OctreeModel& octree = asset.models[0];
        std::size_t expected = 0;
        for (int i = 0; i < 20 * 20 * 20; ++i) {
            const glm::ivec3 p(i % 20, i / 20 % 20, i / 400);
            if (!octree.at(p)) continue;
            for (int axis = 0; axis < 3; ++axis) {
                for (const int side : {-1, 1}) {
                    glm::ivec3 next = p;
                    next[axis] += side;
                    expected += octree.at(next) ? 0u : 1u;
                }
            }
        }
        EXPECT_EQ(exposedFaces(asset), expected);
    }
}

TEST(ExposedFaces, ReachOverRegionsAndLargeLeaves) {
    VoxelModel model;
    fillBox(model, {{250, 0, 0}, {266, 16, 16}}, [](glm::ivec3) { return MaterialIndex{0}; });
    EXPECT_EQ(exposedFaces(build(assetOf(std::move(model), {gray(1)}))), 6u * 16u * 16u);
}

TEST(Emitters, HaveTheirPlaceAreaAndDirection) {
    const auto oneVoxel = [] {
        VoxelModel model;
        model.set({2, 3, 4}, 0);
        return model;
    };
    Affine mirrored{0.5};
    mirrored[0] *= -1.0;
    for (const Affine& world : {identityAffine(), mirrored}) {
        const LoadedScene scene = sceneOf(assetOf(oneVoxel(), {gray(255, 2.0)}), world);
        const auto models = bake::placedModels(scene);
        const bake::EmitterList list = bake::makeEmitters(models);
        ASSERT_EQ(list.faces.size(), 6u);
        const glm::dvec3 middle = 0.5 * (scene.bounds.min + scene.bounds.max);
        const double edge = scene.bounds.max.x - scene.bounds.min.x;
        EXPECT_NEAR(static_cast<double>(list.power), 6.0 * edge * edge * 2.0, 1e-5);
        for (const shared::EmitterFace& face : list.faces) {
            const glm::dvec3 outward(glm::cross(face.edgeU, face.edgeV));
            EXPECT_NEAR(glm::length(outward), edge * edge, 1e-6);
            const glm::dvec3 center =
                glm::dvec3(face.corner) + 0.5 * glm::dvec3(face.edgeU + face.edgeV) - middle;
            EXPECT_NEAR(glm::dot(glm::normalize(outward), center), 0.5 * edge, 1e-6);
            EXPECT_NEAR(static_cast<double>(face.offset), 0.01 * edge, 1e-7);
        }
    }
}

std::size_t emittersUnder(const Material& cover) {
    VoxelModel model;
    fillBox(model, {{0, 0, 0}, {3, 3, 3}},
            [](glm::ivec3 p) { return static_cast<MaterialIndex>(p == glm::ivec3(1) ? 1 : 0); });
    const LoadedScene scene = sceneOf(assetOf(std::move(model), {cover, gray(255, 1.0)}));
    return bake::makeEmitters(bake::placedModels(scene)).faces.size();
}

TEST(Emitters, ThatAreCoveredAreNotThere) {
    EXPECT_EQ(emittersUnder(gray(9)), 0u);
    Material glass = gray(255);
    glass.type = MaterialType::Glass;
    glass.transparency = 0.5f;
    EXPECT_EQ(emittersUnder(glass), 6u);
}

TEST(AliasTable, GivesEachEntryItsFraction) {
    Random random(3);
    std::vector<double> weights;
    for (int i = 0; i < 500; ++i)
        weights.push_back(i % 7 == 0 ? 100.0 * random.uniform(0.0, 1.0) : random.uniform(0.01, 1.0));
    std::vector<shared::EmitterFace> faces(weights.size());
    bake::makeAliasTable(weights, faces);
    double sum = 0.0;
    for (const double w : weights) sum += w;
    std::vector<double> fraction(weights.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const auto threshold = static_cast<double>(faces[i].threshold);
        fraction[i] += threshold / 500.0;
        fraction[faces[i].alias] += (1.0 - threshold) / 500.0;
    }
    for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(fraction[i], weights[i] / sum, 1e-7);
}

}  // namespace
}  // namespace pfvox::test

// Which faces light can reach, against the question asked voxel by voxel.
#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <pfvox/face_index.hpp>
#include <random>
#include <set>

#include "support/procedural.hpp"

namespace pfvox::test {
namespace {

constexpr MaterialIndex kStone = 0;
constexpr MaterialIndex kClear = 1;
constexpr MaterialIndex kCloudy = 2;

std::vector<Material> stoneAndGlass() {
    std::vector<Material> materials{material(180, 180, 180), material(200, 200, 255),
                                    material(200, 255, 200)};
    for (const std::size_t glass : {std::size_t{kClear}, std::size_t{kCloudy}}) {
        materials[glass].type = MaterialType::Glass;
        materials[glass].transparency = glass == kClear ? 1.0f : 0.5f;
    }
    return materials;
}

using Face = std::array<int, 4>;  ///< voxel, face

std::set<Face> facesByVoxel(const OctreeModel& model, const std::vector<Material>& materials) {
    std::set<Face> faces;
    const auto solid = [&](glm::ivec3 p) {
        const auto m = model.at(p);
        return m && !letsThrough(materials[*m]);
    };
    for (int z = model.bounds.min.z; z < model.bounds.max.z; ++z)
        for (int y = model.bounds.min.y; y < model.bounds.max.y; ++y)
            for (int x = model.bounds.min.x; x < model.bounds.max.x; ++x) {
                const glm::ivec3 voxel(x, y, z);
                const auto m = model.at(voxel);
                if (!m || (!solid(voxel) && materials[*m].transparency >= 1.0f)) continue;
                for (int face = 0; face < 6; ++face) {
                    glm::ivec3 beside = voxel;
                    beside[face / 2] += face % 2 != 0 ? 1 : -1;
                    const bool hidden = solid(voxel) ? solid(beside) : model.at(beside).has_value();
                    if (!hidden) faces.insert({x, y, z, face});
                }
            }
    return faces;
}

std::vector<Face> facesByIndex(const FaceIndex& index) {
    std::vector<Face> faces;
    for (const FaceRegion& region : index.regions) {
        EXPECT_EQ(faces.size(), region.firstFace);
        std::uint32_t last = 0;
        for (std::uint32_t i = region.firstBrick; i < region.endBrick; ++i) {
            const FaceBrick& brick = index.bricks[i];
            EXPECT_EQ(faces.size(), brick.firstFace);
            EXPECT_TRUE(i == region.firstBrick || brick.path > last);
            last = brick.path;
            std::uint32_t mask = brick.firstMask;
            for (int face = 0; face < 6; ++face) {
                if ((brick.directions >> face & 1) == 0) continue;
                EXPECT_NE(index.masks[mask], 0u);
                for (std::uint64_t rest = index.masks[mask++]; rest != 0; rest &= rest - 1) {
                    const int k = std::countr_zero(rest);
                    const glm::ivec3 at =
                        region.originVoxels + brick.corner() + glm::ivec3(k & 3, k >> 2 & 3, k >> 4);
                    faces.push_back({at.x, at.y, at.z, face});
                }
            }
        }
        EXPECT_EQ(faces.size(), region.endFace);
    }
    EXPECT_EQ(faces.size(), index.faceCount);
    return faces;
}

void expectSameFaces(VoxelModel model) {
    VoxelAsset asset;
    asset.materials = stoneAndGlass();
    asset.models.push_back(std::move(model));
    const OctreeAsset built = build(asset);
    const auto index = makeFaceIndex(built.models[0], built.materials);
    ASSERT_TRUE(index) << describe(index.error());
    const std::vector<Face> found = facesByIndex(*index);
    const std::set<Face> distinct(found.begin(), found.end());
    EXPECT_EQ(distinct.size(), found.size());
    EXPECT_EQ(distinct, facesByVoxel(built.models[0], built.materials));
    for (std::size_t region = 0; region < index->regions.size(); ++region) {
        const std::vector<std::uint32_t> order = index->fileOrder(region);
        const std::uint32_t first = index->regions[region].firstFace;
        ASSERT_EQ(order.size(), index->regions[region].endFace - first);
        std::set<std::uint32_t> seen(order.begin(), order.end());
        EXPECT_EQ(seen.size(), order.size());
        for (std::size_t i = 1; i < order.size(); ++i)
            EXPECT_LE(found[first + order[i - 1]][3], found[first + order[i]][3]);
    }
}

TEST(FaceIndexTest, ScatteredStoneAndGlassHasTheFacesThatTheVoxelsSay) {
    for (const int edge : {1, 2, 3, 5, 9, 20}) {
        std::mt19937 random(static_cast<unsigned>(edge));
        VoxelModel model;
        for (int i = 0; i < edge * edge * edge / 2 + 1; ++i) {
            const auto coordinate = [&] {
                return static_cast<int>(random() % static_cast<unsigned>(edge)) - 3;
            };
            model.set({coordinate(), coordinate(), coordinate()}, static_cast<MaterialIndex>(random() % 3));
        }
        expectSameFaces(std::move(model));
    }
}

TEST(FaceIndexTest, LargeLeavesAndModelsOverSeveralRegionsHaveTheirSides) {
    VoxelModel model;
    fillBox(model, {{-20, 0, 0}, {44, 32, 16}},
            [](glm::ivec3) { return std::optional<MaterialIndex>(kStone); });
    fillBox(model, {{230, 3, 5}, {290, 9, 8}},
            [](glm::ivec3 p) { return std::optional<MaterialIndex>(p.x < 260 ? kStone : kCloudy); });
    expectSameFaces(std::move(model));
}

}  // namespace
}  // namespace pfvox::test

#include <cstring>
#include <pfvox/import.hpp>

#include "support/corpus.hpp"
#include "support/import_helpers.hpp"
#include "support/legacy_writer.hpp"

namespace pfvox::test {
namespace {

/// Voxels of a .vox file with one model, by its XYZI chunk alone, in our axes.
std::set<std::array<int, 3>> readXyzi(const Bytes& vox) {
    std::set<std::array<int, 3>> voxels;
    const std::string_view text(reinterpret_cast<const char*>(vox.data()), vox.size());
    const std::size_t at = text.find("XYZI");
    if (at == std::string_view::npos || text.find("XYZI", at + 4) != std::string_view::npos) return voxels;
    std::uint32_t count = 0;
    std::memcpy(&count, vox.data() + at + 12, 4);
    for (std::uint32_t i = 0; i < count; ++i) {
        std::array<std::uint8_t, 4> v{};
        std::memcpy(v.data(), vox.data() + at + 16 + 4 * std::size_t{i}, 4);
        voxels.insert({v[0], v[2], -v[1] - 1});
    }
    return voxels;
}

TEST(ImportLegacy, OccupancyOfCorpusEqualsItsSources) {
    const auto files = corpusFiles("legacy", ".pf_vox");
    if (files.empty()) GTEST_SKIP() << "corpus/legacy is absent";
    int compared = 0;
    for (const auto& file : files) {
        SCOPED_TRACE(file.filename());
        const Imported imported = importAs(readBytes(file), file.string());
        ASSERT_TRUE(imported.result) << imported.errorText();
        ASSERT_EQ(imported.result->models.size(), 1u);
        EXPECT_EQ(imported.result->source.format, "legacy");
        const auto source =
            std::filesystem::path(PFVOX_CORPUS_DIR) / "vox" / "mmmm" / file.stem().concat(".vox");
        if (!std::filesystem::exists(source)) continue;
        const auto expected = readXyzi(readBytes(source));
        if (expected.empty()) continue;
        EXPECT_EQ(movedToOrigin(voxelSet(imported.result->models[0])), movedToOrigin(expected));
        ++compared;
    }
    RecordProperty("compared", compared);
    EXPECT_GT(compared, 0);
}

TEST(ImportLegacy, MapsCubesBackToSourceAxes) {
    // A 4^3 octree: one leaf of edge 2 in slot 0, one voxel at (3, 2, 1) below slot 3.
    LegacyWriter writer;
    writer.depth = 2;
    writer.extent = {1.0f, 0.75f, 0.5f};
    writer.origin = {-10.0f, 20.0f, 30.0f};
    writer.nodes = {{.leafMask = 0b0001, .validMask = 0b1001},
                    {.leafMask = 0b100'0000 >> 1, .validMask = 0b10'0000}};
    writer.leafMaterials = {0, 1};
    writer.materials.resize(2);
    writer.materials[1].color = {0.2f, 0.4f, 0.6f, 1.0f};
    const Imported imported = importAs(writer.bytes(), "two.pf_vox");
    ASSERT_TRUE(imported.result) << imported.errorText();

    const VoxelModel& model = imported.result->models[0];
    EXPECT_EQ(model.voxelCount(), 9u);
    EXPECT_EQ(model.at({0, 0, 3}), 0);
    EXPECT_EQ(model.at({1, 1, 2}), 0);
    EXPECT_EQ(model.at({3, 2, 2}), 1);
    // Source voxel (3 - 10, 1 + 30, 2 + 20) = (-7, 31, 22) becomes (-7, 22, -32).
    const glm::dvec3 corner = imported.result->instances[0].worldFromModel * glm::dvec4{3, 2, 2, 1};
    EXPECT_NEAR(corner.x, -0.7, 1e-12);
    EXPECT_NEAR(corner.y, 2.2, 1e-12);
    EXPECT_NEAR(corner.z, -3.2, 1e-12);
    EXPECT_EQ(imported.result->materials[1].baseColor, (glm::u8vec4{51, 102, 153, 255}));
}

TEST(ImportLegacy, KeepsLargeLeavesAsTiles) {
    LegacyWriter writer;
    writer.depth = 12;
    writer.extent = {0.5f, 0.5f, 0.5f};
    writer.nodes = {{.leafMask = 1, .validMask = 1}};
    writer.leafMaterials = {0};
    const Imported imported = importAs(writer.bytes(), "big.pf_vox");
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_EQ(imported.result->models[0].voxelCount(), std::uint64_t{1} << 33);
    EXPECT_LT(imported.result->models[0].memoryBytes(), 1u << 20);
}

TEST(ImportLegacy, RefusesCubesThatOutgrowTheLimits) {
    LegacyWriter writer;
    writer.depth = 23;
    writer.extent = {0.5f, 0.5f, 0.5f};
    writer.nodes = {{.leafMask = 1, .validMask = 1}};
    writer.leafMaterials = {0};
    const Imported imported = importAs(writer.bytes(), "huge.pf_vox");
    ASSERT_FALSE(imported.result);
    EXPECT_EQ(imported.result.error().code, ErrorCode::LimitExceeded);
}

TEST(ImportLegacy, ConvertsMaterials) {
    LegacyWriter writer = LegacyWriter::solidVoxel();
    writer.materials.resize(4);
    writer.materials[1] = {
        .type = 1, .metalness = 0.5f, .roughness = 0.25f, .specular = 0.75f, .indexOfRefraction = 1.0f};
    writer.materials[2] = {.type = 2, .indexOfRefraction = 1.3f, .alpha = 0.25f};
    writer.materials[3] = {.type = 3, .flux = 2.0f, .emission = 0.5f, .color = {7.0f, 0.0f, 0.0f, 1.0f}};
    const Imported imported = importAs(writer.bytes(), "materials.pf_vox");
    ASSERT_TRUE(imported.result) << imported.errorText();
    const auto& materials = imported.result->materials;
    EXPECT_EQ(materials[0].type, MaterialType::Diffuse);
    EXPECT_EQ(materials[0].roughness, 1.0f);
    EXPECT_EQ(materials[1].type, MaterialType::Metal);
    EXPECT_EQ(materials[1].roughness, 0.25f);
    EXPECT_EQ(materials[1].indexOfRefraction, 1.5f);
    EXPECT_EQ(materials[2].transparency, 0.25f);
    EXPECT_EQ(materials[2].indexOfRefraction, 1.3f);
    EXPECT_FLOAT_EQ(materials[3].emissionStrength, 50.0f);
    EXPECT_EQ(materials[3].baseColor.r, 255);
    EXPECT_TRUE(imported.reported("legacy-material-range"));
}

TEST(ImportLegacy, IsKnownByNameAndSizesOnly) {
    const Bytes bytes = LegacyWriter::solidVoxel().bytes();
    EXPECT_TRUE(importAs(bytes, "a.PF_VOX").result);
    EXPECT_EQ(importAs(bytes, "a.bin").result.error().code, ErrorCode::UnsupportedFormat);
    EXPECT_FALSE(looksLikeSource("out/a.pf_vox")) << "folder mode would take its own output for input";
}

}  // namespace
}  // namespace pfvox::test

// The bytes of PF_VOX 1.0. A reader must always take the file of every version; the writer of this version
// must make the same bytes again. Where the writer changes on purpose, run with PFVOX_UPDATE_GOLDEN=1 and say
// why in CHANGELOG.md.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <pfvox/pf_vox.hpp>

#include "support/voxel_models.hpp"

namespace pfvox {
namespace {

/// One kind of file.
struct Golden {
    const char* name;
    bool lod = false;
    Profile profile = Profile::Packed;

    std::filesystem::path file() const {
        return std::filesystem::path(PFVOX_TESTS_DIR) / "golden/data" / name;
    }
};

void PrintTo(const Golden& golden, std::ostream* out) {
    *out << golden.name;
}

/// Several levels, a top tree, all record types; and nothing random, so that it is the same everywhere.
OctreeAsset goldenAsset(bool lod) {
    std::vector<VoxelModel> models;
    models.push_back(test::boxModel({3, 5, 7}, {20, 9, 31}, 1));
    models[0].name = "box";
    for (int i = 0; i < 40; ++i)
        models[0].set({i, (i * 7) % 23, (i * 11) % 29}, static_cast<MaterialIndex>(i % 4));
    models.push_back(test::boxModel({250, 0, -8}, {262, 10, 3}, 2));
    models.emplace_back();
    return buildOctrees(test::assetOf(std::move(models)), Limits{}, {.lod = lod}).value();
}

std::vector<std::byte> readAll(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

class PfVoxGolden : public testing::TestWithParam<Golden> {};

INSTANTIATE_TEST_SUITE_P(
    Files, PfVoxGolden,
    testing::Values(Golden{.name = "v1_0.pf_vox"}, Golden{.name = "v1_0_lod.pf_vox", .lod = true},
                    Golden{.name = "v1_0_resident.pf_vox", .profile = Profile::Resident},
                    Golden{.name = "v1_0_resident_lod.pf_vox", .lod = true, .profile = Profile::Resident}));

TEST_P(PfVoxGolden, WriterMakesTheSameBytes) {
    const ContentKey key{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}};
    const std::vector<std::byte> bytes =
        encodePfVox(goldenAsset(GetParam().lod), {.contentKey = key, .profile = GetParam().profile}).value();
    if (std::getenv("PFVOX_UPDATE_GOLDEN") != nullptr) {
        std::ofstream(GetParam().file(), std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    EXPECT_EQ(bytes, readAll(GetParam().file()));
}

TEST_P(PfVoxGolden, ReaderTakesVersion1_0) {
    DiagnosticList diagnostics;
    const auto asset = loadPfVox(GetParam().file(), Limits{}, diagnostics);
    ASSERT_TRUE(asset) << describe(asset.error());
    const OctreeAsset expected = goldenAsset(GetParam().lod);
    ASSERT_EQ(asset->models.size(), 3u);
    EXPECT_EQ(asset->models[0].name, "box");
    EXPECT_EQ(asset->materials, expected.materials);
    EXPECT_EQ(asset->models[0].regions[0].lod, expected.models[0].regions[0].lod);
    for (int z = -8; z < 32; ++z)
        for (int y = -2; y < 24; ++y)
            for (int x = -2; x < 264; ++x) {
                ASSERT_EQ(asset->models[0].at({x, y, z}), expected.models[0].at({x, y, z}));
                ASSERT_EQ(asset->models[1].at({x, y, z}), expected.models[1].at({x, y, z}));
            }
    EXPECT_EQ(readPfVoxHeader(readAll(GetParam().file()))->contentKey.hex(),
              "0102030405060708090a0b0c0d0e0f10");
}

}  // namespace
}  // namespace pfvox

// Every real .vox file, compared voxel by voxel with the independent reader.
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <pfvox/import.hpp>
#include <set>
#include <sstream>

#include "support/corpus.hpp"
#include "support/independent_vox_reader.hpp"
#include "support/vox_asset_cells.hpp"

namespace pfvox {
namespace {

using test::IndependentVoxReader;

std::string readAll(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream content;
    content << stream.rdbuf();
    return content.str();
}

/// Files that must be refused, with what the message must say about them.
const std::map<std::string, std::string> kRefused{{"slab6_vox_test.vox", "SLAB6"},
                                                  {"teardown.vox", "Teardown"},
                                                  {"not_a.vox", "does not start with \"VOX \""}};

class VoxCorpus : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(VoxCorpus, ReadsLikeTheIndependentReader) {
    DiagnosticList diagnostics;
    const Result<VoxelAsset> asset = importFile(GetParam(), {}, {}, diagnostics);
    if (const auto refused = kRefused.find(GetParam().filename().string()); refused != kRefused.end()) {
        ASSERT_FALSE(asset);
        EXPECT_THAT(describe(asset.error()), testing::HasSubstr(refused->second));
        return;
    }
    ASSERT_TRUE(asset) << describe(asset.error());

    const IndependentVoxReader reader(readAll(GetParam()));
    const std::vector<IndependentVoxReader::Instance> expected = reader.instances();
    ASSERT_EQ(asset->instances.size(), expected.size());

    std::set<int> shown;
    for (const auto& instance : expected) shown.insert(instance.model);
    ASSERT_EQ(asset->models.size(), shown.size());
    std::uint32_t model = 0;
    for (const int id : shown) {
        std::map<test::VoxelLook, std::size_t> expectedCounts;
        std::map<test::VoxelLook, std::size_t> counts;
        for (const auto& [p, index] : reader.models()[static_cast<std::size_t>(id)].indexAt) {
            ++expectedCounts[reader.look(index)];
        }
        for (const auto& [p, material] : test::voxelsOf(asset->models[model])) {
            ++counts[test::lookOf(asset->materials[material])];
        }
        EXPECT_EQ(counts, expectedCounts) << "model " << id;
        ++model;
    }
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_TRUE(test::worldCellsOf(*asset, asset->instances[i]) == test::worldCellsOf(expected[i]))
            << "instance " << i;
    }
}

TEST_P(VoxCorpus, MergesToTheLastVoxelOfEveryCell) {
    if (kRefused.contains(GetParam().filename().string())) GTEST_SKIP() << "refused, see the other test";
    ImportSettings settings;
    settings.merge = true;
    DiagnosticList diagnostics;
    const Result<VoxelAsset> asset = importFile(GetParam(), settings, {}, diagnostics);
    ASSERT_TRUE(asset) << describe(asset.error());
    ASSERT_EQ(asset->models.size(), 1u);
    ASSERT_EQ(asset->instances.size(), 1u);

    std::map<test::Cell, test::VoxelLook> world;
    for (const auto& instance : IndependentVoxReader(readAll(GetParam())).instances()) {
        for (const auto& [cell, look] : test::worldCellsOf(instance)) world[cell] = look;
    }
    const std::vector<std::pair<test::Cell, test::VoxelLook>> expected(world.begin(), world.end());
    EXPECT_TRUE(test::worldCellsOf(*asset, asset->instances[0]) == expected);
}

std::string nameOf(const testing::TestParamInfo<std::filesystem::path>& info) {
    std::string name = info.param.parent_path().filename().string() + "_" + info.param.stem().string();
    std::ranges::replace_if(
        name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(VoxCorpus);
INSTANTIATE_TEST_SUITE_P(RealFiles, VoxCorpus, testing::ValuesIn(test::corpusFiles("vox", ".vox")), nameOf);

TEST(VoxCorpusFolder, IsThere) {
    PFVOX_NEEDS_CORPUS("vox");
    EXPECT_FALSE(test::corpusFiles("vox", ".vox").empty());
}

}  // namespace
}  // namespace pfvox

// The resident profile: the same content as packed, as the words that a GPU reads.
#include <gtest/gtest.h>

#include <cstring>
#include <pfvox/octree.hpp>
#include <pfvox/pf_vox.hpp>

#include "support/voxel_models.hpp"

namespace pfvox {
namespace {

OctreeAsset buildAll(bool lod) {
    std::vector<VoxelModel> models;
    for (test::NamedModel& named : test::standardModels()) models.push_back(std::move(named.model));
    models.push_back(test::randomModel(77, {0, 0, 0}, {160, 160, 160}, 0.2, 4));  // needs far pointers
    return buildOctrees(test::assetOf(std::move(models)), Limits{}, {.lod = lod}).value();
}

OctreeAsset decode(const std::vector<std::byte>& bytes) {
    DiagnosticList diagnostics;
    auto asset = decodePfVox(bytes, Limits{}, diagnostics);
    EXPECT_TRUE(asset) << describe(asset.error());
    return asset ? *std::move(asset) : OctreeAsset{};
}

TEST(Resident, BothProfilesHoldTheSame) {
    for (const bool lod : {false, true}) {
        const OctreeAsset built = buildAll(lod);
        const auto packed = encodePfVox(built, {}).value();
        const auto resident = encodePfVox(built, {.profile = Profile::Resident}).value();
        EXPECT_TRUE(validatePfVox(resident, Limits{}).empty());
        EXPECT_EQ(readPfVoxHeader(resident)->requiredFeatures, kPfVoxResident);
        EXPECT_EQ(readPfVoxHeader(packed)->requiredFeatures, 0u);
        EXPECT_EQ(encodePfVox(decode(resident), {}).value(), packed);
        EXPECT_EQ(encodePfVox(decode(packed), {.profile = Profile::Resident}).value(), resident);
    }
}

TEST(Resident, SectionsAreTheWordsInMemory) {
    const OctreeAsset built = buildAll(true);
    const auto bytes = encodePfVox(built, {.profile = Profile::Resident}).value();
    std::vector<const OctreeRegion*> regions;
    for (const OctreeModel& model : built.models)
        for (const OctreeRegion& region : model.regions) regions.push_back(&region);
    const auto expectWords = [&](const PfVoxSection& section, const auto& words) {
        ASSERT_EQ(section.storedBytes, words.size() * sizeof words[0]) << section.fourcc;
        EXPECT_EQ(std::memcmp(bytes.data() + section.offsetBytes, words.data(), section.storedBytes), 0);
    };
    std::size_t farTables = 0;
    const PfVoxHeader header = readPfVoxHeader(bytes).value();
    for (const PfVoxSection& section : header.sections) {
        if (section.regionId == kWholeFile) continue;
        const OctreeRegion& region = *regions[section.regionId];
        EXPECT_EQ(section.codec, "raw");
        EXPECT_EQ(section.offsetBytes % 64, 0u);
        if (section.fourcc == "NODE") expectWords(section, region.tree.nodes);
        if (section.fourcc == "LOOK") expectWords(section, region.lookup);
        if (section.fourcc == "VALU") expectWords(section, region.values);
        if (section.fourcc != "FARP") continue;
        expectWords(section, region.tree.farTable);
        ++farTables;
    }
    EXPECT_GT(farTables, 0u);
}

}  // namespace
}  // namespace pfvox

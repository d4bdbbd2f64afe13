// Broken, hostile and mistaken .vox files: each must give an error that says why, at once and in little
// memory.
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <fstream>

#include "support/corpus.hpp"
#include "support/import_bytes.hpp"
#include "support/vox_writer.hpp"

namespace pfvox {
namespace {

using test::ImportRun;
using test::voxBytes;
using test::voxChunk;
using test::voxDict;
using test::voxInts;
using test::VoxWriter;
using testing::HasSubstr;

/// A file with every chunk that is read.
std::string smallFile() {
    VoxWriter writer;
    writer.chunk("PACK", voxInts({2}));
    writer.model({3, 2, 1}, {{0, 0, 0, 1}, {2, 1, 0, 255}}).model({1, 1, 1}, {{0, 0, 0, 3}});
    writer.transform({.id = 0, .child = 1}).group(1, {2, 4});
    writer.transform({.id = 2,
                      .child = 3,
                      .frames = {{{"_r", "105"}, {"_t", "1 2 3"}}},
                      .attributes = {{"_name", "a"}},
                      .layer = 0});
    writer.shape({.id = 3}).transform({.id = 4, .child = 5}).shape({.id = 5, .models = {{1, {{"_f", "0"}}}}});
    writer.layer(0, {{"_name", "l"}})
        .chunk("RGBA", std::string(1024, 'c'))
        .chunk("IMAP", std::string(256, 'i'));
    writer.material(1, {{"_type", "_emit"}, {"_emit", "0.5"}, {"_flux", "2"}});
    writer.chunk("MATT", voxInts({2, 1}) + voxBytes(1.0f) + voxInts({2}) + voxBytes(0.5f));
    writer.chunk("rCAM", voxInts({0}) + voxDict({{"_focus", "1 2 3"}})).chunk("NOTE", voxInts({1, 1}) + "n");
    return writer.chunk("META", voxDict({{"k", "v"}})).finish();
}

void expectRefused(const std::string& bytes, ErrorCode code, const std::string& words) {
    ImportRun run;
    const auto asset = run(bytes);
    ASSERT_FALSE(asset) << words;
    EXPECT_EQ(toString(asset.error().code), toString(code)) << describe(asset.error());
    EXPECT_THAT(describe(asset.error()), HasSubstr(words));
    EXPECT_THAT(describe(asset.error()), testing::StartsWith("test.vox: "));
}

TEST(VoxHostile, SmallFileIsValid) {
    ImportRun run;
    const auto asset = run(smallFile());
    ASSERT_TRUE(asset) << describe(asset.error());
    EXPECT_EQ(asset->instances.size(), 2u);
}

TEST(VoxHostile, EveryTruncationIsRefusedOrBetweenChunksSaid) {
    const std::string whole = smallFile();
    std::size_t refused = 0;
    for (std::size_t size = 0; size < whole.size(); ++size) {
        ImportRun run;
        const auto asset = run(whole.substr(0, size));
        refused += asset ? 0u : 1u;
        EXPECT_TRUE(!asset ||
                    run.messageOf("vox-container-size").find("may be incomplete") != std::string::npos)
            << size;
    }
    EXPECT_GT(refused, whole.size() - 20u) << "there are few places between chunks";
}

TEST(VoxHostile, EveryTruncatedRealFileIsRefused) {
    for (const auto& file : test::corpusFiles("vox", ".vox")) {
        std::ifstream stream(file, std::ios::binary);
        const std::string whole(std::istreambuf_iterator<char>(stream), {});
        if (!whole.starts_with("VOX ")) continue;
        for (std::size_t cut = 0; cut < 100; ++cut) {
            ImportRun run;
            EXPECT_TRUE(!run(whole.substr(0, whole.size() * cut / 100)) || run.reported("vox-container-size"))
                << file << " cut to " << cut << " %";
        }
    }
}

TEST(VoxHostile, CorruptBytesGiveAnErrorOrAnAsset) {
    const std::string whole = smallFile();
    std::size_t refused = 0;
    for (std::size_t at = 0; at < whole.size(); ++at) {
        for (const char value : {'\x00', '\x01', '\x7f', '\x80', '\xff'}) {
            std::string bytes = whole;
            bytes[at] = value;
            for (const bool merge : {false, true}) {
                ImportRun run;
                run.settings.merge = merge;
                run.limits.maxMemoryBytes = 64 << 20;
                const auto asset = run(bytes);
                refused += asset ? 0u : 1u;
                if (asset) {
                    EXPECT_LE(asset->instances.size(), 16u);
                }
            }
        }
    }
    EXPECT_GT(refused, 0u);
}

TEST(VoxHostile, ForeignContent) {
    expectRefused("", ErrorCode::UnsupportedFormat, "empty");
    expectRefused("version https://git-lfs.github.com/spec/v1\n", ErrorCode::UnsupportedFormat, "Git LFS");
    expectRefused("just some text\n", ErrorCode::UnsupportedFormat, "text");
    expectRefused("PNG?" + smallFile().substr(4), ErrorCode::BadMagic, "does not start with \"VOX \"");
    expectRefused(voxInts({2, 2, 2}) + std::string(8 + 768, '\0'), ErrorCode::UnsupportedFormat, "SLAB6");
    expectRefused(std::string("VOX "), ErrorCode::Truncated, "version");
    expectRefused("VOX " + voxBytes(150) + voxChunk("SIZE", voxInts({1, 1, 1})), ErrorCode::BadStructure,
                  "MAIN");
}

TEST(VoxHostile, TeardownIsNamed) {
    const std::string voxels = voxInts({1, 1, 1}) + "\x78\xda";
    expectRefused(VoxWriter().chunk("SIZE", voxInts({1, 1, 1})).chunk("TDCZ", voxels).finish(),
                  ErrorCode::UnsupportedFeature, "Teardown");
}

TEST(VoxHostile, ChunkSizes) {
    const std::string start = "VOX " + voxBytes(150);
    expectRefused(start + "MAIN" + voxInts({0x7fffffff, 0}), ErrorCode::Truncated, "chunk MAIN @0x8");
    expectRefused(start + "MAIN" + voxInts({0, -1}), ErrorCode::BadValue, "negative");
    expectRefused(start + voxChunk("MAIN", "", "XYZI" + voxInts({-1, 0})), ErrorCode::BadValue,
                  "chunk XYZI @0x14");
    expectRefused(start + voxChunk("MAIN", "", "XYZI" + voxInts({0x7fffffff, 0x7fffffff})),
                  ErrorCode::Truncated, "2147483647 bytes");
    expectRefused(start + voxChunk("MAIN", "", "XYZ"), ErrorCode::Truncated, "chunk header @0x14");
}

TEST(VoxHostile, Models) {
    const auto withSize = [](const std::vector<std::int32_t>& size) {
        return VoxWriter().chunk("SIZE", voxInts(size)).chunk("XYZI", voxInts({1, 1 << 24})).finish();
    };
    expectRefused(withSize({65536, 65536, 1}), ErrorCode::BadValue, "edge 65536");
    expectRefused(withSize({1, -1, 1}), ErrorCode::BadValue, "edge -1");
    expectRefused(withSize({1, 1}), ErrorCode::Truncated, "chunk SIZE");
    const std::string size = voxInts({1, 1, 1});
    expectRefused(VoxWriter().chunk("SIZE", size).chunk("XYZI", voxInts({2, 0})).finish(),
                  ErrorCode::Truncated, "number of voxels is 2");
    expectRefused(VoxWriter().chunk("SIZE", size).chunk("XYZI", voxInts({-1})).finish(), ErrorCode::BadValue,
                  "negative");
    expectRefused(VoxWriter().chunk("XYZI", voxInts({0})).finish(), ErrorCode::BadStructure,
                  "without a SIZE");
    expectRefused(VoxWriter().chunk("SIZE", size).chunk("SIZE", size).finish(), ErrorCode::BadStructure,
                  "another SIZE");
    expectRefused(VoxWriter().chunk("SIZE", size).finish(), ErrorCode::BadStructure, "no XYZI");
    expectRefused(VoxWriter().finish(), ErrorCode::NothingToConvert, "no voxel model");
}

TEST(VoxHostile, ClaimOfAHugeModelIsRefusedAtOnce) {
    const std::string bytes =
        VoxWriter().chunk("SIZE", voxInts({65536, 65536, 1})).chunk("XYZI", voxInts({0})).finish();
    ASSERT_LE(bytes.size(), 64u);
    const auto start = std::chrono::steady_clock::now();
    expectRefused(bytes, ErrorCode::BadValue, "65536");
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(100));
}

VoxWriter oneModel() {
    return VoxWriter().model({1, 1, 1}, {{0, 0, 0, 1}});
}

TEST(VoxHostile, References) {
    expectRefused(oneModel().transform({.id = 0, .child = 77}).shape({}).finish(), ErrorCode::BadReference,
                  "child node 77 does not exist");
    expectRefused(oneModel().transform({}).shape({.models = {{5, {}}}}).finish(), ErrorCode::BadReference,
                  "model 5 does not exist");
    expectRefused(oneModel().transform({}).shape({.models = {{-1, {}}}}).finish(), ErrorCode::BadReference,
                  "model -1 does not exist");
    expectRefused(oneModel().shape({}).finish(), ErrorCode::BadReference, "node 0 does not exist");
}

TEST(VoxHostile, MessageNamesFileChunkAndOffset) {
    ImportRun run;
    const std::string bytes = oneModel().transform({.id = 0, .child = 77}).shape({}).finish();
    const auto asset = run(bytes, "hall.vox");
    ASSERT_FALSE(asset);
    char expected[80];
    std::snprintf(expected, sizeof expected, "hall.vox: chunk nTRN @0x%zx: child node 77 does not exist",
                  bytes.find("nTRN"));
    EXPECT_EQ(describe(asset.error()), expected);
}

TEST(VoxHostile, Cycles) {
    expectRefused(oneModel().transform({.id = 0, .child = 0}).shape({}).finish(), ErrorCode::BadStructure,
                  "its own descendant");
    expectRefused(oneModel().transform({}).group(1, {2, 1}).shape({.id = 2}).finish(),
                  ErrorCode::BadStructure, "its own descendant");
}

TEST(VoxHostile, DeepNesting) {
    VoxWriter writer = oneModel();
    constexpr int kDepth = 100000;
    for (int id = 0; id < kDepth; ++id) writer.group(id, {id + 1});
    expectRefused(writer.shape({.id = kDepth}).finish(), ErrorCode::LimitExceeded, "maxGraphDepth");
}

/// The longest way down has one node too many, but is found from a shorter one first.
TEST(VoxHostile, NestingAlongASecondWay) {
    const std::string bytes =
        oneModel().group(0, {2, 1}).group(1, {2}).group(2, {3}).shape({.id = 3}).finish();
    ImportRun run;
    run.limits.maxGraphDepth = 4;
    EXPECT_TRUE(run(bytes));
    run.limits.maxGraphDepth = 3;
    EXPECT_FALSE(run(bytes));
}

TEST(VoxHostile, HugeExpansions) {
    for (const bool withShape : {true, false}) {
        VoxWriter writer = oneModel();
        constexpr int kLevels = 60;  // 2^60 ways
        for (int id = 0; id < kLevels; ++id) writer.group(id, {id + 1, id + 1});
        if (withShape) {
            expectRefused(writer.shape({.id = kLevels}).finish(), ErrorCode::LimitExceeded, "maxInstances");
        } else {
            ImportRun run;
            EXPECT_TRUE(
                run(writer.group(kLevels, {kLevels + 1}).shape({.id = kLevels + 1, .models = {}}).finish()));
        }
    }
}

TEST(VoxHostile, Limits) {
    ImportRun run;
    run.limits.maxModels = 1;
    const auto models = run(smallFile());
    ASSERT_FALSE(models);
    EXPECT_THAT(describe(models.error()), HasSubstr("maxModels"));
    run.limits = {};
    run.limits.maxMemoryBytes = 20000;
    const auto memory = run(smallFile());
    ASSERT_FALSE(memory);
    EXPECT_EQ(memory.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(describe(memory.error()), HasSubstr("maxMemoryBytes"));
}

TEST(VoxHostile, InstancesCountAsMemory) {
    VoxWriter writer = oneModel();
    constexpr int kLevels = 20;  // 2^20 ways: allowed by maxInstances
    for (int id = 0; id < kLevels; ++id) writer.group(id, {id + 1, id + 1});
    ImportRun run;
    run.limits.maxMemoryBytes = 1 << 20;
    const auto asset = run(writer.shape({.id = kLevels}).finish());
    ASSERT_FALSE(asset);
    EXPECT_THAT(describe(asset.error()), HasSubstr("1048576 instances"));
}

TEST(VoxHostile, ImpossibleVoxelSizes) {
    for (const double size : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
        ImportRun run;
        run.settings.voxelSizeMetres = size;
        EXPECT_FALSE(run(oneModel().finish())) << size;
    }
}

TEST(VoxHostile, MergeOfFarInstancesIsBounded) {
    VoxWriter writer = oneModel();
    writer.group(0, {1, 3});
    writer.transform({.id = 1, .child = 2, .frames = {{{"_t", "-1000000000 0 0"}}}}).shape({.id = 2});
    writer.transform({.id = 3, .child = 2, .frames = {{{"_t", "1000000000 0 0"}}}});
    ImportRun run;
    EXPECT_TRUE(run(writer.finish()));
    run.settings.merge = true;
    const auto merged = run(writer.finish());
    ASSERT_FALSE(merged);
    EXPECT_THAT(describe(merged.error()), HasSubstr("maxModelDepth"));
}

TEST(VoxHostile, TranslationsThatAddUpTooFar) {
    VoxWriter writer = oneModel();
    for (int id = 0; id < 3; ++id)
        writer.transform({.id = id, .child = id + 1, .frames = {{{"_t", "2147483647 0 0"}}}});
    expectRefused(writer.shape({.id = 3}).finish(), ErrorCode::BadValue, "voxels from the origin");
}

TEST(VoxHostile, DictionariesAndNames) {
    expectRefused(oneModel().chunk("nTRN", voxInts({0, 0x7fffffff})).finish(), ErrorCode::Truncated,
                  "chunk nTRN");
    expectRefused(oneModel().chunk("nTRN", voxInts({0, 1, 0x7fffffff})).finish(), ErrorCode::Truncated,
                  "chunk nTRN");
    expectRefused(oneModel().chunk("nTRN", voxInts({0, -1})).finish(), ErrorCode::BadValue, "negative");
    expectRefused(
        oneModel().transform({.attributes = {{"_name", std::string(5000, 'n')}}}).shape({}).finish(),
        ErrorCode::BadValue, "5000 bytes");
}

}  // namespace
}  // namespace pfvox

#include <pfvox/import.hpp>

#include "support/corpus.hpp"
#include "support/import_helpers.hpp"
#include "support/legacy_writer.hpp"
#include "support/memory.hpp"

namespace pfvox::test {
namespace {

/// A tree of three levels with leaves on each.
LegacyWriter smallTree() {
    LegacyWriter writer;
    writer.depth = 3;
    writer.extent = {1.0f, 1.0f, 1.0f};
    writer.nodes = {{.leafMask = 0x01, .validMask = 0x83},
                    {.leafMask = 0x80, .validMask = 0x81},
                    {.leafMask = 0xff, .validMask = 0xff},
                    {.leafMask = 0x11, .validMask = 0x11}};
    writer.leafMaterials = {0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1};
    writer.materials.resize(2);
    return writer;
}

TEST(HostileLegacy, TheModelItselfIsGood) {
    const Imported imported = importAs(smallTree().bytes(), "a.pf_vox");
    EXPECT_TRUE(imported.result) << imported.errorText();
}

TEST(HostileLegacy, EveryPrefixAndOneByteMoreIsRefused) {
    Bytes file = smallTree().bytes();
    for (std::size_t size = 0; size < file.size(); ++size) {
        EXPECT_FALSE(importAs(std::span(file).first(size), "a.pf_vox").result) << size;
    }
    file.push_back(std::byte{0});
    EXPECT_FALSE(importAs(file, "a.pf_vox").result);
}

TEST(HostileLegacy, DamagedTreesAreRefused) {
    const LegacyWriter good = smallTree();
    const Bytes file = good.bytes();
    // Behind materials, depth and box everything is redundant: any change must be seen, but for material
    // indices.
    const std::size_t sizes = 4 + 60 * good.materials.size() + 44;
    const std::size_t leafMaterials = sizes + 24;
    const std::size_t lookups = leafMaterials + 4 * good.leafMaterials.size();
    for (std::size_t at = sizes; at < file.size(); ++at) {
        if (at >= leafMaterials && at < lookups) continue;
        for (int bit = 0; bit < 8; ++bit) {
            Bytes damaged = file;
            damaged[at] ^= static_cast<std::byte>(1 << bit);
            EXPECT_FALSE(importAs(damaged, "a.pf_vox").result) << at << " bit " << bit;
        }
    }
}

TEST(HostileLegacy, DamagedHeadersNeverCrash) {
    const Bytes file = smallTree().bytes();
    const ResidentPeak peak;
    for (std::size_t at = 0; at < file.size(); ++at) {
        for (int bit = 0; bit < 8; ++bit) {
            Bytes damaged = file;
            damaged[at] ^= static_cast<std::byte>(1 << bit);
            (void)importAs(damaged, "a.pf_vox");
        }
    }
    EXPECT_LT(peak.growthBytes(), 256ull << 20);
}

TEST(HostileLegacy, DanglingMaterialsAreNamed) {
    LegacyWriter writer = smallTree();
    writer.leafMaterials[3] = 2;
    const Imported imported = importAs(writer.bytes(), "a.pf_vox");
    ASSERT_FALSE(imported.result);
    EXPECT_EQ(imported.result.error().code, ErrorCode::BadReference);
}

TEST(HostileLegacy, TreesDeeperThanTheirDepthAreRefused) {
    LegacyWriter writer = smallTree();
    writer.depth = 1;
    EXPECT_FALSE(importAs(writer.bytes(), "a.pf_vox").result);
}

TEST(HostileLegacy, CorpusPrefixesAreRefused) {
    const auto files = corpusFiles("legacy", ".pf_vox");
    if (files.empty()) GTEST_SKIP() << "corpus/legacy is absent";
    for (const auto& file : files) {
        const Bytes bytes = readBytes(file);
        for (std::size_t part = 0; part < 100; ++part) {
            EXPECT_FALSE(importAs(std::span(bytes).first(bytes.size() * part / 100), file.string()).result)
                << file;
        }
    }
}

}  // namespace
}  // namespace pfvox::test

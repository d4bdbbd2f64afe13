#include <cstring>
#include <pfvox/import.hpp>
#include <random>

#include "support/corpus.hpp"
#include "support/import_helpers.hpp"
#include "support/memory.hpp"
#include "support/vdb_writer.hpp"

#ifdef PFVOX_ADDRESS_SANITIZER
/// OpenVDB 10 drops the node that it is about to read when decompression throws in the middle of a tree: at
/// most one path of nodes for each refused file, and nothing that a caller could free.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    return "leak:readTopology";
}
#endif

namespace pfvox::test {
namespace {

constexpr std::uint64_t kModestBytes = 64ull << 20;

Bytes smallVdb(std::uint32_t compression) {
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    for (int i = 0; i < 300; ++i) {
        grid->tree().setValueOn(openvdb::Coord(i * 37 % 40, i * 53 % 40, i * 71 % 40),
                                static_cast<float>(i) / 7.0f);
    }
    grid->tree().addTile(1, openvdb::Coord(64, 64, 64), 1.0f, true);
    return writeVdb({grid}, compression);
}

TEST(HostileVdb, PrefixesAreRefused) {
    const Bytes file = smallVdb(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
    const ResidentPeak peak;
    for (std::size_t part = 0; part < 400; ++part) {
        EXPECT_FALSE(importAs(std::span(file).first(file.size() * part / 400), "a.vdb").result) << part;
    }
    for (std::size_t size = 0; size < 1000 && size < file.size(); ++size) {
        EXPECT_FALSE(importAs(std::span(file).first(size), "a.vdb").result) << size;
    }
    EXPECT_LT(peak.growthBytes(), kModestBytes);
}

TEST(HostileVdb, StreamedPrefixesAreRefused) {
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->tree().setValueOn(openvdb::Coord(1, 2, 3), 1.0f);
    const Bytes file = writeVdbStream({grid});
    for (std::size_t part = 0; part < 200; ++part) {
        EXPECT_FALSE(importAs(std::span(file).first(file.size() * part / 200), "a.vdb").result) << part;
    }
}

TEST(HostileVdb, CorpusPrefixesAreRefused) {
    PFVOX_NEEDS_CORPUS("vdb/made/fog.vdb");
    for (const char* name : {"made/fog.vdb", "made/ls_zip.vdb", "sphere.vdb", "torus01.vdb"}) {
        const Bytes file = readBytes(std::filesystem::path(PFVOX_CORPUS_DIR) / "vdb" / name);
        for (std::size_t part = 0; part < 100; ++part) {
            EXPECT_FALSE(importAs(std::span(file).first(file.size() * part / 100), name).result)
                << name << " " << part;
        }
    }
}

TEST(HostileVdb, DamagedCorpusFilesNeedNoMemory) {
    PFVOX_NEEDS_CORPUS("vdb/damaged");
    for (const auto& path : corpusFiles("vdb/damaged", ".vdb")) {
        const ResidentPeak peak;
        const Imported imported = importAs(readBytes(path), path.string());
        EXPECT_FALSE(imported.result) << path;
        EXPECT_LT(peak.growthBytes(), kModestBytes) << path;
    }
}

/// Bit flips anywhere: an error or a model, but no crash and no wild allocation.
void flipBits(const Bytes& file, std::size_t tries) {
    std::mt19937 random(7);
    const ResidentPeak peak;
    for (std::size_t i = 0; i < tries; ++i) {
        Bytes damaged = file;
        // The first bytes steer most; the rest is sampled.
        const std::size_t at =
            i < 2000 ? i % std::min<std::size_t>(file.size(), 2000) : random() % file.size();
        damaged[at] ^= static_cast<std::byte>(1u << (random() % 8));
        (void)importAs(damaged, "a.vdb");
    }
    EXPECT_LT(peak.growthBytes(), 128ull << 20);
}

TEST(HostileVdb, FlippedBitsUncompressed) {
    flipBits(smallVdb(openvdb::io::COMPRESS_NONE), 4000);
}
TEST(HostileVdb, FlippedBitsZip) {
    flipBits(smallVdb(openvdb::io::COMPRESS_ZIP), 4000);
}
TEST(HostileVdb, FlippedBitsBlosc) {
    flipBits(smallVdb(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK), 4000);
}

/// A header by hand: magic, version 224, library 10.0, offsets, uuid, no metadata.
Bytes header(std::uint32_t version, std::uint32_t gridCount) {
    Bytes bytes;
    const auto put = [&](std::uint64_t value, int size) {
        for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i)));
    };
    put(0x56444220, 8), put(version, 4), put(10, 4), put(0, 4), put(1, 1);
    for (int i = 0; i < 36; ++i) put('0', 1);
    put(0, 4), put(gridCount, 4);
    return bytes;
}

TEST(HostileVdb, LyingCountsAndLengthsAllocateNothing) {
    const ResidentPeak peak;
    const auto codeOf = [](const Bytes& bytes) { return importAs(bytes, "a.vdb").result.error().code; };
    EXPECT_EQ(codeOf(header(224, 0)), ErrorCode::NothingToConvert);
    EXPECT_EQ(codeOf(header(224, 1000)), ErrorCode::Truncated);
    EXPECT_EQ(codeOf(header(224, 0x7fffffff)), ErrorCode::LimitExceeded);
    EXPECT_EQ(codeOf(header(224, 0xffffffff)), ErrorCode::BadValue);
    EXPECT_EQ(codeOf(header(221, 0)), ErrorCode::UnsupportedVersion);
    Bytes longName = header(224, 1);
    longName.resize(longName.size() + 64, std::byte{0xee});
    EXPECT_EQ(codeOf(longName), ErrorCode::Truncated);
    EXPECT_LT(peak.growthBytes(), kModestBytes);
}

TEST(HostileVdb, OffsetsOutsideTheFileAreRefused) {
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("g");
    grid->tree().setValueOn(openvdb::Coord(0, 0, 0), 1.0f);
    const Bytes good = writeVdb({grid});
    const std::string_view text(reinterpret_cast<const char*>(good.data()), good.size());
    const std::size_t offsets = text.find("Tree_float_5_4_3") + 16 + 4;
    for (std::size_t field = 0; field < 3; ++field) {
        for (const std::uint64_t value : {0ull, 1ull << 20, 1ull << 62, ~0ull}) {
            Bytes damaged = good;
            std::memcpy(damaged.data() + offsets + 8 * field, &value, 8);
            EXPECT_FALSE(importAs(damaged, "a.vdb").result) << field << " " << value;
        }
    }
    EXPECT_TRUE(importAs(good, "a.vdb").result);
}

TEST(HostileVdb, OtherFilesOfThatNameAreTold) {
    EXPECT_THAT(importAs(Bytes(100, std::byte{0}), "a.vdb").errorText(),
                testing::HasSubstr("no known voxel source"));
}

}  // namespace
}  // namespace pfvox::test

#include <cstring>
#include <pfvox/import.hpp>

#include "support/corpus.hpp"
#include "support/import_helpers.hpp"
#include "support/memory.hpp"
#include "support/svx_writer.hpp"

namespace pfvox::test {
namespace {

constexpr std::uint64_t kModestBytes = 64ull << 20;

Bytes smallSvx() {
    SvxWriter writer({7, 5, 4});
    writer.addScalarChannel("type=\"DENSITY\"", "density", 8, [](glm::ivec3 v) { return v.x > 2 ? 255 : 0; });
    return writer.finish();
}

/// An archive with this manifest and no slices.
Imported importManifest(const std::string& manifest) {
    ZipWriter zip;
    zip.add("manifest.xml", manifest);
    return importAs(zip.finish(), "a.svx");
}

std::string gridWith(const std::string& attributes, const std::string& pattern = "slice%04d.png") {
    return fmt::format("<grid {}><channels><channel type=\"DENSITY\" slices=\"{}\"/></channels></grid>",
                       attributes, pattern);
}

TEST(HostileSvx, EveryPrefixIsRefused) {
    const Bytes file = smallSvx();
    for (std::size_t size = 0; size < file.size(); ++size) {
        EXPECT_FALSE(importAs(std::span(file).first(size), "a.svx").result) << size;
    }
}

TEST(HostileSvx, DamagedBytesNeverCrash) {
    const Bytes file = smallSvx();
    for (std::size_t at = 0; at < file.size(); ++at) {
        for (const unsigned flip : {0x01u, 0x80u, 0xffu}) {
            Bytes damaged = file;
            damaged[at] ^= static_cast<std::byte>(flip);
            (void)importAs(damaged, "a.svx");
        }
    }
}

TEST(HostileSvx, CorpusFilesMadeBadAreRefusedWithTheReason) {
    PFVOX_NEEDS_CORPUS("svx/made");
    const auto root = std::filesystem::path(PFVOX_CORPUS_DIR) / "svx" / "made";
    const auto errorOf = [&](const char* name) { return importAs(readBytes(root / name), name).errorText(); };
    EXPECT_THAT(errorOf("bad_format_string.svx"), testing::HasSubstr("slice%s%n%04d.png"));
    EXPECT_THAT(errorOf("bad_missing_slice.svx"), testing::HasSubstr("density/slice0002.png"));
    EXPECT_THAT(errorOf("bad_wrong_png_size.svx"), testing::HasSubstr("5 x 4 pixels"));
}

TEST(HostileSvx, PatternsThatPrintfWouldObeyAreRefused) {
    const std::string grid = R"(gridSizeX="1" gridSizeY="1" gridSizeZ="1")";
    for (const char* pattern :
         {"%s", "%n", "%d%d", "slice.png", "%", "%5", "%ld", "%99999999d", "%*d", "%-4d", "%x"}) {
        const Imported imported = importManifest(gridWith(grid, pattern));
        ASSERT_FALSE(imported.result) << pattern;
        EXPECT_EQ(imported.result.error().code, ErrorCode::BadValue) << pattern;
    }
}

TEST(HostileSvx, BrokenXmlNamesLineAndColumn) {
    const Imported imported =
        importManifest("<?xml version=\"1.0\"?>\n<grid gridSizeX=\"1\"\n  gridSizeY=\"1>\n</grid>\n");
    ASSERT_FALSE(imported.result);
    EXPECT_EQ(imported.result.error().code, ErrorCode::BadStructure);
    EXPECT_THAT(imported.errorText(), testing::HasSubstr("manifest.xml line 3, column"));
    EXPECT_THAT(importManifest("<grid gridSizeX=\"1\">\n").errorText(),
                testing::HasSubstr("line 1, column 21"));
    EXPECT_THAT(importManifest("<svx/>").errorText(), testing::HasSubstr("<grid>"));
}

TEST(HostileSvx, EntitiesAreNeverExpanded) {
    // pugixml has no custom entities: the reference stays as it is, so nothing can grow (and here: is no
    // number).
    std::string xml = "<!DOCTYPE grid [<!ENTITY a \"1111111111\">";
    for (char c = 'b'; c < 'k'; ++c) {
        xml += fmt::format("<!ENTITY {0} \"&{1};&{1};&{1};&{1};&{1};&{1};&{1};&{1};&{1};&{1};\">", c,
                           static_cast<char>(c - 1));
    }
    xml += "]>" + gridWith(R"(gridSizeX="&j;" gridSizeY="1" gridSizeZ="1")");
    const ResidentPeak peak;
    const Imported imported = importManifest(xml);
    ASSERT_FALSE(imported.result);
    EXPECT_EQ(imported.result.error().code, ErrorCode::BadValue);
    EXPECT_THAT(imported.errorText(), testing::HasSubstr("&j;"));
    EXPECT_LT(peak.growthBytes(), kModestBytes);
}

TEST(HostileSvx, BadNumbersAreRefused) {
    for (const char* attributes :
         {R"(gridSizeX="0" gridSizeY="1" gridSizeZ="1")", R"(gridSizeX="-1" gridSizeY="1" gridSizeZ="1")",
          R"(gridSizeX="1.5" gridSizeY="1" gridSizeZ="1")",
          R"(gridSizeX="99999999999999999999" gridSizeY="1" gridSizeZ="1")",
          R"(gridSizeX="1" gridSizeY="1" gridSizeZ="1" voxelSize="0")",
          R"(gridSizeX="1" gridSizeY="1" gridSizeZ="1" voxelSize="nan")",
          R"(gridSizeX="1" gridSizeY="1" gridSizeZ="1" originX="inf")",
          R"(gridSizeX="1" gridSizeY="1" gridSizeZ="1" subvoxelBits="17")",
          R"(gridSizeX="1" gridSizeY="1" gridSizeZ="1" slicesOrientation="W")"}) {
        const Imported imported = importManifest(gridWith(attributes));
        ASSERT_FALSE(imported.result) << attributes;
        EXPECT_EQ(imported.result.error().code, ErrorCode::BadValue) << attributes;
        EXPECT_THAT(imported.errorText(), testing::HasSubstr("line 1")) << attributes;
    }
}

TEST(HostileSvx, HugeGridsAreRefusedAtOnce) {
    const ResidentPeak peak;
    const Imported beyond =
        importManifest(gridWith(R"(gridSizeX="2000000000" gridSizeY="2000000000" gridSizeZ="2000000000")"));
    ASSERT_FALSE(beyond.result);
    EXPECT_EQ(beyond.result.error().code, ErrorCode::LimitExceeded);
    EXPECT_FALSE(
        importManifest(gridWith(R"(gridSizeX="8000000" gridSizeY="8000000" gridSizeZ="8000000")")).result);
    EXPECT_FALSE(importManifest(gridWith(R"(gridSizeX="8000" gridSizeY="8000" gridSizeZ="8000")")).result);
    EXPECT_LT(peak.growthBytes(), kModestBytes);
}

TEST(HostileSvx, PngHeadersMustMatchTheGridBeforeAnythingIsDecoded) {
    ZipWriter zip;
    zip.add("manifest.xml", gridWith(R"(gridSizeX="30000" gridSizeY="1" gridSizeZ="30000")"));
    // A header of the right size, 900 million pixels, over next to no data.
    Bytes png = encodePng({.width = 1, .height = 1, .samples = {255}});
    const auto bigEndian = [&](std::size_t at, std::uint32_t value) {
        for (std::size_t i = 0; i < 4; ++i) png[at + i] = static_cast<std::byte>(value >> (24 - 8 * i));
    };
    bigEndian(16, 30000);
    bigEndian(20, 30000);
    std::uint32_t crc = 0xffffffffu;
    for (std::size_t i = 12; i < 29; ++i) {
        crc ^= std::to_integer<std::uint32_t>(png[i]);
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
    }
    bigEndian(29, ~crc);
    zip.add("slice0000.png", png);
    const ResidentPeak peak;
    const Imported imported = importAs(zip.finish(), "a.svx");
    ASSERT_FALSE(imported.result);
    EXPECT_THAT(imported.errorText(), testing::HasSubstr("more than its"));
    EXPECT_LT(peak.growthBytes(), kModestBytes);
}

TEST(HostileSvx, ZipBombsAreRefusedBySize) {
    ZipWriter zip;
    zip.add("manifest.xml", gridWith(R"(gridSizeX="4" gridSizeY="1" gridSizeZ="4")"));
    zip.add("slice0000.png", Bytes(std::size_t{200} << 20));
    const Bytes file = zip.finish();
    EXPECT_LT(file.size(), 1u << 20);
    const ResidentPeak peak;
    const Imported imported = importAs(file, "a.svx");
    ASSERT_FALSE(imported.result);
    EXPECT_EQ(imported.result.error().code, ErrorCode::LimitExceeded);
    EXPECT_LT(peak.growthBytes(), kModestBytes);
}

TEST(HostileSvx, LyingEntryCountsAllocateNothing) {
    // A zip64 end record that announces 2^40 entries over an empty directory.
    Bytes file(4, std::byte{0});
    std::memcpy(file.data(), "PK\x03\x04", 4);
    file.resize(30);
    const std::uint64_t endAt = file.size();
    const auto put = [&](std::uint64_t value, int bytes) {
        for (int i = 0; i < bytes; ++i) file.push_back(static_cast<std::byte>(value >> (8 * i)));
    };
    put(0x06064b50, 4), put(44, 8), put(45, 2), put(45, 2), put(0, 4), put(0, 4);
    put(1ull << 31, 8), put(1ull << 31, 8), put(0, 8), put(30, 8);
    put(0x07064b50, 4), put(0, 4), put(endAt, 8), put(1, 4);
    put(0x06054b50, 4), put(0, 2), put(0, 2), put(0xffff, 2), put(0xffff, 2), put(0xffffffff, 4),
        put(0xffffffff, 4), put(0, 2);
    const ResidentPeak peak;
    EXPECT_FALSE(importAs(file, "a.svx").result);
    EXPECT_LT(peak.growthBytes(), kModestBytes);
}

TEST(HostileSvx, ZipWithoutManifestSaysWhatItIs) {
    ZipWriter zip;
    zip.add("readme.txt", "hello");
    EXPECT_THAT(importAs(zip.finish(), "a.svx").errorText(),
                testing::HasSubstr("zip archive without manifest.xml"));
    ZipWriter folder;
    folder.add("thing/manifest.xml", "<grid/>");
    EXPECT_THAT(importAs(folder.finish(), "a.svx").errorText(),
                testing::HasSubstr("zip the content of the folder"));
}

}  // namespace
}  // namespace pfvox::test

#include <pfvox/import.hpp>

#include "support/corpus.hpp"
#include "support/import_helpers.hpp"
#include "support/svx_writer.hpp"

namespace pfvox::test {
namespace {

constexpr glm::ivec3 kGrid{7, 5, 4};

/// A model that no rotation or mirror maps onto itself: a floor, a post, a bar and two studs.
bool asymmetric(glm::ivec3 v) {
    if (v.y == 0) return true;
    if (v.x == 0 && v.z == 0) return true;
    if (v.y == 1 && v.x == 6 && v.z < 3) return true;
    return v.y == 1 && v.z == 3 && (v.x == 2 || v.x == 4);
}

std::set<std::array<int, 3>> asymmetricVoxels() {
    std::set<std::array<int, 3>> voxels;
    for (int x = 0; x < kGrid.x; ++x)
        for (int y = 0; y < kGrid.y; ++y)
            for (int z = 0; z < kGrid.z; ++z)
                if (asymmetric({x, y, z})) voxels.insert({x, y, z});
    return voxels;
}

Bytes densityFile(int bitDepth, const SvxWriter::Sample& sample, char axis = 'Y', bool interlaced = false) {
    SvxWriter writer(kGrid, axis);
    writer.interlaced = interlaced;
    writer.addScalarChannel(fmt::format("type=\"DENSITY\" bits=\"{}\"", bitDepth), "density", bitDepth,
                            sample);
    return writer.finish();
}

TEST(ImportSvx, MapsSlicesOfEveryOrientation) {
    for (const char axis : {'X', 'Y', 'Z'}) {
        SCOPED_TRACE(axis);
        const Imported imported = importAs(densityFile(
                                               8, [](glm::ivec3 v) { return asymmetric(v) ? 255 : 0; }, axis),
                                           "a.svx");
        ASSERT_TRUE(imported.result) << imported.errorText();
        EXPECT_EQ(voxelSet(imported.result->models[0]), asymmetricVoxels());
    }
}

TEST(ImportSvx, ReadsEveryBitDepthInterlacedOrNot) {
    for (const int bits : {1, 2, 4, 8, 16}) {
        for (const bool interlaced : {false, true}) {
            SCOPED_TRACE(fmt::format("{} bits, interlaced {}", bits, interlaced));
            const auto full = static_cast<std::uint16_t>((1 << bits) - 1);
            const Bytes file = densityFile(
                bits, [&](glm::ivec3 v) { return asymmetric(v) ? full : std::uint16_t{0}; }, 'Z', interlaced);
            const Imported imported = importAs(file, "a.svx");
            ASSERT_TRUE(imported.result) << imported.errorText();
            EXPECT_EQ(voxelSet(imported.result->models[0]), asymmetricVoxels());
        }
    }
}

TEST(ImportSvx, TakesFirstComponentOfEveryColorType) {
    const auto value = [](glm::ivec3 v) { return asymmetric(v) ? std::uint16_t{200} : std::uint16_t{0}; };
    for (const std::uint8_t type :
         {SPNG_COLOR_TYPE_TRUECOLOR, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA, SPNG_COLOR_TYPE_GRAYSCALE_ALPHA}) {
        SCOPED_TRACE(int{type});
        SvxWriter writer(kGrid);
        writer.addChannel("type=\"DENSITY\"", "density", 8, type,
                          [&](glm::ivec3 v, std::vector<std::uint16_t>& out) {
                              out.push_back(value(v));
                              for (std::uint32_t c = 1; c < channelsOf(type); ++c) out.push_back(255);
                          });
        const Imported imported = importAs(writer.finish(), "a.svx");
        ASSERT_TRUE(imported.result) << imported.errorText();
        EXPECT_EQ(voxelSet(imported.result->models[0]), asymmetricVoxels());
    }
    SvxWriter writer(kGrid);
    writer.addChannel(
        "type=\"DENSITY\"", "density", 2, SPNG_COLOR_TYPE_INDEXED,
        [&](glm::ivec3 v, std::vector<std::uint16_t>& out) { out.push_back(asymmetric(v) ? 1 : 2); },
        {{255, 255, 255}, {200, 0, 0}, {10, 255, 255}});
    const Imported imported = importAs(writer.finish(), "a.svx");
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_EQ(voxelSet(imported.result->models[0]), asymmetricVoxels());
}

TEST(ImportSvx, ThresholdIsAFractionOfTheMaximum) {
    // Densities 0, 40, 80, ... 240 along x; 5 x 4 voxels of each.
    const Bytes file = densityFile(8, [](glm::ivec3 v) { return static_cast<std::uint16_t>(40 * v.x); });
    const auto voxelsAt = [&](double threshold) {
        ImportSettings settings;
        settings.svx.threshold = threshold;
        return importAs(file, "a.svx", settings).result.value().models[0].voxelCount();
    };
    EXPECT_EQ(voxelsAt(0.5), 3u * 20);  // 160, 200, 240
    EXPECT_EQ(voxelsAt(0.0), 6u * 20);
    EXPECT_EQ(voxelsAt(240.0 / 255.0), 1u * 20);
    ImportSettings settings;
    settings.svx.threshold = 1.0;
    EXPECT_EQ(importAs(file, "a.svx", settings).result.error().code, ErrorCode::NothingToConvert);
    settings.svx.threshold = 1.5;
    EXPECT_EQ(importAs(file, "a.svx", settings).result.error().code, ErrorCode::BadValue);
}

TEST(ImportSvx, HalfOfTheMaximumIs128Of255) {
    const Bytes file =
        densityFile(8, [](glm::ivec3 v) { return static_cast<std::uint16_t>(v.x < 3 ? 127 : 128); });
    EXPECT_EQ(importAs(file, "a.svx").result.value().models[0].voxelCount(), 4u * 20);
}

TEST(ImportSvx, KeepsColors) {
    const auto color = [](glm::ivec3 v) { return glm::u8vec3{40 * v.x, 60 * v.y, 80 * v.z}; };
    for (const char* type : {"COLOR-RGB", "COLOR", "DENSITY_COLOR"}) {
        SCOPED_TRACE(type);
        SvxWriter writer(kGrid);
        writer.addScalarChannel("type=\"DENSITY\"", "density", 8,
                                [](glm::ivec3 v) { return asymmetric(v) ? 255 : 0; });
        writer.addColorChannel(fmt::format("type=\"{}\" bits=\"24\"", type), "color", color);
        const Imported imported = importAs(writer.finish(), "a.svx");
        ASSERT_TRUE(imported.result) << imported.errorText();
        const VoxelAsset& asset = *imported.result;
        EXPECT_EQ(asset.materials.size(), asymmetricVoxels().size());
        for (const auto& [x, y, z] : asymmetricVoxels()) {
            const auto material = asset.models[0].at({x, y, z});
            ASSERT_TRUE(material);
            EXPECT_EQ(asset.materials[*material].baseColor, (glm::u8vec4{color({x, y, z}), 255}));
        }
    }
}

/// The colors of the test above in three channels; `bits` of a sample.
void addPrimaries(SvxWriter& writer, std::uint8_t bits, const std::vector<std::string>& types) {
    for (const std::string& type : types) {
        const int axis = type == "RED" ? 0 : type == "GREEN" ? 1 : 2;
        writer.addScalarChannel(fmt::format("type=\"{}\"", type), type, bits, [axis, bits](glm::ivec3 v) {
            const int value = 20 * (axis + 2) * v[axis];
            return static_cast<std::uint16_t>(bits == 16 ? value * 257 : value);
        });
    }
}

TEST(ImportSvx, ColorsComeFromRedGreenAndBlue) {
    for (const std::uint8_t bits : {std::uint8_t{8}, std::uint8_t{16}}) {
        SCOPED_TRACE(int{bits});
        SvxWriter writer(kGrid);
        writer.addScalarChannel("type=\"DENSITY\"", "density", 8,
                                [](glm::ivec3 v) { return asymmetric(v) ? 255 : 0; });
        addPrimaries(writer, bits, {"GREEN", "RED", "BLUE"});
        const Imported imported = importAs(writer.finish(), "a.svx");
        ASSERT_TRUE(imported.result) << imported.errorText();
        const VoxelAsset& asset = *imported.result;
        EXPECT_EQ(voxelSet(asset.models[0]), asymmetricVoxels());
        for (const auto& [x, y, z] : asymmetricVoxels()) {
            const auto material = asset.models[0].at({x, y, z});
            EXPECT_EQ(asset.materials[material.value()].baseColor,
                      (glm::u8vec4{40 * x, 60 * y, 80 * z, 255}));
        }
        EXPECT_FALSE(imported.reported("svx-channel-skipped"));
    }
}

TEST(ImportSvx, MaterialFractionsSayWhereColorsAre) {
    for (const bool primaries : {true, false}) {
        SvxWriter writer(kGrid);
        writer.addScalarChannel("type=\"MATERIAL\" id=\"1\"", "m1", 8,
                                [](glm::ivec3 v) { return asymmetric(v) ? 255 : 0; });
        if (primaries) {
            addPrimaries(writer, 8, {"RED", "GREEN", "BLUE"});
        } else {
            writer.addColorChannel("type=\"COLOR-RGB\"", "color", [](glm::ivec3) {
                return glm::u8vec3{1, 2, 3};
            });
        }
        const Imported imported = importAs(writer.finish(), "a.svx");
        ASSERT_TRUE(imported.result) << imported.errorText();
        EXPECT_EQ(voxelSet(imported.result->models[0]), asymmetricVoxels());
        EXPECT_TRUE(imported.reported("svx-materials-unused"));
    }
}

TEST(ImportSvx, SomePrimariesAreNoColor) {
    SvxWriter writer(kGrid);
    writer.addScalarChannel("type=\"DENSITY\"", "density", 8, [](glm::ivec3) { return 255; });
    addPrimaries(writer, 8, {"RED", "BLUE"});
    const Imported imported = importAs(writer.finish(), "a.svx");
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_TRUE(imported.reported("svx-channel-skipped"));
    SvxWriter alone(kGrid);
    addPrimaries(alone, 8, {"RED", "GREEN", "BLUE"});
    EXPECT_EQ(importAs(alone.finish(), "a.svx").result.error().code, ErrorCode::UnsupportedFeature);
}

TEST(ImportSvx, AlphaIsTheDensityOfDensityColor) {
    SvxWriter writer(kGrid);
    writer.addChannel(
        "type=\"DENSITY_COLOR\"", "slices", 8, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA,
        [](glm::ivec3 v, std::vector<std::uint16_t>& out) {
            out.insert(out.end(), {10, 20, 30, static_cast<std::uint16_t>(asymmetric(v) ? 255 : 0)});
        });
    const Imported imported = importAs(writer.finish(), "a.svx");
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_EQ(voxelSet(imported.result->models[0]), asymmetricVoxels());
    EXPECT_EQ(imported.result->materials.at(0).baseColor, (glm::u8vec4{10, 20, 30, 255}));
}

TEST(ImportSvx, ColorsWithoutDensityAreRefused) {
    SvxWriter writer(kGrid);
    writer.addColorChannel("type=\"COLOR-RGB\"", "color", [](glm::ivec3) { return glm::u8vec3{1, 2, 3}; });
    EXPECT_EQ(importAs(writer.finish(), "a.svx").result.error().code, ErrorCode::UnsupportedFeature);
}

TEST(ImportSvx, LargestMaterialFractionWins) {
    SvxWriter writer(kGrid);
    writer.afterChannels =
        R"(<materials><material id="1" urn="urn:test:steel"/><material id="5" urn=""/></materials>)";
    writer.addScalarChannel("type=\"MATERIAL\" id=\"1\"", "m1", 8,
                            [](glm::ivec3 v) { return v.x < 3 ? 200 : 100; });
    writer.addScalarChannel("type=\"MATERIAL\" id=\"5\"", "m5", 8,
                            [](glm::ivec3 v) { return v.x < 3 ? 55 : 155; });
    const Imported imported = importAs(writer.finish(), "a.svx");
    ASSERT_TRUE(imported.result) << imported.errorText();
    const VoxelAsset& asset = *imported.result;
    EXPECT_EQ(asset.models[0].voxelCount(), 7u * 5 * 4);
    EXPECT_EQ(asset.materials[*asset.models[0].at({2, 0, 0})].name, "urn:test:steel");
    EXPECT_EQ(asset.materials[*asset.models[0].at({3, 0, 0})].name, "material 5");
    EXPECT_NE(asset.materials[0].baseColor, asset.materials[1].baseColor);
}

TEST(ImportSvx, ReportsChannelsWithoutMeaning) {
    SvxWriter writer(kGrid);
    const auto solid = [](glm::ivec3) { return std::uint16_t{255}; };
    writer.addScalarChannel("type=\"CUSTOM\" id=\"7\"", "c", 8, solid);
    writer.addScalarChannel("type=\"DENSITY\"", "d", 8, solid);
    const Imported imported = importAs(writer.finish(), "a.svx");
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_TRUE(imported.reported("svx-channel-skipped"));
}

TEST(ImportSvx, ScaleAndOriginAreInMetres) {
    SvxWriter writer(kGrid);
    writer.gridAttributes = R"(voxelSize="0.002" originX="1" originY="-2" originZ="0.5")";
    writer.addScalarChannel("type=\"DENSITY\"", "d", 8, [](glm::ivec3) { return 255; });
    const Bytes file = writer.finish();
    const Imported imported = importAs(file, "a.svx");
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_EQ(imported.result->source.voxelSizeMetres, 0.002);
    const glm::dvec3 corner = imported.result->instances[0].worldFromModel * glm::dvec4{7, 5, 4, 1};
    EXPECT_NEAR(corner.x, 1.014, 1e-12);
    EXPECT_NEAR(corner.y, -1.99, 1e-12);
    EXPECT_NEAR(corner.z, 0.508, 1e-12);
    ImportSettings settings;
    settings.voxelSizeMetres = 0.004;
    const Imported scaled = importAs(file, "a.svx", settings);
    EXPECT_NEAR((scaled.result->instances[0].worldFromModel * glm::dvec4{0, 0, 0, 1}).x, 2.0, 1e-12);
}

TEST(ImportSvx, ForgivesNamesAndReportsThem) {
    SvxWriter writer({2, 2, 2});
    writer.zip.add(".\\Manifest.XML", R"(<grid nx="2" ny="2" nz="2"><channels>
        <channel type="DENSITY" slices="./density/slice%d.png"/></channels></grid>)");
    const Bytes png = encodePng({.width = 2, .height = 2, .samples = {255, 255, 255, 255}});
    for (const char* name : {"DENSITY\\slice0.png", "density/slice1.PNG", "./density/slice2.png"})
        writer.zip.add(name, png);
    const Imported imported = importAs(writer.zip.finish(), "a.svx");
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_EQ(imported.result->models[0].voxelCount(), 8u);
    EXPECT_TRUE(imported.reported("svx-entry-names"));
    EXPECT_TRUE(imported.reported("svx-draft-manifest"));
    EXPECT_TRUE(imported.reported("svx-extra-slices"));
}

// AbFab3D's own sphere is written so.
TEST(ImportSvx, CurlyQuotesAndOpenElementsAreReadWithAWarning) {
    for (const auto& [left, right] : {std::pair{"\x93", "\x94"}, std::pair{"“", "”"}}) {
        SvxWriter writer({2, 2, 2});
        writer.zip.add("manifest.xml", fmt::format(R"(<?xml version="1.0"?>
<grid gridSizeX="2" gridSizeY="2" gridSizeZ="2" voxelSize={0}0.001{1} slicesOrientation="Y">
  <channels><channel type="DENSITY" slices="d/%d.png"/></channels>
  <metadata><entry key="author" value="a > b"><entry key={0}date{1} value="2013"></metadata>
</grid>)",
                                                   left, right));
        const Bytes png = encodePng({.width = 2, .height = 2, .samples = {255, 255, 255, 255}});
        for (const char* name : {"d/0.png", "d/1.png"}) writer.zip.add(name, png);
        const Imported imported = importAs(writer.zip.finish(), "a.svx");
        ASSERT_TRUE(imported.result) << imported.errorText();
        EXPECT_TRUE(imported.reported("svx-manifest-repaired"));
        EXPECT_EQ(imported.result->source.voxelSizeMetres, 0.001);
        EXPECT_EQ(imported.result->models[0].voxelCount(), 8u);
        EXPECT_THAT(imported.result->source.notes, testing::IsSupersetOf({"author: a > b", "date: 2013"}));
    }
}

TEST(ImportSvx, CorpusFilesHaveTheirVoxels) {
    PFVOX_NEEDS_CORPUS("svx");
    const std::filesystem::path root = std::filesystem::path(PFVOX_CORPUS_DIR) / "svx";
    for (const char* name :
         {"bits1_Y", "density_color_Y", "material_custom_Y", "orient_X", "orient_Z", "rgba_png_Y"}) {
        SCOPED_TRACE(name);
        const auto file = (root / "made" / name).concat(".svx");
        const Imported imported = importAs(readBytes(file), file.string());
        ASSERT_TRUE(imported.result) << imported.errorText();
        EXPECT_EQ(voxelSet(imported.result->models[0]), asymmetricVoxels());
    }
    const Imported urchin = importAs(readBytes(root / "urchin.svx"), "urchin.svx");
    ASSERT_TRUE(urchin.result) << urchin.errorText();
    EXPECT_EQ(urchin.result->models[0].voxelCount(), 250038u);
    EXPECT_TRUE(urchin.reported("svx-voxel-size"));
}

}  // namespace
}  // namespace pfvox::test

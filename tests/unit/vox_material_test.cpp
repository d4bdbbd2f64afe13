// Colors and materials of MagicaVoxel files.
#include <gmock/gmock.h>

#include <clocale>
#include <locale>

#include "support/import_bytes.hpp"
#include "support/vox_writer.hpp"

namespace pfvox {
namespace {

using test::ImportRun;
using test::voxBytes;
using test::VoxDict;
using test::voxInts;
using test::VoxWriter;

constexpr std::uint8_t kSlot = 5;

VoxWriter oneVoxel(std::uint8_t index = kSlot) {
    return VoxWriter().model({1, 1, 1}, {{0, 0, 0, index}});
}

Material materialOf(const VoxelAsset& asset) {
    return asset.materials[*asset.models[0].at({0, 0, 0})];
}

Material importMaterial(const VoxDict& properties) {
    ImportRun run;
    const auto asset = run(oneVoxel().material(kSlot, properties).finish());
    EXPECT_TRUE(asset) << describe(asset.error());
    return materialOf(*asset);
}

struct MatlCase {
    const char* name;
    VoxDict properties;
    MaterialType type = MaterialType::Diffuse;
    float Material::*field = &Material::roughness;
    float expected = 1.0f;
};

class Matl : public testing::TestWithParam<MatlCase> {};

TEST_P(Matl, MapsToTheField) {
    const Material material = importMaterial(GetParam().properties);
    EXPECT_EQ(material.type, GetParam().type);
    EXPECT_FLOAT_EQ(material.*GetParam().field, GetParam().expected);
}

using enum MaterialType;
const MatlCase kMatlCases[] = {
    {"NoTypeIsDiffuse", {{"_rough", "0.1"}}, Diffuse, &Material::roughness, 0.1f},
    {"RoughnessByDefault", {{"_type", "_diffuse"}}, Diffuse, &Material::roughness, 1.0f},
    {"SpecularByDefault", {{"_type", "_diffuse"}}, Diffuse, &Material::specular, 0.5f},
    {"IorByDefault", {{"_type", "_diffuse"}}, Diffuse, &Material::indexOfRefraction, 1.5f},
    {"StrengthByDefault", {{"_type", "_emit"}}, Emit, &Material::emissionStrength, 0.0f},
    {"MetalByDefault", {{"_type", "_metal"}}, Metal, &Material::metalness, 0.0f},
    {"Metal",
     {{"_type", "_metal"}, {"_metal", "0.75"}, {"_weight", "0.5"}},
     Metal,
     &Material::metalness,
     0.75f},
    {"OldMetal", {{"_type", "_metal"}, {"_weight", "0.5"}}, Metal, &Material::metalness, 0.5f},
    {"MetalLeftBehind", {{"_type", "_diffuse"}, {"_metal", "0.75"}}, Diffuse, &Material::metalness, 0.0f},
    {"Specular", {{"_type", "_metal"}, {"_spec", "0.25"}}, Metal, &Material::specular, 0.25f},
    {"SpecularScale", {{"_type", "_metal"}, {"_sp", "1.5"}}, Metal, &Material::specular, 0.75f},
    {"IorLessOne", {{"_type", "_glass"}, {"_ior", "0.3"}}, Glass, &Material::indexOfRefraction, 1.3f},
    {"IorItself",
     {{"_type", "_glass"}, {"_ri", "1.33"}, {"_ior", "0.7"}},
     Glass,
     &Material::indexOfRefraction,
     1.33f},
    {"Trans",
     {{"_type", "_glass"}, {"_trans", "0.4"}, {"_alpha", "0.9"}},
     Glass,
     &Material::transparency,
     0.4f},
    {"Alpha", {{"_type", "_glass"}, {"_alpha", "0.9"}}, Glass, &Material::transparency, 0.9f},
    {"OldGlass", {{"_type", "_glass"}, {"_weight", "0.6"}}, Glass, &Material::transparency, 0.6f},
    {"Emit", {{"_type", "_emit"}, {"_emit", "0.5"}}, Emit, &Material::emissionStrength, 0.5f},
    {"EmitWithPower",
     {{"_type", "_emit"}, {"_emit", "0.5"}, {"_flux", "2"}},
     Emit,
     &Material::emissionStrength,
     50.0f},
    {"FractionOfPower",
     {{"_type", "_emit"}, {"_emit", "1"}, {"_flux", "0.5"}},
     Emit,
     &Material::emissionStrength,
     3.1622777f},
    {"OldEmit",
     {{"_type", "_emit"}, {"_weight", "0.5"}, {"_flux", "1"}},
     Emit,
     &Material::emissionStrength,
     5.0f},
    {"EmitLeftBehind",
     {{"_type", "_metal"}, {"_emit", "1"}, {"_flux", "4"}},
     Metal,
     &Material::emissionStrength,
     0.0f},
    {"Plastic", {{"_type", "_plastic"}, {"_rough", "0.5"}}, Plastic, &Material::roughness, 0.5f},
    {"Blend", {{"_type", "_blend"}, {"_metal", "0.5"}}, Blend, &Material::metalness, 0.5f},
    {"Media", {{"_type", "_media"}, {"_d", "0.05"}}, Media, &Material::density, 0.05f},
    {"Phase", {{"_type", "_media"}, {"_g", "-0.9"}}, Media, &Material::phase, -0.9f},
    {"LongDigits", {{"_rough", "0.00999999"}}, Diffuse, &Material::roughness, 0.00999999f},
    {"LastOfEqualKeys", {{"_rough", "0.1"}, {"_rough", "0.2"}}, Diffuse, &Material::roughness, 0.2f},
};

INSTANTIATE_TEST_SUITE_P(Properties, Matl, testing::ValuesIn(kMatlCases),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(VoxMaterial, MalformedValuesAreReportedAndReplaced) {
    for (const char* bad : {"abc", "", "nan", "inf", "0,5", "0.5x"}) {
        ImportRun run;
        const auto asset = run(oneVoxel().material(kSlot, {{"_rough", bad}}).finish());
        ASSERT_TRUE(asset);
        EXPECT_FLOAT_EQ(materialOf(*asset).roughness, 1.0f) << bad;
        EXPECT_TRUE(run.reported("vox-material-malformed")) << bad;
    }
    ImportRun run;
    const auto asset = run(oneVoxel().material(kSlot, {{"_rough", "7"}, {"_type", "_wood"}}).finish());
    EXPECT_FLOAT_EQ(materialOf(*asset).roughness, 1.0f);
    EXPECT_THAT(run.messageOf("vox-material-malformed"), testing::HasSubstr("_rough, _type"));
}

TEST(VoxMaterial, OnlyMaterialsInUseAreReported) {
    ImportRun run;
    ASSERT_TRUE(
        run(oneVoxel().material(kSlot + 1, {{"_rough", "x"}, {"_type", "_media"}, {"_ldr", "1"}}).finish()));
    EXPECT_TRUE(run.diagnostics.entries().empty());
    ASSERT_TRUE(run(oneVoxel().material(kSlot, {{"_type", "_media"}, {"_ldr", "1"}}).finish()));
    EXPECT_TRUE(run.reported("vox-material-approximated"));
    EXPECT_THAT(run.messageOf("vox-material-unmapped"), testing::HasSubstr("_ldr"));
}

/// Writes 0,25 for a quarter, as many locales do.
class CommaForPoint : public std::numpunct<char> {
  protected:
    char do_decimal_point() const override { return ','; }
};

TEST(VoxMaterial, NumbersDoNotDependOnTheLocale) {
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new CommaForPoint));
    std::setlocale(LC_NUMERIC, "de_DE.UTF-8");  // where it is installed
    const Material material = importMaterial({{"_rough", "0.25"}});
    std::locale::global(before);
    EXPECT_FLOAT_EQ(material.roughness, 0.25f);
}

TEST(VoxMaterial, IdsReachFrom1To256) {
    for (const int id : {1, 255, 256, 0}) {
        ImportRun run;
        EXPECT_TRUE(run(oneVoxel(1).material(id, {{"_type", "_metal"}}).finish())) << id;
    }
    for (const int id : {-1, 257, 1 << 30}) {
        ImportRun run;
        const auto asset = run(oneVoxel().material(id, {}).finish());
        ASSERT_FALSE(asset) << id;
        EXPECT_EQ(asset.error().code, ErrorCode::BadValue) << id;
    }
}

// --- MATT ---

Material importMatt(std::int32_t type, float weight, std::int32_t bits, const std::vector<float>& values) {
    std::string content = voxInts({kSlot, type}) + voxBytes(weight) + voxBytes(bits);
    for (const float value : values) content += voxBytes(value);
    ImportRun run;
    const auto asset = run(oneVoxel().chunk("MATT", content).finish());
    EXPECT_TRUE(asset) << describe(asset.error());
    return materialOf(*asset);
}

TEST(VoxMatt, TypeAndWeight) {
    EXPECT_EQ(importMatt(0, 1.0f, 0, {}).type, Diffuse);
    EXPECT_FLOAT_EQ(importMatt(1, 0.25f, 0, {}).metalness, 0.25f);
    EXPECT_FLOAT_EQ(importMatt(2, 0.5f, 0, {}).transparency, 0.5f);
    EXPECT_FLOAT_EQ(importMatt(3, 0.75f, 0, {}).emissionStrength, 0.75f);
    EXPECT_FLOAT_EQ(importMatt(0, 1.0f, 0, {}).emissionStrength, 0.0f);
}

TEST(VoxMatt, OneValueForEachSetBit) {
    // Plastic, roughness, specular, IOR and, without a value, isTotalPower.
    const Material material = importMatt(1, 1.0f, 0b10001111, {1.0f, 0.2f, 0.3f, 0.4f});
    EXPECT_FLOAT_EQ(material.roughness, 0.2f);
    EXPECT_FLOAT_EQ(material.specular, 0.3f);
    EXPECT_FLOAT_EQ(material.indexOfRefraction, 1.4f);
    EXPECT_FLOAT_EQ(importMatt(1, 1.0f, 0b00001000, {0.6f}).indexOfRefraction, 1.6f);
}

TEST(VoxMatt, MissingValuesAndUnknownTypesAreRefused) {
    ImportRun run;
    const auto missing =
        run(oneVoxel().chunk("MATT", voxInts({1, 1}) + voxBytes(1.0f) + voxInts({2})).finish());
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::Truncated);
    const auto unknown =
        run(oneVoxel().chunk("MATT", voxInts({1, 4}) + voxBytes(1.0f) + voxInts({0})).finish());
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().code, ErrorCode::BadValue);
}

// --- Palette ---

std::string rampPalette(std::size_t bytes) {
    std::string palette;
    for (int i = 0; i < 256; ++i) palette += voxBytes(0xff000000u + static_cast<std::uint32_t>(i));
    return palette.substr(0, bytes);
}

glm::u8vec4 colorOf(const std::string& bytes) {
    ImportRun run;
    const auto asset = run(bytes);
    EXPECT_TRUE(asset) << describe(asset.error());
    return materialOf(*asset).baseColor;
}

TEST(VoxPalette, VoxelUsesTheEntryBelowItsIndex) {
    EXPECT_EQ(colorOf(oneVoxel(1).chunk("RGBA", rampPalette(1024)).finish()), (glm::u8vec4{0, 0, 0, 255}));
    EXPECT_EQ(colorOf(oneVoxel(255).chunk("RGBA", rampPalette(1024)).finish()),
              (glm::u8vec4{254, 0, 0, 255}));
}

TEST(VoxPalette, LastEntryMayBeMissing) {
    EXPECT_EQ(colorOf(oneVoxel(255).chunk("RGBA", rampPalette(1020)).finish()),
              (glm::u8vec4{254, 0, 0, 255}));
    ImportRun run;
    const auto asset = run(oneVoxel().chunk("RGBA", rampPalette(1016)).finish());
    ASSERT_FALSE(asset);
    EXPECT_EQ(asset.error().code, ErrorCode::Truncated);
}

TEST(VoxPalette, DefaultBySamples) {
    const std::pair<std::uint8_t, glm::u8vec4> samples[] = {
        {1, {255, 255, 255, 255}}, {2, {255, 255, 204, 255}},   {6, {255, 255, 0, 255}},
        {7, {255, 204, 255, 255}}, {37, {204, 255, 255, 255}},  {215, {0, 0, 51, 255}},
        {216, {238, 0, 0, 255}},   {225, {17, 0, 0, 255}},      {226, {0, 238, 0, 255}},
        {236, {0, 0, 238, 255}},   {246, {238, 238, 238, 255}}, {255, {17, 17, 17, 255}}};
    for (const auto& [index, color] : samples)
        EXPECT_EQ(colorOf(oneVoxel(index).finish()), color) << int{index};
}

TEST(VoxPalette, IndexMapChangesNoColor) {
    std::string reversed;
    for (int i = 255; i >= 0; --i) reversed += static_cast<char>(i);
    ImportRun run;
    const auto asset = run(oneVoxel(9).chunk("RGBA", rampPalette(1024)).chunk("IMAP", reversed).finish());
    ASSERT_TRUE(asset);
    EXPECT_EQ(materialOf(*asset).baseColor, (glm::u8vec4{8, 0, 0, 255}));
    EXPECT_TRUE(run.diagnostics.entries().empty());
}

TEST(VoxPalette, IndexMapThatIsNoPermutationIsReported) {
    for (const std::size_t bytes : {std::size_t{256}, std::size_t{12}}) {
        ImportRun run;
        ASSERT_TRUE(run(oneVoxel().chunk("IMAP", std::string(bytes, '\1')).finish()));
        EXPECT_TRUE(run.reported("vox-imap-invalid"));
    }
}

}  // namespace
}  // namespace pfvox

// A scene with its PF_VOX files, and a PF_VOX file instead of a scene.
#include <gmock/gmock.h>

#include <pfvox/scene.hpp>

#include "support/scene_assets.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class SceneLoader : public ::testing::Test {
  protected:
    void SetUp() override {
        writePfVox(folder / "props/a.pf_vox", boxAsset({{0, 0, 0}, {4, 4, 4}}, 0.5));
        writePfVox(folder / "b.pf_vox", boxAsset({{0, 0, 0}, {8, 2, 2}}, 0.1));
    }
    Result<LoadedScene> load(const std::string& text, const Limits& limits = {}) {
        writeText(folder / "scenes/s.toml", text);
        return loadScene(folder / "scenes/s.toml", limits, diagnostics);
    }
    Error errorOf(const std::string& text) {
        const auto loaded = load(text);
        EXPECT_FALSE(loaded);
        return loaded ? Error{} : loaded.error();
    }

    TempFolder folder;
    DiagnosticList diagnostics;
};

TEST_F(SceneLoader, PathsCountFromTheSceneAndAFileIsLoadedOnce) {
    const auto loaded = load(R"(
[[models]]
path = "../props/a.pf_vox"
[[models]]
path = "../b.pf_vox"
translateVec = [10, 0, 0]
[[models]]
path = "../props/../props/a.pf_vox"
translateVec = [0, 5, 0]
metresPerVoxel = 1
)");
    ASSERT_TRUE(loaded) << describe(loaded.error());
    EXPECT_THAT(diagnostics.entries(), IsEmpty());
    ASSERT_EQ(loaded->parts.size(), 3u);
    EXPECT_EQ(loaded->parts[0].asset, loaded->parts[2].asset);
    EXPECT_NE(loaded->parts[0].asset, loaded->parts[1].asset);
    EXPECT_EQ(loaded->parts[2].model, 2u);
    EXPECT_EQ(loaded->bounds.min, glm::dvec3(0.0));
    EXPECT_NEAR(loaded->bounds.max.x, 10.8, 1e-6);
    EXPECT_NEAR(loaded->bounds.max.y, 9.0, 1e-6);
    EXPECT_EQ(loaded->probes.counts.x, 9u);
}

TEST_F(SceneLoader, AbsolutePathsAreTakenAsTheyAre) {
    const auto loaded = load("[[models]]\npath = '" + (folder / "b.pf_vox").string() + "'\n");
    EXPECT_TRUE(loaded) << describe(loaded.error());
}

TEST_F(SceneLoader, InvisibleModelsAreNotEvenLookedFor) {
    const auto loaded =
        load("[[models]]\npath = 'none.pf_vox'\nvisible = false\n[[models]]\npath = '../b.pf_vox'\n");
    ASSERT_TRUE(loaded) << describe(loaded.error());
    EXPECT_EQ(loaded->scene.models.size(), 2u);
    ASSERT_EQ(loaded->parts.size(), 1u);
    EXPECT_EQ(loaded->parts[0].model, 1u);
}

TEST_F(SceneLoader, SceneWithoutModelsLoads) {
    const auto loaded = load("");
    ASSERT_TRUE(loaded);
    EXPECT_TRUE(loaded->bounds.empty());
    EXPECT_EQ(loaded->probes.counts, glm::uvec3(1));
}

TEST_F(SceneLoader, MissingFileHasItsPlaceInTheScene) {
    const Error error =
        errorOf("[[models]]\npath = '../b.pf_vox'\n[[models]]\nname = 'x'\npath = 'no such.pf_vox'\n");
    EXPECT_EQ(error.code, ErrorCode::FileNotFound);
    EXPECT_EQ(error.file, folder / "scenes/s.toml");
    EXPECT_EQ(error.context, "line 5, column 8");
    EXPECT_THAT(error.message, AllOf(HasSubstr("scenes/no such.pf_vox"), HasSubstr("vox2pf convert")));
}

TEST_F(SceneLoader, SourceInsteadOfAPfVoxFileNamesTheCommand) {
    writeText(folder / "scenes/it's.vox",
              "VOX \x96 and so on, long enough for a header ..........................");
    const Error error = errorOf("[[models]]\npath = \"it's.vox\"\n");
    EXPECT_EQ(error.code, ErrorCode::BadMagic);
    EXPECT_EQ(error.file, folder / "scenes/it's.vox");
    const std::string word = (folder / "scenes/it'\\''s").string();
    EXPECT_THAT(error.message, HasSubstr("vox2pf convert '" + word + ".vox' -o '" + word + ".pf_vox'"));
    EXPECT_THAT(error.message, HasSubstr("s.toml, line 2, column 8"));
}

TEST_F(SceneLoader, BrokenFileIsTheFilesFault) {
    std::filesystem::resize_file(folder / "b.pf_vox", 300);
    const Error error = errorOf("[[models]]\npath = '../b.pf_vox'\n");
    EXPECT_EQ(error.file, folder / "b.pf_vox");
    EXPECT_THAT(error.message, HasSubstr("s.toml, line 2, column 8"));
}

TEST_F(SceneLoader, BrokenSceneAndMissingScene) {
    EXPECT_EQ(errorOf("[[models]]\n").context, "line 1, column 1");
    const auto missing = loadScene(folder / "none.toml", {}, diagnostics);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::FileNotFound);
}

TEST_F(SceneLoader, WarningsNameTheirFile) {
    ASSERT_TRUE(load("shadow = 1\n"));
    ASSERT_EQ(diagnostics.entries().size(), 1u);
    EXPECT_THAT(diagnostics.entries()[0].message, HasSubstr("s.toml: line 1, column 1: unknown key shadow"));
}

TEST_F(SceneLoader, GridThatIsTooLargeIsTheScenesFault) {
    const Error error = errorOf("probeGridStep = 0.0001\n[[models]]\npath = '../b.pf_vox'\n");
    EXPECT_EQ(error.code, ErrorCode::LimitExceeded);
    EXPECT_EQ(error.file, folder / "scenes/s.toml");
}

TEST_F(SceneLoader, InstancesOfAllModelsAreCountedAgainstTheLimit) {
    const std::string model = "[[models]]\npath = '../b.pf_vox'\n";
    EXPECT_TRUE(load(model + model, Limits{.maxInstances = 2}));
    const auto loaded = load(model + model + model, Limits{.maxInstances = 2});
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().code, ErrorCode::LimitExceeded);
    EXPECT_EQ(loaded.error().context, "line 6, column 8");
    EXPECT_THAT(loaded.error().message, HasSubstr("maxInstances = 2"));
}

TEST_F(SceneLoader, PfVoxFileStandsAtTheOriginUnderTheDefaultLight) {
    OctreeAsset asset = boxAsset({{0, 0, 0}, {8, 2, 2}}, 0.1);
    asset.cameras = {{.name = "front", .position = {1, 2, 3}, .target = {0, 0, 0}, .fovYDegrees = 50}};
    writePfVox(folder / "c.pf_vox", asset);
    const auto loaded = loadScene(folder / "c.pf_vox", {}, diagnostics);
    ASSERT_TRUE(loaded) << describe(loaded.error());
    EXPECT_EQ(loaded->scene.sun, Sun{});
    EXPECT_EQ(loaded->scene.sky, Sky{});
    ASSERT_EQ(loaded->scene.cameras.size(), 1u);
    EXPECT_EQ(loaded->scene.cameras[0].name, "front");
    ASSERT_EQ(loaded->parts.size(), 1u);
    EXPECT_EQ(loaded->parts[0].worldFromAsset, identityAffine());
    EXPECT_NEAR(loaded->bounds.max.x, 0.8, 1e-6);
    EXPECT_EQ(loaded->probes.counts, glm::uvec3(9, 3, 3));
}

TEST_F(SceneLoader, SourceInsteadOfASceneNamesTheCommand) {
    writeText(folder / "hall.vdb",
              "no PF_VOX file, but long enough to have a header of one ......................");
    const auto loaded = loadScene(folder / "hall.vdb", {}, diagnostics);
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().code, ErrorCode::BadMagic);
    EXPECT_THAT(loaded.error().message, HasSubstr("hall.pf_vox'"));
}

}  // namespace
}  // namespace pfvox::test

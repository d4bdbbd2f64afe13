// What the viewer remembers.
#include "settings.hpp"

#include <gmock/gmock.h>

#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

using namespace viewer;
using ::testing::HasSubstr;

const Settings kUnusual{.windowWidth = 801,
                        .windowHeight = 603,
                        .cameraMode = CameraMode::Fly,
                        .showWindows = false,
                        .antiAliasing = false,
                        .renderScale = 0.5,
                        .lodPixels = 2.25,
                        .exposureStops = -1.5,
                        .toneMap = ToneMap::Aces,
                        .modelGround = false,
                        .sceneGround = true};
const ViewCamera kCamera{.position = {1.1, -2.5, 1e6}, .target = {0.1, 0.2, 0.3}, .fovYDegrees = 47.3};

TEST(Settings, TextIsReadBack) {
    DiagnosticList diagnostics;
    for (const Settings& settings : {Settings{}, kUnusual}) {
        const Result<Settings> read = parseSettings(settingsText(settings), diagnostics);
        ASSERT_TRUE(read) << describe(read.error());
        EXPECT_EQ(*read, settings);
    }
    EXPECT_TRUE(diagnostics.entries().empty());
}

TEST(Settings, EmptyTextAndUnknownKeysAreDefaults) {
    DiagnosticList diagnostics;
    EXPECT_EQ(parseSettings("", diagnostics).value(), Settings{});
    EXPECT_EQ(parseSettings("later = 'version'\n[more]\na = 1\n", diagnostics).value(), Settings{});
    EXPECT_TRUE(diagnostics.entries().empty());
}

TEST(Settings, WrongValuesBecomeDefaultsAndAreTold) {
    DiagnosticList diagnostics;
    const Result<Settings> read = parseSettings(
        "windowWidth = 3\nwindowHeight = 'tall'\ncameraMode = 'walk'\nshowWindows = 7\nrenderScale = nan\n"
        "lodPixels = -1\nexposureStops = inf\ntoneMap = 'film'\nantiAliasing = false\n",
        diagnostics);
    ASSERT_TRUE(read);
    Settings expected;
    expected.antiAliasing = false;
    EXPECT_EQ(*read, expected);
    EXPECT_EQ(diagnostics.entries().size(), 8u);
    for (const Diagnostic& diagnostic : diagnostics.entries()) EXPECT_EQ(diagnostic.id, "settings-bad-value");
}

TEST(Settings, WhatIsNotTomlIsAnErrorWithItsLine) {
    DiagnosticList diagnostics;
    const Result<Settings> read = parseSettings("renderScale = 1\nnonsense\n", diagnostics);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::BadStructure);
    EXPECT_THAT(read.error().message, HasSubstr("line 2"));
}

TEST(CameraMemory, TextIsReadBackExactly) {
    const CameraMemory cameras{{"/models/a \"quoted\" name.pf_vox", kCamera}, {"/b.toml", ViewCamera{}}};
    const Result<CameraMemory> read = parseCameras(camerasText(cameras));
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_EQ(*read, cameras);
}

TEST(CameraMemory, EntriesThatAreNoCamerasAreLeftOut) {
    const Result<CameraMemory> read = parseCameras(
        "a = 1\n[b]\nposition = [1, 2]\ntarget = [0, 0, 0]\nfovYDegrees = 40\n"
        "[c]\nposition = [1, 1, 1]\ntarget = [1, 1, 1]\nfovYDegrees = 40\n"
        "[d]\nposition = [1, 1, inf]\ntarget = [0, 0, 0]\nfovYDegrees = 40\n"
        "[e]\nposition = [1, 1, 1]\ntarget = [0, 0, 0]\nfovYDegrees = 0\n"
        "[f]\nposition = [1, 1, 1]\ntarget = [0, 0, 0]\nfovYDegrees = 40\n");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->size(), 1u);
    EXPECT_TRUE(read->contains("f"));
}

TEST(UserFolders, FollowTheXdgSpecification) {
    EXPECT_EQ(userFolders("/c", "/s", "/home/x").config, "/c");
    EXPECT_EQ(userFolders("/c", "/s", "/home/x").state, "/s");
    EXPECT_EQ(userFolders(nullptr, "", "/home/x").config, "/home/x/.config");
    EXPECT_EQ(userFolders("relative", nullptr, "/home/x").state, "/home/x/.local/state");
    EXPECT_TRUE(userFolders(nullptr, nullptr, nullptr).config.empty());
}

TEST(Memory, IsKeptInTheUsersFolders) {
    const TempFolder folder;
    const UserFolders folders{.config = folder / "config", .state = folder / "state"};
    const Memory memory{.settings = kUnusual, .cameras = {{"/a.pf_vox", kCamera}}};
    ASSERT_TRUE(saveMemory(folders, memory));
    EXPECT_TRUE(std::filesystem::exists(folder / "config" / "pfvox" / "pfview.toml"));
    DiagnosticList diagnostics;
    const Memory read = loadMemory(folders, diagnostics);
    EXPECT_EQ(read.settings, memory.settings);
    EXPECT_EQ(read.cameras, memory.cameras);
    EXPECT_TRUE(diagnostics.entries().empty());
}

TEST(Memory, MissingOrBrokenFilesAreDefaults) {
    const TempFolder folder;
    const UserFolders folders{.config = folder / "config", .state = folder / "state"};
    DiagnosticList diagnostics;
    EXPECT_EQ(loadMemory(folders, diagnostics).settings, Settings{});
    EXPECT_TRUE(diagnostics.entries().empty()) << "a first run is nothing to talk about";
    std::filesystem::create_directories(folder / "config" / "pfvox");
    writeText(folder / "config" / "pfvox" / "pfview.toml", "= broken");
    EXPECT_EQ(loadMemory(folders, diagnostics).settings, Settings{});
    ASSERT_EQ(diagnostics.entries().size(), 1u);
    EXPECT_THAT(diagnostics.entries()[0].message, HasSubstr("pfview.toml"));
    EXPECT_TRUE(loadMemory({}, diagnostics).cameras.empty());
    EXPECT_TRUE(saveMemory({}, {}));
}

TEST(Memory, FilesThatNestWithoutEndAreDefaults) {
    const TempFolder folder;
    const UserFolders folders{.config = folder / "config", .state = folder / "state"};
    std::string deep = "a";
    for (int i = 0; i < 200'000; ++i) deep += ".a";
    std::filesystem::create_directories(folder / "config" / "pfvox");
    writeText(folder / "config" / "pfvox" / "pfview.toml", deep + "=1");
    DiagnosticList diagnostics;
    EXPECT_EQ(loadMemory(folders, diagnostics).settings, Settings{});
    ASSERT_EQ(diagnostics.entries().size(), 1u);
    EXPECT_THAT(diagnostics.entries()[0].message, HasSubstr("nested deeper"));
}

}  // namespace
}  // namespace pfvox::test

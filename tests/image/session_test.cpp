// The interactive viewer without its window: what is loaded, what commands do, what happens when files
// change.
#include <gmock/gmock.h>

#include "png.hpp"
#include "support/image_compare.hpp"
#include "support/lit_hall.hpp"
#include "support/session_fixture.hpp"

namespace pfvox::test {
namespace {

using namespace viewer;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

fs::path hallProbes() {
    return fs::path(PFVOX_TESTS_DIR) / "image/golden/hall.pf_probe";
}

using SessionTest = SessionFixture;

TEST_F(SessionTest, ShowsAFileAndRestsWhenThePictureIsSmooth) {
    write("room.pf_vox", demoRoom());
    start({.path = folder / "room.pf_vox"});
    ASSERT_NE(session->shown(), nullptr);
    EXPECT_TRUE(session->needsFrame(kSize));
    for (int i = 0; i < 128; ++i) ASSERT_TRUE(session->draw(kSize));
    EXPECT_FALSE(session->needsFrame(kSize));
    EXPECT_EQ(session->frames().frames(), 128u);
    press('3');
    EXPECT_TRUE(session->needsFrame(kSize));
    EXPECT_FALSE(session->needsFrame({0, 0})) << "minimised";
}

TEST_F(SessionTest, WithoutAntiAliasingOneFrameIsAll) {
    write("room.pf_vox", demoRoom());
    start({.path = folder / "room.pf_vox"}, {.settings = {.antiAliasing = false}, .cameras = {}});
    ASSERT_TRUE(session->draw(kSize));
    EXPECT_FALSE(session->needsFrame(kSize));
    press('2');
    ASSERT_TRUE(session->draw(kSize));
    EXPECT_FALSE(session->needsFrame(kSize));
}

TEST_F(SessionTest, KeysSwitchViewsWindowsHelpAndCamera) {
    write("room.pf_vox", demoRoom());
    start({.path = folder / "room.pf_vox"});
    for (const ViewEntry& view : viewModes()) {
        log.dismissStrip();
        press(view.key, view.control);
        EXPECT_EQ(session->mode, view.mode);
        EXPECT_EQ(log.strip().has_value(), view.needs != ViewNeeds::Nothing) << view.name;
        EXPECT_TRUE(session->draw(kSize)) << view.name << ": the final picture stands in";
    }
    press('H');
    EXPECT_TRUE(session->showHelp);
    press(kKeyTab);
    EXPECT_FALSE(session->settings.showWindows);
    press('C');
    EXPECT_EQ(session->camera.mode, CameraMode::Fly);
    const ViewCamera framed = session->camera.camera();
    session->camera.move({1, 1, 1}, 3.0, true);
    press('F');
    EXPECT_NEAR(glm::length(session->camera.camera().target - framed.target), 0.0, 0.5);
    press('V');
    EXPECT_THAT(log.messages().back().text, HasSubstr("no cameras"));
    EXPECT_FALSE(session->wantsToQuit());
    press('Q', true);
    EXPECT_TRUE(session->wantsToQuit());
}

TEST_F(SessionTest, ScreenshotsAreNumberedAndShowThePicture) {
    write("room.pf_vox", demoRoom());
    start({.path = folder / "room.pf_vox", .screenshotFolder = folder / "shots"});
    const Picture picture = drawn();
    press('P');
    press('P');
    const Result<Picture> written = readPng(folder / "shots" / "room-002.png");
    ASSERT_TRUE(written) << describe(written.error());
    EXPECT_TRUE(written->pixels == picture.pixels);
    EXPECT_TRUE(readPng(folder / "shots" / "room-001.png"));
}

TEST_F(SessionTest, PickTellsVoxelMaterialModelAndInstance) {
    write("box.pf_vox", box(8));
    write("room.pf_vox", demoRoom());
    writeText(folder / "s.toml",
              "[[models]]\npath = 'room.pf_vox'\nname = 'far away'\ntranslateVec = [500, 0, 0]\n"
              "[[models]]\npath = 'box.pf_vox'\nname = 'first box'\ntranslateVec = [3, 0, 0]\n"
              "[[models]]\npath = 'box.pf_vox'\nname = 'the box'\n");
    start({.path = folder / "s.toml",
           .camera = {.camera = ViewCamera{.position = {0.45, 0.35, 5.0}, .target = {0.45, 0.35, 0.0}},
                      .name = {}}});
    drawn();
    session->pickAt({0.5, 0.5});
    ASSERT_TRUE(session->pick());
    const Pick& pick = *session->pick();
    EXPECT_EQ(pick.model, "the box");
    EXPECT_THAT(pick.instance, HasSubstr("0 'box'"));
    EXPECT_EQ(pick.voxel, glm::ivec3(4, 3, 7));
    EXPECT_EQ(pick.baseColor, glm::u8vec4(220, 20, 20, 255));
    EXPECT_THAT(pick.material, HasSubstr("0"));
    EXPECT_NEAR(pick.distanceMetres, 4.2, 1e-4);
    session->pickAt({0.01, 0.01});
    EXPECT_FALSE(session->pick()) << "the sky";
}

TEST_F(SessionTest, AModelAloneStandsOnAGroundThatNobodyPicks) {
    write("a.pf_vox", box(8));
    writeText(folder / "s.toml", "[[models]]\npath = 'a.pf_vox'\n");
    const ViewCamera above{.position = {0.4, 3.0, 3.0}, .target = {0.4, 0.0, 0.4}};
    start({.path = folder / "a.pf_vox", .camera = {.camera = above, .name = {}}});
    EXPECT_TRUE(session->showsSingleModel());
    const Picture standing = drawn();
    EXPECT_GT(session->statistics().ambientRays, 0u);
    session->pickAt({0.5, 0.95});
    EXPECT_FALSE(session->pick()) << "the ground";
    session->settings.modelGround = false;
    EXPECT_TRUE(session->needsFrame(kSize));
    EXPECT_FALSE(drawn().pixels == standing.pixels);
    EXPECT_FALSE(session->memory().settings.modelGround);
    session->open(folder / "s.toml");
    settle();
    EXPECT_FALSE(session->showsSingleModel());
    session->settings.modelGround = true;
    session->camera.set(above);
    const Picture floating = drawn();
    session->settings.sceneGround = true;
    EXPECT_FALSE(drawn().pixels == floating.pixels);
}

TEST_F(SessionTest, AChangedFileIsShownAndTheCameraStays) {
    write("a.pf_vox", demoRoom());
    start({.path = folder / "a.pf_vox"});
    session->camera.move({0, 0, 1}, 0.1, false);
    const ViewCamera camera = session->camera.camera();
    const std::uint64_t voxels = session->shown()->scene.statistics().voxels;
    write("a.pf_vox", box(8));
    settle();
    EXPECT_NE(session->shown()->scene.statistics().voxels, voxels);
    EXPECT_EQ(session->shown()->scene.statistics().voxels, 512u);
    EXPECT_EQ(session->camera.camera(), camera);
    EXPECT_FALSE(log.strip());
}

TEST_F(SessionTest, ABrokenFileKeepsTheSceneUntilItIsMended) {
    write("a.pf_vox", box(8));
    start({.path = folder / "a.pf_vox"});
    const Picture before = drawn();
    writeText(folder / "a.pf_vox", "nonsense, and not even long enough");
    settle();
    ASSERT_TRUE(log.strip());
    EXPECT_THAT(*log.strip(), HasSubstr("a.pf_vox"));
    ASSERT_NE(session->shown(), nullptr);
    EXPECT_EQ(session->shown()->scene.statistics().voxels, 512u);
    write("a.pf_vox", demoRoom());
    settle();
    EXPECT_FALSE(log.strip());
    EXPECT_NE(session->shown()->scene.statistics().voxels, 512u);
}

TEST_F(SessionTest, AModelOfASceneIsWatchedToo) {
    write("a.pf_vox", box(8));
    writeText(folder / "s.toml", "[[models]]\npath = 'a.pf_vox'\n");
    start({.path = folder / "s.toml"});
    EXPECT_EQ(session->shown()->scene.statistics().voxels, 512u);
    write("a.pf_vox", demoRoom());
    settle();
    EXPECT_NE(session->shown()->scene.statistics().voxels, 512u);
}

TEST_F(SessionTest, WhatCannotBeOpenedIsTold) {
    start({.path = folder / "none.pf_vox"});
    EXPECT_EQ(session->shown(), nullptr);
    EXPECT_THAT(log.strip().value_or(""), HasSubstr("none.pf_vox"));
    press(kKeyEscape);
    EXPECT_FALSE(log.strip());
    writeText(folder / "hall.vox", "VOX \x96 and so on, long enough to have a header of some kind ........");
    session->open(folder / "hall.vox");
    settle();
    EXPECT_THAT(log.strip().value_or(""), HasSubstr("vox2pf convert"));
    press('P');
    session->pickAt({0.5, 0.5});
    press('F');
    EXPECT_TRUE(session->draw(kSize)) << "nothing to draw is no error";
}

TEST_F(SessionTest, AFolderIsGoneThrough) {
    write("a.pf_vox", box(8));
    write("b.pf_vox", demoRoom());
    start({.path = folder.path()});
    EXPECT_EQ(session->shown()->path.file.filename(), "a.pf_vox");
    press(kKeyPageDown);
    settle();
    EXPECT_EQ(session->shown()->path.file.filename(), "b.pf_vox");
    press(kKeyPageDown);
    settle();
    EXPECT_EQ(session->shown()->path.file.filename(), "a.pf_vox");
}

TEST_F(SessionTest, CamerasAreRememberedForEachFile) {
    write("a.pf_vox", box(8));
    write("b.pf_vox", demoRoom());
    start({.path = folder / "a.pf_vox"});
    const ViewCamera there{.position = {4, 3, 2}, .target = {0, 0, 0}, .fovYDegrees = 55};
    session->camera.set(there);
    session->open(folder / "b.pf_vox");
    settle();
    EXPECT_NE(session->camera.camera(), there);
    session->open(folder / "a.pf_vox");
    settle();
    EXPECT_EQ(session->camera.camera(), there);
    const Memory memory = session->memory();
    EXPECT_EQ(memory.cameras.size(), 2u);
    start({.path = folder / "a.pf_vox"}, memory);
    EXPECT_EQ(session->camera.camera(), there);
    const ViewCamera asked{.position = {9, 9, 9}, .target = {0, 0, 0}};
    start({.path = folder / "a.pf_vox", .camera = {.camera = asked, .name = {}}}, memory);
    EXPECT_EQ(session->camera.camera(), asked) << "what the command line says goes before";
}

TEST_F(SessionTest, ProbesBesideTheSceneLightItAndAreReadAgain) {
    writeLitHall(folder.path());
    fs::copy_file(hallProbes(), folder / "hall.pf_probe");
    start({.path = folder / "hall.toml", .mode = ViewMode::Tiers});
    ASSERT_NE(session->probes(), nullptr);
    EXPECT_EQ(session->probes()->probes.size(), 24u);
    EXPECT_TRUE(session->probes()->ofThisScene);
    EXPECT_THAT(log.messages()[log.messages().size() - 2].text, HasSubstr("probes from"));
    const Picture tiers = drawn();
    EXPECT_GT(session->statistics().tiers[1], 0u);

    // Broken, cut short, from another format: the last good ones stay, and the strip tells what to do.
    const std::string good = readText(folder / "hall.pf_probe");
    for (const std::string& bad :
         {std::string("no probes at all, but long enough for a header ................"),
          good.substr(0, good.size() / 2), readText(folder / "hall.pf_vox")}) {
        writeText(folder / "hall.pf_probe", bad);
        settle();
        ASSERT_TRUE(log.strip());
        EXPECT_THAT(*log.strip(), HasSubstr("hall.pf_probe"));
        EXPECT_THAT(*log.strip(), HasSubstr("probe-bake"));
        ASSERT_NE(session->probes(), nullptr);
        EXPECT_TRUE(drawn().pixels == tiers.pixels);
        log.dismissStrip();
    }
    writeText(folder / "hall.pf_probe", good);
    settle();
    EXPECT_FALSE(log.strip());
    session->dropProbes();
    EXPECT_EQ(session->probes(), nullptr);
    EXPECT_FALSE(drawn().pixels == tiers.pixels);
    session->loadProbes(folder / "hall.pf_probe");
    EXPECT_TRUE(drawn().pixels == tiers.pixels);
}

TEST_F(SessionTest, ProbesThatAppearAreTakenAndThoseOfAnotherSceneAreToldApart) {
    writeLitHall(folder.path());
    start({.path = folder / "hall.toml"});
    EXPECT_EQ(session->probes(), nullptr);
    fs::copy_file(hallProbes(), folder / "hall.pf_probe");
    settle();
    ASSERT_NE(session->probes(), nullptr);
    writeText(folder / "hall.toml", std::string(kLitHallScene) + "translateVec = [0.1, 0, 0]\n");
    settle();
    ASSERT_NE(session->probes(), nullptr);
    EXPECT_FALSE(session->probes()->ofThisScene);
    const auto messages = log.messages();
    EXPECT_TRUE(std::ranges::any_of(messages, [](const Message& m) {
        return m.kind == MessageKind::Warning && m.text.find("probe-bake '") != std::string::npos;
    }));
}

TEST_F(SessionTest, AProbeFileOpensItsScene) {
    writeLitHall(folder.path());
    fs::copy_file(hallProbes(), folder / "hall.pf_probe");
    start({.path = folder / "hall.pf_probe"});
    ASSERT_NE(session->shown(), nullptr);
    EXPECT_EQ(session->shown()->path.file.filename(), "hall.toml");
    EXPECT_NE(session->probes(), nullptr);
    fs::copy_file(hallProbes(), folder / "alone.pf_probe");
    session->open(folder / "alone.pf_probe");
    EXPECT_THAT(log.strip().value_or(""), HasSubstr("alone.toml"));
}

}  // namespace
}  // namespace pfvox::test

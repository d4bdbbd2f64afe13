// The interactive viewer without its window: what is loaded, what commands do, what happens when files
// change.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <atomic>
#include <future>

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
    ASSERT_NE(session->document.shown(), nullptr);
    EXPECT_TRUE(session->view.needsFrame(kSize));
    for (int i = 0; i < 128; ++i) ASSERT_TRUE(session->view.draw(kSize));
    EXPECT_FALSE(session->view.needsFrame(kSize));
    EXPECT_EQ(session->view.frames().frames(), 128u);
    press('3');
    EXPECT_TRUE(session->view.needsFrame(kSize));
    EXPECT_FALSE(session->view.needsFrame({0, 0})) << "minimised";
}

TEST_F(SessionTest, WithoutAntiAliasingOneFrameIsAll) {
    write("room.pf_vox", demoRoom());
    start({.path = folder / "room.pf_vox"}, {.settings = {.antiAliasing = false}, .cameras = {}});
    ASSERT_TRUE(session->view.draw(kSize));
    EXPECT_FALSE(session->view.needsFrame(kSize));
    press('2');
    ASSERT_TRUE(session->view.draw(kSize));
    EXPECT_FALSE(session->view.needsFrame(kSize));
}

TEST_F(SessionTest, KeysSwitchViewsWindowsHelpAndCamera) {
    write("room.pf_vox", demoRoom());
    start({.path = folder / "room.pf_vox"});
    for (const ViewEntry& view : viewModes()) {
        log.dismissStrip();
        press(view.key, view.control);
        EXPECT_EQ(session->view.mode, view.mode);
        EXPECT_EQ(log.strip().has_value(), view.needs != ViewNeeds::Nothing) << view.name;
        EXPECT_TRUE(session->view.draw(kSize)) << view.name << ": the final picture stands in";
    }
    press('H');
    EXPECT_TRUE(session->view.showHelp);
    press(kKeyTab);
    EXPECT_FALSE(session->view.settings.showWindows);
    press('C');
    EXPECT_EQ(session->view.camera.mode, CameraMode::Fly);
    const ViewCamera framed = session->view.camera.camera();
    session->view.camera.move({1, 1, 1}, 3.0, true);
    press('F');
    EXPECT_NEAR(glm::length(session->view.camera.camera().target - framed.target), 0.0, 0.5);
    press('V');
    EXPECT_THAT(log.messages().back().text, HasSubstr("no cameras"));
    EXPECT_FALSE(session->input.wantsToQuit());
    press('Q', true);
    EXPECT_TRUE(session->input.wantsToQuit());
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
    session->view.pickAt({0.5, 0.5});
    ASSERT_TRUE(session->view.pick());
    const Pick& pick = *session->view.pick();
    EXPECT_EQ(pick.model, "the box");
    EXPECT_THAT(pick.instance, HasSubstr("0 'box'"));
    EXPECT_EQ(pick.voxel, glm::ivec3(4, 3, 7));
    EXPECT_EQ(pick.baseColor, glm::u8vec4(220, 20, 20, 255));
    EXPECT_THAT(pick.material, HasSubstr("0"));
    EXPECT_NEAR(pick.distanceMetres, 4.2, 1e-4);
    session->view.pickAt({0.01, 0.01});
    EXPECT_FALSE(session->view.pick()) << "the sky";
}

TEST_F(SessionTest, AModelAloneStandsOnAGroundThatNobodyPicks) {
    write("a.pf_vox", box(8));
    writeText(folder / "s.toml", "[[models]]\npath = 'a.pf_vox'\n");
    const ViewCamera above{.position = {0.4, 3.0, 3.0}, .target = {0.4, 0.0, 0.4}};
    start({.path = folder / "a.pf_vox", .camera = {.camera = above, .name = {}}});
    EXPECT_TRUE(session->document.showsSingleModel());
    const Picture standing = drawn();
    EXPECT_GT(session->view.statistics().ambientRays, 0u);
    session->view.pickAt({0.5, 0.95});
    EXPECT_FALSE(session->view.pick()) << "the ground";
    session->view.settings.modelGround = false;
    EXPECT_TRUE(session->view.needsFrame(kSize));
    EXPECT_FALSE(drawn().pixels == standing.pixels);
    EXPECT_FALSE(session->view.memory().settings.modelGround);
    session->document.open(folder / "s.toml");
    settle();
    EXPECT_FALSE(session->document.showsSingleModel());
    session->view.settings.modelGround = true;
    session->view.camera.set(above);
    const Picture floating = drawn();
    session->view.settings.sceneGround = true;
    EXPECT_FALSE(drawn().pixels == floating.pixels);
}

TEST_F(SessionTest, AChangedFileIsShownAndTheCameraStays) {
    write("a.pf_vox", demoRoom());
    start({.path = folder / "a.pf_vox"});
    session->view.camera.move({0, 0, 1}, 0.1, false);
    const ViewCamera camera = session->view.camera.camera();
    const std::uint64_t voxels = session->document.shown()->scene.statistics().voxels;
    write("a.pf_vox", box(8));
    settle();
    EXPECT_NE(session->document.shown()->scene.statistics().voxels, voxels);
    EXPECT_EQ(session->document.shown()->scene.statistics().voxels, 512u);
    EXPECT_EQ(session->view.camera.camera(), camera);
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
    ASSERT_NE(session->document.shown(), nullptr);
    EXPECT_EQ(session->document.shown()->scene.statistics().voxels, 512u);
    write("a.pf_vox", demoRoom());
    settle();
    EXPECT_FALSE(log.strip());
    EXPECT_NE(session->document.shown()->scene.statistics().voxels, 512u);
}

TEST_F(SessionTest, AModelOfASceneIsWatchedToo) {
    write("a.pf_vox", box(8));
    writeText(folder / "s.toml", "[[models]]\npath = 'a.pf_vox'\n");
    start({.path = folder / "s.toml"});
    EXPECT_EQ(session->document.shown()->scene.statistics().voxels, 512u);
    write("a.pf_vox", demoRoom());
    settle();
    EXPECT_NE(session->document.shown()->scene.statistics().voxels, 512u);
}

TEST_F(SessionTest, WhatCannotBeOpenedIsTold) {
    start({.path = folder / "none.pf_vox"});
    EXPECT_EQ(session->document.shown(), nullptr);
    EXPECT_THAT(log.strip().value_or(""), HasSubstr("none.pf_vox"));
    press(kKeyEscape);
    EXPECT_FALSE(log.strip());
    writeText(folder / "hall.vox", "VOX \x96 and so on, long enough to have a header of some kind ........");
    session->document.open(folder / "hall.vox");
    settle();
    EXPECT_THAT(log.strip().value_or(""), HasSubstr("vox2pf convert"));
    press('P');
    session->view.pickAt({0.5, 0.5});
    press('F');
    EXPECT_TRUE(session->view.draw(kSize)) << "nothing to draw is no error";
}

TEST_F(SessionTest, AFolderIsGoneThrough) {
    write("a.pf_vox", box(8));
    write("b.pf_vox", demoRoom());
    start({.path = folder.path()});
    EXPECT_EQ(session->document.shown()->path.file.filename(), "a.pf_vox");
    press(kKeyPageDown);
    settle();
    EXPECT_EQ(session->document.shown()->path.file.filename(), "b.pf_vox");
    press(kKeyPageDown);
    settle();
    EXPECT_EQ(session->document.shown()->path.file.filename(), "a.pf_vox");
}

TEST_F(SessionTest, CamerasAreRememberedForEachFile) {
    write("a.pf_vox", box(8));
    write("b.pf_vox", demoRoom());
    start({.path = folder / "a.pf_vox"});
    const ViewCamera there{.position = {4, 3, 2}, .target = {0, 0, 0}, .fovYDegrees = 55};
    session->view.camera.set(there);
    session->document.open(folder / "b.pf_vox");
    settle();
    EXPECT_NE(session->view.camera.camera(), there);
    session->document.open(folder / "a.pf_vox");
    settle();
    EXPECT_EQ(session->view.camera.camera(), there);
    const Memory memory = session->view.memory();
    EXPECT_EQ(memory.cameras.size(), 2u);
    start({.path = folder / "a.pf_vox"}, memory);
    EXPECT_EQ(session->view.camera.camera(), there);
    const ViewCamera asked{.position = {9, 9, 9}, .target = {0, 0, 0}};
    start({.path = folder / "a.pf_vox", .camera = {.camera = asked, .name = {}}}, memory);
    EXPECT_EQ(session->view.camera.camera(), asked) << "what the command line says goes before";
}

TEST_F(SessionTest, TheFirstCameraOfASceneComesFirst) {
    write("a.pf_vox", box(8));
    const std::string cameras =
        "[[cameras]]\nname = 'one'\nposition = [1, 1, 5]\ntarget = [0, 0, 0]\n"
        "[[cameras]]\nname = 'two'\nposition = [2, 2, 5]\ntarget = [0, 0, 0]\n";
    for (const char* name : {"s.toml", "t.toml"})
        writeText(folder / name, "[[models]]\npath = 'a.pf_vox'\n" + cameras);
    for (const char* name : {"s.toml", "t.toml"}) {
        name == std::string("s.toml") ? start(folder / name) : session->document.open(folder / name);
        settle();
        press('V');
        EXPECT_EQ(session->view.camera.camera().position, glm::dvec3(1, 1, 5)) << name;
    }
}

TEST_F(SessionTest, KeysMeantForAComingDialogDoNothingElse) {
    write("a.pf_vox", box(8));
    start(folder / "a.pf_vox");
    const auto type = [&](Key key, bool control = false) {
        session->input.execute(*bindingOf(key, control));
    };
    type('O', true);
    for (const Key key : {'C', 'H', 'N', '3'}) type(key);  // before a frame could show the dialog
    EXPECT_EQ(session->document.composer.dialog, Dialog::Open);
    EXPECT_EQ(session->view.camera.mode, CameraMode::Orbit);
    EXPECT_FALSE(session->view.showHelp);
    EXPECT_FALSE(session->document.composer.editor.selected());
    EXPECT_EQ(session->view.mode, ViewMode::Final);
    session->document.composer.dialog = Dialog::None;
    type('C');
    EXPECT_EQ(session->view.camera.mode, CameraMode::Fly);
}

TEST_F(SessionTest, NeitherAnotherFileNorTheEndWaitsForAFileThatIsRead) {
    write("a.pf_vox", box(8));
    write("slow.pf_vox", box(2));
    struct Gate {
        std::promise<void> open;
        std::atomic<int> reading = 0, done = 0;
    };
    const auto gate = std::make_shared<Gate>();
    const std::shared_future<void> opened = gate->open.get_future().share();
    SessionStart slow{.path = {}};
    slow.read = [gate, opened](const fs::path& file, const Limits& limits, Diagnostics& diagnostics) {
        if (file.filename() == "slow.pf_vox") {
            ++gate->reading;
            opened.wait();
            ++gate->done;
        }
        return loadScene(file, limits, diagnostics);
    };
    start(slow);
    session->document.open(folder / "slow.pf_vox");
    session->document.open(folder / "a.pf_vox");
    settle();
    EXPECT_EQ(voxels(), 512u);
    session->document.open(folder / "slow.pf_vox");
    session.reset();
    EXPECT_EQ(gate->done, 0) << "nobody has waited";
    gate->open.set_value();
    for (int i = 0; i < 1000 && backgroundThreads() > 0; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(gate->done, 2);
}

// Two boxes 20 cm apart, 5,200 km from the origin: single precision alone would let them touch.
TEST_F(SessionTest, FarFromTheOriginAllLooksAsItDoesNearby) {
    write("a.pf_vox", box(2));
    const auto sceneAt = [&](const char* name, const glm::dvec3& at) {
        const auto model = [&](double x) {
            return fmt::format("[[models]]\npath = 'a.pf_vox'\ntranslateVec = [{}, {}, {}]\n", at.x + x, at.y,
                               at.z);
        };
        writeText(folder / name, model(0.0) + model(0.4));
        start({.path = folder / name,
               .camera = {.camera = ViewCamera{.position = at + glm::dvec3{0.3, 0.5, 1.5},
                                               .target = at + glm::dvec3{0.3, 0.1, 0.1}},
                          .name = {}}});
        return drawn();
    };
    const Picture near = sceneAt("near.toml", glm::dvec3(0.0));
    const glm::dvec3 away{256.0 * 20313, 0.0, -256.0 * 11719};
    const Picture far = sceneAt("far.toml", away);
    EXPECT_EQ(session->document.shown()->scene.origin(), away);
    EXPECT_LE(differenceOf(far, near, 8).pixels, 4u) << "doubles round too";
    session->view.pickAt({0.5, 0.5});
    EXPECT_FALSE(session->view.pick()) << "between the boxes";
    session->view.pickAt({0.64, 0.5});
    ASSERT_TRUE(session->view.pick());
    EXPECT_NEAR(session->view.pick()->point.x - away.x, 0.4, 0.2);
}

TEST_F(SessionTest, ProbesBesideTheSceneLightItAndAreReadAgain) {
    writeLitHall(folder.path());
    fs::copy_file(hallProbes(), folder / "hall.pf_probe");
    start({.path = folder / "hall.toml", .mode = ViewMode::Tiers});
    ASSERT_NE(session->document.probes(), nullptr);
    EXPECT_EQ(session->document.probes()->probes.size(), 24u);
    EXPECT_TRUE(session->document.probes()->ofThisScene);
    EXPECT_THAT(log.messages()[log.messages().size() - 2].text, HasSubstr("probes from"));
    const Picture tiers = drawn();
    EXPECT_GT(session->view.statistics().tiers[1], 0u);

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
        ASSERT_NE(session->document.probes(), nullptr);
        EXPECT_TRUE(drawn().pixels == tiers.pixels);
        log.dismissStrip();
    }
    writeText(folder / "hall.pf_probe", good);
    settle();
    EXPECT_FALSE(log.strip());
    session->document.dropProbes();
    EXPECT_EQ(session->document.probes(), nullptr);
    EXPECT_FALSE(drawn().pixels == tiers.pixels);
    session->document.loadProbes(folder / "hall.pf_probe");
    EXPECT_TRUE(drawn().pixels == tiers.pixels);
}

TEST_F(SessionTest, ProbesThatAppearAreTakenAndThoseOfAnotherSceneAreToldApart) {
    writeLitHall(folder.path());
    start({.path = folder / "hall.toml"});
    EXPECT_EQ(session->document.probes(), nullptr);
    fs::copy_file(hallProbes(), folder / "hall.pf_probe");
    settle();
    ASSERT_NE(session->document.probes(), nullptr);
    writeText(folder / "hall.toml", std::string(kLitHallScene) + "translateVec = [0.1, 0, 0]\n");
    settle();
    ASSERT_NE(session->document.probes(), nullptr);
    EXPECT_FALSE(session->document.probes()->ofThisScene);
    const auto messages = log.messages();
    EXPECT_TRUE(std::ranges::any_of(messages, [](const Message& m) {
        return m.kind == MessageKind::Warning && m.text.find("probe-bake '") != std::string::npos;
    }));
}

TEST_F(SessionTest, AProbeFileOpensItsScene) {
    writeLitHall(folder.path());
    fs::copy_file(hallProbes(), folder / "hall.pf_probe");
    start({.path = folder / "hall.pf_probe"});
    ASSERT_NE(session->document.shown(), nullptr);
    EXPECT_EQ(session->document.shown()->path.file.filename(), "hall.toml");
    EXPECT_NE(session->document.probes(), nullptr);
    fs::copy_file(hallProbes(), folder / "alone.pf_probe");
    session->document.open(folder / "alone.pf_probe");
    EXPECT_THAT(log.strip().value_or(""), HasSubstr("alone.toml"));
}

}  // namespace
}  // namespace pfvox::test

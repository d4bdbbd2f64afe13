// pfview's window as a user meets it: started on a virtual screen, driven with real key and mouse events, seen, closed.
#include <gmock/gmock.h>

#include <cstdlib>
#include <functional>
#include <pfvox/pf_vox.hpp>

#include "png.hpp"
#include "settings.hpp"
#include "support/image_compare.hpp"
#include "support/procedural.hpp"
#include "support/virtual_screen.hpp"

namespace pfvox::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::uint32_t kWidth = 480;
constexpr std::uint32_t kHeight = 360;
constexpr const char* kConfig = "pfvox/pfview.toml";

/// Sky, sun and room: more than one colour.
bool showsSomething(const viewer::Picture& picture) {
    std::map<std::uint32_t, std::size_t> colours;
    for (const std::uint32_t pixel : picture.pixels) ++colours[pixel];
    return colours.size() > 200;
}

class WindowTest : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto xvfb = programPath("Xvfb");
        const auto xdotool = programPath("xdotool");
        if (!xvfb || !xdotool) GTEST_SKIP() << "Xvfb and xdotool are not installed (Debian: xvfb, xdotool)";
        screen = std::make_unique<VirtualScreen>(*xvfb, *xdotool, kWidth, kHeight);
        ASSERT_TRUE(screen->isThere()) << "Xvfb did not start";
        // The windows of the overlay would cover the picture, and hold figures that change.
        writeText(folder / "config" / kConfig, "showWindows = false\n");
        writeRoom();
    }
    void TearDown() override {
        if (app) {
            app->send(SIGKILL);
            app->finish();
        }
    }

    void writeRoom() const {
        const auto bytes = encodePfVox(build(demoRoom()), EncodeSettings{});
        ASSERT_TRUE(bytes) << describe(bytes.error());
        writeText(folder / "room.pf_vox", {reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    }
    void start(const std::string& file) {
        app = std::make_unique<Process>(
            std::vector<std::string>{PFVOX_PFVIEW, file, "--validate", "--size",
                                     std::to_string(kWidth) + "x" + std::to_string(kHeight)},
            ProcessSetup{.environment = {screen->environment(), "ASAN_OPTIONS=detect_leaks=0",
                                         "XDG_CONFIG_HOME=" + (folder / "config").string(),
                                         "XDG_STATE_HOME=" + (folder / "state").string()},
                         .input = {},
                         .folder = folder.path()});
    }
    /// Until it is so, at most half a minute.
    bool eventually(const std::function<bool()>& isSo) const {
        for (int i = 0; i < 150; ++i) {
            if (isSo()) return true;
            VirtualScreen::pause(0.2);
        }
        return false;
    }
    bool startAndSee(const std::string& file) {
        start(file);
        const bool seen = eventually([&] { return showsSomething(screen->picture()); });
        screen->send({"mousemove", "460", "345"});  // over the picture's edge, and in the window for the keys
        return seen;
    }
    /// Ends it as a user does; the validation layer makes the exit code 70 when it has complaints.
    void close() {
        screen->send({"key", "ctrl+q"});
        const ProcessResult result = app->finish();
        app.reset();
        EXPECT_EQ(result.exitCode, 0) << result.err;
        EXPECT_THAT(result.err, IsEmpty());
        EXPECT_THAT(result.out, IsEmpty());
    }
    viewer::Picture screenshot(const std::string& name) {
        screen->send({"key", "p"});
        EXPECT_TRUE(eventually([&] { return std::filesystem::exists(folder / name); })) << name;
        return viewer::readPng(folder / name).value_or(viewer::Picture{});
    }
    /// When its frames have gathered. The cursor is in the picture.
    ::testing::AssertionResult looksLike(const std::string& golden) {
        const ImageTolerance tolerance{.channel = 12, .pixelShare = 0.01};
        if (std::getenv("PFVOX_UPDATE_GOLDEN") != nullptr) VirtualScreen::pause(12.0);
        ::testing::AssertionResult result = ::testing::AssertionFailure();
        for (int i = 0; i < 60 && !result; ++i) {
            VirtualScreen::pause(0.5);
            result = matchesGolden(screen->picture(), golden, tolerance);
        }
        return result;
    }

    TempFolder folder;
    std::unique_ptr<VirtualScreen> screen;
    std::unique_ptr<Process> app;
};

TEST_F(WindowTest, ShowsTheSceneSwitchesViewsAndCloses) {
    ASSERT_TRUE(startAndSee("room.pf_vox"));
    EXPECT_TRUE(looksLike("window-final"));
    EXPECT_TRUE(matchesGolden(screenshot("room-001.png"), "window-final", {.channel = 12, .pixelShare = 0.01})) << "the file shows what the window shows";
    screen->send({"key", "3"});
    EXPECT_TRUE(looksLike("window-normals"));
    close();
}

TEST_F(WindowTest, TheMouseTurnsTheSceneAndFFramesIt) {
    ASSERT_TRUE(startAndSee("room.pf_vox"));
    VirtualScreen::pause(3.0);
    screen->send({"mousemove", "240", "180"});
    screen->send({"mousedown", "1"});
    for (const char* x : {"260", "290", "320"}) screen->send({"mousemove", x, "170"});
    screen->send({"mouseup", "1"});
    EXPECT_TRUE(eventually([&] { return !matchesGolden(screen->picture(), "window-final"); })) << "it turned";
    for (int i = 0; i < 3; ++i) screen->send({"click", "4"});  // the wheel
    screen->send({"key", "1"});
    VirtualScreen::pause(0.5);
    close();
    DiagnosticList diagnostics;
    const viewer::Memory memory =
        viewer::loadMemory({.config = folder / "config", .state = folder / "state"}, diagnostics);
    ASSERT_EQ(memory.cameras.size(), 1u);
    const viewer::ViewCamera camera = memory.cameras.begin()->second;
    EXPECT_EQ(memory.settings.windowWidth, kWidth);
    EXPECT_FALSE(memory.settings.showWindows);

    // The next run begins there; F goes back to everything.
    ASSERT_TRUE(startAndSee("room.pf_vox"));
    screen->send({"key", "f"});
    VirtualScreen::pause(2.0);
    close();
    const viewer::Memory later =
        viewer::loadMemory({.config = folder / "config", .state = folder / "state"}, diagnostics);
    EXPECT_FALSE(later.cameras.begin()->second == camera);
    EXPECT_GT(glm::length(later.cameras.begin()->second.position - camera.position), 0.5);
}

TEST_F(WindowTest, WindowsHelpAndMessagesAreShown) {
    ASSERT_TRUE(startAndSee("room.pf_vox"));
    VirtualScreen::pause(2.0);
    const viewer::Picture plain = screen->picture();
    const auto changed = [&] { return differenceOf(screen->picture(), plain, 24).pixels > 8000; };
    screen->send({"key", "h"});
    EXPECT_TRUE(eventually(changed)) << "the keys";
    screen->send({"key", "h"});
    EXPECT_TRUE(eventually([&] { return !changed(); }));
    screen->send({"key", "Tab"});
    EXPECT_TRUE(eventually(changed)) << "the windows";
    screen->send({"key", "Tab"});
    EXPECT_TRUE(eventually([&] { return !changed(); }));
    writeText(folder / "room.pf_vox", "broken now");
    const auto red = [&] {  // the strip at the lower edge
        const std::uint32_t pixel = screen->picture().pixels.at((kHeight - 4) * kWidth + kWidth - 10);
        return (pixel & 0xffu) > (pixel >> 8 & 0xffu) + 50u;
    };
    EXPECT_TRUE(eventually(red)) << "a message strip, and the scene stays";
    writeRoom();
    EXPECT_TRUE(eventually([&] { return !red(); })) << "mended";
    close();
}

TEST_F(WindowTest, ResizingIsSurvived) {
    ASSERT_TRUE(startAndSee("room.pf_vox"));
    for (const auto& [width, height] : {std::pair("300", "200"), std::pair("77", "355"), std::pair("480", "360")}) {
        screen->send({"search", "--name", "pfview", "windowsize", width, height});
        VirtualScreen::pause(1.0);
    }
    screen->send({"search", "--name", "pfview", "windowunmap"});
    VirtualScreen::pause(0.7);
    screen->send({"search", "--name", "pfview", "windowmap"});
    screen->send({"mousemove", "459", "345"});
    EXPECT_TRUE(looksLike("window-final"));
    close();
}

TEST_F(WindowTest, WhatCannotBeShownIsToldInTheWindow) {
    start("none.pf_vox");
    EXPECT_TRUE(eventually([&] { return screen->picture().pixels.at(kWidth * 20 + 20) != 0xff000000u; }));
    screen->send({"mousemove", "240", "100"});
    VirtualScreen::pause(1.0);
    close();
}

TEST(WindowWithoutScreen, SaysSoAndNamesTheWayWithout) {
    const ProcessResult result = runProcess({"/usr/bin/env", "-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", PFVOX_PFVIEW});
    EXPECT_EQ(result.exitCode, 6);
    EXPECT_THAT(result.err, HasSubstr("--screenshot needs none"));
}

}  // namespace
}  // namespace pfvox::test

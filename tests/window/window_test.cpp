// pfview's window as a user meets it: shown, turned, resized, told about broken files.
#include "window/window_fixture.hpp"

namespace pfvox::test {
namespace {

using ::testing::HasSubstr;

constexpr std::uint32_t kWidth = 480;
constexpr std::uint32_t kHeight = 360;

class WindowTest : public WindowFixture {
  protected:
    WindowTest() : WindowFixture(kWidth, kHeight) {}
    void SetUp() override {
        WindowFixture::SetUp();
        // The windows of the overlay would cover the picture, and hold figures that change.
        writeText(folder / "config" / kConfig, "showWindows = false\n");
        writeRoom();
    }
    void writeRoom() const { write("room.pf_vox", demoRoom()); }
};

TEST_F(WindowTest, ShowsTheSceneSwitchesViewsAndCloses) {
    ASSERT_TRUE(startAndSee("room.pf_vox"));
    EXPECT_TRUE(looksLike("window-final"));
    EXPECT_TRUE(
        matchesGolden(screenshot("room-001.png"), "window-final", {.channel = 12, .pixelFraction = 0.01}))
        << "the file shows what the window shows";
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
    for (const auto& [columns, rows] :
         {std::pair("300", "200"), std::pair("77", "355"), std::pair("480", "360")}) {
        screen->send({"search", "--name", "pfview", "windowsize", columns, rows});
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
    const ProcessResult result =
        runProcess({"/usr/bin/env", "-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", PFVOX_PFVIEW});
    EXPECT_EQ(result.exitCode, 6);
    EXPECT_THAT(result.err, HasSubstr("--screenshot needs none"));
}

}  // namespace
}  // namespace pfvox::test

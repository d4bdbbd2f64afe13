// pfview's window on a virtual screen: started, driven with real key and mouse events, seen, closed.
#pragma once

#include <gmock/gmock.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <map>
#include <pfvox/pf_vox.hpp>

#include "png.hpp"
#include "settings.hpp"
#include "support/image_compare.hpp"
#include "support/procedural.hpp"
#include "support/virtual_screen.hpp"

namespace pfvox::test {

inline constexpr std::chrono::seconds kLongestWait{20};
inline constexpr const char* kConfig = "pfvox/pfview.toml";

/// Sky, sun and room: more than one color.
inline bool showsSomething(const viewer::Picture& picture) {
    std::map<std::uint32_t, std::size_t> colors;
    for (const std::uint32_t pixel : picture.pixels) ++colors[pixel];
    return colors.size() > 200;
}

class WindowFixture : public ::testing::Test {
  protected:
    WindowFixture(std::uint32_t widthPixels, std::uint32_t heightPixels)
        : width(widthPixels), height(heightPixels) {}
    void SetUp() override {
        const auto xvfb = programPath("Xvfb");
        const auto xdotool = programPath("xdotool");
        if (!xvfb || !xdotool) GTEST_SKIP() << "Xvfb and xdotool are not installed (Debian: xvfb, xdotool)";
        screen = std::make_unique<VirtualScreen>(*xvfb, *xdotool, width, height);
        ASSERT_TRUE(screen->isThere()) << "Xvfb did not start";
    }
    void TearDown() override {
        if (app) {
            app->send(SIGKILL);
            app->finish();
        }
    }

    void write(const std::string& name, const VoxelAsset& asset) const {
        const auto bytes = encodePfVox(build(asset), EncodeSettings{});
        ASSERT_TRUE(bytes) << describe(bytes.error());
        writeText(folder / name, {reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    }
    void start(const std::string& file) {
        app = std::make_unique<Process>(
            std::vector<std::string>{PFVOX_PFVIEW, file, "--validate", "--size",
                                     std::to_string(width) + "x" + std::to_string(height)},
            ProcessSetup{.environment = {screen->environment(), "ASAN_OPTIONS=detect_leaks=0",
                                         "XDG_CONFIG_HOME=" + (folder / "config").string(),
                                         "XDG_STATE_HOME=" + (folder / "state").string()},
                         .input = {},
                         .folder = folder.path()});
    }
    /// Until it is so, at most kLongestWait.
    bool eventually(const std::function<bool()>& isSo) const {
        const auto end = std::chrono::steady_clock::now() + kLongestWait;
        do {
            if (isSo()) return true;
            VirtualScreen::pause(0.1);
        } while (std::chrono::steady_clock::now() < end);
        return isSo();
    }
    bool startAndSee(const std::string& file) {
        start(file);
        const bool seen = eventually([&] { return showsSomething(screen->picture()); });
        // Over the picture's edge, and in the window for the keys.
        screen->send({"mousemove", std::to_string(width - 20), std::to_string(height - 15)});
        return seen;
    }
    /// Waits for its end; the validation layer makes the exit code 70 when it has complaints.
    void expectClosed() {
        if (!eventually([&] { return app->hasEnded(); })) {
            ADD_FAILURE() << "it does not close";
            app->send(SIGKILL);
        }
        const ProcessResult result = app->finish();
        app.reset();
        EXPECT_EQ(result.exitCode, 0) << result.err;
        EXPECT_THAT(result.err, ::testing::IsEmpty());
        EXPECT_THAT(result.out, ::testing::IsEmpty());
    }
    /// Ends it as a user does.
    void close() {
        screen->send({"key", "ctrl+q"});
        expectClosed();
    }
    viewer::Picture screenshot(const std::string& name) {
        screen->send({"key", "p"});
        EXPECT_TRUE(eventually([&] { return std::filesystem::exists(folder / name); })) << name;
        return viewer::readPng(folder / name).value_or(viewer::Picture{});
    }
    /// When its frames have gathered. The cursor is in the picture.
    ::testing::AssertionResult looksLike(const std::string& golden, double pixelFraction = 0.01) {
        const ImageTolerance tolerance{.channel = 12, .pixelFraction = pixelFraction};
        if (std::getenv("PFVOX_UPDATE_GOLDEN") != nullptr) VirtualScreen::pause(12.0);
        ::testing::AssertionResult result = ::testing::AssertionFailure();
        eventually([&] { return bool(result = matchesGolden(screen->picture(), golden, tolerance)); });
        return result;
    }

    std::uint32_t width;
    std::uint32_t height;
    TempFolder folder;
    std::unique_ptr<VirtualScreen> screen;
    std::unique_ptr<Process> app;
};

}  // namespace pfvox::test

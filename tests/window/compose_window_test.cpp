// Composing a scene in the window with real key and mouse events: what is saved in the end is a scene file.
#include <pfvox/scene.hpp>

#include "compose/gizmo.hpp"
#include "window/window_fixture.hpp"

namespace pfvox::test {
namespace {

using viewer::Gizmo;
using viewer::Handle;
using viewer::Projection;
using viewer::ViewCamera;

constexpr std::uint32_t kWidth = 1000;
constexpr std::uint32_t kHeight = 700;
constexpr ViewCamera kCamera{.position = {4.0, 5.0, 16.0}, .target = {4.0, 2.0, 2.0}, .fovYDegrees = 40.0};
// What nothing covers: sky between the panels.
constexpr int kSkyX = 500;
constexpr int kSkyY = 120;
// Each picture at once, and the same one every time: software devices need long for the frames of a smooth
// one.
constexpr const char* kSettings = "renderScale = 0.25\nantiAliasing = false\n";
constexpr const char* kSceneText =
    "[[cameras]]\nposition = [4.0, 5.0, 16.0]\ntarget = [4.0, 2.0, 2.0]\nfovYDegrees = 40.0\n"
    "[[models]]\npath = 'room.pf_vox'\n";

class ComposeWindowTest : public WindowFixture {
  protected:
    ComposeWindowTest() : WindowFixture(kWidth, kHeight) {}
    void SetUp() override {
        WindowFixture::SetUp();
        writeText(folder / "config" / kConfig, kSettings);
        VoxelAsset room = demoRoom();
        room.source.voxelSizeMetres = 0.1;
        write("room.pf_vox", room);
        VoxelAsset box;
        box.source.voxelSizeMetres = 0.1;
        box.materials = {material(30, 60, 220)};
        fillBox(box.models.emplace_back(), {.min = {0, 0, 0}, .max = {16, 16, 16}},
                [](glm::ivec3) { return MaterialIndex{0}; });
        box.instances.push_back({.model = 0, .worldFromModel = Affine{0.1}});
        write("box.pf_vox", box);
        writeText(folder / "scene.toml", kSceneText);
    }
    void click(int x, int y) const {
        screen->send({"mousemove", std::to_string(x), std::to_string(y)});
        VirtualScreen::pause(0.4);
        screen->send({"click", "1"});
        VirtualScreen::pause(0.4);
    }
    void key(const std::string& name) const {
        screen->send({"key", name});
        VirtualScreen::pause(0.4);
    }
    /// Waits until the question or dialog that the key opens has darkened the rest.
    bool keyOpens(const std::string& name) {
        plain_ = screen->picture();
        key(name);
        return eventually([&] { return isDimmed(); });
    }
    bool isDimmed() const { return differenceOf(screen->picture(), plain_, 24).pixels > 100000; }
    std::optional<Scene> saved() const {
        DiagnosticList ignored;
        const Result<Scene> scene = readScene(folder / "scene.toml", Limits{}, ignored);
        return scene ? std::optional(*scene) : std::nullopt;
    }
    /// Presses Ctrl+S until the file says so.
    bool savedAs(const std::function<bool(const Scene&)>& isSo) const {
        return eventually([&] {
            screen->send({"key", "ctrl+s"});
            VirtualScreen::pause(0.3);
            const std::optional<Scene> scene = saved();
            return scene && isSo(*scene);
        });
    }
    void addBox() {
        ASSERT_TRUE(keyOpens("Insert"));
        VirtualScreen::pause(0.5);  // its field takes the keys a frame later
        screen->send({"type", "--delay", "30", "box.pf_vox"});
        key("Return");
        ASSERT_TRUE(eventually([&] { return !isDimmed(); }));
    }

  private:
    viewer::Picture plain_;
};

TEST_F(ComposeWindowTest, AModelIsAddedMovedUndoneAndSaved) {
    ASSERT_TRUE(startAndSee("scene.toml"));
    click(kSkyX, kSkyY);  // the keys are the picture's from here on
    ASSERT_NO_FATAL_FAILURE(addBox());
    ASSERT_TRUE(savedAs([](const Scene& scene) { return scene.models.size() == 2; }));
    EXPECT_EQ(saved()->models[1].path, "box.pf_vox");
    const glm::dvec3 place = saved()->models[1].translateMetres;
    // By a key,
    key("Right");
    ASSERT_TRUE(
        savedAs([&](const Scene& scene) { return scene.models[1].translateMetres.x > place.x + 0.05; }));
    // by the field of the selected model (Ctrl+click types into it),
    screen->send({"mousemove", "50", "279"});
    VirtualScreen::pause(0.4);
    screen->send({"keydown", "ctrl", "click", "1", "keyup", "ctrl"});
    VirtualScreen::pause(0.6);
    screen->send({"type", "--delay", "30", "5.25"});
    key("Return");
    ASSERT_TRUE(savedAs([](const Scene& scene) { return scene.models[1].translateMetres.x == 5.25; }));
    // and back again: the field is one step, the key another.
    key("ctrl+z");
    key("ctrl+z");
    ASSERT_TRUE(savedAs([&](const Scene& scene) { return scene.models[1].translateMetres == place; }));
    key("ctrl+z");
    ASSERT_TRUE(savedAs([](const Scene& scene) { return scene.models.size() == 1; }));
    key("ctrl+shift+z");
    ASSERT_TRUE(savedAs([](const Scene& scene) { return scene.models.size() == 2; }));
    close();
#ifdef PFVOX_PROBE_BAKE
    const ProcessResult planned =
        runProcess({PFVOX_PROBE_BAKE, "bake", "scene.toml", "-o", "out.pf_probe", "--dry-run"},
                   {.environment = {}, .input = {}, .folder = folder.path()});
    EXPECT_EQ(planned.exitCode, 0) << planned.err;
#endif
}

TEST_F(ComposeWindowTest, AKeyIsNotLostInASlowFrame) {
    // Frames that follow each other without a pause, each longer than a key is down.
    writeText(folder / "config" / kConfig, "renderScale = 1.0\n");
    ASSERT_TRUE(startAndSee("scene.toml"));
    click(kSkyX, kSkyY);
    ASSERT_NO_FATAL_FAILURE(addBox());
    EXPECT_TRUE(savedAs([](const Scene& scene) { return scene.models.size() == 2; }));
    close();
}

TEST_F(ComposeWindowTest, TheFileDialogKeepsTheKeyboard) {
    ASSERT_TRUE(startAndSee("scene.toml"));
    click(kSkyX, kSkyY);
    ASSERT_TRUE(keyOpens("Insert"));
    VirtualScreen::pause(0.5);
    const auto type = [&](const std::string& name) {
        key("ctrl+a");  // what was wrong stays, to be mended
        screen->send({"type", "--delay", "30", name});
        key("Return");
        VirtualScreen::pause(0.5);
    };
    key("Return");
    VirtualScreen::pause(0.5);
    type("none.pf_vox");
    EXPECT_TRUE(isDimmed()) << "it says that there is no such file";
    type("..");
    type(folder.path().filename().string());
    type("box.pf_vox");
    ASSERT_TRUE(eventually([&] { return !isDimmed(); }));
    EXPECT_TRUE(savedAs([](const Scene& scene) { return scene.models.size() == 2; }));
    close();
}

TEST_F(ComposeWindowTest, AMessageIsInFrontOfTheWindows) {
    ASSERT_TRUE(startAndSee("scene.toml"));
    const auto red = [&] {  // the strip at the lower edge, where the log is below it
        const std::uint32_t pixel = screen->picture().pixels.at((kHeight - 12) * kWidth + kWidth / 2);
        return (pixel & 0xffu) > (pixel >> 8 & 0xffu) + 50u;
    };
    click(kSkyX, kSkyY);
    writeText(folder / "scene.toml", "broken = [");
    ASSERT_TRUE(eventually(red));
    key("Escape");
    ASSERT_TRUE(eventually([&] { return !red(); }));
    click(500, 640);  // the log comes to the front
    writeText(folder / "scene.toml", "broken once more = [");
    EXPECT_TRUE(eventually(red));
    click(500, 615);
    EXPECT_TRUE(red()) << "whatever is clicked";
    writeText(folder / "scene.toml", kSceneText);
    EXPECT_TRUE(eventually([&] { return !red(); })) << "mended";
    close();
}

TEST_F(ComposeWindowTest, TheMouseSelectsAndDragsAModel) {
    writeText(folder / "scene.toml",
              std::string(kSceneText) + "[[models]]\npath = 'box.pf_vox'\ntranslateVec = [3.2, 0, 3]\n");
    ASSERT_TRUE(startAndSee("scene.toml"));
    const Projection view(kCamera, {kWidth, kHeight});
    const glm::dvec2 middle = *view.pointOf({4.0, 0.8, 4.6});
    click(static_cast<int>(middle.x), static_cast<int>(middle.y));
    VirtualScreen::pause(0.6);
    const Gizmo gizmo(view, {4.0, 0.0, 3.8});
    const glm::dvec2 from = *view.pointOf(gizmo.tipOf(Handle::X));
    const auto moveTo = [&](const glm::dvec2& at) {
        screen->send({"mousemove", std::to_string(std::lround(at.x)), std::to_string(std::lround(at.y))});
        VirtualScreen::pause(0.4);
    };
    moveTo(from);
    screen->send({"mousedown", "1"});
    for (const double by : {-10.0, -30.0, -60.0}) moveTo(from + glm::dvec2(by, 0.0));
    screen->send({"mouseup", "1"});
    ASSERT_TRUE(savedAs([](const Scene& scene) { return scene.models[1].translateMetres.x < 3.0; }));
    EXPECT_EQ(saved()->models[1].translateMetres.y, 0.0);
    EXPECT_EQ(saved()->models[1].translateMetres.z, 3.0);
    key("ctrl+z");
    ASSERT_TRUE(savedAs([](const Scene& scene) { return scene.models[1].translateMetres.x == 3.2; }))
        << "one step";
    close();
}

TEST_F(ComposeWindowTest, ClosingAsksAboutChanges) {
    ASSERT_TRUE(startAndSee("scene.toml"));
    const std::string before = readText(folder / "scene.toml");
    click(kSkyX, kSkyY);
    key("n");
    key("Right");
    VirtualScreen::pause(0.6);
    ASSERT_TRUE(keyOpens("ctrl+q")) << "the question";
    key("Escape");
    ASSERT_TRUE(eventually([&] { return !isDimmed(); })) << "cancelled";
    EXPECT_EQ(readText(folder / "scene.toml"), before);
    ASSERT_TRUE(keyOpens("ctrl+q"));
    key("Delete");
    expectClosed();
    EXPECT_EQ(readText(folder / "scene.toml"), before) << "discarded";

    ASSERT_TRUE(startAndSee("scene.toml"));
    click(kSkyX, kSkyY);
    key("n");
    key("Right");
    VirtualScreen::pause(0.6);
    ASSERT_TRUE(keyOpens("ctrl+q"));
    key("Return");
    expectClosed();
    EXPECT_NEAR(saved()->models[0].translateMetres.x, 0.1, 1e-6) << "saved";
}

TEST_F(ComposeWindowTest, BoxesProbesAndHandlesAreDrawn) {
    writeText(folder / "config" / kConfig,
              std::string(kSettings) + "showProbeGrid = true\nshowBounds = true\n");
    writeText(
        folder / "scene.toml",
        std::string("probeGridPos = [0.5, 0.5, 0.5]\nprobeGridStep = 1.5\nprobeGridCount = [4, 3, 4]\n") +
            kSceneText + "[[models]]\npath = 'box.pf_vox'\ntranslateVec = [3.2, 0, 3]\n");
    ASSERT_TRUE(startAndSee("scene.toml"));
    click(980, 38);   // the statistics' figures change,
    click(652, 602);  // and the log names a folder that does
    key("2");
    key("n");
    key("n");
    screen->send({"mousemove", "500", "690"});
    EXPECT_TRUE(looksLike("window-compose", 0.001));  // the lines are few pixels
    close();
}

}  // namespace
}  // namespace pfvox::test

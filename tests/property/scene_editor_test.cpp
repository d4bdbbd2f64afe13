// Any sequence of edits, then everything undone: the bytes of the scene as it was; then everything redone:
// the bytes as they were at the end. Saving under other names in between changes paths, not that.
#include "compose/scene_editor.hpp"

#include <gtest/gtest.h>

#include "support/procedural.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

using namespace viewer;

class RandomEdits {
  public:
    RandomEdits(SceneEditor& editor, std::uint64_t seed) : editor_(editor), random_(seed) {}

    /// Some edits are refused, some change nothing: that belongs to it.
    void one() {
        const std::string gestures[] = {"", "", "drag", "slide"};
        const std::string gesture = gestures[random_.integer(0, 3)];
        const auto index = static_cast<std::size_t>(random_.integer(0, 6));
        switch (random_.integer(0, 10)) {
            case 0:
                return done(editor_.addModel(model()));
            case 1:
                return done(editor_.duplicateModel(index, vector()));
            case 2:
                return done(editor_.removeModel(index));
            case 3:
            case 4:
            case 5:
                return change(index, gesture);
            case 6:
                return done(editor_.setSun({.direction = vector(), .irradiance = light()}, gesture));
            case 7:
                return done(
                    editor_.setSky({.zenith = light(), .horizon = light(), .ground = light()}, gesture));
            case 8:
                return done(editor_.setProbes(probes(), gesture));
            case 9:
                return done(editor_.setCameras({{.name = "c", .position = vector()}}, gesture));
            default:
                editor_.endGesture();
        }
    }
    int accepted() const { return accepted_; }
    int refused() const { return refused_; }

  private:
    void done(const Result<void>& edit) { ++(edit ? accepted_ : refused_); }
    double number() { return random_.integer(0, 8) == 0 ? 1e12 : 0.25 * random_.integer(-8, 8); }
    glm::dvec3 vector() { return {number(), number(), number()}; }
    glm::dvec3 light() { return glm::dvec3(0.5 * random_.integer(0, 2)); }
    SceneModel model() {
        const std::string paths[] = {"a.pf_vox", "sub/b.pf_vox", "/far/c.pf_vox", ""};
        return {.path = paths[random_.integer(0, 3)], .translateMetres = vector()};
    }
    ProbeGridRequest probes() {
        ProbeGridRequest request;
        if (random_.integer(0, 1) == 0) request.position = vector();
        if (random_.integer(0, 1) == 0) request.stepMetres = glm::dvec3(number());
        if (random_.integer(0, 1) == 0)
            request.count = glm::uvec3(static_cast<std::uint32_t>(random_.integer(0, 9)));
        return request;
    }
    void change(std::size_t index, const std::string& gesture) {
        if (index >= editor_.scene().models.size()) return done(editor_.setModel(index, model()));
        SceneModel changed = editor_.scene().models[index];
        switch (random_.integer(0, 4)) {
            case 0:
                changed.translateMetres = vector();
                break;
            case 1:
                changed.rotateRadians = vector();
                break;
            case 2:
                changed.cubeEdgeMetres = vector();
                break;
            case 3:
                changed.metresPerVoxel = number();
                break;
            default:
                changed.visible = !changed.visible;
        }
        done(editor_.setModel(index, changed, gesture));
    }

    SceneEditor& editor_;
    Random random_;
    int accepted_ = 0;
    int refused_ = 0;
};

Scene startScene() {
    Scene scene;
    for (const char* path : {"hall.pf_vox", "door.pf_vox", "hall.pf_vox"})
        scene.models.push_back({.path = path});
    scene.probes.stepMetres = glm::dvec3(1.5);
    return scene;
}

TEST(SceneEditorProperty, UndoingEverythingGivesTheFirstBytesAndRedoingTheLast) {
    TempFolder folder;
    int accepted = 0;
    int refused = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        SceneEditor editor;
        editor.reset(startScene(), folder / "scene.toml", folder.path());
        const std::string first = sceneText(editor.scene());
        RandomEdits edits(editor, seed);
        for (int i = 0; i < 60; ++i) edits.one();
        const std::string last = sceneText(editor.scene());
        while (editor.undo()) {
        }
        ASSERT_EQ(sceneText(editor.scene()), first) << "seed " << seed;
        ASSERT_FALSE(editor.isChanged());
        ASSERT_TRUE(editor.save());
        ASSERT_EQ(readText(folder / "scene.toml"), first);
        while (editor.redo()) {
        }
        ASSERT_EQ(sceneText(editor.scene()), last) << "seed " << seed;
        accepted += edits.accepted();
        refused += edits.refused();
    }
    EXPECT_GT(accepted, 3000);
    EXPECT_GT(refused, 500) << "the property is also about edits that are refused";
}

TEST(SceneEditorProperty, EveryStateBetweenCanBeWrittenAndReadBack) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SceneEditor editor;
        editor.reset(startScene(), {}, "/base");
        RandomEdits edits(editor, seed);
        Random random(seed + 1000);
        for (int i = 0; i < 60; ++i) {
            edits.one();
            if (random.integer(0, 5) == 0) editor.undo();
            if (random.integer(0, 7) == 0) editor.redo();
            DiagnosticList diagnostics;
            const Result<Scene> read = parseScene(sceneText(editor.scene()), {}, Limits{}, diagnostics);
            ASSERT_TRUE(read) << describe(read.error());
            ASSERT_EQ(*read, editor.scene());
            ASSERT_EQ(editor.isChanged(), !(editor.scene() == editor.saved()));
            ASSERT_TRUE(!editor.selected() || *editor.selected() < editor.scene().models.size());
        }
    }
}

TEST(SceneEditorProperty, SavingElsewhereKeepsWhatUndoLeadsTo) {
    TempFolder folder;
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        SceneEditor editor;
        editor.reset(startScene(), folder / "scene.toml", folder.path());
        const auto files = [&] {
            std::vector<std::filesystem::path> all;
            for (const SceneModel& model : editor.scene().models) all.push_back(editor.fileOf(model));
            return all;
        };
        const std::vector<std::filesystem::path> first = files();
        RandomEdits edits(editor, seed);
        for (int i = 0; i < 40; ++i) {
            edits.one();
            if (i != 20) continue;
            ASSERT_TRUE(editor.saveAs(folder / "deep" / "er" / "scene.toml"));
        }
        const std::vector<std::filesystem::path> last = files();
        while (editor.undo()) {
        }
        ASSERT_EQ(files(), first) << "seed " << seed;
        while (editor.redo()) {
        }
        ASSERT_EQ(files(), last) << "seed " << seed;
    }
}

}  // namespace
}  // namespace pfvox::test

// Editing a scene: what each edit does, what is refused, undo and redo, files.
#include "compose/scene_editor.hpp"

#include <gmock/gmock.h>

#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

using namespace viewer;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

SceneModel model(const std::string& path, const std::string& name = {}) {
    return {.path = path, .name = name};
}

class SceneEditorTest : public ::testing::Test {
  protected:
    SceneEditorTest() {
        Scene scene;
        scene.models = {model("a.pf_vox", "first"), model("b.pf_vox", "second")};
        editor.reset(scene, folder / "scene.toml", folder.path());
    }
    std::vector<std::string> names() const {
        std::vector<std::string> all;
        for (const SceneModel& one : editor.scene().models) all.push_back(labelOf(one));
        return all;
    }
    SceneModel moved(std::size_t index, double x) const {
        SceneModel changed = editor.scene().models[index];
        changed.translateMetres.x = x;
        return changed;
    }

    TempFolder folder;
    SceneEditor editor;
};

TEST_F(SceneEditorTest, BeginsUnchangedWithNothingToUndo) {
    EXPECT_FALSE(editor.isChanged());
    EXPECT_FALSE(editor.canUndo());
    EXPECT_FALSE(editor.undo());
    EXPECT_FALSE(editor.redo());
    EXPECT_EQ(editor.undoText(), "");
    EXPECT_FALSE(editor.selected());
}

// What a slow frame makes of "5.25" and Return: the field is left in the frame in which it changed.
TEST_F(SceneEditorTest, TheEditThatEndsAStepBelongsToIt) {
    ASSERT_TRUE(editor.setModel(0, moved(0, 5.0), "place"));
    editor.endGestureAfterNextEdit();
    ASSERT_TRUE(editor.setModel(0, moved(0, 5.25), "place"));
    ASSERT_TRUE(editor.setModel(0, moved(0, 6.0), "place"));
    ASSERT_TRUE(editor.undo());
    EXPECT_EQ(editor.scene().models[0].translateMetres.x, 5.25) << "the next one is another step";
    ASSERT_TRUE(editor.undo());
    EXPECT_EQ(editor.scene().models[0].translateMetres.x, 0.0);
    EXPECT_FALSE(editor.canUndo());
    // An edit that changes nothing or is refused ends the step as well.
    ASSERT_TRUE(editor.setModel(0, moved(0, 1.0), "place"));
    editor.endGestureAfterNextEdit();
    ASSERT_TRUE(editor.setModel(0, moved(0, 1.0), "place"));
    ASSERT_TRUE(editor.setModel(0, moved(0, 2.0), "place"));
    ASSERT_TRUE(editor.undo());
    EXPECT_EQ(editor.scene().models[0].translateMetres.x, 1.0);
}

TEST_F(SceneEditorTest, AddDuplicateAndRemoveSelectWhatTheyTouch) {
    ASSERT_TRUE(editor.addModel(model("c.pf_vox")));
    EXPECT_EQ(editor.selected(), 2u);
    EXPECT_EQ(editor.undoText(), "add 'c.pf_vox'");
    ASSERT_TRUE(editor.duplicateModel(0, {2, 0, 0}));
    EXPECT_THAT(names(), ElementsAre("first", "first", "second", "c.pf_vox"));
    EXPECT_EQ(editor.selected(), 1u);
    EXPECT_EQ(editor.selectedModel()->translateMetres, glm::dvec3(2, 0, 0));
    ASSERT_TRUE(editor.removeModel(0));
    EXPECT_THAT(names(), ElementsAre("first", "second", "c.pf_vox"));
    EXPECT_FALSE(editor.selected());
    ASSERT_TRUE(editor.undo());
    EXPECT_EQ(editor.selected(), 0u);
    EXPECT_EQ(editor.redoText(), "remove 'first'");
    ASSERT_TRUE(editor.undo());
    ASSERT_TRUE(editor.undo());
    EXPECT_THAT(names(), ElementsAre("first", "second"));
    EXPECT_FALSE(editor.isChanged());
    while (editor.redo()) {
    }
    EXPECT_THAT(names(), ElementsAre("first", "second", "c.pf_vox"));
    EXPECT_TRUE(editor.isChanged());
}

TEST_F(SceneEditorTest, StepsAreNamedByWhatTheyDo) {
    const auto what = [&](const std::function<void(SceneModel&)>& change) {
        SceneModel changed = editor.scene().models[0];
        change(changed);
        EXPECT_TRUE(editor.setModel(0, changed));
        return std::string(editor.undoText());
    };
    EXPECT_EQ(what([](SceneModel& m) { m.translateMetres.y = 3; }), "move 'first'");
    EXPECT_EQ(what([](SceneModel& m) { m.rotateRadians.y = 1; }), "rotate 'first'");
    EXPECT_EQ(what([](SceneModel& m) { m.metresPerVoxel = 0.2; }), "scale 'first'");
    EXPECT_EQ(what([](SceneModel& m) { m.visible = false; }), "hide 'first'");
    EXPECT_EQ(what([](SceneModel& m) { m.visible = true; }), "show 'first'");
    EXPECT_EQ(what([](SceneModel& m) { m.name = "hall"; }), "name 'hall'");
    ASSERT_TRUE(editor.setSun({.direction = {0, -1, 0}}));
    EXPECT_EQ(editor.undoText(), "sun");
}

TEST_F(SceneEditorTest, AGestureIsOneStep) {
    for (const double x : {1.0, 2.0, 3.0}) ASSERT_TRUE(editor.setModel(0, moved(0, x), "drag"));
    editor.endGesture();
    for (const double x : {4.0, 5.0}) ASSERT_TRUE(editor.setModel(0, moved(0, x), "drag"));
    EXPECT_EQ(editor.scene().models[0].translateMetres.x, 5.0);
    ASSERT_TRUE(editor.undo());
    EXPECT_EQ(editor.scene().models[0].translateMetres.x, 3.0);
    ASSERT_TRUE(editor.undo());
    EXPECT_EQ(editor.scene().models[0].translateMetres.x, 0.0);
    EXPECT_FALSE(editor.canUndo());
    // After an undo the same gesture is another step.
    ASSERT_TRUE(editor.redo());
    ASSERT_TRUE(editor.setModel(0, moved(0, 9.0), "drag"));
    ASSERT_TRUE(editor.undo());
    EXPECT_EQ(editor.scene().models[0].translateMetres.x, 3.0);
}

TEST_F(SceneEditorTest, GesturesOfDifferentThingsStayApart) {
    ASSERT_TRUE(editor.setModel(0, moved(0, 1.0), "x"));
    ASSERT_TRUE(editor.setModel(1, moved(1, 1.0), "x"));
    ASSERT_TRUE(editor.setSky({.zenith = {1, 1, 1}}, "x"));
    ASSERT_TRUE(editor.setSun({.irradiance = {1, 1, 1}}, "x"));
    ASSERT_TRUE(editor.setSun({.irradiance = {2, 2, 2}}, "x"));
    int steps = 0;
    while (editor.undo()) ++steps;
    EXPECT_EQ(steps, 4);
}

TEST_F(SceneEditorTest, AGestureThatEndsWhereItBeganLeavesNoStep) {
    ASSERT_TRUE(editor.setModel(0, moved(0, 1.0), "drag"));
    ASSERT_TRUE(editor.setModel(0, moved(0, 0.0), "drag"));
    EXPECT_FALSE(editor.canUndo());
    EXPECT_FALSE(editor.isChanged());
    ASSERT_TRUE(editor.setModel(0, moved(0, 0.0)));
    EXPECT_FALSE(editor.canUndo()) << "nothing was changed";
}

TEST_F(SceneEditorTest, WhatNoFileMayHoldIsRefusedAndChangesNothing) {
    const std::string before = sceneText(editor.scene());
    const std::uint64_t revision = editor.revision();
    SceneModel bad = editor.scene().models[0];
    bad.translateMetres.x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(editor.setModel(0, bad));
    bad = editor.scene().models[0];
    bad.cubeEdgeMetres = glm::dvec3(1, 0, 1);
    const Result<void> flat = editor.setModel(0, bad);
    ASSERT_FALSE(flat);
    EXPECT_THAT(flat.error().message, HasSubstr("cannot be inverted"));
    bad.metresPerVoxel = 0.1;
    bad.cubeEdgeMetres = glm::dvec3(1);
    EXPECT_FALSE(editor.setModel(0, bad)) << "both scales";
    EXPECT_FALSE(editor.addModel({.path = ""}));
    EXPECT_FALSE(editor.addModel({.path = "\xff.pf_vox"})) << "no UTF-8";
    EXPECT_FALSE(editor.setSun({.direction = {0, 0, 0}}));
    EXPECT_FALSE(editor.setSky({.zenith = {-1, 0, 0}}));
    EXPECT_FALSE(editor.setProbes({.count = glm::uvec3(1024)}));
    EXPECT_FALSE(editor.setProbes({.stepMetres = glm::dvec3(0.0)}));
    EXPECT_FALSE(editor.setModel(7, bad));
    EXPECT_FALSE(editor.removeModel(2));
    EXPECT_FALSE(editor.duplicateModel(2, {}));
    EXPECT_EQ(sceneText(editor.scene()), before);
    EXPECT_EQ(editor.revision(), revision);
    EXPECT_FALSE(editor.canUndo());
}

TEST_F(SceneEditorTest, AnEditAfterUndoForgetsWhatWasUndone) {
    ASSERT_TRUE(editor.setModel(0, moved(0, 1.0)));
    ASSERT_TRUE(editor.undo());
    ASSERT_TRUE(editor.setModel(0, moved(0, 2.0)));
    EXPECT_FALSE(editor.canRedo());
}

TEST_F(SceneEditorTest, TheOldestStepsAreForgotten) {
    for (std::size_t i = 1; i <= SceneEditor::kMaxUndoSteps + 5; ++i)
        ASSERT_TRUE(editor.setModel(0, moved(0, static_cast<double>(i))));
    std::size_t steps = 0;
    while (editor.undo()) ++steps;
    EXPECT_EQ(steps, SceneEditor::kMaxUndoSteps);
    EXPECT_EQ(editor.scene().models[0].translateMetres.x, 5.0);
}

TEST_F(SceneEditorTest, SelectionGoesAroundAndNeverBeyond) {
    editor.selectNext(1);
    EXPECT_EQ(editor.selected(), 0u);
    editor.selectNext(-1);
    EXPECT_EQ(editor.selected(), 1u);
    editor.selectNext(1);
    EXPECT_EQ(editor.selected(), 0u);
    editor.select(9);
    EXPECT_FALSE(editor.selected());
    editor.reset({}, {}, folder.path());
    editor.selectNext(1);
    EXPECT_FALSE(editor.selected());
}

TEST_F(SceneEditorTest, SavedIsUnchangedAndUndoCanLeaveIt) {
    ASSERT_TRUE(editor.setModel(0, moved(0, 1.0)));
    EXPECT_TRUE(editor.isChanged());
    ASSERT_TRUE(editor.save());
    EXPECT_FALSE(editor.isChanged());
    EXPECT_EQ(readText(folder / "scene.toml"), sceneText(editor.scene()));
    ASSERT_TRUE(editor.undo());
    EXPECT_TRUE(editor.isChanged());
    ASSERT_TRUE(editor.redo());
    EXPECT_FALSE(editor.isChanged());
}

TEST_F(SceneEditorTest, AFailedSaveKeepsFileAndChanges) {
    ASSERT_TRUE(editor.save());
    const std::string before = readText(folder / "scene.toml");
    ASSERT_TRUE(editor.setModel(0, moved(0, 1.0)));
    writeText(folder / "plain", "a file, no folder");
    EXPECT_FALSE(editor.saveAs(folder / "plain" / "scene.toml"));
    EXPECT_TRUE(editor.isChanged());
    EXPECT_EQ(editor.file(), folder / "scene.toml");
    EXPECT_EQ(editor.scene().models[0].path, "a.pf_vox");
    EXPECT_EQ(readText(folder / "scene.toml"), before);
    editor.reset({}, {}, folder.path());
    EXPECT_FALSE(editor.save()) << "no name yet";
}

TEST_F(SceneEditorTest, SavedElsewherePathsStillLeadToTheModels) {
    ASSERT_TRUE(editor.addModel(model("/far/away.pf_vox")));
    ASSERT_TRUE(editor.removeModel(1));
    const std::filesystem::path a = editor.fileOf(editor.scene().models[0]);
    ASSERT_TRUE(editor.saveAs(folder / "levels" / "one.toml"));
    EXPECT_EQ(editor.scene().models[0].path, "../a.pf_vox");
    EXPECT_EQ(editor.fileOf(editor.scene().models[0]), a);
    EXPECT_EQ(editor.scene().models[1].path, "/far/away.pf_vox");
    EXPECT_FALSE(editor.isChanged());
    ASSERT_TRUE(editor.undo());
    EXPECT_EQ(editor.scene().models[1].path, "../b.pf_vox") << "steps to undo know the new folder too";
    DiagnosticList diagnostics;
    const Result<Scene> read = readScene(folder / "levels" / "one.toml", Limits{}, diagnostics);
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_EQ(read->models[0].path, "../a.pf_vox");
}

TEST_F(SceneEditorTest, PathsAreRelativeWhereThatMakesSense) {
    EXPECT_EQ(editor.pathOf(folder / "a.pf_vox"), "a.pf_vox");
    EXPECT_EQ(editor.pathOf(folder / "sub" / "a.pf_vox"), "sub/a.pf_vox");
    EXPECT_EQ(editor.pathOf("/nowhere/else/a.pf_vox"), "/nowhere/else/a.pf_vox");
    EXPECT_EQ(editor.fileOf({.path = "sub/../a.pf_vox"}), folder / "a.pf_vox");
    EXPECT_EQ(editor.fileOf({.path = "/x/a.pf_vox"}), "/x/a.pf_vox");
}

}  // namespace
}  // namespace pfvox::test

// Composing in the viewer without its window: what commands, drops, clicks and drags do to document and
// picture.
#include <gmock/gmock.h>

#include "support/session_fixture.hpp"

namespace pfvox::test {
namespace {

using namespace viewer;
using ::testing::HasSubstr;

class ComposeTest : public SessionFixture {
  protected:
    void SetUp() override {
        SessionFixture::SetUp();
        write("a.pf_vox", box(8));
        write("b.pf_vox", box(4, 90));
        writeText(folder / "s.toml", "[[models]]\npath = 'a.pf_vox'\nname = 'first'\n");
    }
    void draw() { ASSERT_TRUE(session->view.draw(kSize)); }
    double x(std::size_t model) const { return scene().models[model].translateMetres.x; }
    SceneEditor& editor() { return session->document.composer.editor; }
    glm::dvec2 partsOf(const glm::dvec3& world) {
        return session->view.projection().pointOf(world).value_or(glm::dvec2(-1.0)) /
               session->view.windowSize;
    }
};

TEST_F(ComposeTest, ModelsAreAddedBesideWhatIsThere) {
    start(folder / "s.toml");
    EXPECT_EQ(voxels(), 512u);
    session->document.addModels({folder / "b.pf_vox", folder / "a.pf_vox"});
    settle();
    ASSERT_EQ(scene().models.size(), 3u);
    EXPECT_EQ(scene().models[1].path, "b.pf_vox");
    EXPECT_EQ(scene().models[1].name, "b");
    EXPECT_EQ(instances(), 3u);
    EXPECT_EQ(voxels(), 512u + 64u) << "a file that is there twice has its voxels once";
    EXPECT_GT(x(1), 0.8);
    EXPECT_GT(x(2), x(1) + 0.4);
    EXPECT_EQ(editor().selected(), 2u);
    EXPECT_TRUE(editor().isChanged());
    press('Z', true);
    press('Z', true);
    settle();
    EXPECT_EQ(instances(), 1u);
    EXPECT_FALSE(editor().isChanged());
    press('Z', true, true);
    settle();
    EXPECT_EQ(instances(), 2u) << "redone";
}

TEST_F(ComposeTest, KeysEditTheSelectedModel) {
    start(folder / "s.toml");
    press(kKeyRight);
    EXPECT_FALSE(editor().isChanged()) << "nothing is selected";
    press('N');
    EXPECT_EQ(editor().selected(), 0u);
    press(kKeyRight);
    EXPECT_NEAR(x(0), 0.1, 1e-6) << "by a voxel";
    press(kKeyUp, false, true);
    EXPECT_NEAR(scene().models[0].translateMetres.y, 0.1, 1e-6);
    press(kKeyDown);
    EXPECT_NEAR(scene().models[0].translateMetres.z, 0.1, 1e-6);
    press(kKeyLeft, true);
    EXPECT_NEAR(scene().models[0].rotateRadians.y, glm::radians(15.0), 1e-12);
    press(kKeyUp, true);
    EXPECT_NEAR(scene().models[0].metresPerVoxel.value_or(0.0), 0.11, 1e-9);
    press('D', true);
    settle();
    EXPECT_EQ(instances(), 2u);
    EXPECT_EQ(editor().selected(), 1u);
    press(kKeyDelete);
    settle();
    EXPECT_EQ(instances(), 1u);
    for (int i = 0; i < 7; ++i) press('Z', true);
    EXPECT_FALSE(editor().isChanged());
    press('G');
    press('B');
    EXPECT_TRUE(session->view.settings.showProbeGrid && session->view.settings.showBounds);
}

TEST_F(ComposeTest, ThePictureFollowsAndLooksAsIfReadFromTheFile) {
    start(folder / "s.toml");
    session->document.addModels({folder / "b.pf_vox"});
    settle();
    press(kKeyRight);
    press(kKeyLeft, true);
    EXPECT_TRUE(editor().setSun({.direction = {1, -2, -1}, .irradiance = {2, 1, 1}}));
    settle();
    session->view.settings.antiAliasing = false;
    const ViewCamera camera{.position = {2, 2, 5}, .target = {0.8, 0.4, 0.4}};
    session->view.camera.set(camera);
    draw();
    const Picture edited = session->view.frames().picture(device()).value();
    press('S', true);
    EXPECT_FALSE(editor().isChanged());
    start(folder / "s.toml");
    session->view.settings.antiAliasing = false;
    session->view.camera.set(camera);
    draw();
    EXPECT_TRUE(session->view.frames().picture(device()).value().pixels == edited.pixels);
}

TEST_F(ComposeTest, AClickSelectsTheModelAndAHandleDragsIt) {
    start(folder / "s.toml");
    session->document.addModels({folder / "b.pf_vox"});
    settle();
    session->view.camera.set({.position = {0.6, 1.5, 4}, .target = {0.6, 0.2, 0.4}});
    draw();
    session->input.clickAt(partsOf({0.4, 0.4, 0.8}));
    ASSERT_TRUE(session->view.pick());
    EXPECT_EQ(session->view.pick()->modelIndex, 0u);
    EXPECT_EQ(editor().selected(), 0u);
    const auto gizmo = session->view.gizmo();
    ASSERT_TRUE(gizmo);
    const glm::dvec3 grip = gizmo->tipOf(Handle::X);
    EXPECT_FALSE(session->input.grabAt({0.02, 0.02}));
    ASSERT_TRUE(session->input.grabAt(partsOf(grip)));
    for (const double by : {0.1, 0.35, 0.25}) {
        session->input.drag({.to = partsOf(grip + glm::dvec3(by, 0, 0)), .ended = by == 0.25});
        session->update(now);
    }
    EXPECT_NEAR(x(0), 0.25, 1e-6);
    EXPECT_NEAR(session->document.shown()->loaded.parts[0].worldFromAsset[3].x, 0.25, 1e-6)
        << "the device's scene moved too";
    press('Z', true);
    EXPECT_EQ(x(0), 0.0) << "a drag is one step";
    EXPECT_EQ(editor().selected(), 0u);
    press(kKeyEscape);
    EXPECT_FALSE(editor().selected());
    EXPECT_FALSE(session->view.gizmo());
}

TEST_F(ComposeTest, ProbesAreClickedWhereTheyAreDrawn) {
    start(folder / "s.toml");
    ASSERT_TRUE(editor().setProbes(
        {.position = glm::dvec3(-0.5, 1.2, 0), .stepMetres = glm::dvec3(0.6), .count = glm::uvec3(3, 2, 2)}));
    settle();
    EXPECT_EQ(session->document.shown()->loaded.probes.counts, glm::uvec3(3, 2, 2));
    const glm::dvec2 there = partsOf(session->document.placeOfProbe(4));
    session->input.clickAt(there);
    EXPECT_FALSE(session->view.selectedProbe) << "not drawn";
    press('G');
    session->input.clickAt(there);
    EXPECT_EQ(session->view.selectedProbe, 4u);
    EXPECT_FALSE(session->view.pick());
    ASSERT_TRUE(editor().setProbes({.count = glm::uvec3(2)}));
    settle();
    EXPECT_FALSE(session->view.selectedProbe) << "another grid";
}

TEST_F(ComposeTest, AGridOfTooManyProbesIsToldAndTheSceneStays) {
    start(folder / "s.toml");
    ASSERT_TRUE(editor().setProbes({.stepMetres = glm::dvec3(1e-4)}));
    settle();
    EXPECT_THAT(log.strip().value_or(""), HasSubstr("probeGridStep"));
    EXPECT_EQ(voxels(), 512u);
    press('Z', true);
    settle();
    press('N');
    press(kKeyRight);
    EXPECT_NEAR(session->document.shown()->loaded.parts[0].worldFromAsset[3].x, 0.1, 1e-6)
        << "editing goes on";
}

TEST_F(ComposeTest, DroppedModelsJoinASceneAndOtherwiseAreOpened) {
    start(folder / "s.toml");
    session->document.drop({folder / "b.pf_vox"});
    settle();
    EXPECT_EQ(scene().models.size(), 2u);
    EXPECT_EQ(session->document.shown()->path.file, folder / "s.toml");
    press('Z', true);
    session->document.drop({folder / "b.pf_vox", folder / "s.toml"});
    settle();
    EXPECT_EQ(scene().models.size(), 1u) << "a scene is opened";
    start(folder / "a.pf_vox");
    session->document.drop({folder / "b.pf_vox"});
    settle();
    EXPECT_EQ(session->document.shown()->path.file, folder / "b.pf_vox");
    start();
    session->document.drop({folder / "a.pf_vox"});
    settle();
    EXPECT_EQ(session->document.shown()->path.file, folder / "a.pf_vox");
}

TEST_F(ComposeTest, ANewSceneIsBuiltUpAndSavedUnderAName) {
    start();
    press('N', true);
    ASSERT_NE(session->document.shown(), nullptr);
    EXPECT_TRUE(session->document.shown()->path.file.empty());
    session->document.addModels({folder / "a.pf_vox"});
    settle();
    EXPECT_EQ(voxels(), 512u);
    EXPECT_EQ(x(0), 0.0);
    press('S', true);
    EXPECT_EQ(session->document.composer.dialog, Dialog::SaveAs) << "it has no name yet";
    session->document.composer.dialog = Dialog::None;
    ASSERT_TRUE(session->document.composer.saveAs(folder / "made"));
    settle();
    EXPECT_EQ(session->document.shown()->path.file, folder / "made.toml");
    EXPECT_FALSE(editor().isChanged());
    EXPECT_THAT(readText(folder / "made.toml"), HasSubstr("path = \"a.pf_vox\""));
    write("a.pf_vox", box(4));
    settle();
    EXPECT_EQ(voxels(), 64u) << "its models are watched";
    EXPECT_TRUE(editor().canUndo()) << "and the steps to undo are still there";
}

TEST_F(ComposeTest, UnsavedChangesAreAskedAbout) {
    start(folder / "s.toml");
    press('N');
    press(kKeyRight);
    press('Q', true);
    EXPECT_FALSE(session->input.wantsToQuit());
    ASSERT_TRUE(session->document.composer.isAsking());
    session->document.composer.answer(Answer::Cancel);
    EXPECT_FALSE(session->document.composer.isAsking());
    EXPECT_TRUE(editor().isChanged());
    session->document.open(folder / "b.pf_vox");
    settle();
    EXPECT_EQ(session->document.shown()->path.file, folder / "s.toml") << "not before the answer";
    session->document.composer.answer(Answer::Discard);
    settle();
    EXPECT_EQ(session->document.shown()->path.file, folder / "b.pf_vox");
    EXPECT_THAT(readText(folder / "s.toml"), testing::Not(HasSubstr("translateVec")));
    session->document.open(folder / "s.toml");
    settle();
    press('N');
    press(kKeyRight);
    press('Q', true);
    session->document.composer.answer(Answer::Save);
    EXPECT_TRUE(session->input.wantsToQuit());
    EXPECT_THAT(readText(folder / "s.toml"), HasSubstr("translateVec = [0.1"));
}

TEST_F(ComposeTest, ASaveThatFailsLosesNothing) {
    start(folder / "s.toml");
    press('N');
    press(kKeyRight);
    press('Q', true);
    std::filesystem::remove(folder / "s.toml");
    std::filesystem::create_directory(folder / "s.toml");  // no file can take its place
    session->document.composer.answer(Answer::Save);
    EXPECT_FALSE(session->input.wantsToQuit());
    EXPECT_TRUE(session->document.composer.isAsking());
    EXPECT_TRUE(editor().isChanged());
    EXPECT_TRUE(log.strip());
}

TEST_F(ComposeTest, AnotherProgramsChangeDoesNotTakeOursAway) {
    start(folder / "s.toml");
    press('N');
    press(kKeyRight);
    writeText(folder / "s.toml", "[[models]]\npath = 'b.pf_vox'\nname = 'theirs'\n");
    settle();
    EXPECT_EQ(labelOf(scene().models[0]), "first");
    EXPECT_THAT(log.strip().value_or(""), HasSubstr("another program"));
    press('R');
    ASSERT_TRUE(session->document.composer.isAsking());
    session->document.composer.answer(Answer::Discard);
    settle();
    EXPECT_EQ(labelOf(scene().models[0]), "theirs");
}

TEST_F(ComposeTest, OurOwnSaveIsNotReadAgain) {
    start(folder / "s.toml");
    press('N');
    press(kKeyRight);
    press('S', true);
    settle();
    settle();
    EXPECT_TRUE(editor().canUndo());
    press('Z', true);
    EXPECT_EQ(x(0), 0.0);
}

TEST_F(ComposeTest, WhatCannotBeAddedIsToldAndLeftOut) {
    start(folder / "s.toml");
    writeText(folder / "hall.vox", "VOX \x96 and so on, long enough to have a header of some kind ........");
    session->document.addModels(
        {folder / "hall.vox", folder / "none.pf_vox", folder / "s.toml", folder / "b.pf_vox"});
    settle();
    EXPECT_EQ(scene().models.size(), 2u);
    std::string all;
    for (const Message& message : log.messages()) all += message.text + "\n";
    EXPECT_THAT(all, HasSubstr("vox2pf convert"));
    EXPECT_THAT(all, HasSubstr("none.pf_vox"));
    EXPECT_THAT(all, HasSubstr("a scene cannot stand in a scene"));
}

TEST_F(ComposeTest, AHiddenModelWhoseFileIsGoneIsToldWhenShown) {
    writeText(folder / "s.toml",
              "[[models]]\npath = 'a.pf_vox'\n[[models]]\npath = 'gone.pf_vox'\nvisible = false\n");
    start(folder / "s.toml");
    EXPECT_EQ(instances(), 1u);
    SceneModel shown = scene().models[1];
    shown.visible = true;
    ASSERT_TRUE(editor().setModel(1, shown));
    settle();
    EXPECT_THAT(log.strip().value_or(""), HasSubstr("gone.pf_vox"));
    EXPECT_EQ(instances(), 1u) << "the last good scene stays";
    write("gone.pf_vox", box(4));
    settle();
    EXPECT_EQ(instances(), 2u) << "mended";
}

TEST_F(ComposeTest, ThisViewBecomesACamera) {
    start(folder / "s.toml");
    session->view.camera.set({.position = {1, 2, 3}, .target = {0, 0, 0}, .fovYDegrees = 33});
    session->input.addCamera();
    ASSERT_EQ(scene().cameras.size(), 1u);
    EXPECT_EQ(scene().cameras[0].fovYDegrees, 33.0);
    press('Z', true);
    EXPECT_TRUE(scene().cameras.empty());
}

}  // namespace
}  // namespace pfvox::test

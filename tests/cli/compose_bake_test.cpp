// A scene that was composed and saved by the viewer's editor is taken by probe-bake as it is.
#include <gmock/gmock.h>

#include "compose/composer.hpp"
#include "compose/model_edits.hpp"
#include "support/process.hpp"
#include "support/scene_assets.hpp"
#include "support/temp_folder.hpp"

#include <chrono>
#include <pfvox/probe_file.hpp>
#include <thread>

namespace pfvox::test {
namespace {

using namespace viewer;

class ComposeBakeTest : public ::testing::Test {
  protected:
    void SetUp() override {
        writePfVox(folder / "models" / "box.pf_vox", boxAsset({{0, 0, 0}, {12, 6, 12}}, 0.1));
        writePfVox(folder / "models" / "pillar.pf_vox", boxAsset({{0, 0, 0}, {3, 12, 3}}, 0.1));
    }
    std::optional<LoadedScene> settle() {
        std::optional<LoadedScene> latest;
        for (int i = 0; i < 2000; ++i) {
            if (std::optional<LoadedScene> scene = composer.update()) latest = std::move(scene);
            if (!composer.isReading() && latest) break;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return latest;
    }
    ProcessResult bake(std::vector<std::string> more) const {
        std::vector<std::string> words{PFVOX_PROBE_BAKE, "bake",     "scenes/made.toml", "-o", "out.pf_probe",
                                       "--resolution",   "16,8,4,6", "--samples",        "32"};
        words.insert(words.end(), more.begin(), more.end());
        return runProcess(std::move(words), {.environment = {}, .input = {}, .folder = folder.path()});
    }

    TempFolder folder;
    MessageLog log;
    Composer composer{log};
};

TEST_F(ComposeBakeTest, WhatIsSavedIsBaked) {
    SceneEditor& editor = composer.editor;
    composer.beginEmpty(folder / "models");
    composer.addModels({folder / "models" / "box.pf_vox", folder / "models" / "pillar.pf_vox"});
    std::optional<LoadedScene> loaded = settle();
    ASSERT_TRUE(loaded);
    ASSERT_EQ(editor.scene().models.size(), 2u);
    composer.duplicateSelected(*loaded);
    editor.select(0);
    ASSERT_TRUE(editor.setModel(0, turnedAbout(editor.scene().models[0], {0.6, 0, 0.6}, 0.5)));
    ASSERT_TRUE(editor.setSun({.direction = {0.3, -1, 0.2}, .irradiance = {2, 2, 1.5}}));
    ASSERT_TRUE(
        editor.setSky({.zenith = glm::dvec3(0.5), .horizon = glm::dvec3(0.5), .ground = glm::dvec3(0.5)}));
    loaded = settle();
    ASSERT_TRUE(loaded);
    DiagnosticList diagnostics;
    const Result<ProbeGrid> grid = fitProbeGrid({.stepMetres = glm::dvec3(1.1)}, loaded->bounds, diagnostics);
    ASSERT_TRUE(grid);
    ASSERT_TRUE(editor.setProbes({.position = glm::dvec3(grid->start),
                                  .stepMetres = glm::dvec3(grid->step),
                                  .count = grid->counts,
                                  .proximityCells = glm::uvec3(8)}));
    ASSERT_TRUE(composer.saveAs(folder / "scenes" / "made.toml"));

    const ProcessResult planned = bake({"--dry-run"});
    EXPECT_EQ(planned.exitCode, 0) << planned.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pf_probe"));
    const ProcessResult baked = bake({"--warnings-as-errors"});
    ASSERT_EQ(baked.exitCode, 0) << baked.err << readText(folder / "scenes" / "made.toml");
    const Result<ProbeFileReader> reader =
        ProbeFileReader::open(folder / "out.pf_probe", Limits{}, diagnostics);
    ASSERT_TRUE(reader) << describe(reader.error());
    EXPECT_EQ(reader->info().grid, *grid);
    EXPECT_TRUE(reader->info().isWhole());
}

}  // namespace
}  // namespace pfvox::test

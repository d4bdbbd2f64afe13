// The demo folder: converted, its scene loaded, a part of its probes baked with every layer.
#include <gmock/gmock.h>

#include <iostream>
#include <pfvox/convert.hpp>
#include <pfvox/files.hpp>
#include <pfvox/probe_file.hpp>

#include "bake_fixture.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

class DemoBakeTest : public BakeTest {
  protected:
    Result<LoadedScene> load() {
        const std::filesystem::path data = PFVOX_DATA_DIR;
        for (const char* const name : {"courtyard", "tree", "lamp", "statue"}) {
            PFVOX_TRY(const auto, converted,
                      convertFile(data / (std::string(name) + ".vox"),
                                  folder / (std::string(name) + ".pf_vox"), {}, Limits{}, diagnostics));
            static_cast<void>(converted);
        }
        PFVOX_TRY(const std::string, text,
                  withModelPaths(
                      readText(data / "scene.toml"), "scene.toml", Limits{}, diagnostics,
                      [](const ModelPathUse& use) -> std::optional<std::string> {
                          return std::filesystem::path(use.model.path).replace_extension(".pf_vox").string();
                      }));
        writeText(folder / "scene.toml", text);
        return loadScene(folder / "scene.toml", Limits{}, diagnostics);
    }
    TempFolder folder;
};

TEST_F(DemoBakeTest, AllLayersOfTheDemoScene) {
    PFVOX_ASSERT_VALUE(LoadedScene, scene, load());
    // Every third probe of the scene's own grid: the court from end to end.
    scene.probes.step *= 3.0f;
    scene.probes.counts = (scene.probes.counts + 2u) / 3u;
    BakeObserver observer;
    BakeSettings settings = plain(32, 32);
    settings.resolution.light = 16;
    PFVOX_ASSERT_VALUE(
        const BakeReport, report,
        bakeProbes(device(), scene, settings, folder / "demo.pf_probe", observer, diagnostics));
    std::cout << "  " << report.probes << " probes, " << report.counts.relocated << " relocated, "
              << report.counts.inactive << " inactive; " << report.emitterFaces << " emitter faces; "
              << report.light.rays << " rays; uncovered cells " << report.proximity.uncoveredCells << " of "
              << report.proximity.surfaceCells << "; noise " << report.meanError.value() << "; "
              << report.fileBytes << " bytes; " << report.totalMs << " ms (light " << report.light.gpuMs
              << ", proximity " << report.proximityMs << ")\n";
    EXPECT_EQ(report.probes, 75u);
    EXPECT_GT(report.counts.active, 60u);
    EXPECT_EQ(report.stepLimitRays, 0u);
    EXPECT_GT(report.emitterFaces, 0u);
    EXPECT_GT(report.proximity.seenSamples, report.proximity.samples / 4);
    EXPECT_THAT(validatePfProbeFile(folder / "demo.pf_probe", Limits{}), ::testing::IsEmpty());
}

}  // namespace
}  // namespace pfvox::test

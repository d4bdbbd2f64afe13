// The demo folder as a user sees it: converted, its scene loaded, drawn by a named camera under the scene's
// light.
#include <algorithm>
#include <pfvox/convert.hpp>
#include <pfvox/files.hpp>
#include <pfvox/scene.hpp>

#include "support/image_compare.hpp"
#include "support/picture_fixture.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

class ScenePicture : public PictureTest {
  protected:
    /// The scene of data/, its sources converted and its paths turned to them.
    Result<LoadedScene> demoScene() {
        const std::filesystem::path data = PFVOX_DATA_DIR;
        DiagnosticList diagnostics;
        for (const char* name : {"courtyard", "tree", "lamp", "statue"}) {
            PFVOX_TRY([[maybe_unused]] const ConvertReport, report,
                      convertFile(data / (std::string(name) + ".vox"),
                                  folder / (std::string(name) + ".pf_vox"), {}, Limits{}, diagnostics));
        }
        PFVOX_TRY(
            const std::string, text,
            withModelPaths(readText(data / "scene.toml"), "scene.toml", Limits{}, diagnostics,
                           [](const ModelPathUse& use) {
                               return std::filesystem::path(use.model.path).replace_extension(".pf_vox");
                           }));
        writeText(folder / "scene.toml", text);
        PFVOX_TRY(LoadedScene, scene, loadScene(folder / "scene.toml", Limits{}, diagnostics));
        for (const Diagnostic& diagnostic : diagnostics.entries())
            EXPECT_NE(diagnostic.severity, Severity::Warning) << diagnostic.message;
        return scene;
    }

    TempFolder folder;
};

TEST_F(ScenePicture, DemoSceneByTwoOfItsCameras) {
    PFVOX_ASSERT_VALUE(const LoadedScene, loaded, demoScene());
    DiagnosticList diagnostics;
    PFVOX_ASSERT_VALUE(const gpu::Scene, scene,
                       gpu::Scene::build(device(), gpu::partsOf(loaded), diagnostics));
    PFVOX_ASSERT_VALUE(const viewer::PictureRenderer, renderer, viewer::PictureRenderer::create(device()));
    const viewer::PictureSettings settings{
        .width = 320, .height = 180, .lighting = viewer::lightingOf(loaded.scene)};
    for (const char* name : {"court", "roof"}) {
        const auto camera = std::ranges::find(loaded.scene.cameras, name, &Camera::name);
        ASSERT_NE(camera, loaded.scene.cameras.end()) << name;
        viewer::PictureStatistics statistics;
        PFVOX_ASSERT_VALUE(
            const viewer::Picture, picture,
            renderer.render(device(), scene, viewer::viewCameraOf(*camera), settings, statistics));
        EXPECT_TRUE(matchesGolden(picture, std::string("scene-") + name));
        EXPECT_EQ(statistics.stepLimitRays, 0u);
    }
}

TEST(SceneLight, IsTheScenes) {
    Scene scene;
    scene.sun = {.direction = {0.0, -2e9, 0.0}, .irradiance = {1.0, 2.0, 3.0}};
    scene.sky = {.zenith = {4.0, 5.0, 6.0}, .horizon = {7.0, 8.0, 9.0}, .ground = {1.5, 2.5, 3.5}};
    const viewer::Lighting light = viewer::lightingOf(scene);
    EXPECT_EQ(light.sunDirection, glm::vec3(0.0f, -1.0f, 0.0f));
    EXPECT_EQ(light.sunIrradiance, glm::vec3(1.0f, 2.0f, 3.0f));
    EXPECT_EQ(light.skyZenith, glm::vec3(4.0f, 5.0f, 6.0f));
    EXPECT_EQ(light.skyHorizon, glm::vec3(7.0f, 8.0f, 9.0f));
    EXPECT_EQ(light.skyGround, glm::vec3(1.5f, 2.5f, 3.5f));
}

}  // namespace
}  // namespace pfvox::test

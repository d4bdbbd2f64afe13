// Draws an octree asset as pfview does without a window, on the test device.
#pragma once

#include <pfvox/gpu_scene.hpp>
#include <pfvox/octree.hpp>
#include <pfvox/scene.hpp>

#include "picture.hpp"
#include "support/gpu_fixture.hpp"

namespace pfvox::test {

class PictureTest : public GpuTest {
  protected:
    struct Shot {
        viewer::Picture picture;
        viewer::PictureStatistics statistics;
    };
    static viewer::ViewCamera cameraOf(const gpu::WorldBox& bounds, const viewer::PictureSettings& settings) {
        return viewer::cameraFraming(bounds, static_cast<double>(settings.width) / settings.height, 40.0);
    }
    static viewer::ViewCamera cameraOf(const OctreeAsset& asset, const viewer::PictureSettings& settings) {
        const WorldBounds bounds = boundsOf(asset);
        return cameraOf(gpu::WorldBox{.min = bounds.min, .max = bounds.max}, settings);
    }
    /// The whole asset in view, from the default direction.
    static Result<Shot> draw(const OctreeAsset& asset, const viewer::PictureSettings& settings) {
        DiagnosticList diagnostics;
        const gpu::ScenePart part{.asset = &asset};
        PFVOX_TRY(const gpu::Scene, scene, gpu::Scene::build(device(), {&part, 1}, diagnostics));
        PFVOX_TRY(const viewer::PictureRenderer, renderer, viewer::PictureRenderer::create(device()));
        const viewer::ViewCamera camera = cameraOf(scene.bounds(), settings);
        Shot shot;
        PFVOX_TRY(viewer::Picture, picture,
                  renderer.render(device(), scene, camera, settings, shot.statistics));
        shot.picture = std::move(picture);
        return shot;
    }
};

}  // namespace pfvox::test

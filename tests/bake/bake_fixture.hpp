// Scenes for the tests of the baker, and one probe traced in them.
#pragma once

#include <pfvox/bake.hpp>

#include "bake/placed_models.hpp"
#include "bake/probe_tracer.hpp"
#include "support/gpu_fixture.hpp"
#include "support/procedural.hpp"

namespace pfvox::test {

/// sRGB bytes and their linear value.
double linearOf(std::uint8_t byte);
/// A Lambert material; with `radiance` it emits that, in every channel.
Material gray(std::uint8_t byte, double radiance = 0.0);

/// One model of 1 voxel = `voxelMetres`, no sun, black sky, one probe in the middle of its box.
LoadedScene sceneOf(VoxelAsset asset, const Affine& worldFromAsset = identityAffine());
/// An asset of one model, its instance scaled to metres.
VoxelAsset assetOf(VoxelModel model, std::vector<Material> materials, double voxelMetres = 0.1);
/// A hollow box: walls of one voxel around `inner` voxels from (0, 0, 0) on.
VoxelModel hollowBox(const glm::ivec3& inner, int wall = 1);

/// What one probe gave.
struct LitProbe {
    std::vector<shared::SeenTexel> seen;
    std::vector<glm::vec3> normals;  ///< of `seen`, unit length
    std::vector<glm::vec3> light;    ///< at the same edge as `seen`
    std::vector<double> errors;      ///< standard error of each texel's mean channel
    double meanError = 0.0;
    std::uint64_t rays = 0;
};

class BakeTest : public GpuTest {
  protected:
    /// `edge` texels of depth and light, `samples` paths each, not adaptive.
    static BakeSettings plain(std::uint32_t edge, std::uint32_t samples);
    static LitProbe lightAt(const LoadedScene& scene, const glm::vec3& position,
                            const BakeSettings& settings);

    DiagnosticList diagnostics;
};

/// Mean over texels that see a surface, all channels.
double meanLight(const LitProbe& probe);
/// The same over texels for which `counts` says yes; the error of that mean in `error`.
struct Mean {
    double value = 0.0;
    double error = 0.0;
    std::size_t texels = 0;
};
Mean meanWhere(const LitProbe& probe, const std::function<bool(std::size_t texel)>& counts);

}  // namespace pfvox::test

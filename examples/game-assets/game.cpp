// What a game does first: loads a level, that is, its scene with the models and its light.
#include <pfvox/probe_file.hpp>
#include <pfvox/scene.hpp>

#include <cstdio>
#include <filesystem>

namespace {

pfvox::Result<void> loadLevel(const std::filesystem::path& scene, pfvox::Diagnostics& diagnostics) {
    PFVOX_TRY(const auto, level, pfvox::loadScene(scene, {}, diagnostics));
    std::printf("%s: %zu models\n", scene.filename().c_str(), level.parts.size());
    for (const pfvox::PlacedAsset& part : level.parts) {
        std::uint64_t voxels = 0;
        for (const pfvox::OctreeModel& model : part.asset->models) voxels += model.voxelCount;
        std::printf("  %s: %llu voxels\n", level.scene.models[part.model].path.c_str(),
                    static_cast<unsigned long long>(voxels));
    }
    const std::filesystem::path light = std::filesystem::path(scene).replace_extension(".pf_probe");
    PFVOX_TRY(const auto, probes, pfvox::ProbeFileReader::open(light, {}, diagnostics));
    std::printf("%s: %llu probes\n", light.filename().c_str(),
                static_cast<unsigned long long>(probes.info().grid.probeCount()));
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: game <level.toml>\n", stderr);
        return 2;
    }
    pfvox::DiagnosticList diagnostics;
    const auto loaded = loadLevel(argv[1], diagnostics);
    for (const pfvox::Diagnostic& entry : diagnostics.entries())
        std::fprintf(stderr, "%s\n", entry.message.c_str());
    if (loaded) return 0;
    std::fprintf(stderr, "game: %s\n", describe(loaded.error()).c_str());
    return 1;
}

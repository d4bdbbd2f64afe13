// pfvox-make-demo-data: writes the demo sources of data/, or those of examples/game-assets. The outputs are
// committed; a test runs this program and compares.

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "courtyard.hpp"
#include "models.hpp"
#include "verify_scenes.hpp"

namespace {

using namespace pfvox::demo;

void writeFile(const std::filesystem::path& file, const VoxScene& scene, const Palette& palette) {
    const std::string bytes = writeVox(scene, palette);
    std::ofstream stream(file, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) throw std::runtime_error("cannot write " + file.string());
    std::printf("%s: %zu models, %zu bytes\n", file.string().c_str(), scene.models.size(), bytes.size());
}

/// One model whose corner at left, bottom and back lies in the origin, seen with y up.
VoxScene only(Canvas model) {
    VoxScene scene;
    scene.nodes.push_back(placeAtCorner("", 0, model.size(), {0, -model.size().y, 0}));
    scene.models.push_back(std::move(model));
    return scene;
}

void writeExample(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder / "props");
    const DemoPalette p;
    writeFile(folder / "terrace.vox", only(makeTerrace(p)), p.palette);
    writeFile(folder / "props/lamp.vox", only(makeLamp(p)), p.palette);
    writeFile(folder / "props/bench.vox", only(makeBench(p)), p.palette);
    writeFile(folder / "props/planter.vox", only(makePlanter(p)), p.palette);
    writeFile(folder / "props/metal ball.vox", only(makeMetalBall(p)), p.palette);
}

void writeAll(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder / "verify");
    const DemoPalette p;
    writeFile(folder / "courtyard.vox", makeCourtyard(p), p.palette);
    writeFile(folder / "tree.vox", only(makeTree(p, 17)), p.palette);
    writeFile(folder / "lamp.vox", only(makeLamp(p)), p.palette);
    writeFile(folder / "statue.vox", only(makeStatue(p)), p.palette);
    writeFile(folder / "verify/interior.vox", only(makeInterior(p)), p.palette);
    writeFile(folder / "verify/foundry.vox", only(makeFoundry(p)), p.palette);
}

}  // namespace

int main(int argc, char** argv) {
    const bool example = argc == 3 && std::string_view(argv[1]) == "--example";
    if (argc != 2 && !example) {
        std::fputs("usage: pfvox-make-demo-data [--example] <folder>\n", stderr);
        return 2;
    }
    try {
        example ? writeExample(argv[2]) : writeAll(argv[1]);
    } catch (const std::exception& exception) {
        std::fprintf(stderr, "error: %s\n", exception.what());
        return 3;
    }
    return 0;
}

// Writes the sources that bench/run-import converts: make_large_sources <folder>. About 700 MB; what is there
// already is left alone.
#include <cstdio>
#include <exception>
#include <functional>
#include <string>

#include "large_sources.hpp"

namespace {

namespace fs = std::filesystem;

/// Makes folder/name under another name first, so that what was interrupted is made again.
void make(const fs::path& folder, const std::string& name,
          const std::function<void(const fs::path&)>& write) {
    const fs::path target = folder / name;
    if (fs::exists(target)) return;
    std::printf("%s\n", name.c_str());
    std::fflush(stdout);
    const fs::path unfinished = folder / (name + ".unfinished");
    fs::remove_all(unfinished);
    write(unfinished);
    fs::rename(unfinished, target);
}

void makeAll(const fs::path& folder) {
    using namespace pfvox::bench;
    fs::create_directories(folder);
    make(folder, "liar.vox", writeLiar);
    make(folder, "cut", writeCutFiles);
    make(folder, "small", writeSmallFiles);
    make(folder, "instances_900.vox", [](const fs::path& file) { writeInstances(file, 900); });
    make(folder, "city_10000.vox", [](const fs::path& file) { writeInstances(file, 10'000); });
    make(folder, "self_cycles", writeSelfCycles);
    make(folder, "half_planet.vox", writeHalfPlanet);
    make(folder, "monument.vox", writeMonument);
    make(folder, "terrain_shell.vox", writeTerrainShell);
    make(folder, "solid_terrain.vox", writeSolidTerrain);
#ifdef PFVOX_BENCH_WITH_OPENVDB
    make(folder, "fog_r400.vdb", writeFogBall);
    make(folder, "far_apart.vdb", writeFarApart);
    make(folder, "huge_shell.vdb", writeHugeShell);
#endif
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: make_large_sources <folder>\n", stderr);
        return 2;
    }
    try {
        makeAll(argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_large_sources: %s\n", error.what());
        return 1;
    }
    return 0;
}

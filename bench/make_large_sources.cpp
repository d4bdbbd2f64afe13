// Writes the sources that bench/run-import converts: make_large_sources <folder> [name of one of them]. About
// 700 MB in all; what is there already is left alone.
#include <cstdio>
#include <exception>
#include <functional>
#include <string>

#include "large_sources.hpp"

namespace {

namespace fs = std::filesystem;

struct Wanted {
    fs::path folder;
    std::string only;  ///< empty = all
};

/// Makes folder/name under another name first, so that what was interrupted is made again.
void make(const Wanted& wanted, const std::string& name, const std::function<void(const fs::path&)>& write) {
    const fs::path target = wanted.folder / name;
    if (fs::exists(target) || (!wanted.only.empty() && name != wanted.only)) return;
    std::printf("%s\n", name.c_str());
    std::fflush(stdout);
    const fs::path unfinished = wanted.folder / (name + ".unfinished");
    fs::remove_all(unfinished);
    write(unfinished);
    fs::rename(unfinished, target);
}

void makeAll(const Wanted& wanted) {
    using namespace pfvox::bench;
    fs::create_directories(wanted.folder);
    make(wanted, "liar.vox", writeLiar);
    make(wanted, "cut", writeCutFiles);
    make(wanted, "small", writeSmallFiles);
    make(wanted, "instances_900.vox", [](const fs::path& file) { writeInstances(file, 900); });
    make(wanted, "city_10000.vox", [](const fs::path& file) { writeInstances(file, 10'000); });
    make(wanted, "self_cycles", writeSelfCycles);
    make(wanted, "half_planet.vox", writeHalfPlanet);
    make(wanted, "monument.vox", writeMonument);
    make(wanted, "terrain_shell.vox", writeTerrainShell);
    make(wanted, "valley.scene.toml", writeValley);
    make(wanted, "solid_terrain.vox", writeSolidTerrain);
#ifdef PFVOX_BENCH_WITH_OPENVDB
    make(wanted, "fog_r400.vdb", writeFogBall);
    make(wanted, "far_apart.vdb", writeFarApart);
    make(wanted, "huge_shell.vdb", writeHugeShell);
#endif
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2 && argc != 3) {
        std::fputs("usage: make_large_sources <folder> [name]\n", stderr);
        return 2;
    }
    try {
        makeAll({.folder = argv[1], .only = argc == 3 ? argv[2] : ""});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_large_sources: %s\n", error.what());
        return 1;
    }
    return 0;
}

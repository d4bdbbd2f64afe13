// What decides a bake without being an input of it (kBakeVersion, the revision of the filter) is part of its
// key: with an equal key come equal bytes, or users' probes would stay what they are. Device and programs are
// in the key, too, so that this is about the part that runs on the CPU.
#include <gmock/gmock.h>

#include <pfvox/files.hpp>

#include "bake_fixture.hpp"
#include "support/revision_table.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

/// A room with an emitter, sun and sky, and a probe that must be moved.
LoadedScene litRoom() {
    LoadedScene scene = sceneOf(demoRoom());
    scene.scene.sun = {.direction = {-0.3, -1.0, -0.6}, .irradiance = {3.0, 2.9, 2.7}};
    scene.scene.sky = Sky{};
    scene.scene.probes.proximityCells = glm::uvec3(8);
    scene.probes = {.start = {0.05f, 1.0f, 1.0f}, .step = {3.0f, 1.5f, 2.5f}, .counts = {2, 1, 1}};
    return scene;
}

class BakeRevision : public BakeTest {};

TEST_F(BakeRevision, RisesWithTheBytes) {
    RevisionTable table("bake_revisions.txt");
    const gpu::DeviceInfo& info = device().info();
    std::string machine = info.name + "," + info.driver;
    std::ranges::replace(machine, ' ', '_');
    if (!table.knows(machine) && std::getenv("PFVOX_UPDATE_GOLDEN") == nullptr)
        GTEST_SKIP() << "bake_revisions.txt knows nothing of " << machine;

    BakeSettings settings;
    settings.resolution = {.depth = 32, .light = 16, .irradiance = 8, .moments = 8};
    settings.minSamples = 32;
    settings.maxSamples = 64;
    settings.noiseTarget = 0.05f;
    const LoadedScene scene = litRoom();
    const TempFolder folder;
    BakeObserver observer;
    const auto report = bakeProbes(device(), scene, settings, folder / "a.pf_probe", observer, diagnostics);
    ASSERT_TRUE(report) << describe(report.error());
    const auto contents = io::readFile(folder / "a.pf_probe", std::uint64_t{1} << 30);
    ASSERT_TRUE(contents);
    table.expect(
        bakeContentKey(scene, settings, info).hex(), machine, hashText(contents->bytes()),
        "raise kBakeVersion in libbake/src/bake/content_hash.cpp, then run with PFVOX_UPDATE_GOLDEN=1");
}

}  // namespace
}  // namespace pfvox::test

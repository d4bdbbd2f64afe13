// A bake from end to end: the file, shards, resuming, and what the report says.
#include <gmock/gmock.h>

#include <fstream>
#include <iostream>
#include <pfvox/probe_file.hpp>
#include <pfvox/probe_layers.hpp>
#include <pfvox/probe_maths.hpp>

#include "bake_fixture.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

class StopAfter final : public BakeObserver {
  public:
    explicit StopAfter(std::uint64_t probes) : probes_(probes) {}
    void progress(const BakeProgress& progress) override {
        EXPECT_GE(progress.probesDone, done_);
        done_ = progress.probesDone;
    }
    bool stopRequested() override { return done_ >= probes_; }

  private:
    std::uint64_t probes_;
    std::uint64_t done_ = 0;
};

class BakeFileTest : public BakeTest {
  protected:
    static LoadedScene room() {
        LoadedScene scene = sceneOf(demoRoom());
        scene.scene.sun = {.direction = {-0.3, -1.0, -0.6}, .irradiance = {3.0, 2.9, 2.7}};
        scene.scene.sky = Sky{};
        scene.scene.probes.proximityCells = glm::uvec3(8);
        scene.probes = {.start = {0.05f, 1.0f, 1.0f}, .step = {3.0f, 1.5f, 2.5f}, .counts = {2, 2, 2}};
        return scene;
    }
    static BakeSettings small() {
        BakeSettings settings = plain(32, 32);
        settings.resolution.light = 16;
        settings.noiseTarget = 0.05f;
        settings.maxSamples = 64;
        return settings;
    }
    BakeReport bake(const BakeSettings& settings, const std::string& name) {
        BakeObserver observer;
        const Result<BakeReport> report =
            bakeProbes(device(), scene, settings, folder / name, observer, diagnostics);
        EXPECT_TRUE(report) << describe(report.error());
        return report.value_or(BakeReport{});
    }
    std::string bytesOf(const std::string& name) const {
        std::ifstream file(folder / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    TempFolder folder;
    LoadedScene scene = room();
};

TEST_F(BakeFileTest, MakesAFileWithAllLayers) {
    const BakeReport report = bake(small(), "a.pf_probe");
    EXPECT_EQ(report.probes, 8u);
    EXPECT_EQ(report.counts.active + report.counts.inactive, 8u);
    EXPECT_GT(report.counts.active, 4u);
    EXPECT_GT(report.light.rays, 10000u);
    EXPECT_EQ(report.stepLimitRays, 0u);
    EXPECT_GE(report.meanSamples.value(), 32.0);
    EXPECT_GT(report.proximity.surfaceCells, 0u);
    EXPECT_EQ(report.fileBytes, bytesOf("a.pf_probe").size());
    EXPECT_THAT(validatePfProbeFile(folder / "a.pf_probe", Limits{}), ::testing::IsEmpty());
    PFVOX_ASSERT_VALUE(const ProbeField, field, loadPfProbe(folder / "a.pf_probe", Limits{}, diagnostics));
    EXPECT_EQ(field.info.sceneHash, sceneContentHash(scene));
    ASSERT_TRUE(field.proximity);
    for (const ProbeData& probe : field.probes) {
        if (!probe.record.isActive()) continue;
        EXPECT_EQ(probe.minDepth, minDepthLayer(probe.depthNormal, 32));
        EXPECT_GT(*std::ranges::max_element(probe.light), 0u);
    }
    std::cout << "  " << report.light.rays << " rays, " << report.counts.relocated << " relocated, "
              << report.counts.inactive << " inactive, uncovered cells " << report.proximity.uncoveredCells
              << " of " << report.proximity.surfaceCells << ", " << report.totalMs << " ms\n";
}

TEST_F(BakeFileTest, TwoBakesAreEqual) {
    bake(small(), "a.pf_probe");
    bake(small(), "b.pf_probe");
    EXPECT_EQ(bytesOf("a.pf_probe"), bytesOf("b.pf_probe"));
    BakeSettings other = small();
    other.seed = 1;
    bake(other, "c.pf_probe");
    EXPECT_NE(bytesOf("a.pf_probe"), bytesOf("c.pf_probe"));
}

TEST_F(BakeFileTest, ThePieceSizeOfDispatchesChangesNothing) {
    bake(small(), "a.pf_probe");
    BakeSettings pieces = small();
    pieces.dispatchSeconds = 1e-4;
    bake(pieces, "b.pf_probe");
    EXPECT_EQ(bytesOf("a.pf_probe"), bytesOf("b.pf_probe"));
}

TEST_F(BakeFileTest, ShardsMergeToTheWhole) {
    bake(small(), "whole.pf_probe");
    PFVOX_ASSERT_VALUE(const ProbeField, whole,
                       loadPfProbe(folder / "whole.pf_probe", Limits{}, diagnostics));
    for (const std::uint32_t shards : {1u, 2u, 4u}) {
        std::vector<std::filesystem::path> files;
        for (std::uint32_t i = 0; i < shards; ++i) {
            BakeSettings settings = small();
            settings.range = ProbeRange{8 * i / shards, 8 * (i + 1) / shards};
            const std::string name = std::to_string(shards) + "-" + std::to_string(i) + ".pf_probe";
            bake(settings, name);
            files.push_back(folder / name);
        }
        const auto merged = mergeProbeFields(files, folder / "merged.pf_probe",
                                             {.proximity = whole.proximity}, Limits{}, diagnostics);
        ASSERT_TRUE(merged) << describe(merged.error());
        PFVOX_ASSERT_VALUE(const ProbeField, field,
                           loadPfProbe(folder / "merged.pf_probe", Limits{}, diagnostics));
        EXPECT_EQ(field, whole) << shards;
    }
}

TEST_F(BakeFileTest, AStoppedBakeIsResumed) {
    bake(small(), "whole.pf_probe");
    StopAfter observer(3);
    const auto stopped =
        bakeProbes(device(), scene, small(), folder / "part.pf_probe", observer, diagnostics);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, ErrorCode::Cancelled);
    EXPECT_TRUE(std::filesystem::exists(probeJournalPath(folder / "part.pf_probe")));
    BakeSettings resumed = small();
    resumed.resume = true;
    const BakeReport report = bake(resumed, "part.pf_probe");
    EXPECT_GE(report.reused, 3u);
    if (device().info().kind == gpu::DeviceKind::Software) {  // others take all eight as one group
        EXPECT_LT(report.reused, 8u);
    }
    EXPECT_EQ(bytesOf("whole.pf_probe"), bytesOf("part.pf_probe"));
}

TEST_F(BakeFileTest, ResumingTakesNothingOfAnotherScene) {
    StopAfter observer(3);
    EXPECT_FALSE(bakeProbes(device(), scene, small(), folder / "part.pf_probe", observer, diagnostics));
    scene.scene.sun.irradiance.x += 1.0;
    BakeSettings resumed = small();
    resumed.resume = true;
    EXPECT_EQ(bake(resumed, "part.pf_probe").reused, 0u);
}

TEST_F(BakeFileTest, WhatIsUpToDateIsNotBakedAgain) {
    bake(small(), "a.pf_probe");
    EXPECT_TRUE(bake(small(), "a.pf_probe").upToDate);
    BakeSettings forced = small();
    forced.force = true;
    EXPECT_FALSE(bake(forced, "a.pf_probe").upToDate);
    scene.scene.sky.zenith.y += 0.1;
    EXPECT_FALSE(bake(small(), "a.pf_probe").upToDate);
}

TEST_F(BakeFileTest, CompactFilesHaveTheSmallLayersOnly) {
    BakeSettings settings = small();
    settings.resolution = resolutionOf(ProbeProfile::Compact);
    settings.maxSamples = 32;
    settings.range = ProbeRange{3, 4};
    bake(settings, "a.pf_probe");
    PFVOX_ASSERT_VALUE(const ProbeField, field, loadPfProbe(folder / "a.pf_probe", Limits{}, diagnostics));
    EXPECT_EQ(field.probes[0].irradiance.size(), 100u);
    EXPECT_EQ(field.probes[0].moments.size(), 256u);
    EXPECT_TRUE(field.probes[0].light.empty());
}

TEST_F(BakeFileTest, AFurnaceFillsTheIrradianceMap) {
    scene = sceneOf(assetOf(hollowBox(glm::ivec3(10)), {gray(188, 0.5)}));
    scene.probes.step = glm::vec3(0.4f);
    bake(plain(16, 128), "a.pf_probe");
    PFVOX_ASSERT_VALUE(const ProbeField, field, loadPfProbe(folder / "a.pf_probe", Limits{}, diagnostics));
    const double expected = 0.5 / (1.0 - linearOf(188));  // what leaves the walls is what comes in
    for (const std::uint32_t word : field.probes[0].irradiance)
        EXPECT_NEAR(static_cast<double>(unpackLight(word).x) / expected, 1.0, 0.02);
}

TEST_F(BakeFileTest, AnEmptySceneHasSkyAlone) {
    scene.parts.clear();
    scene.bounds = {};
    scene.scene.sky = {.zenith = glm::dvec3(1.0), .horizon = glm::dvec3(1.0), .ground = glm::dvec3(1.0)};
    bake(small(), "a.pf_probe");
    PFVOX_ASSERT_VALUE(const ProbeField, field, loadPfProbe(folder / "a.pf_probe", Limits{}, diagnostics));
    for (const std::uint32_t word : field.probes[5].irradiance) EXPECT_NEAR(unpackLight(word).y, 1.0f, 1e-3f);
    for (const std::uint32_t word : field.probes[5].depthNormal) EXPECT_EQ(depthCodeOf(word), kDepthMissCode);
}

TEST_F(BakeFileTest, SettingsOutOfRangeAreNamed) {
    const auto refused = [&](const auto& change) {
        BakeSettings settings = small();
        change(settings);
        BakeObserver observer;
        const auto report =
            bakeProbes(device(), scene, settings, folder / "x.pf_probe", observer, diagnostics);
        return report ? ErrorCode::Internal : report.error().code;
    };
    EXPECT_EQ(refused([](BakeSettings& s) { s.minSamples = 20; }), ErrorCode::BadValue);
    EXPECT_EQ(refused([](BakeSettings& s) { s.maxSamples = 16; }), ErrorCode::BadValue);
    EXPECT_EQ(refused([](BakeSettings& s) { s.resolution.depth = 40; }), ErrorCode::BadValue);
    EXPECT_EQ(refused([](BakeSettings& s) { s.resolution.light = 12; }), ErrorCode::BadValue);
    EXPECT_EQ(refused([](BakeSettings& s) { s.resolution = {}; }), ErrorCode::BadValue);
    EXPECT_EQ(refused([](BakeSettings& s) { s.range = ProbeRange{4, 9}; }), ErrorCode::BadValue);
    EXPECT_EQ(refused([](BakeSettings& s) { s.noiseTarget = -1.0f; }), ErrorCode::BadValue);
}

}  // namespace
}  // namespace pfvox::test

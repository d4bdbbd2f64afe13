// What a probe file tells of the settings of its bake, and what its reports say of figures that are not
// known.
#include "cli/probe_bake_fixture.hpp"

namespace pfvox::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class ProbeBakeFigures : public ProbeBakeScene {
  protected:
    void SetUp() override {
        ProbeBakeScene::SetUp();
        writeScene("scene.toml", "box.pf_vox",
                   std::string(kGrid) +
                       "[[cameras]]\nname = \"front\"\nposition = [0.6, 1.2, 3]\ntarget = [0.6, 0.3, 0.6]\n");
    }

    /// The line of bake --json.
    json bake(const std::string& name, std::vector<std::string> options) const {
        options.insert(options.begin(), {"scene.toml", "-o", name, "--resolution", "16,8,4,6", "--json"});
        const ProcessResult result = run(std::move(options));
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return json::parse(result.out);
    }
    json info(const std::string& name) const {
        json found = json::parse(run({"info", "--json", name}).out);
        expectSchema("probe-info", found);
        return found;
    }
};

/// --bounces 0 was stored as "no limit", and verify took it so.
TEST_F(ProbeBakeFigures, NoBounceIsNotNoLimit) {
    const auto meanReference = [&](const char* name) {
        return json::parse(run({"verify", "--json", "scene.toml", name, "--size", "24x16", "--samples", "64"})
                               .out)["all"]["meanReference"]
            .get<double>();
    };
    // A gap between two boxes, whose walls light each other.
    writePfVox(folder / "box.pf_vox", boxAsset({{0, 0, 0}, {12, 6, 12}}, 0.1, {{0, 0, 0}, {15, 0, 0}}));
    writeScene("scene.toml", "box.pf_vox",
               std::string(kGrid) +
                   "[[cameras]]\nname = \"gap\"\nposition = [1.35, 1.4, 1.6]\ntarget = [1.35, 0.1, 0.6]\n");
    bake("none.pf_probe", {"--samples", "32", "--bounces", "0"});
    bake("all.pf_probe", {"--samples", "32"});
    EXPECT_EQ(info("none.pf_probe")["settings"]["maxBounces"], 0);
    EXPECT_EQ(info("all.pf_probe")["settings"]["maxBounces"], "unlimited");
    EXPECT_THAT(run({"info", "none.pf_probe"}).out, HasSubstr("--bounces 0, "));
    EXPECT_THAT(run({"info", "all.pf_probe"}).out, HasSubstr("--bounces unlimited, "));
    EXPECT_LT(meanReference("none.pf_probe"), meanReference("all.pf_probe"));
}

TEST_F(ProbeBakeFigures, TheFileKeepsThem) {
    bake("a.pf_probe", {"--samples", "48", "--bounces", "3", "--no-relocate", "--no-filter", "--seed", "7"});
    const json settings = info("a.pf_probe")["settings"];
    EXPECT_EQ(settings["minSamples"], 48);
    EXPECT_EQ(settings["maxBounces"], 3);
    EXPECT_EQ(settings["relocate"], false);
    EXPECT_EQ(settings["filter"], 0);
    EXPECT_EQ(settings["seed"], 7);
    bake("b.pf_probe", {"--samples", "48"});
    EXPECT_EQ(info("b.pf_probe")["settings"]["relocate"], true);
    EXPECT_GT(info("b.pf_probe")["settings"]["filter"], 0) << "every default bake was unfiltered";
}

TEST_F(ProbeBakeFigures, ShardsOfOtherSettingsDoNotMerge) {
    bake("a.pf_probe", {"--probes", "0:9", "--samples", "32", "--bounces", "2"});
    struct Case {
        std::vector<std::string> options;
        std::string first;
        std::string second;
    };
    for (const Case& it :
         {Case{{"--samples", "32", "--bounces", "4"}, "--bounces 2", "--bounces 4"},
          Case{{"--samples", "32", "--bounces", "2", "--no-relocate"}, "--relocate", "--no-relocate"},
          Case{{"--samples", "32", "--bounces", "2", "--no-filter"}, "--filter (revision ", "--no-filter"},
          Case{{"--samples", "48", "--bounces", "2"},
               "least samples 32, most samples 32",
               "least samples 48, most samples 48"},
          Case{{"--bounces", "2", "--noise", "0.9", "--max-samples", "32"}, "--noise 0", "--noise 0.9"}}) {
        std::vector<std::string> options = it.options;
        options.insert(options.end(), {"--probes", "9:18"});
        bake("b.pf_probe", options);
        const ProcessResult merged = run({"merge", "a.pf_probe", "b.pf_probe", "-o", "all.pf_probe"});
        EXPECT_EQ(merged.exitCode, 4) << it.second;
        EXPECT_THAT(merged.err, HasSubstr("a.pf_probe was baked with " + it.first));
        EXPECT_THAT(merged.err, HasSubstr("b.pf_probe with " + it.second));
        EXPECT_FALSE(std::filesystem::exists(folder / "all.pf_probe"));
    }
    bake("b.pf_probe", {"--probes", "9:18", "--samples", "32", "--bounces", "2"});
    EXPECT_EQ(run({"merge", "a.pf_probe", "b.pf_probe", "-o", "all.pf_probe"}).exitCode, 0);
}

/// "noise 0.00 %" of one batch of paths, which has no spread.
TEST_F(ProbeBakeFigures, NoiseOfOneBatchIsUnknown) {
    const json report = bake("a.pf_probe", {"--samples", "16"});
    expectSchema("bake", report);
    EXPECT_TRUE(report["meanError"].is_null());
    EXPECT_TRUE(report["maxError"].is_null());
    EXPECT_TRUE(report["noisyTileFraction"].is_null()) << "every tile stopped where it was told to";
    for (const json& probe : info("a.pf_probe")["probes"]) EXPECT_TRUE(probe["error"].is_null());
    EXPECT_THAT(run({"info", "a.pf_probe"}).out, HasSubstr("unknown"));
    const ProcessResult text =
        run({"scene.toml", "-o", "b.pf_probe", "--resolution", "16,8,4,6", "--samples", "16"});
    EXPECT_THAT(text.out, HasSubstr("16.0 paths a texel, noise unknown\n"));
    EXPECT_EQ(run({"validate", "a.pf_probe"}).exitCode, 0);

    const json known = bake("c.pf_probe", {"--samples", "32"});
    EXPECT_GT(known["meanError"], 0.0);
    EXPECT_GE(known["maxError"], known["meanError"]);
    const json adaptive = bake("d.pf_probe", {"--noise", "0.9", "--max-samples", "32"});
    EXPECT_TRUE(adaptive["noisyTileFraction"].is_number());
}

/// "9 active, 9 of them relocated" of the bake was "0 active, 9 relocated" of info.
TEST_F(ProbeBakeFigures, BakeAndInfoCountAlike) {
    const json report = bake("a.pf_probe", {"--samples", "16"});
    const json states = info("a.pf_probe")["states"];
    EXPECT_GT(report["relocated"], 0);
    for (const char* state : {"active", "relocated", "inactive"})
        EXPECT_EQ(states[state], report[state]) << state;
    EXPECT_EQ(report["active"].get<int>() + report["inactive"].get<int>(), report["probes"].get<int>());
}

/// Of a run that only took probes from the journal, "0.0 paths a texel" would be told.
TEST_F(ProbeBakeFigures, WhatWasNotTracedHasNoPaths) {
    bake("a.pf_probe", {"--samples", "16"});
    const json planned = bake("a.pf_probe", {"--samples", "16", "--dry-run"});
    expectSchema("bake", planned);
    EXPECT_TRUE(planned["meanSamples"].is_null());
    EXPECT_EQ(planned["contentKey"], info("a.pf_probe")["contentKey"]);
}

}  // namespace
}  // namespace pfvox::test

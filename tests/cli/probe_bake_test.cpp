// probe-bake as a child process: what needs no GPU.
#include <pfvox/probe_maths.hpp>

#include "cli/probe_bake_fixture.hpp"

namespace pfvox::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST_F(ProbeBake, InfoTellsWhatProbesSee) {
    write("a.pf_probe", probeField(probeInfo()));
    const ProcessResult text = run({"info", "a.pf_probe"});
    EXPECT_EQ(text.exitCode, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("grid 3 x 2 x 2"));
    EXPECT_THAT(text.out, HasSubstr("inactive"));

    const ProcessResult result = run({"info", "--json", "a.pf_probe"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const json info = json::parse(result.out);
    expectSchema("probe-info", info);
    ASSERT_EQ(info["probes"].size(), 12u);
    EXPECT_EQ(info["states"]["inactive"], 2);
    EXPECT_EQ(info["probes"][3]["state"], "inactive");
    EXPECT_TRUE(info["probes"][3]["meanIndirect"].is_null());
    EXPECT_EQ(info["probes"][4]["state"], "relocated");
    EXPECT_NEAR(info["probes"][4]["position"][0], -1 + 1 + 0.25, 1e-6);
}

/// Light of one value everywhere has that mean, whatever the weights; texels without a surface do not count.
TEST_F(ProbeBake, InfoMeansAreOverWhatIsSeen) {
    ProbeFieldInfo info = probeInfo({1, 1, 1}, {.depth = 32, .light = 16});
    info.depth = {.scale = 4, .farMetres = 100};
    const DepthCoder coder(info.depth);
    ProbeField field{.info = info, .probes = {{}}, .proximity = {}};
    ProbeData& probe = field.probes[0];
    for (std::uint32_t i = 0; i < 32 * 32; ++i)
        probe.depthNormal.push_back(i < 32 * 16 ? kDepthMissCode
                                                : packDepthNormal(coder.encode(2.0f), {0, 1, 0}));
    probe.minDepth.assign(4, 0);
    for (std::uint32_t i = 0; i < 4; ++i)
        probe.minDepth[i] = static_cast<std::uint16_t>(i < 2 ? kDepthMissCode : coder.encode(2.0f));
    for (std::uint32_t i = 0; i < 16 * 16; ++i)
        probe.light.push_back(i < 16 * 8 ? 0 : packLight({0.5f, 1.0f, 2.0f}));
    write("a.pf_probe", field);
    const ProcessResult result = run({"info", "--json", "a.pf_probe"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const json counted = json::parse(result.out)["probes"][0];
    EXPECT_NEAR(counted["missFraction"], 0.5, 1e-6);
    EXPECT_NEAR(counted["meanIndirect"][0], 0.5, 1e-6);
    EXPECT_NEAR(counted["meanIndirect"][2], 2.0, 1e-6);
    EXPECT_NEAR(counted["maxIndirect"], 2.0, 1e-6);
    EXPECT_NEAR(counted["minDepth"], 2.0, 1e-3);
    EXPECT_NEAR(counted["meanDepth"], 2.0, 1e-3);
}

/// info named its own version of the format and took 0 for "no limit".
TEST_F(ProbeBake, InfoOfAnOlderFileSaysWhatItDoesNotKnow) {
    std::filesystem::copy_file(std::filesystem::path(PFVOX_TESTS_DIR) / "golden/data/v1_0.pf_probe",
                               folder / "old.pf_probe");
    const json old = json::parse(run({"info", "--json", "old.pf_probe"}).out);
    expectSchema("probe-info", old);
    EXPECT_EQ(old["formatVersion"], "1.0");
    EXPECT_EQ(old["settings"]["maxBounces"], 16);
    for (const char* name : {"noiseFloor", "sampling", "stratified", "relocate", "filter"})
        EXPECT_TRUE(old["settings"].at(name).is_null()) << name;
    const ProcessResult text = run({"info", "old.pf_probe"});
    EXPECT_THAT(text.out, HasSubstr("PF_PROBE 1.0, "));
    EXPECT_THAT(text.out, HasSubstr("--filter unknown"));
}

TEST_F(ProbeBake, InfoCountsStatesAsBakeDoes) {
    write("a.pf_probe", probeField(probeInfo()));
    const json states = json::parse(run({"info", "--json", "a.pf_probe"}).out)["states"];
    EXPECT_EQ(states["active"], 10) << "relocated ones are active";
    EXPECT_EQ(states["relocated"], 2);
    EXPECT_THAT(run({"info", "a.pf_probe"}).out, HasSubstr("10 active, 2 of them relocated; 2 inactive"));
}

TEST_F(ProbeBake, InfoOfSomethingElseFails) {
    writeText(folder / "a.pf_probe", "no probe file at all, but long enough to hold a header of one");
    EXPECT_EQ(run({"info", "a.pf_probe"}).exitCode, 4);
    EXPECT_EQ(run({"info", "absent.pf_probe"}).exitCode, 3);
    std::filesystem::copy_file(std::filesystem::path(PFVOX_TESTS_DIR) / "golden/data/v1_0.pf_vox",
                               folder / "b.pf_probe");
    EXPECT_THAT(run({"info", "b.pf_probe"}).err, HasSubstr("but PF_VOX, which vox2pf reads"));
}

TEST_F(ProbeBake, AFileThatCannotBeReadHasAnObjectToo) {
    for (const std::string command : {"info", "validate"}) {
        const ProcessResult result = run({command, "--json", "none.pf_probe"});
        EXPECT_EQ(result.exitCode, 3);
        const json object = json::parse(result.out);
        expectSchema("read-failure", object);
        EXPECT_EQ(object["error"]["code"], "file-not-found");
    }
}

TEST_F(ProbeBake, ValidateFindsDamage) {
    write("a.pf_probe", probeField(probeInfo()));
    EXPECT_EQ(run({"validate", "a.pf_probe"}).exitCode, 0);
    std::string bytes = readText(folder / "a.pf_probe");
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x10);
    writeText(folder / "b.pf_probe", bytes);
    const ProcessResult result = run({"validate", "--json", "b.pf_probe"});
    EXPECT_EQ(result.exitCode, 4);
    const json findings = json::parse(result.out);
    expectSchema("validate", findings);
    EXPECT_FALSE(findings["valid"]);
}

TEST_F(ProbeBake, CompareTellsHowFarFilesAreApart) {
    ProbeField field = probeField(probeInfo());
    write("a.pf_probe", field);
    field.probes[0].light[5] = packLight({4, 4, 4});
    field.probes[0].record.hash = 0;
    field.info.settings.seed = 78;
    write("b.pf_probe", field);

    EXPECT_EQ(run({"compare", "--equal", "a.pf_probe", "a.pf_probe"}).exitCode, 0);
    const ProcessResult result = run({"compare", "--json", "a.pf_probe", "b.pf_probe"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const json difference = json::parse(result.out);
    expectSchema("probe-compare", difference);
    EXPECT_EQ(difference["equalProbes"], 11);
    EXPECT_FALSE(difference["equal"]);
    EXPECT_EQ(difference["layers"][1]["name"], "light");
    EXPECT_EQ(difference["layers"][1]["differentWords"], 1);
    EXPECT_EQ(difference["layers"][1]["largestProbe"], 0);
    EXPECT_EQ(difference["layers"][0]["differentWords"], 0);
    EXPECT_THAT(std::string(difference["differentSettings"][0]), HasSubstr("--seed 77 and --seed 78"));

    const ProcessResult unequal = run({"compare", "--equal", "a.pf_probe", "b.pf_probe"});
    EXPECT_EQ(unequal.exitCode, 1);
    EXPECT_THAT(unequal.err, HasSubstr("1 probe differ"));
    EXPECT_EQ(run({"compare", "--min-psnr", "200", "a.pf_probe", "b.pf_probe"}).exitCode, 1);
}

/// A field without one active probe was as near to another as could be asked for; so was light beside a dark
/// map.
TEST_F(ProbeBake, CompareDoesNotPraiseWhatItDidNotSee) {
    ProbeField field = probeField(probeInfo());
    write("a.pf_probe", field);
    for (ProbeData& probe : field.probes) probe.light.assign(probe.light.size(), 0);
    write("dark.pf_probe", field);
    for (ProbeData& probe : field.probes)
        probe = {.record = {.state = ProbeState::Inactive}, .inputHash = probe.inputHash};
    field.proximity.reset();
    write("none.pf_probe", field);
    const ProcessResult none = run({"compare", "--json", "a.pf_probe", "none.pf_probe"});
    ASSERT_EQ(none.exitCode, 0) << none.err;
    const json difference = json::parse(none.out);
    expectSchema("probe-compare", difference);
    EXPECT_TRUE(difference["layers"][0]["withinOneFraction"].is_null());
    EXPECT_THAT(run({"compare", "a.pf_probe", "none.pf_probe"}).out, ::testing::Not(HasSubstr("100.000 %")));
    for (const char* limit : {"--min-psnr", "--min-depth-within-one"}) {
        const ProcessResult asked = run({"compare", limit, "1", "a.pf_probe", "none.pf_probe"});
        EXPECT_EQ(asked.exitCode, 1) << limit;
        EXPECT_THAT(asked.err, HasSubstr("no probe is active in both"));
    }
    EXPECT_EQ(run({"compare", "--min-psnr", "100", "none.pf_probe", "none.pf_probe"}).exitCode, 0);
    EXPECT_EQ(run({"compare", "--min-psnr", "100", "a.pf_probe", "dark.pf_probe"}).exitCode, 1);
    EXPECT_EQ(run({"compare", "--min-psnr", "100", "dark.pf_probe", "a.pf_probe"}).exitCode, 1);
}

TEST_F(ProbeBake, CompareRefusesOtherGrids) {
    write("a.pf_probe", probeField(probeInfo()));
    write("b.pf_probe", probeField(probeInfo({2, 2, 2})));
    const ProcessResult result = run({"compare", "a.pf_probe", "b.pf_probe"});
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_THAT(result.err, HasSubstr("grid"));
    EXPECT_THAT(result.err, HasSubstr("b.pf_probe: cannot be compared with the first file"));
    const ProcessResult one = run({"compare", "a.pf_probe"});
    EXPECT_EQ(one.exitCode, 2);
    EXPECT_THAT(one.err, HasSubstr("two files are compared, and only one was named"));
}

TEST_F(ProbeBake, MergeGivesTheWhole) {
    const ProbeField field = probeField(probeInfo(), false);
    write("whole.pf_probe", field);
    writeShard("s1.pf_probe", field, {0, 5});
    writeShard("s2.pf_probe", field, {5, 12});
    const ProcessResult result =
        run({"merge", "--json", "s2.pf_probe", "s1.pf_probe", "-o", "merged.pf_probe"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    expectSchema("probe-merge", json::parse(result.out));
    EXPECT_EQ(readText(folder / "merged.pf_probe"), readText(folder / "whole.pf_probe"));
}

TEST_F(ProbeBake, MergeNamesWhatIsMissing) {
    const ProbeField field = probeField(probeInfo(), false);
    writeShard("s1.pf_probe", field, {0, 5});
    const ProcessResult result = run({"merge", "s1.pf_probe", "-o", "merged.pf_probe"});
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_FALSE(std::filesystem::exists(folder / "merged.pf_probe"));
    EXPECT_EQ(run({"merge", "s1.pf_probe", "-o", "s1.pf_probe"}).exitCode, 2);
}

TEST_F(ProbeBake, WrongUsageIsRefused) {
    EXPECT_EQ(run({}).exitCode, 2);
    EXPECT_EQ(run({"--help"}).exitCode, 0);
    EXPECT_EQ(run({"bake", "--help"}).exitCode, 0);
    EXPECT_EQ(run({"--version"}).exitCode, 0);
    EXPECT_EQ(run({"scene.toml"}).exitCode, 2);
    EXPECT_EQ(run({"scene.toml", "-o", "a.pf_probe", "--samples", "64", "--noise", "0.1"}).exitCode, 2);
    EXPECT_EQ(run({"scene.toml", "-o", "a.pf_probe", "--bounces", "17"}).exitCode, 2);
    EXPECT_EQ(run({"scene.toml", "-o", "scene.toml"}).exitCode, 2);
}

}  // namespace
}  // namespace pfvox::test

// probe-bake bake and verify as child processes, on whatever device there is.
#include <chrono>
#include <thread>

#include "cli/probe_bake_fixture.hpp"

namespace pfvox::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST_F(ProbeBakeScene, WarningsNameTheSceneOnce) {
    writeText(folder / "a.toml", "color = 1\n[[models]]\npath = \"box.pf_vox\"\n");
    const ProcessResult result = run({"a.toml", "-o", "a.pf_probe", "--dry-run"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.err, ::testing::StartsWith("warning: a.toml: line 1, column 1: unknown key color"));
}

TEST_F(ProbeBakeScene, WithoutADriverTheRemedyIsNamed) {
    const ProcessResult result =
        runProcess({PFVOX_PROBE_BAKE, "box.pf_vox", "-o", "a.pf_probe"},
                   {.environment = {"VK_DRIVER_FILES=/nowhere", "VK_ICD_FILENAMES=/nowhere"},
                    .input = {},
                    .folder = folder.path()});
    EXPECT_EQ(result.exitCode, 6);
    EXPECT_THAT(result.err, HasSubstr("no Vulkan driver is installed"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.pf_probe"));
}

TEST_F(ProbeBakeScene, BakesAndLeavesAloneWhatIsUpToDate) {
    writeScene("scene.toml", "box.pf_vox", kGrid);
    const ProcessResult baked =
        run(tiny({"scene.toml", "-o", "out.pf_probe", "--json", "--depfile", "out.d"}));
    ASSERT_EQ(baked.exitCode, 0) << baked.err;
    const json report = json::parse(baked.out);
    expectSchema("bake", report);
    EXPECT_EQ(report["status"], "baked");
    EXPECT_EQ(report["probes"], 18);
    EXPECT_EQ(readText(folder / "out.d"), "out.pf_probe: scene.toml box.pf_vox\n");
    EXPECT_EQ(run({"validate", "out.pf_probe"}).exitCode, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pf_probe.journal"));

    const ProcessResult again = run(tiny({"scene.toml", "-o", "out.pf_probe", "--json"}));
    EXPECT_EQ(json::parse(again.out)["status"], "up-to-date");
    const auto time = std::filesystem::last_write_time(folder / "out.pf_probe");
    const ProcessResult forced =
        run(tiny({"scene.toml", "-o", "out.pf_probe", "--force", "--if-changed", "--explain"}));
    EXPECT_THAT(forced.out, HasSubstr("--force"));
    EXPECT_EQ(std::filesystem::last_write_time(folder / "out.pf_probe"), time);
    const ProcessResult seeded = run(tiny({"scene.toml", "-o", "out.pf_probe", "--seed", "5", "--explain"}));
    EXPECT_THAT(seeded.out, HasSubstr("changed since the last bake"));
}

TEST_F(ProbeBakeScene, TheDepfileNamesAListInPlaceOfWhatTheBuildKnows) {
    std::filesystem::copy(folder / "box.pf_vox", folder / "it's.pf_vox");
    writeScene("scene.toml", "it's.pf_vox", kGrid);
    const std::vector<std::string> bake{"scene.toml", "-o", "out.pf_probe", "--if-changed", "--depfile", "d"};
    const ProcessResult refused = run(tiny(bake));
    EXPECT_EQ(refused.exitCode, 4);
    EXPECT_THAT(refused.err, HasSubstr("the character '"));
    EXPECT_FALSE(std::filesystem::exists(folder / "d"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pf_probe")) << "refused before the bake";

    writeText(folder / "known.txt", "other.pf_vox\n./it's.pf_vox\n");
    std::vector<std::string> known = bake;
    known.insert(known.end(), {"--depfile-known", "known.txt"});
    EXPECT_EQ(run(tiny(known)).exitCode, 0);
    EXPECT_EQ(readText(folder / "d"), "out.pf_probe: known.txt scene.toml\n");
}

TEST_F(ProbeBakeScene, ADryRunSaysWhatWouldBeBaked) {
    writeScene("scene.toml", "box.pf_vox", kGrid);
    const ProcessResult planned = run(tiny({"scene.toml", "-o", "out.pf_probe", "--dry-run", "--json"}));
    ASSERT_EQ(planned.exitCode, 0) << planned.err;
    const json report = json::parse(planned.out);
    expectSchema("bake", report);
    EXPECT_EQ(report["status"], "planned");
    EXPECT_EQ(report["probes"], 18);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pf_probe"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pf_probe.journal"));
    ASSERT_EQ(run(tiny({"scene.toml", "-o", "out.pf_probe"})).exitCode, 0);
    const ProcessResult again = run(tiny({"scene.toml", "-o", "out.pf_probe", "--dry-run"}));
    EXPECT_THAT(again.out, HasSubstr("is up to date"));
    EXPECT_THAT(run(tiny({"scene.toml", "-o", "out.pf_probe", "--dry-run", "--force"})).out,
                HasSubstr("would bake"));
}

TEST_F(ProbeBakeScene, ShardsMergeToTheWhole) {
    writeScene("scene.toml", "box.pf_vox", kGrid);
    ASSERT_EQ(run(tiny({"scene.toml", "-o", "whole.pf_probe"})).exitCode, 0);
    ASSERT_EQ(run(tiny({"scene.toml", "-o", "a.pf_probe", "--probes", "0:7"})).exitCode, 0);
    ASSERT_EQ(run(tiny({"scene.toml", "-o", "b.pf_probe", "--probes", "7:18"})).exitCode, 0);
    ASSERT_EQ(run({"merge", "a.pf_probe", "b.pf_probe", "-o", "merged.pf_probe"}).exitCode, 0);
    const ProcessResult compared = run({"compare", "--equal", "whole.pf_probe", "merged.pf_probe"});
    EXPECT_EQ(compared.exitCode, 0) << compared.out << compared.err;
    EXPECT_NE(readText(folder / "whole.pf_probe"), readText(folder / "merged.pf_probe"))
        << "no proximity grid";
    ASSERT_EQ(
        run({"merge", "b.pf_probe", "a.pf_probe", "-o", "full.pf_probe", "--scene", "scene.toml"}).exitCode,
        0);
    EXPECT_EQ(readText(folder / "whole.pf_probe"), readText(folder / "full.pf_probe"));
    EXPECT_EQ(json::parse(run(tiny({"scene.toml", "-o", "full.pf_probe", "--json"})).out)["status"],
              "up-to-date");
    EXPECT_EQ(json::parse(run(tiny({"scene.toml", "-o", "merged.pf_probe", "--json"})).out)["status"],
              "baked")
        << "no proximity grid";
    const ProcessResult other =
        run(tiny({"scene.toml", "-o", "full.pf_probe", "--probes", "0:7", "--json", "--explain"}));
    EXPECT_EQ(json::parse(other.out)["status"], "baked") << "other probes";
    EXPECT_THAT(json::parse(other.out)["reason"], "the existing output holds other probes");
    writePfVox(folder / "box.pf_vox", boxAsset({{0, 0, 0}, {12, 7, 12}}, 0.1));
    const ProcessResult changed =
        run({"merge", "a.pf_probe", "b.pf_probe", "-o", "other.pf_probe", "--scene", "scene.toml"});
    EXPECT_EQ(changed.exitCode, 4);
    EXPECT_THAT(changed.err, HasSubstr("another scene"));
    EXPECT_FALSE(std::filesystem::exists(folder / "other.pf_probe"));
    EXPECT_EQ(run(tiny({"scene.toml", "-o", "a.pf_probe", "--probes", "7:19"})).exitCode, 2);
    EXPECT_EQ(run(tiny({"scene.toml", "-o", "a.pf_probe", "--probes", "7"})).exitCode, 2);
}

TEST_F(ProbeBakeScene, LightOnFacesIsWhatIsBakedWithoutOptions) {
    writeScene("scene.toml", "box.pf_vox", kGrid);
    const ProcessResult baked = run({"scene.toml", "-o", "a.pf_probe", "--samples", "128", "--json"});
    ASSERT_EQ(baked.exitCode, 0) << baked.err;
    const json report = json::parse(baked.out);
    expectSchema("bake", report);
    EXPECT_EQ(report["faces"]["faces"], 2 * (12 * 12 + 2 * 12 * 6));
    EXPECT_GE(report["faces"]["values"], report["faces"]["faces"]);
    const json info = json::parse(run({"info", "--json", "a.pf_probe"}).out);
    expectSchema("probe-info", info);
    EXPECT_EQ(info["faces"]["faces"], report["faces"]["faces"]);
    EXPECT_EQ(info["layers"].size(), 2u) << "irradiance and moments";
    EXPECT_EQ(run({"validate", "a.pf_probe"}).exitCode, 0);
    const json again = json::parse(run({"scene.toml", "-o", "a.pf_probe", "--samples", "128", "--json"}).out);
    EXPECT_EQ(again["status"], "up-to-date");
    // Parts have chunks and probes; joined they are the whole.
    for (const char* part : {"0/2", "1/2"}) {
        const std::string name = std::string(1, part[0]) + ".pf_probe";
        ASSERT_EQ(run({"scene.toml", "-o", name, "--samples", "128", "--probes", part}).exitCode, 0);
    }
    ASSERT_EQ(
        run({"merge", "1.pf_probe", "0.pf_probe", "-o", "b.pf_probe", "--scene", "scene.toml"}).exitCode, 0);
    EXPECT_EQ(readText(folder / "a.pf_probe"), readText(folder / "b.pf_probe"));
}

TEST_F(ProbeBakeScene, PartsOfNMakeUpTheGrid) {
    writeScene("scene.toml", "box.pf_vox", kGrid);
    for (const char* part : {"0/4", "1/4", "2/4", "3/4"}) {
        const std::string name = std::string("shards/") + part[0] + ".pf_probe";
        std::filesystem::create_directories(folder / "shards");
        ASSERT_EQ(run(tiny({"scene.toml", "-o", name, "--probes", part})).exitCode, 0) << part;
    }
    ASSERT_EQ(run({"merge", "shards", "-o", "merged.pf_probe"}).exitCode, 0);
    EXPECT_EQ(json::parse(run({"info", "--json", "merged.pf_probe"}).out)["range"]["end"], 18);
    for (const char* wrong : {"4/4", "0/19", "0/0", "1/", "1/2/3"})
        EXPECT_EQ(run(tiny({"scene.toml", "-o", "a.pf_probe", "--probes", wrong})).exitCode, 2) << wrong;
}

/// A bake that takes some seconds, stopped by `signal` when its journal holds a probe.
class StoppedBake : public ProbeBakeScene {
  protected:
    ProcessResult stopBy(int signal) {
        writeScene("scene.toml", "box.pf_vox", kGrid);
        ProcessSetup setup{.environment = {}, .input = {}, .folder = folder.path()};
        std::vector<std::string> command{PFVOX_PROBE_BAKE};
        command.insert(command.end(), arguments.begin(), arguments.end());
        Process process(command, setup);
        // The head of the journal comes first; what it grows by are probes.
        std::uintmax_t headBytes = 0;
        for (int i = 0; i < 3000; ++i) {
            std::error_code absent;
            const auto bytes = std::filesystem::file_size(journal(), absent);
            if (!absent && headBytes == 0) headBytes = bytes;
            if (!absent && headBytes != 0 && bytes > headBytes) break;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        process.send(signal);
        return process.finish();
    }
    ProcessResult resume() {
        std::vector<std::string> again = arguments;
        again.insert(again.end(), {"--resume", "--json"});
        return run(again);
    }
    void expectWholeBake() {
        std::vector<std::string> whole = arguments;
        std::ranges::replace(whole, std::string("out.pf_probe"), std::string("whole.pf_probe"));
        ASSERT_EQ(run(whole).exitCode, 0);
        EXPECT_EQ(readText(folder / "out.pf_probe"), readText(folder / "whole.pf_probe"));
    }
    std::filesystem::path journal() const { return folder / "out.pf_probe.journal"; }

    std::vector<std::string> arguments{"scene.toml", "-o",        "out.pf_probe", "--resolution",
                                       "64,32,4,6",  "--samples", "512"};
};

TEST_F(StoppedBake, CtrlCLeavesWhatResumeTakes) {
    const ProcessResult stopped = stopBy(SIGINT);
    ASSERT_EQ(stopped.exitCode, 130) << stopped.err;
    EXPECT_THAT(stopped.err, HasSubstr("--resume"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pf_probe"));
    ASSERT_TRUE(std::filesystem::exists(journal()));

    const ProcessResult resumed = resume();
    ASSERT_EQ(resumed.exitCode, 0) << resumed.err;
    EXPECT_GT(json::parse(resumed.out)["reused"], 0);
    EXPECT_FALSE(std::filesystem::exists(journal()));
}

TEST_F(ProbeBakeScene, CtrlCEndsABakeWithADepfileAtAnyTime) {
    writeScene("scene.toml", "box.pf_vox", kGrid);
    const std::vector<std::string> arguments =
        tiny({"scene.toml", "-o", "out.pf_probe", "--depfile", "out.d"});
    ASSERT_EQ(run(arguments).exitCode, 0);
    std::vector<std::string> command{PFVOX_PROBE_BAKE};
    command.insert(command.end(), arguments.begin(), arguments.end());
    for (const int delayMs : {20, 40, 60, 80, 120, 160, 240}) {
        Process process(command, {.environment = {}, .input = {}, .folder = folder.path()});
        std::this_thread::sleep_for(std::chrono::milliseconds(delayMs));
        process.send(SIGINT);
        for (int i = 0; i < 200 && !process.hasEnded(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        const bool hangs = !process.hasEnded();
        process.send(SIGKILL);
        EXPECT_THAT(process.finish().exitCode, ::testing::AnyOf(0, 130)) << delayMs << " ms";
        ASSERT_FALSE(hangs) << delayMs << " ms";
    }
}

TEST_F(StoppedBake, AKilledBakeResumesToTheSameBytes) {
    EXPECT_NE(stopBy(SIGKILL).exitCode, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pf_probe"));
    const ProcessResult resumed = resume();
    ASSERT_EQ(resumed.exitCode, 0) << resumed.err;
    EXPECT_GT(json::parse(resumed.out)["reused"], 0);
    expectWholeBake();
}

TEST_F(StoppedBake, OfADamagedJournalOnlyWhatIsWholeIsTaken) {
    EXPECT_NE(stopBy(SIGKILL).exitCode, 0);
    std::string bytes = readText(journal());
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x40);
    writeText(journal(), bytes);
    const ProcessResult resumed = resume();
    ASSERT_EQ(resumed.exitCode, 0) << resumed.err;
    EXPECT_THAT(resumed.err, HasSubstr("journal"));
    expectWholeBake();
}

TEST_F(StoppedBake, AForeignJournalIsNotTaken) {
    writeScene("scene.toml", "box.pf_vox", kGrid);
    writeText(journal(), "these are not probes, and nobody said they were; " + std::string(4096, 'x'));
    const ProcessResult resumed = resume();
    ASSERT_EQ(resumed.exitCode, 0) << resumed.err;
    EXPECT_THAT(resumed.err, HasSubstr("journal"));
    EXPECT_EQ(json::parse(resumed.out)["reused"], 0);
}

TEST_F(ProbeBakeScene, AFullDiskLosesNothing) {
    writeScene("scene.toml", "box.pf_vox", kGrid);
    ASSERT_EQ(run(tiny({"scene.toml", "-o", "out.pf_probe"})).exitCode, 0);
    const std::string before = readText(folder / "out.pf_probe");
    // No file may grow beyond 8 blocks of 512 bytes; the write fails as it does on a full disk.
    const std::string command = "ulimit -f 8; exec " PFVOX_PROBE_BAKE
                                " scene.toml -o out.pf_probe --resolution 64,32,4,6 --samples 32";
    const ProcessSetup setup{.environment = {}, .input = {}, .folder = folder.path()};
    const ProcessResult full = Process({"/bin/sh", "-c", command}, setup).finish();
    EXPECT_EQ(full.exitCode, 3) << full.err;
    EXPECT_THAT(full.err, HasSubstr("out.pf_probe"));
    EXPECT_EQ(readText(folder / "out.pf_probe"), before);
}

TEST_F(ProbeBakeScene, AReadOnlyOutputIsRefusedBeforeTheBake) {
    writeScene("scene.toml", "box.pf_vox", kGrid);
    writeText(folder / "out.pf_probe", "somebody protects this");
    std::filesystem::permissions(folder / "out.pf_probe", std::filesystem::perms(0444));
    const ProcessResult refused = run(tiny({"scene.toml", "-o", "out.pf_probe"}));
    EXPECT_EQ(refused.exitCode, 3);
    EXPECT_THAT(refused.err, HasSubstr("--force"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pf_probe.journal"));
    EXPECT_EQ(run(tiny({"scene.toml", "-o", "out.pf_probe", "--force"})).exitCode, 0);
}

TEST_F(ProbeBakeScene, OutputsMayHaveTheLongestNames) {
    writeScene("scene.toml", "box.pf_vox", kGrid);
    const std::string output = std::string(246, 'x') + ".pf_probe";  // its journal's name would be too long
    EXPECT_EQ(run(tiny({"scene.toml", "-o", output})).exitCode, 0);
    EXPECT_TRUE(std::filesystem::exists(folder / output));
}

TEST_F(ProbeBakeScene, TooLittleDeviceMemoryIsNamed) {
    writeScene("scene.toml", "box.pf_vox", kGrid);
    const ProcessResult scarce =
        run({"scene.toml", "-o", "out.pf_probe", "--profile", "thesis", "--device-memory", "64"});
    EXPECT_EQ(scarce.exitCode, 6);
    EXPECT_THAT(scarce.err, HasSubstr("MiB of device memory"));
    EXPECT_THAT(scarce.err, HasSubstr("--profile"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pf_probe"));
    EXPECT_EQ(run(tiny({"scene.toml", "-o", "out.pf_probe", "--device-memory", "256"})).exitCode, 0);
}

TEST_F(ProbeBakeScene, MistakesAreNamed) {
    writeScene("missing.toml", "absent.pf_vox", kGrid);
    const ProcessResult missing = run(tiny({"missing.toml", "-o", "out.pf_probe"}));
    EXPECT_EQ(missing.exitCode, 3);
    EXPECT_THAT(missing.err, HasSubstr("absent.pf_vox"));

    std::filesystem::copy_file(std::filesystem::path(PFVOX_DATA_DIR) / "lamp.vox", folder / "lamp.vox");
    writeScene("source.toml", "lamp.vox", kGrid);
    const ProcessResult source = run(tiny({"source.toml", "-o", "out.pf_probe"}));
    EXPECT_EQ(source.exitCode, 4);
    EXPECT_THAT(source.err, HasSubstr("vox2pf"));

    writeScene("outside.toml", "box.pf_vox",
               "probeGridPos = [50, 0, 0]\nprobeGridStep = 1\nprobeGridCount = [2, 2, 2]\n");
    const ProcessResult outside = run(tiny({"outside.toml", "-o", "out.pf_probe"}));
    EXPECT_EQ(outside.exitCode, 4);
    EXPECT_THAT(outside.err, HasSubstr("outside the scene"));

    writeScene("zero.toml", "box.pf_vox", "probeGridCount = [0, 2, 2]\n");
    const ProcessResult zero = run(tiny({"zero.toml", "-o", "out.pf_probe"}));
    EXPECT_EQ(zero.exitCode, 4);
    EXPECT_THAT(zero.err, HasSubstr("probeGridCount"));

    writeScene("scene.toml", "box.pf_vox", kGrid);
    EXPECT_EQ(run(tiny({"scene.toml", "-o", "out.pf_probe", "--device", "no such device"})).exitCode, 6);
    EXPECT_EQ(run(tiny({"scene.toml", "-o", "box.pf_vox/out.pf_probe"})).exitCode, 3);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pf_probe"));
    EXPECT_EQ(run({"bake", "--list-devices"}).exitCode, 0);
}

TEST_F(ProbeBakeScene, VerifyLooksThroughTheCameras) {
    writeScene("scene.toml", "box.pf_vox",
               std::string(kGrid) +
                   "[[cameras]]\nname = \"front\"\nposition = [0.6, 1.2, 3]\ntarget = [0.6, 0.3, 0.6]\n");
    ASSERT_EQ(run(tiny({"scene.toml", "-o", "out.pf_probe"})).exitCode, 0);
    const auto verify = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"verify", "scene.toml", "out.pf_probe", "--size", "48x32"});
        return run(std::move(options));
    };
    const ProcessResult result =
        verify({"--json", "--samples", "16", "--max-samples", "16", "-o", "pictures"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const json score = json::parse(result.out);
    expectSchema("verify", score);
    EXPECT_GT(score["surfacePixels"], 100);
    EXPECT_EQ(score["withoutValue"], 0);
    EXPECT_LE(score["all"]["relativeTrimmedRmse"], score["all"]["relativeRmse"]);
    EXPECT_EQ(score["reference"]["samples"], 16);
    for (const char* name : {"front-probes.png", "front-reference.png", "front-flip.png", "front-tiers.png"})
        EXPECT_TRUE(std::filesystem::exists(folder / "pictures" / name)) << name;
    EXPECT_EQ(verify({"--samples", "2", "--max-samples", "2", "--max-flip", "0"}).exitCode, 1);
    EXPECT_EQ(verify({"--camera", "absent"}).exitCode, 4);
    EXPECT_EQ(run({"verify", "scene.toml", "out.pf_probe", "--size", "48"}).exitCode, 2);
    EXPECT_EQ(verify({"--reference-noise", "-1"}).exitCode, 2);
    EXPECT_EQ(verify({"--max-samples", "1"}).exitCode, 2);
}

/// A reference that is too noisy for what it judges gets more paths, and where it may not, the figures say
/// so.
TEST_F(ProbeBakeScene, VerifyGoesOnUntilTheReferenceIsGoodEnough) {
    writeScene("scene.toml", "box.pf_vox",
               std::string(kGrid) +
                   "[[cameras]]\nname = \"front\"\nposition = [0.6, 1.2, 3]\ntarget = [0.6, 0.3, 0.6]\n");
    ASSERT_EQ(run(tiny({"scene.toml", "-o", "out.pf_probe"})).exitCode, 0);
    const auto verify = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"verify", "scene.toml", "out.pf_probe", "--size", "48x32"});
        return run(std::move(options));
    };
    const auto scoreOf = [&](std::vector<std::string> options) {
        options.insert(options.end(), {"--json"});
        const ProcessResult result = verify(std::move(options));
        EXPECT_EQ(result.exitCode, 0) << result.err;
        const json score = json::parse(result.out);
        expectSchema("verify", score);
        return score;
    };
    // No noise at all cannot be reached.
    const json capped = scoreOf({"--samples", "4", "--reference-noise", "0"});
    EXPECT_EQ(capped["reference"]["samples"], 64);
    EXPECT_EQ(capped["reference"]["isCertain"], false);
    EXPECT_THAT(capped["reference"]["message"].get<std::string>(),
                HasSubstr("figures are uncertain; raise --max-samples"));
    EXPECT_THAT(verify({"--samples", "4", "--reference-noise", "0"}).out,
                HasSubstr("front: reference noise"));
    const json reached = scoreOf({"--samples", "2", "--max-samples", "4096"});
    EXPECT_EQ(reached["reference"]["isCertain"], true);
    EXPECT_GT(reached["reference"]["samples"], 2);
    EXPECT_LE(reached["all"]["relativeNoise"], 0.33 * reached["all"]["relativeError"].get<double>());

    // What is kept is taken on from where it ended, and one with more paths serves as it is.
    const std::vector<std::string> few{"--samples", "16", "--max-samples", "16", "--references", "kept"};
    const std::vector<std::string> more{"--samples", "64", "--max-samples", "64", "--references", "kept"};
    EXPECT_EQ(scoreOf(few)["reference"]["samples"], 16);
    EXPECT_EQ(scoreOf(more)["all"], capped["all"]);
    EXPECT_EQ(scoreOf(few)["all"], capped["all"]);
    EXPECT_EQ(readTree(folder / "kept").size(), 1u);
    for (const auto& [name, bytes] : readTree(folder / "kept"))
        writeText(folder / "kept" / name, "damaged" + bytes);
    EXPECT_EQ(scoreOf(more)["all"], capped["all"]);
}

}  // namespace
}  // namespace pfvox::test

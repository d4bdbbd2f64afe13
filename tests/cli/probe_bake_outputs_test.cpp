// What probe-bake does with outputs: damaged ones, names of pictures, figures that are not known.

#include "cli/probe_bake_fixture.hpp"

namespace pfvox::test {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

namespace {

class ProbeBakeOutputs : public ProbeBakeScene {
  protected:
    void SetUp() override {
        ProbeBakeScene::SetUp();
        writeScene("scene.toml", "box.pf_vox", kGrid);
    }
    ProcessResult bake(std::vector<std::string> options = {}) const {
        options.insert(options.begin(), {"scene.toml", "-o", "out.pf_probe"});
        return run(tiny(std::move(options)));
    }
    json bakeJson(std::vector<std::string> options = {}) const {
        options.emplace_back("--json");
        const ProcessResult result = bake(std::move(options));
        EXPECT_EQ(result.exitCode, 0) << result.err;
        json object = json::parse(result.out);
        expectSchema("bake", object);
        return object;
    }
};

}  // namespace

// One flipped bit was "up to date", and so no build ever repaired it.
TEST_F(ProbeBakeOutputs, AFlippedBitIsBakedAgain) {
    ASSERT_EQ(bake().exitCode, 0);
    const std::string good = readText(folder / "out.pf_probe");
    for (const std::size_t at : {good.size() * 3 / 4, good.size() / 2, std::size_t{70}}) {
        std::string bad = good;
        bad[at] = static_cast<char>(bad[at] ^ 16);
        writeText(folder / "out.pf_probe", bad);
        ASSERT_EQ(run({"validate", "out.pf_probe"}).exitCode, 4) << at;
        EXPECT_THAT(bakeJson({"--dry-run"})["reason"].get<std::string>(), HasSubstr("was damaged")) << at;
        const ProcessResult again = bake({"-v"});
        EXPECT_EQ(again.exitCode, 0) << again.err;
        EXPECT_THAT(again.err, HasSubstr("output-damaged")) << at;
        EXPECT_THAT(again.out, HasSubstr("the existing output was damaged")) << at;
        EXPECT_TRUE(readText(folder / "out.pf_probe") == good) << at;
    }
    EXPECT_THAT(bake().out, HasSubstr("is up to date"));
}

TEST_F(ProbeBakeOutputs, JsonHasTheFiguresOfTheOutputAndNullForWhatIsUnknown) {
    const std::vector<const char*> ofWork{"reused",       "geometry",      "light",        "totalMs",
                                          "emitterFaces", "stepLimitRays", "surfaceCells", "uncoveredCells"};
    const json planned = bakeJson({"--dry-run"});
    EXPECT_EQ(planned["probes"], 18);
    for (const char* key : ofWork) EXPECT_TRUE(planned[key].is_null()) << key;
    for (const char* key : {"active", "relocated", "inactive", "fileBytes"})
        EXPECT_TRUE(planned[key].is_null()) << key;
    const json baked = bakeJson();
    for (const char* key : ofWork) EXPECT_FALSE(baked[key].is_null()) << key;
    const json upToDate = bakeJson();
    EXPECT_EQ(upToDate["status"], "up-to-date");
    for (const char* key : ofWork) EXPECT_TRUE(upToDate[key].is_null()) << key;
    for (const char* key : {"probes", "active", "relocated", "inactive", "fileBytes", "device", "contentKey"})
        EXPECT_EQ(upToDate[key], baked[key]) << key;
}

// Pictures of cameras whose names differ in Chinese characters overwrote each other.
TEST_F(ProbeBakeOutputs, EveryCameraHasPicturesOfItsOwn) {
    std::string cameras = kGrid;
    int x = 2;
    for (const char* name : {"房间", "厨房", "hall, east", "hall  east"})
        cameras += "[[cameras]]\nname = \"" + std::string(name) + "\"\nposition = [" + std::to_string(x++) +
                   ".0, 1.2, 3.0]\ntarget = [0.6, 0.3, 0.6]\n";
    writeScene("scene.toml", "box.pf_vox", cameras);
    ASSERT_EQ(bake().exitCode, 0);
    const auto verify = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"verify", "scene.toml", "out.pf_probe", "--size", "16x16",
                                         "--samples", "2", "--max-samples", "2"});
        const ProcessResult result = run(std::move(options));
        EXPECT_EQ(result.exitCode, 0) << result.err;
    };
    verify({"-o", "all", "--references", "kept"});
    const auto all = readTree(folder / "all");
    EXPECT_EQ(all.size(), 16u);
    EXPECT_EQ(readTree(folder / "kept").size(), 4u);
    EXPECT_TRUE(all.contains("房间-probes.png"));
    // The same names when only some are looked at, and a comma in the name.
    verify({"-o", "one", "--camera", "hall  east"});
    for (const auto& [name, bytes] : readTree(folder / "one")) {
        ASSERT_TRUE(all.contains(name)) << name;
        EXPECT_TRUE(all.at(name) == bytes) << name;
    }
    verify({"-o", "other", "--camera", "hall, east"});
    EXPECT_EQ(readTree(folder / "other").size(), 4u);
}

TEST_F(ProbeBakeOutputs, StandardOutputIsNoOutput) {
    const auto refused = [&](std::vector<std::string> arguments) {
        const ProcessResult result = run(std::move(arguments));
        EXPECT_EQ(result.exitCode, 2);
        EXPECT_THAT(result.err, HasSubstr("./-"));
    };
    refused({"scene.toml", "-o", "-"});
    refused({"scene.toml", "-o", "a.pf_probe", "--depfile", "-"});
    refused({"merge", "a.pf_probe", "-o", "-"});
    refused({"verify", "scene.toml", "a.pf_probe", "-o", "-"});
    EXPECT_FALSE(std::filesystem::exists(folder / "-"));
}

}  // namespace pfvox::test

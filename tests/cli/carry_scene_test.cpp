// Scenes that vox2pf convert carries over: paths turned, everything else byte for byte, reported like an
// asset.

#include <nlohmann/json.hpp>

#include "cli/vox2pf_fixture.hpp"
#include "support/json_schema.hpp"

namespace pfvox::test {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class Vox2pfScene : public Vox2pf {
  protected:
    void addScene(const std::filesystem::path& name, const std::string& text) const {
        writeText(folder / name, text);
    }
    static std::string modelAt(const std::string& path) { return "[[models]]\npath = \"" + path + "\"\n"; }
};

TEST_F(Vox2pfScene, PathsAreTurnedAndNothingElseChanges) {
    addSource("in/lamp.vox");
    addSource("in/props/old tree.vox", "tree.vox");
    addScene("in/levels/scene.toml",
             "# The user's own words \xc3\xa4, path = \"x.vox\"\r\n[[models]]\t# lamp\r\n  path   = "
             "'../lamp.vox' # keep\r\n"
             "visible=true\n\n[[models]]\npath = \"../props/old tree.vox\"\nmyTool = {a=1}\n");
    const ProcessResult result = run({"in", "-o", "out"});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_THAT(filesBelow("out"), ElementsAre("lamp.pf_vox", "levels/scene.toml", "props/old tree.pf_vox"));
    EXPECT_EQ(readText(folder / "out/levels/scene.toml"),
              "# The user's own words \xc3\xa4, path = \"x.vox\"\r\n[[models]]\t# lamp\r\n  path   = "
              "'../lamp.pf_vox' # keep\r\n"
              "visible=true\n\n[[models]]\npath = \"../props/old tree.pf_vox\"\nmyTool = {a=1}\n");
    EXPECT_THAT(result.err, AllOf(HasSubstr("unknown key myTool"), HasSubstr("line 8, column 1")));
}

TEST_F(Vox2pfScene, NamesTellScenesFromSettings) {
    addSource("in/lamp.vox");
    addScene("in/night.scene.toml", modelAt("lamp.vox"));
    addScene("in/pfvox.toml", "[build]\nlod = true\n");
    addScene("in/myscene.toml", modelAt("lamp.vox"));
    EXPECT_EQ(run({"in", "-o", "out"}).exitCode, 0);
    EXPECT_THAT(filesBelow("out"), ElementsAre("lamp.pf_vox", "night.scene.toml"));
}

TEST_F(Vox2pfScene, ANamedTomlFileIsAScene) {
    addSource("lamp.vox");
    addScene("level1.toml", modelAt("lamp.vox"));
    EXPECT_EQ(run({"level1.toml", "lamp.vox", "-o", "out"}).exitCode, 0);
    EXPECT_THAT(readText(folder / "out/level1.toml"), HasSubstr("\"lamp.pf_vox\""));
    EXPECT_EQ(run({"level1.toml", "-o", "level1.pf_vox"}).exitCode, 2) << "it keeps its name";
    EXPECT_EQ(run({"level1.toml", "-o", "."}).exitCode, 2) << "it would overwrite itself";
}

TEST_F(Vox2pfScene, PathsThatNameTheOutputsAreRight) {
    addSource("in/lamp.vox");
    addScene("in/a.scene.toml", modelAt("lamp.pf_vox"));              // as it will stand beside the scene
    addScene("in/b.scene.toml", modelAt("../deep/out/lamp.pf_vox"));  // where this run writes it
    const ProcessResult result = run({"in", "-o", "deep/out"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.err, Not(HasSubstr("scene-")));
    EXPECT_EQ(readText(folder / "deep/out/a.scene.toml"), modelAt("lamp.pf_vox"));
    EXPECT_EQ(readText(folder / "deep/out/b.scene.toml"), modelAt("lamp.pf_vox"));
}

TEST_F(Vox2pfScene, BuiltFilesElsewhereAreStillFound) {
    addSource("lamp.vox");
    ASSERT_EQ(run({"lamp.vox", "-o", "built/lamp.pf_vox"}).exitCode, 0);
    addScene("in/scene.toml",
             modelAt("../built/lamp.pf_vox") + modelAt((folder / "built/lamp.pf_vox").string()));
    const ProcessResult result = run({"in", "-o", "far/away/out"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.err, Not(HasSubstr("scene-")));
    EXPECT_EQ(readText(folder / "far/away/out/scene.toml"),
              modelAt("../../../built/lamp.pf_vox") + modelAt((folder / "built/lamp.pf_vox").string()));
}

TEST_F(Vox2pfScene, PathsToNothingAndToSourcesOutsideAreWarnedAbout) {
    addSource("outside/lamp.vox");
    addScene("in/scene.toml", modelAt("gone.vox") + modelAt("../outside/lamp.vox"));
    const ProcessResult result = run({"in", "-o", "out"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.err, AllOf(HasSubstr("in/scene.toml: line 2, column 8: gone.vox does not exist"),
                                  HasSubstr("[scene-missing-model]"),
                                  HasSubstr("line 4, column 8: ../outside/lamp.vox is no input of this run"),
                                  HasSubstr("[scene-model-not-converted]")));
    EXPECT_EQ(readText(folder / "out/scene.toml"), modelAt("gone.vox") + modelAt("../outside/lamp.pf_vox"));
    EXPECT_EQ(run({"in", "-o", "strict", "--warnings-as-errors"}).exitCode, 4);
    EXPECT_FALSE(exists("strict/scene.toml"));
}

TEST_F(Vox2pfScene, ASceneAloneFindsWhatAnEarlierRunConverted) {
    addSource("in/props/lamp.vox");
    addScene("in/levels/one.toml", modelAt("../props/lamp.vox"));
    ASSERT_EQ(run({"--base-dir", "in", "in/props/lamp.vox", "-o", "out"}).exitCode, 0);
    const ProcessResult result = run({"--base-dir", "in", "in/levels/one.toml", "-o", "out"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.err, Not(HasSubstr("scene-")));
    EXPECT_EQ(readText(folder / "out/levels/one.toml"), modelAt("../props/lamp.pf_vox"));
}

TEST_F(Vox2pfScene, ABrokenSceneIsAFailedAssetWithItsPlace) {
    addSource("in/lamp.vox");
    addScene("in/scene.toml", modelAt("lamp.vox") + "scaleVec = [0, 1, 1]\n");
    addScene("out/scene.toml", "before");
    const ProcessResult result = run({"in", "-o", "out"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.err, AllOf(HasSubstr("in/scene.toml: line 3, column 12: "), HasSubstr("[bad-value]")));
    EXPECT_TRUE(exists("out/lamp.pf_vox"));
    EXPECT_EQ(readText(folder / "out/scene.toml"), "before");
}

TEST_F(Vox2pfScene, UpToDateMeansTheBytes) {
    addSource("in/lamp.vox");
    addScene("in/scene.toml", modelAt("lamp.vox"));
    const auto lineAbout = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"in", "-o", "out", "--explain"});
        for (const std::string& line : linesOf(run(options).out)) {
            if (line.find("scene.toml") != std::string::npos) return line;
        }
        return std::string();
    };
    EXPECT_THAT(lineAbout({"--dry-run"}),
                AllOf(HasSubstr("would convert"), HasSubstr("there was no output")));
    EXPECT_FALSE(exists("out"));
    EXPECT_THAT(lineAbout({}), AllOf(HasSubstr("converted"), HasSubstr("scene of 1 model")));
    EXPECT_THAT(lineAbout({}), AllOf(HasSubstr("up to date"), HasSubstr("holds these bytes")));
    EXPECT_THAT(run({"in", "-o", "out"}).out, HasSubstr("all 2 files are up to date"));
    EXPECT_THAT(lineAbout({"--force"}), HasSubstr("converted"));
    EXPECT_THAT(lineAbout({"--force", "--if-changed"}), HasSubstr("up to date"));
    addScene("in/scene.toml", "# edited\n" + modelAt("lamp.vox"));
    EXPECT_THAT(lineAbout({"--no-clobber"}), HasSubstr("kept"));
    EXPECT_THAT(lineAbout({}), AllOf(HasSubstr("converted"), HasSubstr("changed")));
    EXPECT_EQ(readText(folder / "out/scene.toml"), "# edited\n" + modelAt("lamp.pf_vox"));
}

TEST_F(Vox2pfScene, JsonSummaryAndDepfileCountIt) {
    addSource("in/lamp.vox");
    addScene("in/scene.toml", modelAt("lamp.vox") + modelAt("lamp.vox"));
    writeText(folder / "s.toml", "[build]\nlod = true\n");
    const ProcessResult result =
        run({"in", "-o", "out", "--json", "--depfile", "d.d", "--settings", "s.toml"});
    EXPECT_EQ(result.exitCode, 0);
    const auto schema = nlohmann::json::parse(
        readText(std::filesystem::path(PFVOX_DOCS_DIR) / "schema" / "convert.schema.json"));
    std::vector<std::string> kinds;
    for (const std::string& line : linesOf(result.out)) {
        const auto json = nlohmann::json::parse(line);
        EXPECT_THAT(SchemaChecker::check(schema, json), IsEmpty()) << line;
        kinds.push_back(json["kind"]);
        if (json["kind"] == "scene") {
            EXPECT_EQ(json["output"], "out/scene.toml");
            EXPECT_EQ(json["models"], 2);
            EXPECT_EQ(json["outputBytes"], std::filesystem::file_size(folder / "out/scene.toml"));
        }
    }
    EXPECT_THAT(kinds, ElementsAre("asset", "scene"));
    EXPECT_THAT(linesOf(readText(folder / "d.d")),
                ElementsAre("out/lamp.pf_vox: in/lamp.vox s.toml", "out/scene.toml: in/scene.toml"));
}

TEST_F(Vox2pfScene, ConvertingAFolderIntoItselfLeavesItsScenesAlone) {
    addSource("in/lamp.vox");
    addScene("in/scene.toml", modelAt("lamp.vox"));
    EXPECT_EQ(run({"in", "-o", "in"}).exitCode, 0);
    EXPECT_EQ(readText(folder / "in/scene.toml"), modelAt("lamp.vox"));
}

TEST_F(Vox2pfScene, BytesDependNeitherOnThreadsNorOnTheFolder) {
    addSource("in/lamp.vox");
    addSource("in/sub/tree.vox", "tree.vox");
    addScene("in/sub/scene.toml", modelAt("../lamp.vox") + modelAt("tree.vox"));
    EXPECT_EQ(run({"in", "-o", "one", "-j", "1"}).exitCode, 0);
    EXPECT_EQ(run({(folder / "in").string(), "-o", "deep/er/eight", "-j", "8"}).exitCode, 0);
    EXPECT_EQ(readTree(folder / "one"), readTree(folder / "deep/er/eight"));
}

}  // namespace pfvox::test

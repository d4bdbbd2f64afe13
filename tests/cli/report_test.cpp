// JSON against its schemas, and vox2pf info and validate.

#include <nlohmann/json.hpp>

#include "cli/vox2pf_fixture.hpp"
#include "support/json_schema.hpp"

namespace pfvox::test {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

namespace {

nlohmann::json schema(const std::string& name) {
    return nlohmann::json::parse(
        readText(std::filesystem::path(PFVOX_DOCS_DIR) / "schema" / (name + ".schema.json")));
}

}  // namespace

TEST_F(Vox2pf, convertWritesOneJsonLineAnAssetInOrder) {
    addSource("in/a.vox");
    addBrokenSource("in/b.vox");
    addSource("in/c.vox", "statue.vox");
    const ProcessResult result = run({"in", "-o", "out", "--json"});
    EXPECT_EQ(result.exitCode, 1);
    const auto lines = linesOf(result.out);
    ASSERT_EQ(lines.size(), 3u);
    std::vector<std::string> states;
    for (const std::string& line : lines) {
        const auto json = nlohmann::json::parse(line);
        EXPECT_THAT(SchemaChecker::check(schema("convert"), json), IsEmpty()) << line;
        states.push_back(json["status"]);
    }
    EXPECT_THAT(states, ::testing::ElementsAre("converted", "failed", "converted"));
}

TEST_F(Vox2pf, infoTellsWhatIsInTheCourtyard) {
    addSource("courtyard.vox", "courtyard.vox");
    ASSERT_EQ(run({"courtyard.vox", "-o", "courtyard.pf_vox"}).exitCode, 0);
    const ProcessResult result = run({"info", "courtyard.pf_vox"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.out, AllOf(HasSubstr("Models (15)"), HasSubstr("mirrored"), HasSubstr("emit"),
                                  HasSubstr("glass"), HasSubstr("MATL"), HasSubstr("bytes/voxel")));
    const ProcessResult json = run({"info", "--json", "courtyard.pf_vox"});
    const auto object = nlohmann::json::parse(json.out);
    EXPECT_THAT(SchemaChecker::check(schema("info"), object), IsEmpty());
    EXPECT_EQ(object["totals"]["models"], 15);
}

TEST_F(Vox2pf, infoOnASourceNamesTheCommandToRun) {
    addSource("lamp.vox");
    const ProcessResult result = run({"info", "lamp.vox"});
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_THAT(result.err, HasSubstr("vox2pf lamp.vox -o lamp.pf_vox"));
}

TEST_F(Vox2pf, validateAcceptsWhatConvertWrites) {
    addSource("courtyard.vox", "courtyard.vox");
    ASSERT_EQ(run({"courtyard.vox", "-o", "out/courtyard.pf_vox"}).exitCode, 0);
    const ProcessResult result = run({"validate", "out"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.out, HasSubstr("courtyard.pf_vox: valid"));
}

TEST_F(Vox2pf, validateNamesWhatIsWrongAndGivesFour) {
    addSource("lamp.vox");
    ASSERT_EQ(run({"lamp.vox", "-o", "lamp.pf_vox"}).exitCode, 0);
    std::string bytes = readText(folder / "lamp.pf_vox");
    bytes.back() = static_cast<char>(bytes.back() ^ 0x55);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
    writeText(folder / "lamp.pf_vox", bytes);
    const ProcessResult result = run({"validate", "lamp.pf_vox"});
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_THAT(result.out, HasSubstr("finding"));
    const ProcessResult json = run({"validate", "--json", "lamp.pf_vox"});
    EXPECT_EQ(json.exitCode, 4);
    const auto object = nlohmann::json::parse(json.out);
    EXPECT_THAT(SchemaChecker::check(schema("validate"), object), IsEmpty());
    EXPECT_EQ(object["valid"], false);
    EXPECT_FALSE(object["findings"].empty());
}

TEST_F(Vox2pf, aFileThatCannotBeReadHasAnObjectToo) {
    for (const std::string command : {"info", "validate"}) {
        EXPECT_EQ(run({command, "none.pf_vox"}).exitCode, 3);
        const ProcessResult result = run({command, "--json", "none.pf_vox"});
        EXPECT_EQ(result.exitCode, 3);
        ASSERT_EQ(linesOf(result.out).size(), 1u) << command;
        const auto object = nlohmann::json::parse(result.out);
        EXPECT_THAT(SchemaChecker::check(schema("read-failure"), object), IsEmpty());
        EXPECT_EQ(object["file"], "none.pf_vox");
        EXPECT_EQ(object["error"]["code"], "file-not-found");
    }
}

TEST(DemoData, generatorReproducesTheCommittedBytes) {
    const TempFolder folder;
    ASSERT_EQ(runProcess({PFVOX_MAKE_DEMO_DATA, folder.path().string()}).exitCode, 0);
    const auto made = readTree(folder.path());
    EXPECT_EQ(made.size(), 6u);
    for (const auto& [name, bytes] : made) {
        EXPECT_TRUE(bytes == readText(std::filesystem::path(PFVOX_DATA_DIR) / name))
            << name << " differs: run pfvox-make-demo-data data and commit";
    }
}

TEST(DemoData, generatorReproducesTheAssetsOfTheExample) {
    const TempFolder folder;
    ASSERT_EQ(runProcess({PFVOX_MAKE_DEMO_DATA, "--example", folder.path().string()}).exitCode, 0);
    const auto made = readTree(folder.path());
    EXPECT_EQ(made.size(), 5u);
    const auto assets = std::filesystem::path(PFVOX_DATA_DIR).parent_path() / "examples/game-assets/assets";
    for (const auto& [name, bytes] : made) {
        EXPECT_TRUE(bytes == readText(assets / name))
            << name << " differs: run pfvox-make-demo-data --example " << assets << " and commit";
    }
}

}  // namespace pfvox::test

// vox2pf export: back to .vox and .vdb, from the command line.
#include <nlohmann/json.hpp>

#include "cli/vox2pf_fixture.hpp"
#include "support/json_schema.hpp"

namespace pfvox::test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

class Vox2pfExport : public Vox2pf {
  protected:
    void SetUp() override {
        addSource("courtyard.vox", "courtyard.vox");
        ASSERT_EQ(run({"courtyard.vox", "-o", "courtyard.pf_vox"}).exitCode, 0);
    }
};

}  // namespace

TEST_F(Vox2pfExport, vdbComesBackAsTheSameModel) {
    const ProcessResult result = run({"export", "courtyard.pf_vox", "-o", "courtyard.vdb"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("courtyard.vdb"));
    ASSERT_EQ(run({"courtyard.vdb", "-o", "again.pf_vox"}).exitCode, 0);
    ASSERT_EQ(run({"export", "again.pf_vox", "-o", "again.vdb"}).exitCode, 0);
    EXPECT_EQ(readText(folder / "again.vdb"), readText(folder / "courtyard.vdb"));
    ASSERT_EQ(run({"export", "again.pf_vox", "-o", "again.vox"}).exitCode, 0);
    EXPECT_EQ(readText(folder / "again.vox").substr(0, 4), "VOX ");
}

TEST_F(Vox2pfExport, aFolderTakesEitherFormat) {
    ASSERT_EQ(run({"export", "courtyard.pf_vox", "-o", "back"}).exitCode, 0);
    ASSERT_EQ(run({"export", "courtyard.pf_vox", "--format", "vdb", "-o", "back"}).exitCode, 0);
    EXPECT_THAT(filesBelow("back"), ElementsAre("courtyard.vdb", "courtyard.vox"));
}

// Names that were equal in different folders failed, after the first had been written.
TEST_F(Vox2pfExport, aFolderKeepsItsTree) {
    for (const char* name : {"in/a/hall.pf_vox", "in/b/hall.pf_vox", "in/hall.pf_vox"}) {
        std::filesystem::create_directories((folder / name).parent_path());
        std::filesystem::copy_file(folder / "courtyard.pf_vox", folder / name);
    }
    const ProcessResult result = run({"export", "in", "-o", "back"});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_THAT(filesBelow("back"), ElementsAre("a/hall.vox", "b/hall.vox", "hall.vox"));
}

TEST_F(Vox2pfExport, twoInputsOfOneOutputFailBeforeAnythingIsWritten) {
    for (const char* name : {"a/hall.pf_vox", "b/hall.pf_vox"}) {
        std::filesystem::create_directories((folder / name).parent_path());
        std::filesystem::copy_file(folder / "courtyard.pf_vox", folder / name);
    }
    const ProcessResult result =
        run({"export", "a/hall.pf_vox", "b/hall.pf_vox", "courtyard.pf_vox", "-o", "back", "--json"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.err, HasSubstr("a/hall.pf_vox would become back/hall.vox, too"));
    EXPECT_THAT(filesBelow("back"), ElementsAre("courtyard.vox"));
    const auto lines = linesOf(result.out);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(nlohmann::json::parse(lines[1])["error"]["code"], "file-not-writable");
    const auto object = nlohmann::json::parse(lines[2]);
    const auto schema =
        nlohmann::json::parse(readText(std::filesystem::path(PFVOX_DOCS_DIR) / "schema/export.schema.json"));
    EXPECT_THAT(SchemaChecker::check(schema, object), ::testing::IsEmpty());
    EXPECT_EQ(object["outputBytes"], readText(folder / "back/courtyard.vox").size());
}

TEST_F(Vox2pfExport, contradictionsAreWrongUsage) {
    const ProcessResult result = run({"export", "courtyard.pf_vox", "--format", "vox", "-o", "a.vdb"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.err, HasSubstr("--format vox"));
    EXPECT_EQ(run({"export", "courtyard.pf_vox", "--format", "obj", "-o", "back"}).exitCode, 2);
    EXPECT_FALSE(exists("a.vdb") || exists("back"));
}

TEST_F(Vox2pfExport, aFileOfAnotherKindIsNoFolder) {
    const ProcessResult result = run({"export", "courtyard.pf_vox", "-o", "courtyard.obj"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.err, HasSubstr("-o courtyard.obj is neither a .vox or .vdb file nor a folder"));
    EXPECT_FALSE(exists("courtyard.obj"));
    EXPECT_EQ(run({"export", "courtyard.pf_vox", "-o", "courtyard.pf_vox"}).exitCode, 2);
    EXPECT_EQ(run({"export", "courtyard.pf_vox", "-o", "release.2/"}).exitCode, 0);
    EXPECT_EQ(run({"export", ".", "-o", "release.3"}).exitCode, 0);
    EXPECT_TRUE(exists("release.2/courtyard.vox") && exists("release.3/courtyard.vox"));
}

TEST_F(Vox2pfExport, aFailureLeavesThePreviousOutput) {
    writeText(folder / "a.vdb", "before");
    const ProcessResult result =
        run({"export", "courtyard.pf_vox", "-o", "a.vdb", "--limit", "maxMemoryBytes=64K"});
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_EQ(readText(folder / "a.vdb"), "before");
}

}  // namespace pfvox::test

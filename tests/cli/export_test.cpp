// vox2pf export: back to .vox and .vdb, from the command line.
#include "cli/vox2pf_fixture.hpp"

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

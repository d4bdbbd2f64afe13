// vox2pf convert: one file, folders, lists, failures; files that exist afterwards and that must not.

#include <fstream>

#include "cli/vox2pf_fixture.hpp"
#include "support/vox_writer.hpp"

#include <nlohmann/json.hpp>

namespace pfvox::test {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST_F(Vox2pf, convertsOneFileWithAndWithoutTheCommand) {
    addSource("lamp.vox");
    const ProcessResult result = run({"lamp.vox", "-o", "out/lamp.pf_vox"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.out, HasSubstr("converted lamp.vox -> out/lamp.pf_vox"));
    EXPECT_THAT(result.err, IsEmpty());
    EXPECT_EQ(run({"convert", "lamp.vox", "-o", "other.pf_vox"}).exitCode, 0);
    EXPECT_EQ(readText(folder / "out/lamp.pf_vox"), readText(folder / "other.pf_vox"));
    EXPECT_THAT(filesBelow("out"), ElementsAre("lamp.pf_vox")) << "no temporary file stays behind";
}

TEST_F(Vox2pf, baseDirGivesNamedFilesTheirPlaceOfTheFolder) {
    addSource("in/props/lamp.vox");
    addSource("in/tree.vox", "tree.vox");
    addSource("outside.vox");
    writeText(folder / "settings.toml", "[[override]]\nfiles = \"props/**\"\nimport.voxelSizeMetres = 0.5\n");
    const std::string base = (folder / "in").string();
    ASSERT_EQ(run({"in", "-o", "whole", "--settings", "settings.toml"}).exitCode, 0);
    for (const char* file : {"in/props/lamp.vox", "in/tree.vox"}) {
        const auto result = run({file, "--base-dir", base, "-o", "out", "--settings", "settings.toml"});
        EXPECT_EQ(result.exitCode, 0) << result.err;
    }
    EXPECT_EQ(readTree(folder / "out"), readTree(folder / "whole"));

    const ProcessResult refused = run({"outside.vox", "--base-dir", "in", "-o", "out"});
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_THAT(refused.err, HasSubstr("outside.vox is not below --base-dir in"));
}

TEST_F(Vox2pf, quietSaysNothingWhenAllIsWell) {
    addSource("lamp.vox");
    const ProcessResult result = run({"-q", "lamp.vox", "-o", "lamp.pf_vox"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_THAT(result.err, IsEmpty());
}

TEST_F(Vox2pf, missingFileGivesThree) {
    const ProcessResult result = run({"none.vox", "-o", "none.pf_vox"});
    EXPECT_EQ(result.exitCode, 3);
    EXPECT_THAT(result.err, AllOf(HasSubstr("none.vox"), HasSubstr("[file-not-found]")));
    EXPECT_FALSE(exists("none.pf_vox"));
}

TEST_F(Vox2pf, unwritableOutputGivesThree) {
    addSource("lamp.vox");
    writeText(folder / "wall", "a file, not a folder");
    const ProcessResult result = run({"lamp.vox", "-o", "wall/below/lamp.pf_vox"});
    EXPECT_EQ(result.exitCode, 3);
    EXPECT_THAT(result.err, HasSubstr("[file-not-writable]"));
    EXPECT_EQ(readText(folder / "wall"), "a file, not a folder");
}

TEST_F(Vox2pf, brokenFileGivesFourAndLeavesThePreviousOutput) {
    addBrokenSource("hall.vox");
    writeText(folder / "hall.pf_vox", "what was there before");
    const ProcessResult result = run({"hall.vox", "-o", "hall.pf_vox"});
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_THAT(result.err, AllOf(HasSubstr("hall.vox"), HasSubstr("@0x"))) << "file and place are named";
    EXPECT_EQ(readText(folder / "hall.pf_vox"), "what was there before");
}

TEST_F(Vox2pf, fileOfAnotherKindGivesFive) {
    writeText(folder / "pointer.vox", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n");
    const ProcessResult result = run({"pointer.vox", "-o", "pointer.pf_vox"});
    EXPECT_EQ(result.exitCode, 5);
    EXPECT_THAT(result.err, HasSubstr("Git LFS"));
}

TEST_F(Vox2pf, limitGivesFourAndNamesTheFigure) {
    addSource("lamp.vox");
    const ProcessResult result = run({"lamp.vox", "-o", "lamp.pf_vox", "--limit", "maxFileBytes=1K"});
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_THAT(result.err, AllOf(HasSubstr("maxFileBytes"), HasSubstr("[limit-exceeded]")));
}

TEST_F(Vox2pf, folderIsMirroredAndABadAssetStopsNobody) {
    addSource("in/lamp.vox");
    addSource("in/deep/er/statue.vox", "statue.vox");
    addBrokenSource("in/deep/broken.vox");
    writeText(folder / "in/readme.txt", "no source");
    const ProcessResult result = run({"in", "-o", "out"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(filesBelow("out"), ElementsAre("deep/er/statue.pf_vox", "lamp.pf_vox"));
    EXPECT_THAT(result.err, HasSubstr("in/deep/broken.vox"));
    EXPECT_THAT(result.out, AllOf(HasSubstr("converted"), HasSubstr("failed"))) << "the summary counts both";
}

TEST_F(Vox2pf, folderWithoutOneGoodAssetTellsByTheKindOfFailure) {
    addBrokenSource("in/a.vox");
    addBrokenSource("in/b.vox");
    EXPECT_EQ(run({"in", "-o", "out"}).exitCode, 4);
    EXPECT_FALSE(exists("out"));
}

TEST_F(Vox2pf, emptyFolderIsAnError) {
    std::filesystem::create_directory(folder / "in");
    const ProcessResult result = run({"in", "-o", "out"});
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_THAT(result.err, HasSubstr("[nothing-to-convert]"));
}

TEST_F(Vox2pf, failFastStartsNothingFurther) {
    addBrokenSource("in/a.vox");
    addSource("in/b.vox");
    addSource("in/c.vox");
    const ProcessResult result = run({"in", "-o", "out", "--fail-fast", "-j", "1"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(filesBelow("out"), IsEmpty());
    EXPECT_THAT(result.out, HasSubstr("not started"));
}

TEST_F(Vox2pf, outputFolderInsideTheInputIsNotSearched) {
    addSource("in/lamp.vox");
    addSource("in/out/old.vox");
    EXPECT_EQ(run({"in", "-o", "in/out"}).exitCode, 0);
    EXPECT_THAT(filesBelow("in/out"), ElementsAre("lamp.pf_vox", "old.vox"));
}

TEST_F(Vox2pf, listsNameInputs) {
    addSource("a.vox");
    addSource("sub folder/b.vox", "statue.vox");
    writeText(folder / "list.txt", "a.vox\n\nsub folder/b.vox\n");
    EXPECT_EQ(run({"@list.txt", "-o", "fromfile"}).exitCode, 0);
    EXPECT_THAT(filesBelow("fromfile"), ElementsAre("a.pf_vox", "b.pf_vox"));
    EXPECT_EQ(run({"-", "-o", "fromstdin/"}, {.environment = {}, .input = "a.vox\n", .folder = {}}).exitCode,
              0);
    EXPECT_THAT(filesBelow("fromstdin"), ElementsAre("a.pf_vox"));
    EXPECT_EQ(run({"@absent.txt", "-o", "x"}).exitCode, 3);
}

TEST_F(Vox2pf, namesWithSpacesAndUmlautsWork) {
    addSource("in/große Halle/Tür 1.vox");
    EXPECT_EQ(
        run({"in", "-o", "aus gabe"}, {.environment = {"LC_ALL=C"}, .input = {}, .folder = {}}).exitCode, 0);
    EXPECT_THAT(filesBelow("aus gabe"), ElementsAre("große Halle/Tür 1.pf_vox"));
}

TEST_F(Vox2pf, dryRunWritesNothing) {
    addSource("in/a.vox");
    addSource("in/b.vox", "statue.vox");
    const ProcessResult result = run({"in", "-o", "out", "--dry-run", "--explain", "--depfile", "d.d"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.out, AllOf(HasSubstr("would convert in/a.vox"), HasSubstr("there was no output")));
    EXPECT_FALSE(exists("out"));
    EXPECT_FALSE(exists("d.d"));
}

TEST_F(Vox2pf, noClobberKeepsWhatIsThere) {
    addSource("lamp.vox");
    writeText(folder / "lamp.pf_vox", "precious");
    const ProcessResult result = run({"lamp.vox", "-o", "lamp.pf_vox", "--no-clobber"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(readText(folder / "lamp.pf_vox"), "precious");
}

TEST_F(Vox2pf, bytesDependNeitherOnThreadsNorOnTheFolder) {
    for (const char* demo : {"courtyard.vox", "lamp.vox", "statue.vox", "tree.vox"}) addSource(demo, demo);
    std::filesystem::create_directory(folder / "elsewhere");
    EXPECT_EQ(run({".", "-o", "one", "-j", "1"}).exitCode, 0);
    EXPECT_EQ(run({".", "-o", "eight", "-j", "8"}).exitCode, 0);
    ProcessSetup elsewhere{.environment = {"LC_ALL=C.utf8"}, .input = {}, .folder = folder / "elsewhere"};
    EXPECT_EQ(run({"..", "-o", "../other"}, elsewhere).exitCode, 0);
    const auto reference = readTree(folder / "one");
    EXPECT_EQ(reference.size(), 4u);
    EXPECT_EQ(reference, readTree(folder / "eight"));
    EXPECT_EQ(reference, readTree(folder / "other"));
}

TEST_F(Vox2pf, archiveIsSmallerAndDiffersInContentKey) {
    addSource("courtyard.vox", "courtyard.vox");
    EXPECT_EQ(run({"courtyard.vox", "-o", "fast.pf_vox"}).exitCode, 0);
    EXPECT_EQ(run({"courtyard.vox", "-o", "small.pf_vox", "--archive"}).exitCode, 0);
    EXPECT_LT(std::filesystem::file_size(folder / "small.pf_vox"),
              std::filesystem::file_size(folder / "fast.pf_vox"));
}

TEST_F(Vox2pf, interruptGives130AndNoTemporaryFile) {
    for (int i = 0; i < 200; ++i) addSource("in/" + std::to_string(i) + ".vox", "courtyard.vox");
    Process child({PFVOX_VOX2PF, "in", "-o", "out", "-j", "2"},
                  {.environment = {}, .input = {}, .folder = folder.path()});
    while (filesBelow("out").empty()) ::usleep(1000);
    child.send(SIGINT);
    const ProcessResult result = child.finish();
    EXPECT_EQ(result.exitCode, 130);
    const auto written = readTree(folder / "out");
    ASSERT_FALSE(written.empty());
    for (const auto& [name, bytes] : written) {
        EXPECT_THAT(name, Not(HasSubstr(".tmp")));
        EXPECT_EQ(bytes, written.begin()->second) << name << " is not complete";
    }
}

TEST_F(Vox2pf, metadataOfMacOsIsSkippedWithANote) {
    addSource("in/a.vox");
    writeText(folder / "in/._a.vox", std::string("\0\x05\x16\x07\0\2\0\0Mac OS X", 16));
    const ProcessResult result = run({"in", "-o", "out", "-v"});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("1 file that macOS keeps beside others"));
    EXPECT_THAT(filesBelow("out"), ElementsAre("a.pf_vox"));
    EXPECT_THAT(run({"in/._a.vox", "-o", "out/"}).err, HasSubstr("what macOS keeps beside a file"));
}

TEST_F(Vox2pf, linkedFoldersThatAreNotSearchedAreSaid) {
    addSource("in/a.vox");
    addSource("elsewhere/b.vox");
    std::filesystem::create_directory_symlink("../elsewhere", folder / "in/link");
    EXPECT_THAT(run({"in", "-o", "out"}).err, HasSubstr("in: 1 linked folder not searched"));
}

TEST_F(Vox2pf, namesOfSourcesReachNoTerminalAsTheyAre) {
    const std::string evil = "\x1b]0;pwn\x07\x1b[31mred\nline";
    test::VoxWriter writer;
    writer.model({1, 1, 1}, {{0, 0, 0, 1}})
        .transform({.id = 0, .child = 1, .attributes = {{"_name", evil}}})
        .shape({.id = 1})
        .chunk("NOTE", test::voxInts({1}) + test::voxString(evil));
    const std::string name = "evil\x1b[2J\n.vox";
    writeText(folder / name, writer.finish());
    writeText(folder / ("broken" + name), "VOX ");
    const std::vector<std::vector<std::string>> commands{
        {name, "-o", "a.pf_vox", "-v"},
        {name, "-o", "a.pf_vox", "--explain"},
        {"broken" + name, "-o", "b.pf_vox", "--color", "always"},
        {"info", "-v", "a.pf_vox"},
        {"validate", "a.pf_vox"},
        {"export", "a.pf_vox", "-o", "x" + name},
        {"info", name},
        {name, name, "-o", "\x1b[2J.bin"}};
    for (const std::vector<std::string>& command : commands) {
        const ProcessResult result = run(command);
        for (const std::string& text : {result.out, result.err}) {
            EXPECT_THAT(text, Not(HasSubstr("\x1b]"))) << command[0];
            EXPECT_THAT(text, Not(HasSubstr("\x1b[2J"))) << command[0];
            EXPECT_THAT(text, Not(HasSubstr("\x1b[31m"))) << command[0];
            EXPECT_THAT(text, Not(HasSubstr("\nline"))) << command[0];
            EXPECT_THAT(text, Not(HasSubstr("\n.vox"))) << command[0];
        }
    }
}

TEST_F(Vox2pf, equalWarningsAreOneLineWithACount) {
    std::string chunks = test::voxChunk("SIZE", test::voxInts({1, 1, 1})) +
                         test::voxChunk("XYZI", test::voxInts({1, 0x01000000}));
    const std::string palette = test::voxChunk("RGBA", std::string(1024, '\xff'));
    for (int i = 0; i < 11; ++i) chunks += palette;
    writeText(folder / "a.vox", "VOX " + test::voxBytes(150) + test::voxChunk("MAIN", "", chunks));
    const ProcessResult result = run({"a.vox", "-o", "a.pf_vox"});
    EXPECT_EQ(linesOf(result.err).size(), 1u) << result.err;
    EXPECT_THAT(result.err, AllOf(HasSubstr("another chunk RGBA"), HasSubstr("(10 times)")));
}

TEST_F(Vox2pf, settingsThatNestWithoutEndAreAnError) {
    addSource("a.vox");
    std::string deep = "a";
    for (int i = 0; i < 100'000; ++i) deep += ".a";
    writeText(folder / "deep.toml", deep + "=1");
    const ProcessResult result = run({"a.vox", "-o", "a.pf_vox", "--settings", "deep.toml"});
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_THAT(result.err, AllOf(HasSubstr("deep.toml"), HasSubstr("line 1"), HasSubstr("nested deeper")));
}

TEST_F(Vox2pf, signalsThatWereIgnoredAtTheStartStayIgnored) {
    for (int i = 0; i < 40; ++i) addSource("in/" + std::to_string(i) + ".vox", "courtyard.vox");
    Process child({"/bin/sh", "-c", "trap '' INT HUP; exec \"$0\" in -o out -q", PFVOX_VOX2PF},
                  {.environment = {}, .input = {}, .folder = folder.path()});
    while (!exists("out")) ::usleep(1000);
    child.send(SIGHUP);
    child.send(SIGINT);
    EXPECT_EQ(child.finish().exitCode, 0);
    EXPECT_EQ(filesBelow("out").size(), 40u);
}

TEST_F(Vox2pf, aReaderThatGoesAwayIsAnErrorAndNoOutputIsMissing) {
    for (int i = 0; i < 20; ++i) addSource("in/" + std::to_string(i) + ".vox");
    const ProcessResult result =
        runProcess({"/bin/bash", "-c", "\"$0\" in -o out --json | true; exit ${PIPESTATUS[0]}", PFVOX_VOX2PF},
                   {.environment = {}, .input = {}, .folder = folder.path()});
    EXPECT_EQ(result.exitCode, 3);
    EXPECT_THAT(result.err, HasSubstr("its reader has gone"));
    EXPECT_EQ(filesBelow("out").size(), 20u);
}

TEST_F(Vox2pf, aLimitOfFileSizesIsAnErrorAndLeavesNothing) {
    addSource("a.vox", "courtyard.vox");
    const ProcessResult result =
        runProcess({"/bin/sh", "-c", "ulimit -f 1; exec \"$0\" a.vox -o out/", PFVOX_VOX2PF},
                   {.environment = {}, .input = {}, .folder = folder.path()});
    EXPECT_EQ(result.exitCode, 3);
    EXPECT_THAT(result.err, HasSubstr("File too large"));
    EXPECT_THAT(filesBelow("out"), IsEmpty());
}

TEST_F(Vox2pf, aReadOnlyOutputIsReplacedByForceOnly) {
    addSource("a.vox");
    addSource("b.vox", "statue.vox");
    ASSERT_EQ(run({"a.vox", "-o", "x.pf_vox"}).exitCode, 0);
    const std::string before = readText(folder / "x.pf_vox");
    std::filesystem::permissions(folder / "x.pf_vox", std::filesystem::perms(0444));
    EXPECT_EQ(run({"a.vox", "-o", "x.pf_vox"}).exitCode, 0) << "it is up to date";
    const ProcessResult refused = run({"b.vox", "-o", "x.pf_vox"});
    EXPECT_EQ(refused.exitCode, 3);
    EXPECT_THAT(refused.err, HasSubstr("read-only"));
    EXPECT_THAT(refused.err, HasSubstr("--force"));
    EXPECT_EQ(readText(folder / "x.pf_vox"), before);
    EXPECT_EQ(run({"b.vox", "-o", "x.pf_vox", "--force"}).exitCode, 0);
    EXPECT_NE(readText(folder / "x.pf_vox"), before);
}

TEST_F(Vox2pf, namesOfOutputsMayBeAsLongAsTheFileSystemTakesThem) {
    const std::string name(240, 'x');
    addSource(name + ".vox");
    EXPECT_EQ(run({name + ".vox", "-o", "out/"}).exitCode, 0);
    EXPECT_TRUE(exists("out/" + name + ".pf_vox"));
}

/// Converts the statue with these options and returns what info tells.
class Vox2pfOctreeOptions : public Vox2pf {
  protected:
    std::string infoOf(std::vector<std::string> options) {
        addSourceOnce();
        options.insert(options.begin(), {"statue.vox", "-o", "statue.pf_vox"});
        EXPECT_EQ(run(options).exitCode, 0);
        EXPECT_EQ(run({"validate", "statue.pf_vox"}).exitCode, 0);
        return run({"info", "statue.pf_vox"}).out;
    }

  private:
    void addSourceOnce() {
        if (!exists("statue.vox")) addSource("statue.vox", "statue.vox");
    }
};

TEST_F(Vox2pf, jsonSaysHowLongWritingTookAndHowMuchWasHollowed) {
    addSource("a.vox");
    const auto lineOf = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"a.vox", "-o", "a.pf_vox", "--json", "--force"});
        return nlohmann::json::parse(run(options).out);
    };
    const auto plain = lineOf({});
    EXPECT_GT(plain["seconds"]["write"].get<double>(), 0.0);
    EXPECT_EQ(plain["hollowedVoxels"], 0);
    const auto hollow = lineOf({"--hollow"});
    EXPECT_GT(hollow["hollowedVoxels"], 0);
    EXPECT_LT(hollow["hollowedVoxels"], hollow["voxels"]);
}

TEST_F(Vox2pfOctreeOptions, hollowIsRecordedAndCanBeTakenBack) {
    EXPECT_THAT(infoOf({"--hollow"}), HasSubstr(", hollow"));
    writeText(folder / "s.toml", "[build]\nhollow = true\n");
    EXPECT_THAT(infoOf({"--settings", "s.toml"}), HasSubstr(", hollow"));
    EXPECT_THAT(infoOf({"--settings", "s.toml", "--no-hollow"}), Not(HasSubstr(", hollow")));
}

TEST_F(Vox2pfOctreeOptions, lodAddsASectionAndIsAnotherContent) {
    EXPECT_THAT(infoOf({}), Not(HasSubstr("LODA")));
    EXPECT_THAT(infoOf({"--lod"}), HasSubstr("LODA")) << "not up to date with other settings";
    writeText(folder / "s.toml", "[build]\nlod = true\n");
    EXPECT_THAT(infoOf({"--settings", "s.toml"}), HasSubstr("LODA"));
}

TEST_F(Vox2pfOctreeOptions, profileIsPackedOrResident) {
    EXPECT_THAT(infoOf({"--profile", "resident"}), AllOf(HasSubstr(", resident"), HasSubstr("NODE")));
    EXPECT_THAT(infoOf({"--profile", "packed"}), AllOf(Not(HasSubstr(", resident")), HasSubstr("MASK")));
    writeText(folder / "s.toml", "[encode]\nprofile = \"resident\"\n");
    EXPECT_THAT(infoOf({"--settings", "s.toml"}), HasSubstr(", resident"));
    EXPECT_EQ(run({"statue.vox", "-o", "x.pf_vox", "--profile", "small"}).exitCode, 2);
    writeText(folder / "s.toml", "[encode]\nprofile = 1\n");
    const ProcessResult result = run({"statue.vox", "-o", "x.pf_vox", "--settings", "s.toml"});
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_THAT(result.err, AllOf(HasSubstr("line 2"), HasSubstr("\"resident\"")));
}

}  // namespace pfvox::test

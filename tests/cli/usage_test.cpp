// Help, version and wrong usage: what is printed where, and the exit code.

#include <unistd.h>

#include "cli/vox2pf_fixture.hpp"

namespace pfvox::test {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

TEST_F(Vox2pf, helpGoesToStdoutAndExitsWithZero) {
    for (const auto& arguments : std::vector<std::vector<std::string>>{
             {"--help"}, {"-h"}, {"convert", "--help"}, {"info", "--help"}, {"validate", "--help"}}) {
        const ProcessResult result = run(arguments);
        EXPECT_EQ(result.exitCode, 0);
        EXPECT_THAT(result.out, AllOf(HasSubstr("Usage:"), HasSubstr("Examples:"), HasSubstr("Exit codes:")));
        EXPECT_THAT(result.err, IsEmpty());
    }
}

TEST_F(Vox2pf, versionNamesTheFormats) {
    const ProcessResult result = run({"--version"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.out, AllOf(StartsWith("vox2pf "), HasSubstr(".vox"), HasSubstr("PF_VOX 1.")));
    EXPECT_THAT(result.err, IsEmpty());
}

TEST_F(Vox2pf, withoutTheModuleOpenVdbFilesGetTheRemedyAndExitCodeFive) {
    // A program by itself: no module in its tree. One that is installed on this machine is of another build.
    const std::filesystem::path lonely = folder / "lonely" / "vox2pf";
    std::filesystem::create_directories(lonely.parent_path());
    std::filesystem::copy_file(PFVOX_VOX2PF, lonely);
    addSource("a.vox");
    writeText(folder / "a.vdb", std::string(" BDV\0\0\0\0\xe0\0\0\0", 12));
    const ProcessResult vdb =
        runProcess({lonely.string(), "a.vdb", "-o", "a.pf_vox"}, {.folder = folder.path()});
    EXPECT_EQ(vdb.exitCode, 5);
    EXPECT_THAT(vdb.err, AllOf(HasSubstr("a.vdb"), HasSubstr("module"), HasSubstr("install")));
    EXPECT_FALSE(exists("a.pf_vox"));
    EXPECT_EQ(runProcess({lonely.string(), "a.vox", "-o", "a.pf_vox"}, {.folder = folder.path()}).exitCode,
              0);
    EXPECT_EQ(run({"a.vdb", "-o", "b.pf_vox"}).exitCode, 4)
        << "with its module it reads the file, which is broken";
}

TEST_F(Vox2pf, withoutArgumentsHelpGoesToStderr) {
    const ProcessResult result = run({});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_THAT(result.err, HasSubstr("Usage:"));
}

TEST_F(Vox2pf, unknownOptionIsRefusedWithTheNearestOne) {
    addSource("a.vox");
    const ProcessResult result = run({"a.vox", "-o", "a.pf_vox", "--forse"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.err, AllOf(HasSubstr("--forse"), HasSubstr("did you mean --force?")));
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_FALSE(exists("a.pf_vox"));
}

TEST_F(Vox2pf, misspeltCommandIsRefusedWithTheNearestOne) {
    const ProcessResult result = run({"inof", "a.pf_vox"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.err, HasSubstr("did you mean info?"));
}

TEST_F(Vox2pf, numbersOutOfRangeAreRefusedNotClamped) {
    addSource("a.vox");
    for (const auto& option : std::vector<std::vector<std::string>>{{"-j", "-1"},
                                                                    {"-j", "100000"},
                                                                    {"-j", "2x"},
                                                                    {"--voxel-size", "0"},
                                                                    {"--voxel-size", "nan"},
                                                                    {"--frame", "-2"},
                                                                    {"--limit", "maxFileBytes=-1"},
                                                                    {"--limit", "maxFileBytes"},
                                                                    {"--limit", "maxModels=5G"}}) {
        std::vector<std::string> arguments{"a.vox", "-o", "a.pf_vox"};
        arguments.insert(arguments.end(), option.begin(), option.end());
        const ProcessResult result = run(arguments);
        EXPECT_EQ(result.exitCode, 2) << option[0] << ' ' << option[1];
        EXPECT_FALSE(exists("a.pf_vox"));
    }
}

TEST_F(Vox2pf, unknownLimitIsRefusedWithTheNearestOne) {
    const ProcessResult result = run({"a.vox", "-o", "b/", "--limit", "maxfilebytes=1"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.err, HasSubstr("did you mean maxFileBytes?"));
}

TEST_F(Vox2pf, contradictingOptionsAreRefused) {
    addSource("a.vox");
    EXPECT_EQ(run({"a.vox", "-o", "a.pf_vox", "--force", "--no-clobber"}).exitCode, 2);
    EXPECT_EQ(run({"a.vox", "-o", "a.pf_vox", "-q", "-v"}).exitCode, 2);
    EXPECT_FALSE(exists("a.pf_vox"));
}

TEST_F(Vox2pf, missingOutputIsRefused) {
    addSource("a.vox");
    const ProcessResult result = run({"a.vox"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.err, HasSubstr("--output"));
}

TEST_F(Vox2pf, severalInputsIntoOneFileAreRefused) {
    addSource("a.vox");
    addSource("b.vox", "statue.vox");
    EXPECT_EQ(run({"a.vox", "b.vox", "-o", "all.pf_vox"}).exitCode, 2);
    EXPECT_FALSE(exists("all.pf_vox"));
}

TEST_F(Vox2pf, twoInputsWithOneOutputAreRefusedByName) {
    addSource("x/hall.vox");
    addSource("y/hall.vox", "statue.vox");
    const ProcessResult result = run({"x/hall.vox", "y/hall.vox", "-o", "out"});
    EXPECT_EQ(result.exitCode, 3);
    EXPECT_THAT(result.err,
                AllOf(HasSubstr("x/hall.vox"), HasSubstr("y/hall.vox"), HasSubstr("hall.pf_vox")));
    EXPECT_FALSE(exists("out"));
}

TEST_F(Vox2pf, outputThatIsTheInputIsRefused) {
    const std::filesystem::path source = addSource("hall.pf_vox");
    const std::string before = readText(source);
    const ProcessResult result = run({"hall.pf_vox", "-o", "hall.pf_vox"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_EQ(readText(source), before);
}

TEST_F(Vox2pf, outputWithAnotherExtensionIsRefused) {
    addSource("a.vox");
    const ProcessResult result = run({"a.vox", "-o", "a.bin"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.err, HasSubstr(".pf_vox"));
    EXPECT_FALSE(exists("a.bin"));
}

TEST_F(Vox2pf, outputThatIsAnotherFileIsRefusedAsSuch) {
    const std::string before = readText(addSource("a.vox"));
    const ProcessResult result = run({"a.vox", "-o", "a.vox"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.err, HasSubstr("-o a.vox is a file, but no .pf_vox file"));
    EXPECT_EQ(run({".", "-o", "a.vox"}).exitCode, 2);
    EXPECT_EQ(readText(folder / "a.vox"), before);
}

TEST_F(Vox2pf, resultsThatCannotBeWrittenAreAFailure) {
    addSource("a.vox");
    ASSERT_EQ(run({"a.vox", "-o", "a.pf_vox"}).exitCode, 0);
    const ProcessResult result =
        runProcess({"/bin/sh", "-c", "exec \"$0\" info --json a.pf_vox > /dev/full", PFVOX_VOX2PF},
                   {.environment = {}, .input = {}, .folder = folder.path()});
    EXPECT_EQ(result.exitCode, 3);
    EXPECT_THAT(result.err, HasSubstr("standard output"));
}

TEST_F(Vox2pf, aFolderThatCannotBeSearchedIsNamedAndTheOthersAreConverted) {
    namespace fs = std::filesystem;
    addSource("assets/a.vox");
    addSource("assets/z/b.vox");
    fs::create_directories(folder / "assets/locked");
    fs::permissions(folder / "assets/locked", fs::perms::none);
    std::vector<std::string> command{PFVOX_VOX2PF, "assets", "-o", "out", "--json"};
    if (::geteuid() == 0) {  // who may search everything
        fs::permissions(folder.path(), fs::perms::all);
        command.insert(command.begin(),
                       {"/usr/bin/setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"});
    }
    const ProcessResult result =
        runProcess(command, {.environment = {}, .input = {}, .folder = folder.path()});
    fs::permissions(folder / "assets/locked", fs::perms::owner_all);
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.err, HasSubstr("assets/locked: cannot search this folder"));
    EXPECT_EQ(linesOf(result.out).size(), 3u) << "an object for the folder, too";
    EXPECT_THAT(filesBelow("out"), ::testing::ElementsAre("a.pf_vox", "z/b.pf_vox"));
}

/// Runs vox2pf in a shell that sets limits first, as a user of its own: root has no limit of processes.
class LimitedVox2pf : public Vox2pf {
  protected:
    ProcessResult limited(const std::string& limits, const std::string& arguments) const {
        const std::string user = std::to_string(100'000 + ::getpid() % 100'000);
        std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
        return runProcess({"/usr/bin/setpriv", "--reuid=" + user, "--regid=65534", "--clear-groups",
                           "/bin/bash", "-c", limits + "; exec \"$0\" " + arguments, PFVOX_VOX2PF},
                          {.environment = {}, .input = {}, .folder = folder.path()});
    }
    void SetUp() override {
        if (::geteuid() != 0) GTEST_SKIP() << "only root can become a user of its own";
        for (int i = 0; i < kAssets; ++i) addSource("in/" + std::to_string(i) + ".vox");
    }
    static constexpr int kAssets = 120;
};

TEST_F(LimitedVox2pf, whereThreadsAreFewItTakesFewer) {
    const ProcessResult result = limited("ulimit -u 4", "in -o out -j 8");
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(filesBelow("out").size(), 1u * kAssets);
}

TEST_F(LimitedVox2pf, withoutAnyThreadTheRemedyIsNamed) {
    const ProcessResult result = limited("ulimit -u 1", "in -o out");
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_THAT(result.err, HasSubstr("ulimit -u"));
}

TEST_F(LimitedVox2pf, whereFilesAreFewItWaits) {
    const ProcessResult result = limited("ulimit -n 24", "in -o out -j 16");
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(filesBelow("out").size(), 1u * kAssets);
}

TEST_F(LimitedVox2pf, whereOpenVdbHasTooFewThreadsTheRemedyIsNamed) {
    ASSERT_EQ(run({"in/0.vox", "-o", "a.pf_vox"}).exitCode, 0);
    const ProcessResult exported = run({"export", "a.pf_vox", "-o", "a.vdb"});
    if (exported.exitCode == 5) GTEST_SKIP() << "without OpenVDB";
    ASSERT_EQ(exported.exitCode, 0);
    for (const int threads : {2, 3, 4, 6}) {
        const ProcessResult result =
            limited("ulimit -u " + std::to_string(threads), "a.vdb -o b.pf_vox -j 4");
        EXPECT_EQ(result.exitCode, 4) << threads << ": " << result.err;
        EXPECT_THAT(result.err, HasSubstr("ulimit -u")) << threads;
    }
}

#ifndef PFVOX_ADDRESS_SANITIZER
TEST_F(LimitedVox2pf, whereMemoryIsLittleItIsSaidOrTakenLessOf) {
    const ProcessResult result = limited("ulimit -v 100000", "in -o out -j 16");
    EXPECT_THAT(result.exitCode, ::testing::AnyOf(0, 1, 4)) << result.err;
    EXPECT_TRUE(result.exitCode == 0 || result.err.find("not enough memory") != std::string::npos)
        << result.err;
}
#endif

TEST_F(Vox2pf, filesOfOtherKindsGetTheCommandThatReadsThem) {
    writeText(folder / "old.pf_vox",
              "what the thesis program wrote, long enough for a header of 64 bytes and more");
    EXPECT_THAT(run({"info", "old.pf_vox"}).err, HasSubstr("vox2pf old.pf_vox -o converted/"));
    writeText(folder / "a.pf_probe", "probes, or what is called so");
    EXPECT_THAT(run({"info", "a.pf_probe"}).err, HasSubstr("probe-bake info a.pf_probe"));
    addSource("a.vox");
    ASSERT_EQ(run({"a.vox", "-o", "a.pf_vox"}).exitCode, 0);
    writeText(folder / "cut.pf_vox", readText(folder / "a.pf_vox").substr(0, 300));
    EXPECT_THAT(run({"info", "cut.pf_vox"}).err, HasSubstr("convert the source again"));
}

TEST_F(Vox2pf, colorFollowsOptionAndEnvironment) {
    const auto errorOf = [&](const std::vector<std::string>& options, const ProcessSetup& setup) {
        std::vector<std::string> arguments{"none.vox", "-o", "x.pf_vox"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run(arguments, setup).err;
    };
    EXPECT_THAT(errorOf({}, {}), Not(HasSubstr("\x1b["))) << "a pipe is no terminal";
    EXPECT_THAT(errorOf({"--color", "always"}, {}), HasSubstr("\x1b["));
    EXPECT_THAT(errorOf({"--color", "auto"}, {.environment = {"NO_COLOR=1"}, .input = {}, .folder = {}}),
                Not(HasSubstr("\x1b[")));
    EXPECT_THAT(errorOf({"--color", "never"}, {}), Not(HasSubstr("\x1b[")));
}

}  // namespace pfvox::test

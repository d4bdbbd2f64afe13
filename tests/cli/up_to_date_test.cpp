// Up to date means content: what a second run of vox2pf does and says, and what build systems get from it.

#include <nlohmann/json.hpp>

#include "cli/vox2pf_fixture.hpp"

namespace pfvox::test {

using ::testing::AllOf;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

class UpToDate : public Vox2pf {
  protected:
    void SetUp() override {
        addSource("in/a.vox");
        addSource("in/b.vox", "statue.vox");
        ASSERT_EQ(run({"in", "-o", "out"}).exitCode, 0);
    }

    /// Makes a file look an hour old, so that a later write shows in its time stamp.
    fs::file_time_type age(const fs::path& name) const {
        const auto past = fs::last_write_time(folder / name) - std::chrono::hours(1);
        fs::last_write_time(folder / name, past);
        return past;
    }
    bool written(const fs::path& name, fs::file_time_type since) const {
        return fs::last_write_time(folder / name) != since;
    }
};

TEST_F(UpToDate, secondRunConvertsNothingAndSaysSo) {
    const auto since = age("out/a.pf_vox");
    const ProcessResult result = run({"in", "-o", "out"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.out, AllOf(HasSubstr("nothing to do"), HasSubstr("2 files")));
    EXPECT_FALSE(written("out/a.pf_vox", since));
}

TEST_F(UpToDate, touchingConvertsNothing) {
    const auto since = age("out/a.pf_vox");
    fs::last_write_time(folder / "in/a.vox", fs::file_time_type::clock::now() + std::chrono::hours(1));
    EXPECT_EQ(run({"in", "-o", "out"}).exitCode, 0);
    EXPECT_FALSE(written("out/a.pf_vox", since));
}

TEST_F(UpToDate, changedContentConvertsThatFileOnly) {
    const auto sinceA = age("out/a.pf_vox");
    const auto sinceB = age("out/b.pf_vox");
    const auto stamp = fs::last_write_time(folder / "in/a.vox");
    changeOneByte(folder / "in/a.vox");
    fs::last_write_time(folder / "in/a.vox", stamp);
    EXPECT_EQ(run({"in", "-o", "out"}).exitCode, 0);
    EXPECT_TRUE(written("out/a.pf_vox", sinceA));
    EXPECT_FALSE(written("out/b.pf_vox", sinceB));
}

TEST_F(UpToDate, changedSettingConverts) {
    const auto since = age("out/a.pf_vox");
    const ProcessResult result = run({"in", "-o", "out", "--voxel-size", "0.25", "--explain"});
    EXPECT_TRUE(written("out/a.pf_vox", since));
    EXPECT_THAT(result.out, HasSubstr("changed since the last conversion"));
}

TEST_F(UpToDate, damagedOutputIsConvertedAgain) {
    const std::string good = readText(folder / "out/a.pf_vox");
    writeText(folder / "out/a.pf_vox", good.substr(0, good.size() / 2));
    const ProcessResult result = run({"in", "-o", "out", "--explain"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(readText(folder / "out/a.pf_vox"), good);
}

// One flipped bit was "up to date", and so no build ever repaired it.
TEST_F(UpToDate, aFlippedBitIsRepaired) {
    const std::string good = readText(folder / "out/a.pf_vox");
    for (const std::size_t at : {good.size() * 3 / 4, good.size() / 2, good.size() - 1, std::size_t{70}}) {
        std::string bad = good;
        bad[at] = static_cast<char>(bad[at] ^ 16);
        writeText(folder / "out/a.pf_vox", bad);
        if (run({"validate", "out/a.pf_vox"}).exitCode == 0) continue;  // between two parts
        const ProcessResult result = run({"in", "-o", "out", "-v", "--json"});
        EXPECT_EQ(result.exitCode, 0);
        EXPECT_THAT(result.err, AllOf(HasSubstr("output-damaged"), HasSubstr("was damaged"))) << at;
        EXPECT_TRUE(readText(folder / "out/a.pf_vox") == good) << at;
    }
    writeText(folder / "out/a.pf_vox", good.substr(0, good.size() - 1) + static_cast<char>(good.back() ^ 1));
    EXPECT_THAT(run({"in/a.vox", "-o", "out/a.pf_vox"}).out, HasSubstr("the existing output was damaged"));
}

TEST_F(UpToDate, jsonHasTheFiguresOfTheOutputAndNullForWhatIsUnknown) {
    const auto first = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"in", "-o", "out", "--json"});
        return nlohmann::json::parse(linesOf(run(options).out).at(0));
    };
    const auto converted = first({"--force"});
    const auto upToDate = first({});
    EXPECT_EQ(upToDate["status"], "up-to-date");
    EXPECT_GT(converted["voxels"], 0);
    for (const char* key :
         {"sourceBytes", "outputBytes", "models", "instances", "materials", "voxels", "nodes", "leaves"})
        EXPECT_EQ(upToDate[key], converted[key]) << key;
    EXPECT_TRUE(upToDate["hollowedVoxels"].is_null());
    EXPECT_TRUE(upToDate["seconds"]["import"].is_null());
    for (const std::vector<std::string>& options :
         {std::vector<std::string>{"--force", "--dry-run"}, {"--no-clobber", "--voxel-size", "2"}}) {
        const auto kept = first(options);
        EXPECT_GT(kept["sourceBytes"], 0);
        for (const char* key :
             {"outputBytes", "models", "instances", "materials", "voxels", "nodes", "leaves"})
            EXPECT_TRUE(kept[key].is_null()) << key;
    }
}

TEST_F(UpToDate, forceConvertsWithoutNeed) {
    const auto since = age("out/a.pf_vox");
    const ProcessResult result = run({"in", "-o", "out", "--force", "--explain"});
    EXPECT_TRUE(written("out/a.pf_vox", since));
    EXPECT_THAT(result.out, HasSubstr("--force"));
}

TEST_F(UpToDate, ifChangedLeavesEqualBytesAlone) {
    const auto since = age("out/a.pf_vox");
    EXPECT_EQ(run({"in", "-o", "out", "--force", "--if-changed"}).exitCode, 0);
    EXPECT_FALSE(written("out/a.pf_vox", since));
}

TEST_F(UpToDate, makeGetsAFreshTimeStampUnlessIfChanged) {
    auto since = age("out/a.pf_vox");
    EXPECT_EQ(run({"in", "-o", "out", "--depfile", "d.d", "--if-changed"}).exitCode, 0);
    EXPECT_FALSE(written("out/a.pf_vox", since));
    EXPECT_EQ(run({"in", "-o", "out", "--depfile", "d.d"}).exitCode, 0);
    EXPECT_TRUE(written("out/a.pf_vox", since));
}

TEST_F(UpToDate, explainGivesAReasonForEveryFile) {
    addSource("in/c.vox", "tree.vox");
    const ProcessResult result = run({"in", "-o", "out", "--explain"});
    EXPECT_THAT(result.out, AllOf(HasSubstr("up to date in/a.vox"), HasSubstr("same source"),
                                  HasSubstr("converted in/c.vox"), HasSubstr("there was no output")));
}

TEST_F(Vox2pf, depfileNamesSourcesAndSettingsWithEscapes) {
    addSource("in/a b#c$d.vox");
    writeText(folder / "s.toml", "[encode]\nzstdLevel = 4\n");
    EXPECT_EQ(
        run({"in/a b#c$d.vox", "-o", "o.pf_vox", "--settings", "s.toml", "--depfile", "d/o.d"}).exitCode, 0);
    EXPECT_EQ(readText(folder / "d/o.d"), "o.pf_vox: in/a\\ b\\#c$$d.vox s.toml\n");
}

TEST_F(Vox2pf, depfileNeverHoldsARuleOfAName) {
    addSource("in/good.vox");
    addSource("in/x:\nall:;touch\tPWNED;\tb.vox");
    for (const std::vector<std::string>& reader : {std::vector<std::string>{}, {"--if-changed"}}) {
        std::vector<std::string> arguments{"in", "-o", "out", "--depfile", "d.d"};
        arguments.insert(arguments.end(), reader.begin(), reader.end());
        const ProcessResult result = run(arguments);
        EXPECT_EQ(result.exitCode, 4) << result.err;
        EXPECT_THAT(result.err, AllOf(HasSubstr("a depfile for"), HasSubstr("[bad-value]")));
        EXPECT_FALSE(fs::exists(folder / "d.d"));
        EXPECT_FALSE(fs::exists(folder / "out"));
    }
}

TEST_F(Vox2pf, noSummaryLeavesWarningsAndErrors) {
    addSource("a.vox");
    const ProcessResult result = run({"a.vox", "-o", "a.pf_vox", "--no-summary"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.out + result.err, "");
    EXPECT_THAT(run({"none.vox", "-o", "a.pf_vox", "--no-summary"}).err, HasSubstr("none.vox"));
}

TEST_F(Vox2pf, settingsFileAppliesOverridesByPattern) {
    addSource("in/a.vox");
    addSource("in/props/b.vox", "statue.vox");
    writeText(folder / "s.toml",
              "[import]\nvoxelSizeMetres = 0.5\n[[override]]\nfiles = \"props/**\"\nimport.voxelSizeMetres = "
              "0.25\n");
    EXPECT_EQ(run({"in", "-o", "out", "--settings", "s.toml"}).exitCode, 0);
    EXPECT_THAT(run({"info", "out/a.pf_vox"}).out, HasSubstr("0.5 m voxels"));
    EXPECT_THAT(run({"info", "out/props/b.pf_vox"}).out, HasSubstr("0.25 m voxels"));
    EXPECT_EQ(run({"in", "-o", "out", "--settings", "s.toml", "--voxel-size", "1"}).exitCode, 0);
    EXPECT_THAT(run({"info", "out/props/b.pf_vox"}).out, HasSubstr("1 m voxels")) << "the command line wins";
}

TEST_F(Vox2pf, settingsFileComplaintsHaveLineAndColumn) {
    addSource("a.vox");
    const auto complaint = [&](const std::string& text) {
        writeText(folder / "s.toml", text);
        const ProcessResult result = run({"a.vox", "-o", "a.pf_vox", "--settings", "s.toml"});
        EXPECT_EQ(result.exitCode, 4) << text;
        return result.err;
    };
    EXPECT_THAT(complaint("[import]\nmerg = true\n"),
                AllOf(HasSubstr("line 2"), HasSubstr("did you mean merge?")));
    EXPECT_THAT(complaint("[import]\nframe = -1\n"), HasSubstr("line 2, column 9"));
    EXPECT_THAT(complaint("[encode]\nzstdLevel = 20\n"), HasSubstr("from 1 to 19"));
    EXPECT_THAT(complaint("[import\n"), HasSubstr("line 1"));
    EXPECT_THAT(complaint("[[override]]\nimport.merge = true\n"), HasSubstr("files"));
    EXPECT_FALSE(exists("a.pf_vox"));
}

}  // namespace pfvox::test

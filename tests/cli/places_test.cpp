// What texts and links become: lists of inputs, pipes, names that are nearly right, folders of links, and two
// sources for one output.

#include <map>
#include <nlohmann/json.hpp>

#include "cli/vox2pf_fixture.hpp"
#include "support/vox_writer.hpp"

namespace pfvox::test {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

namespace fs = std::filesystem;

namespace {

class Vox2pfLists : public Vox2pf {
  protected:
    void SetUp() override {
        addSource("l/one.vox");
        addSource("l/two\nlines.vox", "statue.vox");
        addSource("l/two.vox", "statue.vox");
    }
    ProcessResult convertList(const std::string& list, std::vector<std::string> options = {}) const {
        fs::remove_all(folder / "lo");
        options.insert(options.begin(), {"-", "-o", "lo"});
        return run(std::move(options), {.environment = {}, .input = list, .folder = {}});
    }
};

}  // namespace

// one.vox's bytes were in lo/two.pf_vox: the system ends a path at NUL.
TEST_F(Vox2pfLists, nullSeparatedOnesAreReadWithTheirOptionAndElseRefused) {
    const std::string list{"l/one.vox\0l/two\nlines.vox\0", 26};
    const ProcessResult refused = convertList(list);
    EXPECT_EQ(refused.exitCode, 4);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("line 1"), HasSubstr("-0"), HasSubstr("bad-value")));
    EXPECT_FALSE(exists("lo"));
    for (const std::string option : {"-0", "--null"}) {
        EXPECT_EQ(convertList(list, {option}).exitCode, 0);
        EXPECT_THAT(filesBelow("lo"), ElementsAre("one.pf_vox", "two\nlines.pf_vox"));
    }
    EXPECT_EQ(run({"validate", "-0", "-"},
                  {.environment = {}, .input = std::string("lo/one.pf_vox\0", 14), .folder = {}})
                  .exitCode,
              0);
}

TEST_F(Vox2pfLists, marksAndLineEndsOfOtherSystemsAreNoPartOfNames) {
    EXPECT_EQ(convertList("\xef\xbb\xbfl/one.vox\r\nl/two.vox\r\n").exitCode, 0);
    EXPECT_THAT(filesBelow("lo"), ElementsAre("one.pf_vox", "two.pf_vox"));
    const ProcessResult utf16 = convertList(std::string("\xff\xfel\0/\0", 6));
    EXPECT_EQ(utf16.exitCode, 4);
    EXPECT_THAT(utf16.err, HasSubstr("UTF-16"));
}

TEST_F(Vox2pf, emptyNamesAndStandardOutputAreNoPaths) {
    addSource("a.vox");
    ASSERT_EQ(run({"a.vox", "-o", "a.pf_vox"}).exitCode, 0);
    for (const std::vector<std::string>& command : {std::vector<std::string>{"a.vox", "-o", "-"},
                                                    {"a.vox", "-o", ""},
                                                    {"a.vox", "-o", "b.pf_vox", "--depfile", "-"},
                                                    {"export", "a.pf_vox", "-o", "-"}}) {
        const ProcessResult result = run(command);
        EXPECT_EQ(result.exitCode, 2) << command.back();
        EXPECT_THAT(result.err, HasSubstr(command.back().empty() ? "empty path" : "./-"));
    }
    EXPECT_THAT(filesBelow("."), ElementsAre("a.pf_vox", "a.vox"));
    EXPECT_THAT(run({"", "-o", "out/"}).err, HasSubstr("an empty path names nothing"));
    EXPECT_EQ(run({"a.vox", "-o", "./-"}).exitCode, 0);
    EXPECT_THAT(filesBelow("-"), ElementsAre("a.pf_vox"));
}

TEST_F(Vox2pf, aPipeIsAnInput) {
    addSource("a.vox");
    const std::string source = readText(folder / "a.vox");
    ASSERT_EQ(run({"a.vox", "-o", "a.pf_vox"}).exitCode, 0);
    const ProcessResult result =
        run({"/dev/stdin", "-o", "b.pf_vox"}, {.environment = {}, .input = source, .folder = {}});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(readText(folder / "b.pf_vox"), readText(folder / "a.pf_vox"));
    EXPECT_EQ(run({"validate", "/dev/stdin"},
                  {.environment = {}, .input = readText(folder / "a.pf_vox"), .folder = {}})
                  .exitCode,
              0);
    const ProcessResult empty = run({"/dev/stdin", "-o", "c.pf_vox"});
    EXPECT_EQ(empty.exitCode, 3);
    EXPECT_THAT(empty.err, HasSubstr("nothing comes out of this pipe"));
}

TEST_F(Vox2pf, namesThatLookLikeSomethingElseAreFilesAllTheSame) {
    addSource("[a,b]");
    addSource("-dash.vox");
    addSource("@at.vox");
    EXPECT_EQ(run({"[a,b]", "-o", "A.PF_VOX"}).exitCode, 0);
    EXPECT_TRUE(exists("A.PF_VOX"));
    EXPECT_EQ(run({"-o", "out/", "--", "-dash.vox", "[a,b]"}).exitCode, 0);
    EXPECT_EQ(run({"./@at.vox", "-o", "out/"}).exitCode, 0);
    EXPECT_THAT(filesBelow("out"), ElementsAre("-dash.pf_vox", "@at.pf_vox", "[a,b].pf_vox"));
    EXPECT_THAT(run({"@at.vox", "-o", "out/"}).err, HasSubstr("the file of that name is ./@at.vox"));
    // An option takes one value, and leaves the input behind it alone.
    EXPECT_EQ(run({"-o", "b.pf_vox", "--vdb-grid", "[x,y]", "-dash.vox"}).exitCode, 2);
    EXPECT_EQ(run({"-o", "b.pf_vox", "--vdb-grid", "[x,y]", "./-dash.vox"}).exitCode, 0);
}

// Of five assets, four of them links, two were converted, without a word.
TEST_F(Vox2pf, everyLinkOfAFolderIsAnAsset) {
    addSource("store/8f14e45f");
    addSource("store/c9f0f895", "statue.vox");
    fs::create_directories(folder / "in/sub");
    for (const char* name : {"a.vox", "b.vox", "sub/c.vox"})
        fs::create_symlink(folder / "store/8f14e45f", folder / "in" / name);
    fs::create_symlink(folder / "store/c9f0f895", folder / "in/d.vox");
    addSource("in/e.vox");
    const ProcessResult result = run({"in", "in/a.vox", "-o", "out"});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_THAT(filesBelow("out"),
                ElementsAre("a.pf_vox", "b.pf_vox", "d.pf_vox", "e.pf_vox", "sub/c.pf_vox"));
    EXPECT_EQ(readText(folder / "out/a.pf_vox"), readText(folder / "out/sub/c.pf_vox"));
    EXPECT_EQ(linesOf(run({"validate", "out"}).out).size(), 5u);
}

TEST_F(Vox2pf, linksThatLeadNowhereFailAndLoopsEnd) {
    addSource("in/a.vox");
    fs::create_symlink("../store/absent", folder / "in/b.vox");
    fs::create_symlink("d.vox", folder / "in/c.vox");
    fs::create_symlink("c.vox", folder / "in/d.vox");
    fs::create_symlink("me@host.123", folder / "in/.#a.vox");  // Emacs edits a.vox
    fs::create_directory_symlink("..", folder / "in/loop");
    const ProcessResult result = run({"in", "-o", "out"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.err, AllOf(HasSubstr("in/b.vox: a link that leads to no file"), HasSubstr("in/c.vox"),
                                  HasSubstr("in/d.vox"), HasSubstr("1 linked folder not searched"),
                                  Not(HasSubstr(".#a"))));
    EXPECT_THAT(filesBelow("out"), ElementsAre("a.pf_vox"));
}

TEST_F(Vox2pf, scenesFindTheOutputOfTheLinkTheyName) {
    addSource("store/x");
    fs::create_directories(folder / "in");
    for (const char* name : {"a.vox", "b.vox"}) fs::create_symlink(folder / "store/x", folder / "in" / name);
    writeText(folder / "in/scene.toml", "[[models]]\npath = \"a.vox\"\n[[models]]\npath = \"b.vox\"\n");
    ASSERT_EQ(run({"in", "-o", "out"}).exitCode, 0);
    EXPECT_EQ(readText(folder / "out/scene.toml"),
              "[[models]]\npath = \"a.pf_vox\"\n[[models]]\npath = \"b.pf_vox\"\n");
}

// One such pair stopped the whole run.
TEST_F(Vox2pf, twoSourcesOfOneOutputFailAndTheOthersGoOn) {
    addSource("in/hall.vox");
    addSource("in/hall.vdb", "statue.vox");
    addSource("in/tree.vox", "tree.vox");
    const ProcessResult result = run({"in", "-o", "out", "--json"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.err, AllOf(HasSubstr("in/hall.vdb: in/hall.vox would become out/hall.pf_vox, too"),
                                  HasSubstr("in/hall.vox: in/hall.vdb would become out/hall.pf_vox, too")));
    EXPECT_THAT(filesBelow("out"), ElementsAre("tree.pf_vox"));
    std::vector<std::string> states;
    for (const std::string& line : linesOf(result.out))
        states.push_back(nlohmann::json::parse(line)["status"]);
    EXPECT_THAT(states, ElementsAre("failed", "failed", "converted"));
    // The same file by two ways is one source.
    fs::remove(folder / "in/hall.vdb");
    fs::create_directory_symlink("in", folder / "other");
    EXPECT_EQ(run({"in", "other", "-o", "out"}).exitCode, 0);
}

TEST_F(Vox2pf, namesThatAreNearlyRightAreNamed) {
    addSource("in/Props/Lamp.vox");
    for (const char* name : {"in/props/lamp.vox", "in\\Props\\Lamp.vox"}) {
        const ProcessResult result = run({name, "-o", "out/"});
        EXPECT_EQ(result.exitCode, 3);
        EXPECT_THAT(result.err, HasSubstr("did you mean in/Props/Lamp.vox?")) << name;
    }
    writeText(folder / "in/Level.Scene.TOML", "[[models]]\npath = \"props\\\\lamp.vox\"\n");
    const ProcessResult scene = run({"in", "-o", "out"});
    EXPECT_EQ(scene.exitCode, 0);
    EXPECT_THAT(scene.err,
                AllOf(HasSubstr("scene-missing-model"), HasSubstr("did you mean Props/Lamp.vox?")));
    EXPECT_THAT(filesBelow("out"), ElementsAre("Level.Scene.TOML", "Props/Lamp.pf_vox"));
}

TEST_F(Vox2pf, patternsTakeBackslashesAndSayWhenOnlyTheCaseIsWrong) {
    addSource("in/props/a.vox");
    const auto convert = [&](const std::string& pattern) {
        writeText(folder / "s.toml",
                  "[[override]]\nfiles = '" + pattern + "'\nimport.voxelSizeMetres = 0.25\n");
        return run({"in", "-o", "out", "--settings", "s.toml"});
    };
    EXPECT_THAT(convert("props\\*").err, IsEmpty());
    EXPECT_THAT(run({"info", "out/props/a.pf_vox"}).out, HasSubstr("0.25 m voxels"));
    const ProcessResult other = convert("Props/*.VOX");
    EXPECT_EQ(other.exitCode, 0);
    EXPECT_THAT(other.err, AllOf(HasSubstr("s.toml"), HasSubstr("would fit props/a.vox in other case"),
                                 HasSubstr("override-case")));
    EXPECT_THAT(convert("rooms/*").err, Not(HasSubstr("override-case"))) << "another run may have such files";
}

// Code pages of others, UTF-16, NUL and control characters as names of nodes, layers and notes.
TEST_F(Vox2pf, namesInOtherEncodingsAreConvertedWithAWarningAndNeverStoredRaw) {
    const std::map<std::string, std::string> names{{"latin1", "Fen\xeatre"},
                                                   {"gbk", "\xb7\xbf\xd7\xd3"},
                                                   {"utf16", std::string("H\0a\0u\0s\0", 8)},
                                                   {"nul", std::string("a\0b", 3)},
                                                   {"escape", "\x1b[31mred\x07"},
                                                   {"lines", "one\ntwo\r\nthree"}};
    for (const auto& [kind, name] : names) {
        VoxWriter writer;
        writer.model({1, 1, 1}, {{0, 0, 0, 1}})
            .transform({.id = 0, .child = 1, .attributes = {{"_name", name}}, .layer = 0})
            .shape({.id = 1})
            .layer(0, {{"_name", name}})
            .chunk("NOTE", voxInts({1}) + voxString(name));
        writeText(folder / (kind + ".vox"), writer.finish());
        const ProcessResult result = run({kind + ".vox", "-o", kind + ".pf_vox"});
        EXPECT_EQ(result.exitCode, 0) << kind << ": " << result.err;
        const bool isText = kind == "escape" || kind == "lines" || kind == "nul" || kind == "utf16";
        EXPECT_EQ(result.err.empty(), isText) << kind << ": " << result.err;
        const ProcessResult info = run({"info", "--json", kind + ".pf_vox"});
        const auto object = nlohmann::json::parse(info.out);  // refuses what is not UTF-8
        EXPECT_THAT(info.out, Not(HasSubstr("\xef\xbf\xbd"))) << kind << ": not even in place of raw bytes";
        EXPECT_EQ(object["instances"].size(), 1u);
        const std::string text = run({"info", "-v", kind + ".pf_vox"}).out;
        EXPECT_TRUE(
            std::ranges::none_of(text, [](char c) { return c == '\x1b' || c == '\x07' || c == '\0'; }))
            << kind << ": " << text;
        EXPECT_THAT(text, Not(HasSubstr("\ntwo"))) << kind;
    }
}

}  // namespace pfvox::test

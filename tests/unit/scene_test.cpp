// scene.toml: every key, every complaint with its place, the canonical text, and paths replaced in place.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <pfvox/scene.hpp>

#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kWhole = R"(probeGridPos = [-1.0, 0.0, -1.5]
probeGridStep = 1.5
probeGridCount = [8, 4, 9]
proximityGridSize = [64, 32, 16]
[sun]
direction = [-0.4, -1, -0.3]
irradiance = [3.0, 2.5, 2]
[sky]
zenith = [0.1, 0.2, 0.3]
horizon = [0.4, 0.5, 0.6]
ground = [0.7, 0.8, 0.9]
[[cameras]]
name = "front"
position = [0, 1.5, 10]
target = [0, 1, 0]
fovYDegrees = 50
[[models]]
path = "hall.pf_vox"
name = "hall"
translateVec = [1, 2, 3]
rotateVec = [0.1, 0.2, 0.3]
scaleVec = [4, -4.5, 5]
visible = false
[[models]]
path = 'props/door.pf_vox'
metresPerVoxel = 0.05
)";

struct Parsed {
    Result<Scene> scene;
    std::vector<Diagnostic> diagnostics;
};
Parsed parse(const std::string& text, const Limits& limits = {}) {
    DiagnosticList diagnostics;
    Result<Scene> scene = parseScene(text, "test.toml", limits, diagnostics);
    return {std::move(scene), diagnostics.entries()};
}

Scene parsed(const std::string& text) {
    Parsed p = parse(text);
    EXPECT_TRUE(p.scene) << describe(p.scene.error());
    EXPECT_THAT(p.diagnostics, IsEmpty());
    return p.scene ? *p.scene : Scene{};
}

TEST(SceneFile, EveryKeyIsRead) {
    const Scene scene = parsed(kWhole);
    EXPECT_EQ(scene.probes.position, glm::dvec3(-1.0, 0.0, -1.5));
    EXPECT_EQ(scene.probes.stepMetres, glm::dvec3(1.5));
    EXPECT_EQ(scene.probes.count, glm::uvec3(8, 4, 9));
    EXPECT_EQ(scene.probes.proximityCells, glm::uvec3(64, 32, 16));
    EXPECT_EQ(scene.sun.direction, glm::dvec3(-0.4, -1.0, -0.3)) << "integers stand for floats";
    EXPECT_EQ(scene.sun.irradiance, glm::dvec3(3.0, 2.5, 2.0));
    EXPECT_EQ(scene.sky.zenith, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(scene.sky.horizon, glm::dvec3(0.4, 0.5, 0.6));
    EXPECT_EQ(scene.sky.ground, glm::dvec3(0.7, 0.8, 0.9));
    EXPECT_THAT(scene.cameras, ElementsAre(Camera{"front", {0.0, 1.5, 10.0}, {0.0, 1.0, 0.0}, 50.0}));
    ASSERT_EQ(scene.models.size(), 2u);
    const SceneModel hall{.path = "hall.pf_vox",
                          .name = "hall",
                          .translateMetres = {1.0, 2.0, 3.0},
                          .rotateRadians = {0.1, 0.2, 0.3},
                          .cubeEdgeMetres = glm::dvec3(4.0, -4.5, 5.0),
                          .metresPerVoxel = std::nullopt,
                          .visible = false};
    EXPECT_EQ(scene.models[0], hall);
    EXPECT_EQ(scene.models[1].path, "props/door.pf_vox");
    EXPECT_EQ(scene.models[1].metresPerVoxel, 0.05);
    EXPECT_FALSE(scene.models[1].cubeEdgeMetres);
    EXPECT_TRUE(scene.models[1].visible);
}

TEST(SceneFile, WhatIsLeftOutHasItsDefault) {
    EXPECT_EQ(parsed(""), Scene{});
    const Scene scene = parsed("[[models]]\npath = 'a.pf_vox'\n[sky]\nzenith = [1, 2, 3]\n");
    EXPECT_EQ(scene.models[0], SceneModel{.path = "a.pf_vox"});
    EXPECT_EQ(scene.sky.zenith, glm::dvec3(1.0, 2.0, 3.0));
    EXPECT_EQ(scene.sky.ground, Sky{}.ground);
    EXPECT_FALSE(scene.probes.position || scene.probes.stepMetres || scene.probes.count);
    EXPECT_EQ(scene.probes.proximityCells, glm::uvec3(64));
}

TEST(SceneFile, TheExampleOfTheThesisIsRead) {
    const Scene scene = parsed(R"(probeGridPos = [ -1.0, 0.0, -1.0 ]
probeGridStep = 1.5
proximityGridSize = [ 64, 64, 64 ]

[[models]]
path = '/chair.vox'
rotateVec = [ 0.0, 0.0, 0.0 ]
scaleVec = [ 4.0, 4.0, 4.0 ]
translateVec = [ 0.0, 0.0, 0.0 ]
)");
    EXPECT_EQ(scene.models[0].cubeEdgeMetres, glm::dvec3(4.0));
}

TEST(SceneFile, StepsMayDifferByAxisAndASkyMayBeConstant) {
    EXPECT_EQ(parsed("probeGridStep = [1, 2, 3.5]").probes.stepMetres, glm::dvec3(1.0, 2.0, 3.5));
    const Scene scene = parsed("[sky]\nradiance = [1, 1, 2]");
    EXPECT_TRUE(scene.sky.isConstant());
    EXPECT_EQ(scene.sky.ground, glm::dvec3(1.0, 1.0, 2.0));
}

struct Fault {
    const char* text;
    const char* place;
    const char* message;
    ErrorCode code = ErrorCode::BadValue;
};

void PrintTo(const Fault& fault, std::ostream* out) {
    *out << fault.place << ": " << fault.message;
}

class SceneFaults : public ::testing::TestWithParam<Fault> {};

TEST_P(SceneFaults, HaveFileLineAndColumn) {
    const Fault& fault = GetParam();
    const Parsed p = parse(fault.text);
    ASSERT_FALSE(p.scene) << fault.text;
    EXPECT_EQ(p.scene.error().code, fault.code) << fault.text;
    EXPECT_EQ(p.scene.error().file, "test.toml");
    EXPECT_EQ(p.scene.error().context, fault.place) << fault.text << "\n" << describe(p.scene.error());
    EXPECT_THAT(p.scene.error().message, HasSubstr(fault.message)) << fault.text;
}

constexpr const char* kModel = "line 1, column 1";
INSTANTIATE_TEST_SUITE_P(
    All, SceneFaults,
    ::testing::Values(
        Fault{"probeGridPos = 1", "line 1, column 16", "list of 3 numbers"},
        Fault{"probeGridPos = [1, 2]", "line 1, column 16", "list of 3 numbers"},
        Fault{"probeGridPos = [1, 2, 3, 4]", "line 1, column 16", "list of 3 numbers"},
        Fault{"probeGridPos = [1, 2, nan]", "line 1, column 23", "from -1000000000 to"},
        Fault{"probeGridPos = [1, -inf, 0]", "line 1, column 20", "from -1000000000 to"},
        Fault{"probeGridPos = [1, 'x', 0]", "line 1, column 20", "list of 3 numbers"},
        Fault{"probeGridPos = [1, true, 0]", "line 1, column 20", "list of 3 numbers"},
        Fault{"probeGridStep = 0", "line 1, column 17", "from 1e-06 to"},
        Fault{"probeGridStep = -1.5", "line 1, column 17", "from 1e-06 to"},
        Fault{"probeGridStep = 'one'", "line 1, column 17", "probeGridStep is a number"},
        Fault{"probeGridStep = [1, 0, 1]", "line 1, column 21", "from 1e-06 to"},
        Fault{"probeGridCount = 8", "line 1, column 18", "3 whole numbers from 1 to 1024"},
        Fault{"probeGridCount = [8, 8, 1.5]", "line 1, column 18", "whole"},
        Fault{"probeGridCount = [8, 0, 8]", "line 1, column 22", "from 1 to 1024"},
        Fault{"probeGridCount = [8, 8, 1025]", "line 1, column 25", "from 1 to 1024"},
        Fault{"probeGridCount = [1024, 1024, 2]", "line 1, column 18", "at most 1048576 probes"},
        Fault{"proximityGridSize = [64, 64, 513]", "line 1, column 30", "from 1 to 512"},
        Fault{"sun = 3", "line 1, column 7", "[sun]"},
        Fault{"[sun]\ndirection = [0, 0, 0]", "line 1, column 1", "no length"},
        Fault{"[sun]\nirradiance = [1, 1, -1]", "line 2, column 21", "from 0 to"},
        Fault{"sky = 'blue'", "line 1, column 7", "[sky]"},
        Fault{"[sky]\nradiance = 1.0", "line 2, column 12", "list of 3 numbers"},
        Fault{"[sky]\nradiance = [1, 1, 1]\nground = [1, 1, 1]", "line 1, column 1", "either radiance or"},
        Fault{"cameras = 1", "line 1, column 11", "[[cameras]]"},
        Fault{"[cameras]\nname = 'x'", "line 1, column 1", "[[cameras]]"},
        Fault{"[[cameras]]\nposition = [1, 2, 3]", "line 1, column 1", "position and target"},
        Fault{"[[cameras]]\nposition = [1, 2, 3]\ntarget = [1, 2, 3]", "line 1, column 1", "the same"},
        Fault{"[[cameras]]\nposition = [1, 2, 3]\ntarget = [0, 0, 0]\nfovYDegrees = 180", "line 4, column 15",
              "from 1 to 170"},
        Fault{"[[cameras]]\nposition = [1, 2, 3]\ntarget = [0, 0, 0]\nname = 5", "line 4, column 8",
              "in quotes"},
        Fault{"models = [1, 2]", "line 1, column 10", "[[models]]"},
        Fault{"[[models]]\nname = 'x'", kModel, "needs path"},
        Fault{"[[models]]\npath = ''", "line 2, column 8", "path is empty"},
        Fault{"[[models]]\npath = 7", "line 2, column 8", "in quotes"},
        Fault{"[[models]]\npath = \"a\\u0000b\"", "line 2, column 8", "without NUL"},
        Fault{"[[models]]\npath = 'a'\nscaleVec = [1, 0, 1]", "line 3, column 12", "cannot be inverted"},
        Fault{"[[models]]\npath = 'a'\nscaleVec = [1, 1e-300, 1]", "line 3, column 12", "cannot be inverted"},
        Fault{"[[models]]\npath = 'a'\nscaleVec = 4.0", "line 3, column 12", "list of 3 numbers"},
        Fault{"[[models]]\npath = 'a'\nscaleVec = [1, 1, inf]", "line 3, column 19", "from -1000000000"},
        Fault{"[[models]]\npath = 'a'\nmetresPerVoxel = 0", "line 3, column 18", "from 1e-06 to 1000000"},
        Fault{"[[models]]\npath = 'a'\nscaleVec = [1, 1, 1]\nmetresPerVoxel = 1", "line 3, column 12",
              "either scaleVec or metresPerVoxel"},
        Fault{"[[models]]\npath = 'a'\nrotateVec = [0, nan, 0]", "line 3, column 17", "rotateVec"},
        Fault{"[[models]]\npath = 'a'\ntranslateVec = [0, 0]", "line 3, column 16", "translateVec"},
        Fault{"[[models]]\npath = 'a'\nvisible = 1", "line 3, column 11", "true or false"},
        Fault{"probeGridStep = ", "line 1, column 17", "", ErrorCode::BadStructure},
        Fault{"a = 1\na = 2", "line 2, column 5", "", ErrorCode::BadStructure},
        Fault{"# \xc3\xa4\nname = \"\xff\"", "line 2, column 8", "", ErrorCode::BadStructure}));

TEST(SceneFile, SeveralFaultsAreToldInOneRunInTheOrderOfTheText) {
    const Parsed p = parse("probeGridStep = 0\nproximityGridSize = 1\n[[models]]\nname = 1\n");
    ASSERT_FALSE(p.scene);
    const std::string text = describe(p.scene.error());
    EXPECT_THAT(text, HasSubstr("test.toml: line 1, column 17: probeGridStep"));
    EXPECT_THAT(text, HasSubstr("\n  line 2, column 21: proximityGridSize"));
    EXPECT_THAT(text, HasSubstr("\n  line 3, column 1: a model needs path"));
    EXPECT_THAT(text, HasSubstr("\n  line 4, column 8: name"));
}

TEST(SceneFile, ManyFaultsAreCounted) {
    std::string text;
    for (int i = 0; i < 25; ++i) text += "[[models]]\n";
    const Parsed p = parse(text);
    ASSERT_FALSE(p.scene);
    EXPECT_THAT(p.scene.error().message, AllOf(HasSubstr("line 10, column 1"), HasSubstr("and 15 more")));
}

TEST(SceneFile, UnknownKeysAreWarnedAboutWithPlaceAndWhatThereIs) {
    const Parsed p = parse("[sun]\ncolor = 1\n[[models]]\npath = 'a'\nscale = 2\n[extra]\nx = 1\n");
    EXPECT_TRUE(p.scene);
    ASSERT_EQ(p.diagnostics.size(), 3u);
    EXPECT_EQ(p.diagnostics[0].id, "scene-unknown-key");
    EXPECT_THAT(p.diagnostics[0].message,
                AllOf(HasSubstr("line 2, column 1: unknown key color"), HasSubstr("direction, irradiance")));
    EXPECT_THAT(p.diagnostics[1].message, AllOf(HasSubstr("line 5, column 1"), HasSubstr("scaleVec")));
    EXPECT_THAT(p.diagnostics[2].message, AllOf(HasSubstr("line 6, column 2"), HasSubstr("extra")));
}

TEST(SceneFile, WarningsWithoutEndAreCounted) {
    std::string text;
    for (int i = 0; i < 150; ++i) text += "key" + std::to_string(i) + " = 1\n";
    const Parsed p = parse(text);
    EXPECT_TRUE(p.scene);
    ASSERT_EQ(p.diagnostics.size(), 101u);
    EXPECT_THAT(p.diagnostics[99].message, HasSubstr("line 100, column 1"));
    EXPECT_EQ(p.diagnostics[100].id, "scene-more-warnings");
    EXPECT_THAT(p.diagnostics[100].message, HasSubstr("50 more"));
}

TEST(SceneFile, TwoCamerasOfOneNameAreWarnedAbout) {
    const std::string camera = "[[cameras]]\nname = 'a'\nposition = [1, 2, 3]\ntarget = [0, 0, 0]\n";
    const Parsed p = parse(camera + camera);
    EXPECT_TRUE(p.scene);
    ASSERT_EQ(p.diagnostics.size(), 1u);
    EXPECT_EQ(p.diagnostics[0].id, "scene-duplicate-camera");
}

TEST(SceneFile, LimitsAreKept) {
    const Parsed p = parse("[[models]]\npath = 'a'\n[[models]]\npath = 'b'\n", Limits{.maxModels = 1});
    ASSERT_FALSE(p.scene);
    EXPECT_EQ(p.scene.error().code, ErrorCode::LimitExceeded);
    EXPECT_EQ(p.scene.error().context, "line 3, column 1");
    EXPECT_THAT(p.scene.error().message, HasSubstr("maxModels = 1"));

    const Parsed large = parse(std::string(kMaxSceneBytes + 1, '#'));
    ASSERT_FALSE(large.scene);
    EXPECT_EQ(large.scene.error().code, ErrorCode::LimitExceeded);
}

TEST(SceneFile, MissingFileFolderAndHugeFile) {
    const TempFolder folder;
    DiagnosticList diagnostics;
    const auto codeOf = [&](const std::filesystem::path& file, const Limits& limits = {}) {
        const auto scene = readScene(file, limits, diagnostics);
        return scene ? ErrorCode::Internal : scene.error().code;
    };
    EXPECT_EQ(codeOf(folder / "none.toml"), ErrorCode::FileNotFound);
    EXPECT_EQ(codeOf(folder.path()), ErrorCode::FileNotReadable);
    writeText(folder / "huge.toml", "");
    std::filesystem::resize_file(folder / "huge.toml", std::uint64_t{1} << 40);
    EXPECT_EQ(codeOf(folder / "huge.toml"), ErrorCode::LimitExceeded);
    writeText(folder / "small.toml", kWhole);
    EXPECT_EQ(codeOf(folder / "small.toml", Limits{.maxFileBytes = 100}), ErrorCode::LimitExceeded);
}

TEST(SceneFile, CanonicalTextReadsBack) {
    const Scene scene = parsed(kWhole);
    EXPECT_EQ(parsed(sceneText(scene)), scene);
    EXPECT_EQ(sceneText(parsed(sceneText(scene))), sceneText(scene));
    EXPECT_EQ(parsed(sceneText(Scene{})), Scene{});
}

TEST(SceneFile, WrittenFileIsTheCanonicalText) {
    const TempFolder folder;
    const Scene scene = parsed(kWhole);
    ASSERT_TRUE(writeScene(folder / "new/s.toml", scene));
    EXPECT_EQ(readText(folder / "new/s.toml"), sceneText(scene));
}

TEST(SceneFile, WhatNoFileMayHoldIsNotWritten) {
    const TempFolder folder;
    writeText(folder / "s.toml", "before");
    Scene scene;
    scene.sun.direction.x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(writeScene(folder / "s.toml", scene));
    scene = {};
    scene.models.push_back({.path = ""});
    EXPECT_FALSE(writeScene(folder / "s.toml", scene));
    scene.models[0].path = "not utf-8: \xff";
    EXPECT_FALSE(writeScene(folder / "s.toml", scene));
    scene.models[0] = {.path = "a", .cubeEdgeMetres = glm::dvec3(1.0), .metresPerVoxel = 1.0};
    EXPECT_FALSE(writeScene(folder / "s.toml", scene));
    EXPECT_EQ(readText(folder / "s.toml"), "before");
}

// ---- Paths replaced in the text ---------------------------------------------------------------------------

std::string replaced(const std::string& text, const std::string& with) {
    DiagnosticList diagnostics;
    const auto edited = withModelPaths(text, "test.toml", {}, diagnostics,
                                       [&](const ModelPathUse&) { return std::optional(with); });
    EXPECT_TRUE(edited) << describe(edited.error());
    return edited.value_or("");
}

TEST(ScenePaths, NothingButThePathsChanges) {
    const std::string before =
        "\xef\xbb\xbf# Gr\xc3\xbc\xc3\x9f"
        "e; path = \"no\"\r\n\r\n[[models]]   # one\r\n\tpath   =   "
        "\"\xc3\xa4 hall.vox\"  # path\r\nfuture = { a = [1,\n2] }\n[[models]]\n'path' = 'two.vox'\n"
        "name = 'path = \"x.vox\"'\n";
    const std::string after =
        "\xef\xbb\xbf# Gr\xc3\xbc\xc3\x9f"
        "e; path = \"no\"\r\n\r\n[[models]]   # one\r\n\tpath   =   "
        "\"new.pf_vox\"  # path\r\nfuture = { a = [1,\n2] }\n[[models]]\n'path' = 'new.pf_vox'\n"
        "name = 'path = \"x.vox\"'\n";
    EXPECT_EQ(replaced(before, "new.pf_vox"), after);
}

TEST(ScenePaths, EveryKindOfStringAndInlineTables) {
    EXPECT_EQ(replaced("[[models]]\npath = \"\"\"\nlong \\\n  path\"\"\" # c\n", "n"),
              "[[models]]\npath = \"n\" # c\n");
    EXPECT_EQ(replaced("[[models]]\npath = '''a'b'''\n", "n"), "[[models]]\npath = \"n\"\n");
    EXPECT_EQ(replaced("models = [{path = 'a', name = 'b'}, {name = 'd', path = \"c\"}]", "n"),
              "models = [{path = 'n', name = 'b'}, {name = 'd', path = \"n\"}]");
    EXPECT_EQ(replaced("\xef\xbb\xbfmodels = [{path='a'}]", "n"), "\xef\xbb\xbfmodels = [{path='n'}]");
    EXPECT_EQ(replaced("models = [{path='a'},{path='b'}]", "longer than before"),
              "models = [{path='longer than before'},{path='longer than before'}]");
}

TEST(ScenePaths, QuotesAndControlCharactersInNewPathsAreEscaped) {
    EXPECT_EQ(replaced("[[models]]\npath = 'a'", "it's"), "[[models]]\npath = \"it's\"");
    EXPECT_EQ(replaced("[[models]]\npath = \"a\"", "q\"b\\c\n"), "[[models]]\npath = \"q\\\"b\\\\c\\u000a\"");
}

TEST(ScenePaths, ThePlaceIsThatOfTheString) {
    DiagnosticList diagnostics;
    std::vector<std::string> places;
    const std::string text = "[[models]]\n# \xc3\xa4\npath = 'a'\n[[models]]\n  path='b'";
    const auto edited = withModelPaths(text, "t", {}, diagnostics, [&](const ModelPathUse& use) {
        places.push_back(use.model.path + " " + use.place);
        return std::nullopt;
    });
    ASSERT_TRUE(edited);
    EXPECT_EQ(*edited, text);
    EXPECT_THAT(places, ElementsAre("a line 3, column 8", "b line 5, column 8"));
}

TEST(ScenePaths, ABrokenSceneIsAnError) {
    DiagnosticList diagnostics;
    const auto edited = withModelPaths("[[models]]", "t.toml", {}, diagnostics,
                                       [](const ModelPathUse&) { return std::nullopt; });
    ASSERT_FALSE(edited);
    EXPECT_EQ(edited.error().context, "line 1, column 1");
}

}  // namespace
}  // namespace pfvox::test

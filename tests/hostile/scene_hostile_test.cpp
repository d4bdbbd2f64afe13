// Scene files that lie: cut off, with bits flipped, nested without end, made of noise.
#include <gtest/gtest.h>

#include <pfvox/scene.hpp>
#include <random>

#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

/// Reads, and does with what was accepted what a tool does. Returns whether it was accepted.
bool survives(const std::string& text) {
    DiagnosticList diagnostics;
    const auto scene = parseScene(text, "hostile.toml", {}, diagnostics);
    if (!scene) {
        EXPECT_EQ(scene.error().file, "hostile.toml");
        EXPECT_FALSE(scene.error().context.empty()) << describe(scene.error());
        return false;
    }
    const auto again = parseScene(sceneText(*scene), "again.toml", {}, diagnostics);
    EXPECT_TRUE(again && *again == *scene) << text;
    const auto edited = withModelPaths(text, "hostile.toml", {}, diagnostics,
                                       [](const ModelPathUse&) { return "elsewhere/x.pf_vox"; });
    EXPECT_TRUE(edited) << text << "\n" << describe(edited.error());
    return true;
}

std::string demoScene() {
    return readText(std::filesystem::path(PFVOX_DATA_DIR) / "scene.toml");
}

TEST(SceneHostile, EveryPrefix) {
    const std::string whole = demoScene();
    std::size_t accepted = 0;
    for (std::size_t size = 0; size <= whole.size(); ++size)
        accepted += survives(whole.substr(0, size)) ? 1u : 0u;
    EXPECT_GT(accepted, 10u) << "a scene may end after any line";
    EXPECT_LT(accepted, whole.size());
}

TEST(SceneHostile, EveryBitFlipped) {
    const std::string whole =
        "probeGridStep=1.5\nprobeGridCount=[8,4,9]\n[sun]\ndirection=[-0.4,-1,-0.3]\n[sky]\nradiance=[1,1,1]#"
        "x\n"
        "[[cameras]]\nname='a'\nposition=[0,1.5,10]\ntarget=[0,1,0]\nfovYDegrees=50\n[[models]]\n"
        "path=\"h\\u00e4ll.pf_vox\"\nscaleVec=[4,-4.5,5]\nvisible=false\n[[models]]\npath='d'"
        "\nmetresPerVoxel=1e-2\n";
    for (std::size_t i = 0; i < whole.size(); ++i) {
        for (int bit = 0; bit < 8; ++bit) {
            std::string text = whole;
            text[i] = static_cast<char>(text[i] ^ (1 << bit));
            survives(text);
        }
    }
}

TEST(SceneHostile, SplicedAndRepeatedPieces) {
    std::mt19937 random(7);
    const std::string whole = demoScene();
    const auto at = [&] { return std::uniform_int_distribution<std::size_t>(0, whole.size())(random); };
    for (int i = 0; i < 3000; ++i)
        survives(whole.substr(0, at()) + whole.substr(at(), at() % 200) + whole.substr(at()));
}

std::string repeated(std::string_view piece, std::size_t times) {
    std::string text;
    for (std::size_t i = 0; i < times; ++i) text += piece;
    return text;
}

TEST(SceneHostile, DeepNestingIsRefusedBeforeItIsBuilt) {
    constexpr std::size_t kDeep = 1'000'000;
    for (const std::string& text :
         {repeated("a.", kDeep) + "a = 1", "[" + repeated("a.", kDeep) + "a]", "x = " + repeated("[", kDeep),
          "x = " + repeated("{a=", kDeep), repeated("'a' . ", kDeep) + "a = 1",
          "x = {\"#\"." + repeated("a.", kDeep) + "a=1}",
          "x = '''\n''''' # \"\n" + repeated("a.", kDeep) + "a = 1",
          "x = \"\\\"\"\n" + repeated("a.", kDeep) + "a = 1",
          repeated("a.", 31) + "a = " + repeated("{" + repeated("a.", 31) + "a = ", 40)}) {
        DiagnosticList diagnostics;
        const auto scene = parseScene(text, "deep.toml", {}, diagnostics);
        ASSERT_FALSE(scene);
        EXPECT_EQ(scene.error().code, ErrorCode::BadStructure);
        EXPECT_NE(scene.error().message.find("levels deep"), std::string::npos) << text.substr(0, 80);
    }
}

TEST(SceneHostile, NestingThatIsAllowedIsBuilt) {
    std::string text = repeated("a.", 31) + "a = ";
    for (int i = 0; i < 31; ++i) text += "{" + repeated("a.", 31) + "a = ";
    EXPECT_TRUE(survives(text + "1" + repeated("}", 31)));
    EXPECT_TRUE(survives("# " + repeated("..........", 20) + "\n[[models]]\npath = '" + repeated("../", 100) +
                         "a'\n"));
}

TEST(SceneHostile, ManyModelsAndManyFaultsStayQuick) {
    // Quadratic work would take minutes here.
    EXPECT_TRUE(survives(repeated("[[models]]\npath='a'\n", 100000)));
    EXPECT_TRUE(survives("models = [" + repeated("{path='a'},", 100000) + "]"));
    EXPECT_FALSE(survives(repeated("[[models]]\n", 100000)));
    EXPECT_FALSE(survives(repeated("[[models]]\npath=1\nvisible=2\n", 50000)));
}

}  // namespace
}  // namespace pfvox::test

// read(write(scene)) is the scene, for random scenes with awkward numbers and names.
#include <gtest/gtest.h>

#include <cmath>
#include <pfvox/scene.hpp>
#include <random>

namespace pfvox::test {
namespace {

class RandomScene {
  public:
    explicit RandomScene(std::uint32_t seed) : random_(seed) {}

    Scene make() {
        Scene scene;
        if (chance()) scene.probes.position = vector(-1e9, 1e9);
        if (chance()) scene.probes.stepMetres = chance() ? glm::dvec3(magnitude(1e-6, 1e9)) : scales();
        if (chance()) scene.probes.count = counts(100);
        scene.probes.proximityCells = counts(512);
        do {
            scene.sun.direction = vector(-1.0, 1.0);
        } while (glm::length(scene.sun.direction) < 1e-3);
        scene.sun.irradiance = light();
        scene.sky = {.zenith = light(), .horizon = light(), .ground = light()};
        if (chance()) scene.sky.horizon = scene.sky.ground = scene.sky.zenith;
        for (int i = integer(0, 4); i > 0; --i) scene.cameras.push_back(camera());
        for (int i = integer(0, 6); i > 0; --i) scene.models.push_back(model());
        return scene;
    }

  private:
    bool chance() { return integer(0, 1) != 0; }
    int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    double magnitude(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
    /// Whole numbers, zeroes and all bits of a double.
    double number(double low, double high) {
        switch (integer(0, 3)) {
            case 0:
                return 0.0;
            case 1:
                return std::round(uniform(std::max(low, -1e6), std::min(high, 1e6)));
            case 2:
                return std::min(magnitude(1e-300, 1e9), high);
            default:
                return uniform(low, high);
        }
    }
    glm::dvec3 vector(double low, double high) {
        return {number(low, high), number(low, high), number(low, high)};
    }
    glm::dvec3 light() { return vector(0.0, 1e9); }
    glm::dvec3 scales() { return {magnitude(1e-6, 1e9), magnitude(1e-6, 1e9), magnitude(1e-6, 1e9)}; }
    glm::uvec3 counts(int high) {
        return glm::uvec3(glm::ivec3(integer(1, high), integer(1, high), integer(1, high)));
    }

    std::string text() {
        const std::string pieces[] = {"a", "B ",   "\"", "\\", "'", "\n", "\t", "\x01",   "\x7f", "#",
                                      "é", "日本", "😀",  "=",  "[", "]",  "\r", "\"\"\"", "\\u",  "."};
        std::string text;
        for (int i = integer(0, 12); i > 0; --i) text += pieces[integer(0, std::size(pieces) - 1)];
        return text;
    }
    Camera camera() {
        Camera camera{.name = text(), .position = vector(-1e9, 1e9), .fovYDegrees = uniform(1.0, 170.0)};
        camera.target = camera.position;
        camera.target.z = camera.position.z == 0.0 ? 1.0 : 0.5 * camera.position.z;
        return camera;
    }
    SceneModel model() {
        SceneModel model{.path = "x" + text(),
                         .name = text(),
                         .translateMetres = vector(-1e9, 1e9),
                         .rotateRadians = vector(-1e6, 1e6),
                         .visible = chance()};
        if (chance()) {
            model.cubeEdgeMetres = scales() * glm::dvec3(chance() ? -1.0 : 1.0, 1.0, chance() ? -1.0 : 1.0);
        } else if (chance()) {
            model.metresPerVoxel = magnitude(1e-6, 1e6);
        }
        return model;
    }

    std::mt19937 random_;
};

TEST(SceneProperty, WhatIsWrittenReadsBack) {
    for (std::uint32_t seed = 0; seed < 500; ++seed) {
        const Scene scene = RandomScene(seed).make();
        const std::string text = sceneText(scene);
        DiagnosticList diagnostics;
        const auto again = parseScene(text, "random.toml", {}, diagnostics);
        ASSERT_TRUE(again) << seed << ": " << describe(again.error()) << "\n" << text;
        ASSERT_TRUE(*again == scene) << seed << "\n" << text << "\n" << sceneText(*again);
        ASSERT_EQ(sceneText(*again), text) << seed;
    }
}

TEST(SceneProperty, NewPathsChangeNothingElse) {
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        Scene scene = RandomScene(seed).make();
        DiagnosticList diagnostics;
        const auto edited =
            withModelPaths(sceneText(scene), "random.toml", {}, diagnostics,
                           [](const ModelPathUse& use) { return use.model.path + "'\"\n." + use.place; });
        ASSERT_TRUE(edited) << seed << ": " << describe(edited.error());
        const auto again = parseScene(*edited, "random.toml", {}, diagnostics);
        ASSERT_TRUE(again) << seed;
        ASSERT_EQ(again->models.size(), scene.models.size());
        for (std::size_t i = 0; i < scene.models.size(); ++i) {
            ASSERT_TRUE(again->models[i].path.starts_with(scene.models[i].path + "'\"\n.line "));
            scene.models[i].path = again->models[i].path;
        }
        ASSERT_TRUE(*again == scene) << seed;
    }
}

}  // namespace
}  // namespace pfvox::test

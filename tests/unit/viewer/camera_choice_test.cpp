// Which camera --camera means.
#include "camera_choice.hpp"

#include <gmock/gmock.h>

#include <array>

#include "options.hpp"

namespace pfvox::viewer {
namespace {

Scene sceneWith(std::initializer_list<const char*> names) {
    Scene scene;
    for (const char* name : names) {
        const auto x = static_cast<double>(scene.cameras.size() + 10);
        scene.cameras.push_back({.name = name, .position = {x, 0, 0}, .target = {0, 0, 0}});
    }
    return scene;
}

CameraRequest requested(const char* text) {
    const std::array arguments{"pfview", "s.toml", "--screenshot", "a.png", "--camera", text};
    const auto options = parseOptions(static_cast<int>(arguments.size()), arguments.data());
    EXPECT_TRUE(std::holds_alternative<Options>(options)) << text;
    return std::get<Options>(options).camera;
}

// A name with a comma could not be chosen.
TEST(CameraChoice, namesGoBeforeNumbersAndMayHoldCommas) {
    const Scene scene = sceneWith({"hall, east", "1,2,3,4,5,6", "1,2"});
    const auto x = [&](const char* text) {
        const auto camera = chosenCamera(requested(text), "s.toml", scene);
        EXPECT_TRUE(camera && *camera) << text;
        return camera && *camera ? (*camera)->position.x : -1.0;
    };
    EXPECT_EQ(x("hall, east"), 10.0);
    EXPECT_EQ(x("1,2,3,4,5,6"), 11.0);
    EXPECT_EQ(x("7,2,3,4,5,6"), 7.0);
}

TEST(CameraChoice, otherTextsNameWhatThereIs) {
    const auto camera = chosenCamera(requested("hall,west"), "s.toml", sceneWith({"hall, east"}));
    ASSERT_FALSE(camera);
    EXPECT_THAT(camera.error().message,
                testing::AllOf(testing::HasSubstr("'hall, east'"), testing::HasSubstr("px,py,pz")));
}

}  // namespace
}  // namespace pfvox::viewer

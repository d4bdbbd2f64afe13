// Flights through a scene.
#include "camera_path.hpp"

#include <gmock/gmock.h>

namespace pfvox::test {
namespace {

using ::testing::HasSubstr;
using viewer::CameraPath;
using viewer::ViewCamera;

constexpr const char* kThree =
    R"({"cameras": [{"position": [0, 0, 9], "target": [0, 0, 0]},
                    {"position": [4, 1, 5], "target": [0, 1, 0], "fovYDegrees": 60},
                    {"position": [8, 0, 0], "target": [0, 0, 0], "fovYDegrees": 20}]})";

TEST(CameraPath, GoesThroughItsCameras) {
    const Result<CameraPath> path = CameraPath::parse(kThree);
    ASSERT_TRUE(path) << describe(path.error());
    EXPECT_EQ(path->at(0.0), (ViewCamera{.position = {0, 0, 9}, .target = {0, 0, 0}, .fovYDegrees = 40}));
    EXPECT_EQ(path->at(0.5), (ViewCamera{.position = {4, 1, 5}, .target = {0, 1, 0}, .fovYDegrees = 60}));
    EXPECT_EQ(path->at(1.0), (ViewCamera{.position = {8, 0, 0}, .target = {0, 0, 0}, .fovYDegrees = 20}));
    EXPECT_EQ(path->at(-3.0), path->at(0.0));
    EXPECT_EQ(path->at(7.0), path->at(1.0));
    EXPECT_EQ(path->atFrame(0, 5), path->at(0.0));
    EXPECT_EQ(path->atFrame(2, 5), path->at(0.5));
    EXPECT_EQ(path->atFrame(4, 5), path->at(1.0));
    EXPECT_EQ(path->atFrame(0, 1), path->at(0.0));
}

TEST(CameraPath, HasNoCorners) {
    const CameraPath path = CameraPath::parse(kThree).value();
    const double h = 1e-6;
    const glm::dvec3 before = (path.at(0.5).position - path.at(0.5 - h).position) / h;
    const glm::dvec3 after = (path.at(0.5 + h).position - path.at(0.5).position) / h;
    EXPECT_NEAR(glm::length(before - after), 0.0, 1e-3);
}

TEST(CameraPath, OneCameraStandsStill) {
    const CameraPath path =
        CameraPath::parse(R"({"cameras": [{"position": [1, 2, 3], "target": [0, 0, 0]}]})").value();
    EXPECT_EQ(path.at(0.7), path.at(0.0));
}

TEST(CameraPath, ErrorsNameTheCamera) {
    const auto message = [](const char* text) {
        const Result<CameraPath> path = CameraPath::parse(text);
        return path ? std::string("none") : path.error().message;
    };
    EXPECT_THAT(message("{"), HasSubstr("not JSON"));
    EXPECT_THAT(message("[]"), HasSubstr("no list 'cameras'"));
    EXPECT_THAT(message(R"({"cameras": []})"), HasSubstr("no list 'cameras'"));
    EXPECT_THAT(message(R"({"cameras": [7]})"), HasSubstr("camera 1: is no object"));
    EXPECT_THAT(message(R"({"cameras": [{"position": [1, 2], "target": [0, 0, 0]}]})"),
                HasSubstr("camera 1: position"));
    EXPECT_THAT(message(R"({"cameras": [{"position": [1, 2, 1e999], "target": [0, 0, 0]}]})"),
                ::testing::Ne("none"));
    EXPECT_THAT(message(R"({"cameras": [{"position": [1, 2, 3], "target": [1, 2, 3]}]})"),
                HasSubstr("the same"));
    EXPECT_THAT(message(R"({"cameras": [{"position": [1, 2, 3], "target": [0, 0, 0], "fovYDegrees": 171}]})"),
                HasSubstr("1 to 170"));
}

}  // namespace
}  // namespace pfvox::test

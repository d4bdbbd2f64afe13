// Frames that follow one another become one picture: the mean while the camera stands, a history that moves
// along when it does not.
#include "frame_sequence.hpp"

#include <array>
#include <cmath>

#include "support/image_compare.hpp"
#include "support/picture_fixture.hpp"
#include "support/procedural.hpp"

namespace pfvox::test {
namespace {

using namespace viewer;

constexpr std::uint32_t kWidth = 160;
constexpr std::uint32_t kHeight = 120;

/// Root of the mean square difference of the channels, of 255.
double distanceBetween(const Picture& a, const Picture& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        for (int shift = 0; shift < 24; shift += 8) {
            const auto x = static_cast<int>(a.pixels[i] >> shift & 0xffu);
            const auto y = static_cast<int>(b.pixels[i] >> shift & 0xffu);
            sum += static_cast<double>((x - y) * (x - y));
        }
    }
    return std::sqrt(sum / (3.0 * static_cast<double>(a.pixels.size())));
}

class FrameSequenceTest : public PictureTest {
  protected:
    void SetUp() override {
        PictureTest::SetUp();
        DiagnosticList diagnostics;
        const OctreeAsset asset = build(demoRoom());
        const gpu::ScenePart part{.asset = &asset};
        auto built = gpu::Scene::build(device(), {&part, 1}, diagnostics);
        ASSERT_TRUE(built);
        scene.emplace(*std::move(built));
        auto made = FrameSequence::create(device());
        ASSERT_TRUE(made);
        frames.emplace(*std::move(made));
        camera = cameraFraming(scene->bounds(), static_cast<double>(kWidth) / kHeight, 40.0);
    }
    void TearDown() override {
        frames.reset();
        scene.reset();
        PictureTest::TearDown();
    }
    /// The picture after one more frame.
    Picture next(const ViewCamera& at) {
        const auto drawn = frames->draw(device(), *scene, at, settings);
        EXPECT_TRUE(drawn) << describe(drawn.error());
        return frames->picture(device()).value();
    }
    Picture reference(const ViewCamera& at, std::uint32_t samples) {
        PictureSettings smooth = settings;
        smooth.samplesPerPixel = samples;
        PictureStatistics statistics;
        return PictureRenderer::create(device())->render(device(), *scene, at, smooth, statistics).value();
    }
    /// The camera turned about the room.
    ViewCamera turned(double radians) const {
        ViewCamera at = camera;
        const glm::dvec3 v = camera.position - camera.target;
        at.position = camera.target + glm::dvec3(std::cos(radians) * v.x + std::sin(radians) * v.z, v.y,
                                                 std::cos(radians) * v.z - std::sin(radians) * v.x);
        return at;
    }

    std::optional<gpu::Scene> scene;
    std::optional<FrameSequence> frames;
    ViewCamera camera;
    PictureSettings settings{.width = kWidth, .height = kHeight, .samplesPerPixel = 1, .lighting = {}};
};

TEST_F(FrameSequenceTest, StandingStillItIsTheMeanOfAllSamples) {
    Picture picture;
    for (int i = 0; i < 8; ++i) picture = next(camera);
    EXPECT_EQ(frames->frames(), 8u);
    EXPECT_LE(differenceOf(picture, reference(camera, 8), 1).largest, 2u) << "rounding";
}

TEST_F(FrameSequenceTest, OtherSettingsStartAnew) {
    next(camera);
    next(camera);
    settings.mode = ViewMode::Normals;
    const Picture picture = next(camera);
    EXPECT_EQ(frames->frames(), 1u);
    EXPECT_LE(differenceOf(picture, reference(camera, 1), 1).largest, 2u);
}

TEST_F(FrameSequenceTest, AMovingPictureIsSmootherThanOneFrame) {
    Picture moving;
    for (int i = 0; i <= 20; ++i) moving = next(turned(0.002 * i));
    const ViewCamera last = turned(0.002 * 20);
    const Picture smooth = reference(last, 64);
    const double history = distanceBetween(moving, smooth);
    const double single = distanceBetween(reference(last, 1), smooth);
    RecordProperty("history", std::to_string(history));
    RecordProperty("single", std::to_string(single));
    EXPECT_LT(history, 0.8 * single);
}

TEST_F(FrameSequenceTest, ACutLeavesNoGhost) {
    for (int i = 0; i < 16; ++i) next(camera);
    const ViewCamera other = turned(0.9);
    const Picture cut = next(other);
    // Where the history is held near the neighbors it may add a little; what the first frame alone shows is
    // the measure.
    EXPECT_LT(distanceBetween(cut, reference(other, 64)),
              1.05 * distanceBetween(reference(other, 1), reference(other, 64)));
}

TEST_F(FrameSequenceTest, SizeMayChange) {
    next(camera);
    for (const glm::uvec2 size : {glm::uvec2(33, 17), glm::uvec2(1, 1), glm::uvec2(200, 9)}) {
        settings.width = size.x;
        settings.height = size.y;
        const Picture picture = next(camera);
        EXPECT_EQ(picture.pixels.size(), std::size_t{size.x} * size.y);
        EXPECT_EQ(frames->frames(), 1u);
    }
}

}  // namespace
}  // namespace pfvox::test

// The light filter on maps whose light is known: how much noise it takes away, and that it moves nothing else.
#include <gtest/gtest.h>

#include <cmath>
#include <pfvox/probe_maths.hpp>
#include <random>

#include "filter/light_filter.hpp"
#include "support/box_room.hpp"

namespace pfvox::test {
namespace {

constexpr std::uint32_t kLightEdge = 128;
constexpr std::uint32_t kDepthEdge = 256;

/// What a probe in the middle of a room sees.
struct RoomMap {
    explicit RoomMap(const BoxRoom& room) {
        const glm::vec3 eye = 0.5f * room.size();
        const DepthCoder coder(depthEncodingFor(glm::vec3{0}, room.size()));
        words = traceDepthNormal(room, eye, kDepthEdge, coder);
        for (std::uint32_t i = 0; i < words.size(); ++i)
            metres.push_back(room.trace(eye, directionOfTexel(i % kDepthEdge, i / kDepthEdge, kDepthEdge)).distance);
        for (std::uint32_t i = 0; i < kLightEdge * kLightEdge; ++i) {
            const glm::vec3 direction = directionOfTexel(i % kLightEdge, i / kLightEdge, kLightEdge);
            const RoomHit hit = room.trace(eye, direction);
            hits.push_back(hit);
            points.push_back(eye + hit.distance * direction);
        }
    }

    std::vector<glm::vec3> filtered(const std::vector<glm::vec3>& light, const std::vector<float>& errors) const {
        return filter::filterLight({.words = words,
                                    .metres = metres,
                                    .depthEdge = kDepthEdge,
                                    .light = light,
                                    .lightEdge = kLightEdge,
                                    .errors = errors,
                                    .voxelMetres = BoxRoom::kVoxelMetres},
                                   {});
    }

    std::vector<std::uint32_t> words;
    std::vector<float> metres;
    std::vector<RoomHit> hits;
    std::vector<glm::vec3> points;
};

double rmse(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(glm::dot(a[i] - b[i], a[i] - b[i])) / 3.0;
    return std::sqrt(sum / static_cast<double>(a.size()));
}

double meanOf(const std::vector<glm::vec3>& light) {
    double sum = 0.0;
    for (const glm::vec3& c : light) sum += static_cast<double>(c.x + c.y + c.z) / 3.0;
    return sum / static_cast<double>(light.size());
}

std::vector<glm::vec3> smoothLightOf(const RoomMap& map) {
    std::vector<glm::vec3> light;
    for (std::size_t i = 0; i < map.points.size(); ++i)
        light.push_back(0.5f + 0.05f * glm::vec3{map.points[i].x, map.points[i].y, map.points[i].z} + 0.2f * map.hits[i].normal);
    return light;
}

/// The noise of few paths: mostly little, now and then much; its mean is 1. Errors are those of four batches.
struct NoisyLight {
    explicit NoisyLight(const std::vector<glm::vec3>& truth) {
        std::mt19937 random(5);
        std::uniform_real_distribution<float> uniform;
        for (const glm::vec3& c : truth) {
            float sum = 0.0f;
            float squares = 0.0f;
            for (int batch = 0; batch < 4; ++batch) {
                const float u = uniform(random);
                const float factor = u < 0.02f ? 16.0f : 0.14f + 1.1f * uniform(random);
                sum += factor;
                squares += factor * factor;
            }
            const float mean = 0.25f * sum;
            light.push_back(c * mean);
            errors.push_back((c.x + c.y + c.z) / 3.0f * std::sqrt(std::max(0.25f * squares - mean * mean, 0.0f) / 3.0f));
        }
    }
    std::vector<glm::vec3> light;
    std::vector<float> errors;
};

TEST(LightFilter, TakesNoiseAway) {
    const RoomMap map(BoxRoom(24));
    const std::vector<glm::vec3> truth = smoothLightOf(map);
    const std::vector<glm::vec3> light = NoisyLight(truth).light;
    const std::vector<glm::vec3> result = map.filtered(light, {});
    RecordProperty("before", std::to_string(rmse(light, truth)));
    RecordProperty("guessed_mean", std::to_string(meanOf(result) / meanOf(light)));
    RecordProperty("after", std::to_string(rmse(result, truth)));
    EXPECT_LT(rmse(result, truth), 0.4 * rmse(light, truth));
    EXPECT_NEAR(meanOf(result), meanOf(light), 0.08 * meanOf(light));
}

TEST(LightFilter, KnownErrorsTakeMoreAway) {
    const RoomMap map(BoxRoom(24));
    const std::vector<glm::vec3> truth = smoothLightOf(map);
    const auto [light, errors] = NoisyLight(truth);
    const std::vector<glm::vec3> result = map.filtered(light, errors);
    RecordProperty("known_after", std::to_string(rmse(result, truth)));
    RecordProperty("known_mean", std::to_string(meanOf(result) / meanOf(light)));
    EXPECT_LT(rmse(result, truth), 0.4 * rmse(light, truth));
    EXPECT_NEAR(meanOf(result), meanOf(light), 0.05 * meanOf(light));
}

/// Light that is known to be exact stays as it is, whatever its edges.
TEST(LightFilter, LeavesWhatIsKnown) {
    const RoomMap map(BoxRoom(24));
    std::vector<glm::vec3> light = smoothLightOf(map);
    for (std::size_t i = 0; i < light.size(); ++i)
        if (map.points[i].x > 4.0f && map.points[i].x < 6.0f) light[i] *= 3.0f;
    const std::vector<float> errors(light.size(), 1e-4f);
    EXPECT_LT(rmse(map.filtered(light, errors), light), 0.01 * meanOf(light));
}

/// Nothing goes from one surface to another, over a fold of the map neither.
TEST(LightFilter, KeepsSurfacesApart) {
    const RoomMap map(BoxRoom(24));
    std::vector<glm::vec3> light;
    for (const RoomHit& hit : map.hits) light.emplace_back(hit.normal.y > 0.5f ? 1.0f : hit.normal.x > 0.5f ? 2.0f : 0.0f);
    const std::vector<float> errors(light.size(), 1.0f);
    const std::vector<glm::vec3> result = map.filtered(light, errors);
    for (std::size_t i = 0; i < light.size(); ++i) EXPECT_NEAR(result[i].x, light[i].x, 1e-4f) << i;
}

TEST(LightFilter, TexelsWithoutSurfaceStay) {
    std::vector<std::uint32_t> words(16 * 16, kDepthMissCode);
    std::vector<float> metres(words.size(), -1.0f);
    const std::vector<glm::vec3> light(words.size(), glm::vec3{0.0f});
    const auto result = filter::filterLight(
        {.words = words, .metres = metres, .depthEdge = 16, .light = light, .lightEdge = 16, .errors = {}}, {});
    EXPECT_EQ(result, light);
}

}  // namespace
}  // namespace pfvox::test

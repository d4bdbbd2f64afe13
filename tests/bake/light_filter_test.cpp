// The light filter on maps whose light is known: how much noise it takes away, and that it moves nothing
// else.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <pfvox/probe_maths.hpp>
#include <random>

#include "filter/light_filter.hpp"
#include "support/box_room.hpp"

namespace pfvox::test {
namespace {

/// Edges of the maps of a probe, in texels.
struct Edges {
    std::uint32_t depth = 256;
    std::uint32_t light = 128;
};

/// What a probe in the middle of a room sees.
struct RoomMap {
    explicit RoomMap(const BoxRoom& room, Edges ofMaps = {}) : edges(ofMaps) {
        const glm::vec3 eye = 0.5f * room.size();
        const DepthCoder coder(depthEncodingFor(glm::vec3{0}, room.size()));
        words = traceDepthNormal(room, eye, edges.depth, coder);
        for (std::uint32_t i = 0; i < words.size(); ++i) {
            const glm::vec3 direction = directionOfTexel(i % edges.depth, i / edges.depth, edges.depth);
            hits.push_back(room.trace(eye, direction));
            metres.push_back(hits.back().distance);
            points.push_back(eye + hits.back().distance * direction);
        }
    }

    /// A light map: the mean of a function over the depth texels below.
    template <class LightAt>
    std::vector<glm::vec3> lightOf(const LightAt& lightAt) const {
        std::vector<glm::vec3> light(std::size_t{edges.light} * edges.light, glm::vec3{0.0f});
        const std::uint32_t block = edges.depth / edges.light;
        for (std::uint32_t i = 0; i < words.size(); ++i)
            light[i % edges.depth / block + edges.light * (i / edges.depth / block)] +=
                lightAt(hits[i], points[i]) / static_cast<float>(block * block);
        return light;
    }

    /// Whether all depth texels below show one face.
    bool showsOneFace(std::uint32_t texel) const {
        const std::uint32_t block = edges.depth / edges.light;
        const std::uint32_t first = texel % edges.light * block + edges.depth * (texel / edges.light * block);
        for (std::uint32_t i = 0; i < block * block; ++i) {
            const RoomHit& hit = hits[first + i % block + edges.depth * (i / block)];
            if (hit.surface != hits[first].surface || hit.normal != hits[first].normal) return false;
        }
        return true;
    }

    std::vector<glm::vec3> filtered(const std::vector<glm::vec3>& light,
                                    const std::vector<float>& errors) const {
        return filter::filterLight({.words = words,
                                    .metres = metres,
                                    .depthResolution = edges.depth,
                                    .light = light,
                                    .lightResolution = edges.light,
                                    .errors = errors,
                                    .voxelMetres = BoxRoom::kVoxelMetres},
                                   {});
    }

    Edges edges;
    std::vector<std::uint32_t> words;
    std::vector<float> metres;
    std::vector<RoomHit> hits;
    std::vector<glm::vec3> points;
};

double rmse(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += static_cast<double>(glm::dot(a[i] - b[i], a[i] - b[i])) / 3.0;
    return std::sqrt(sum / static_cast<double>(a.size()));
}

double meanOf(const std::vector<glm::vec3>& light) {
    double sum = 0.0;
    for (const glm::vec3& c : light) sum += static_cast<double>(c.x + c.y + c.z) / 3.0;
    return sum / static_cast<double>(light.size());
}

std::vector<glm::vec3> smoothLightOf(const RoomMap& map) {
    return map.lightOf(
        [](const RoomHit& hit, const glm::vec3& point) { return 0.5f + 0.05f * point + 0.2f * hit.normal; });
}

/// The noise of few paths: mostly little, now and then much; its mean is 1. Errors are those of four batches.
struct NoisyLight {
    explicit NoisyLight(const std::vector<glm::vec3>& truth, unsigned seed = 5) {
        std::mt19937 random(seed);
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
            errors.push_back((c.x + c.y + c.z) / 3.0f *
                             std::sqrt(std::max(0.25f * squares - mean * mean, 0.0f) / 3.0f));
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
    const std::vector<glm::vec3> light = map.lightOf([](const RoomHit&, const glm::vec3& point) {
        return glm::vec3((0.5f + 0.05f * point.y) * (point.x > 4.0f && point.x < 6.0f ? 3.0f : 1.0f));
    });
    const std::vector<float> errors(light.size(), 1e-4f);
    EXPECT_LT(rmse(map.filtered(light, errors), light), 0.01 * meanOf(light));
}

/// Nothing goes from one surface to another, over a fold of the map neither.
TEST(LightFilter, KeepsSurfacesApart) {
    const RoomMap map(BoxRoom(24));
    const auto colorOf = [](const RoomHit& hit, const glm::vec3&) {
        return glm::vec3(hit.normal.y > 0.5f ? 1.0f : hit.normal.x > 0.5f ? 2.0f : 0.0f);
    };
    const std::vector<glm::vec3> light = map.lightOf(colorOf);
    const std::vector<float> errors(light.size(), 1.0f);
    const std::vector<glm::vec3> result = map.filtered(light, errors);
    std::size_t pure = 0;
    for (std::uint32_t i = 0; i < light.size(); ++i) {
        const bool isPure = map.showsOneFace(i);
        pure += isPure ? 1u : 0u;
        EXPECT_NEAR(result[i].x, light[i].x, isPure ? 1e-4f : 0.5f) << i;
    }
    EXPECT_GT(pure, light.size() / 2);
}

/// How much noise is left must not depend on how much of a surface a texel covers.
TEST(LightFilter, TakesNoiseAwayFromLargeTexels) {
    for (const Edges edges :
         {Edges{64, 16}, Edges{64, 32}, Edges{128, 32}, Edges{128, 64}, Edges{256, 128}}) {
        const RoomMap map(BoxRoom(4), edges);
        const std::vector<glm::vec3> truth = smoothLightOf(map);
        const NoisyLight one(truth, 5);
        const NoisyLight other(truth, 6);
        const auto first = map.filtered(one.light, one.errors);
        const double left =
            rmse(first, map.filtered(other.light, other.errors)) / rmse(one.light, other.light);
        const double error = rmse(first, truth) / rmse(one.light, truth);
        std::cout << "  light map of " << edges.light << " texels, depth " << edges.depth << ": noise left "
                  << left << ", error left " << error << "\n";
        EXPECT_LT(left, edges.light < 32 ? 0.6 : 0.5) << edges.light;
        EXPECT_LT(error, edges.light < 32 ? 0.6 : 0.5) << edges.light;
    }
}

TEST(LightFilter, TexelsWithoutSurfaceStay) {
    std::vector<std::uint32_t> words(16 * 16, kDepthMissCode);
    std::vector<float> metres(words.size(), -1.0f);
    const std::vector<glm::vec3> light(words.size(), glm::vec3{0.0f});
    const auto result = filter::filterLight({.words = words,
                                             .metres = metres,
                                             .depthResolution = 16,
                                             .light = light,
                                             .lightResolution = 16,
                                             .errors = {}},
                                            {});
    EXPECT_EQ(result, light);
}

}  // namespace
}  // namespace pfvox::test

// Light-field tracing against the room that the probes have seen, which is traced analytically.
#include <algorithm>

#include "support/probe_query.hpp"
#include "support/room_field.hpp"

namespace pfvox::test {
namespace {

using gpu::FieldAnswer;
using gpu::FieldRay;
using gpu::FieldTrace;
using gpu::FieldTracing;

constexpr float kRightMetres = 0.05f;

struct Score {
    double ok = 0.0;
    double wrong = 0.0;
    double falseMiss = 0.0;
    double unknown = 0.0;        ///< of rays that end on a surface that a probe of the field sees
    double unknownHidden = 0.0;  ///< of rays that end where no probe sees: nobody could know
    std::uint64_t stepLimitReached = 0;
    std::uint64_t notFinite = 0;
    double probesPerRay = 0.0;
    double lowSteps = 0.0;
    double highSteps = 0.0;
};

class FieldTraceTest : public GpuTest {
  protected:
    static Result<gpu::GpuProbes> roomOf(const BoxRoom& room, std::uint32_t edge) {
        ProbeField field = makeRoomField(room, {.resolution = {.depth = edge}});
        addProximity(field, room, {24, 10, 24});
        return uploadField(device(), field, {.voxelMetres = 0.1f});
    }

    /// Where the active probes of roomOf stand.
    static std::vector<glm::vec3> eyesOf(const BoxRoom& room) {
        const ProbeField field = makeRoomField(room, {.resolution = {.irradiance = 1}});
        std::vector<glm::vec3> eyes;
        for (std::uint32_t i = 0; i < field.info.range.end; ++i) {
            const ProbeRecord& record = field.probes[i].record;
            if (record.isActive()) eyes.push_back(field.info.grid.pointOf(i) + record.offset);
        }
        return eyes;
    }

    static std::vector<FieldRay> randomRays(const BoxRoom& room, std::size_t count) {
        std::mt19937 random(11);
        std::uniform_real_distribution<float> uniform;
        std::normal_distribution<float> normal;
        std::vector<FieldRay> rays;
        while (rays.size() < count) {
            const glm::vec3 origin =
                room.size() * glm::vec3{uniform(random), uniform(random), uniform(random)};
            if (room.isSolid(origin)) continue;
            rays.push_back(
                {.origin = origin,
                 .direction = glm::normalize(glm::vec3{normal(random), normal(random), normal(random)})});
        }
        return rays;
    }

    static std::vector<FieldTrace> trace(const gpu::GpuProbes& probes, const std::vector<FieldRay>& rays,
                                         FieldTracing tracing) {
        const auto query = gpu::ProbeQuery::create(device());
        EXPECT_TRUE(query);
        auto traces = query->trace(device(), probes, rays, tracing);
        EXPECT_TRUE(traces) << describe(traces.error());
        return traces ? *std::move(traces) : std::vector<FieldTrace>{};
    }

    static bool seenByAny(const BoxRoom& room, const std::vector<glm::vec3>& eyes, glm::vec3 point) {
        return std::ranges::any_of(eyes, [&](const glm::vec3& eye) {
            const float distance = glm::distance(eye, point);
            return room.trace(eye, (point - eye) / distance).distance > distance - 2e-3f;
        });
    }

    static Score scoreOf(const BoxRoom& room, const std::vector<FieldRay>& rays,
                         const std::vector<FieldTrace>& traces) {
        Score score;
        const std::vector<glm::vec3> eyes = eyesOf(room);
        const double one = 1.0 / static_cast<double>(rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const FieldTrace& trace = traces[i];
            const float truth = room.trace(rays[i].origin, rays[i].direction).distance;
            score.stepLimitReached += trace.stepLimitReached;
            score.probesPerRay += one * trace.probesAsked;
            score.lowSteps += one * trace.lowSteps;
            score.highSteps += one * trace.highSteps;
            if (!std::isfinite(trace.t) || !std::isfinite(trace.light.x)) ++score.notFinite;
            if (trace.answer == FieldAnswer::Miss) score.falseMiss += one;
            if (trace.answer == FieldAnswer::Unknown)
                (seenByAny(room, eyes, rays[i].origin + truth * rays[i].direction) ? score.unknown
                                                                                   : score.unknownHidden) +=
                    one;
            if (trace.answer != FieldAnswer::Hit) continue;
            (std::abs(trace.t - truth) <= kRightMetres ? score.ok : score.wrong) += one;
        }
        RecordProperty("ok_percent", std::to_string(100 * score.ok));
        RecordProperty("wrong_percent", std::to_string(100 * score.wrong));
        RecordProperty("false_miss_percent", std::to_string(100 * score.falseMiss));
        RecordProperty("unknown_percent", std::to_string(100 * score.unknown));
        RecordProperty("unknown_hidden_percent", std::to_string(100 * score.unknownHidden));
        RecordProperty("probes_per_ray", std::to_string(score.probesPerRay));
        RecordProperty("low_steps_per_ray", std::to_string(score.lowSteps));
        RecordProperty("high_steps_per_ray", std::to_string(score.highSteps));
        return score;
    }
};

TEST_F(FieldTraceTest, FindsWhatTheRoomHoldsAt512) {
    const BoxRoom room(24);
    PFVOX_ASSERT_VALUE(const gpu::GpuProbes, probes, roomOf(room, 512));
    const std::vector<FieldRay> rays = randomRays(room, 100000);
    const Score score = scoreOf(room, rays, trace(probes, rays, FieldTracing::Full));
    EXPECT_GE(score.ok, 0.955);
    EXPECT_LE(score.wrong, 0.005);
    EXPECT_LE(score.unknown, 0.007);
    EXPECT_EQ(score.falseMiss, 0.0);
    EXPECT_EQ(score.stepLimitReached, 0u);
    EXPECT_EQ(score.notFinite, 0u);
}

TEST_F(FieldTraceTest, FindsWhatTheRoomHoldsAt1024) {
    const BoxRoom room(24);
    PFVOX_ASSERT_VALUE(const gpu::GpuProbes, probes, roomOf(room, 1024));
    const std::vector<FieldRay> rays = randomRays(room, 100000);
    const Score score = scoreOf(room, rays, trace(probes, rays, FieldTracing::Full));
    EXPECT_GE(score.ok, 0.97);
    EXPECT_LE(score.wrong, 0.003);
    EXPECT_LE(score.unknown, 0.007);
    EXPECT_EQ(score.falseMiss, 0.0);
    EXPECT_EQ(score.stepLimitReached, 0u);
}

/// The min maps save steps and change nothing.
TEST_F(FieldTraceTest, MinMapsChangeNothing) {
    const BoxRoom room(24);
    PFVOX_ASSERT_VALUE(const gpu::GpuProbes, probes, roomOf(room, 512));
    const std::vector<FieldRay> rays = randomRays(room, 100000);
    const std::vector<FieldTrace> full = trace(probes, rays, FieldTracing::Full);
    const std::vector<FieldTrace> high = trace(probes, rays, FieldTracing::HighOnly);
    std::size_t same = 0;
    std::uint64_t fullSteps = 0;
    std::uint64_t highSteps = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        same += full[i].answer == high[i].answer && std::abs(full[i].t - high[i].t) <= 1e-4f ? 1u : 0u;
        fullSteps += full[i].lowSteps + full[i].highSteps;
        highSteps += high[i].highSteps;
        EXPECT_EQ(high[i].lowSteps, 0u);
    }
    RecordProperty("different_rays", std::to_string(rays.size() - same));
    EXPECT_GE(static_cast<double>(same), 0.9999 * static_cast<double>(rays.size()));
    EXPECT_LT(2 * fullSteps, highSteps);
}

/// Rays along axes and diagonals, from anywhere and from the probes themselves: where planes, folds and poles
/// of the maps are met exactly.
TEST_F(FieldTraceTest, AxisRaysEndAndAreRight) {
    const BoxRoom room(24);
    const ProbeField field = makeRoomField(room, {.resolution = {.depth = 512}});
    PFVOX_ASSERT_VALUE(const gpu::GpuProbes, probes, uploadField(device(), field, {.voxelMetres = 0.1f}));
    std::vector<glm::vec3> origins;
    for (const FieldRay& ray : randomRays(room, 3000)) origins.push_back(ray.origin);
    for (std::uint32_t i = 0; i < field.info.range.end; ++i) {
        const glm::vec3 probe = field.info.grid.pointOf(i) + field.probes[i].record.offset;
        for (const glm::vec3 apart : {glm::vec3{0}, glm::vec3{0.01f, 0, 0}, glm::vec3{0, 0, -0.01f}}) {
            if (field.probes[i].record.isActive()) origins.push_back(probe + apart);
        }
    }
    std::vector<FieldRay> rays;
    for (const glm::vec3& origin : origins) {
        for (int k = 0; k < 27; ++k) {
            const glm::vec3 way{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
            if (k != 13) rays.push_back({.origin = origin, .direction = glm::normalize(way)});
        }
    }
    const Score score = scoreOf(room, rays, trace(probes, rays, FieldTracing::Full));
    EXPECT_EQ(score.notFinite, 0u);
    EXPECT_LT(score.falseMiss, 0.001);
    EXPECT_LT(static_cast<double>(score.stepLimitReached), 1e-4 * static_cast<double>(rays.size()));
    EXPECT_GE(score.ok, 0.94);
}

TEST_F(FieldTraceTest, HolesAreFilled) {
    const BoxRoom room(24);
    PFVOX_ASSERT_VALUE(const gpu::GpuProbes, probes, roomOf(room, 256));
    const std::vector<FieldRay> rays = randomRays(room, 20000);
    std::size_t unknown = 0;
    std::size_t filled = 0;
    for (const FieldTrace& trace : trace(probes, rays, FieldTracing::Full))
        unknown += trace.answer == FieldAnswer::Unknown ? 1u : 0u;
    for (const FieldTrace& trace : trace(probes, rays, FieldTracing::Filled)) {
        filled += trace.answer == FieldAnswer::Filled ? 1u : 0u;
        EXPECT_NE(trace.answer, FieldAnswer::Unknown);
    }
    EXPECT_GT(unknown, 0u);
    EXPECT_EQ(filled, unknown);
}

/// A ray that ends before the wall is seen to be free.
TEST_F(FieldTraceTest, ShortRaysMiss) {
    const BoxRoom room(0);
    PFVOX_ASSERT_VALUE(const gpu::GpuProbes, probes, roomOf(room, 256));
    std::vector<FieldRay> rays = randomRays(room, 2000);
    for (FieldRay& ray : rays) ray.tMax = 0.7f * room.trace(ray.origin, ray.direction).distance;
    std::size_t misses = 0;
    for (const FieldTrace& trace : trace(probes, rays, FieldTracing::Full))
        misses += trace.answer == FieldAnswer::Miss ? 1u : 0u;
    EXPECT_GE(misses, 1980u);
}

/// A hall of 6 x 3 x 6 m under the open sky, its walls and its roof one voxel thick, with an opening of 2 x 2
/// m in the roof.
BoxRoom hallWithOpenRoof() {
    BoxRoom hall = BoxRoom::underSky({6, 3, 6});
    hall.add({{-3, -0.1f, -3}, {9, 0, 9}});
    hall.add({{-0.1f, 0, -0.1f}, {0, 3, 6.1f}});
    hall.add({{6, 0, -0.1f}, {6.1f, 3, 6.1f}});
    hall.add({{0, 0, -0.1f}, {6, 3, 0}});
    hall.add({{0, 0, 6}, {6, 3, 6.1f}});
    hall.add({{-0.1f, 3, -0.1f}, {2, 3.1f, 6.1f}});
    hall.add({{4, 3, -0.1f}, {6.1f, 3.1f, 6.1f}});
    hall.add({{2, 3, -0.1f}, {4, 3.1f, 2}});
    hall.add({{2, 3, 4}, {4, 3.1f, 6.1f}});
    return hall;
}

/// From a corner of the hall up through the opening: a picture of 240 x 160 rays.
std::vector<FieldRay> raysTowardsTheOpening() {
    const glm::vec3 eye{1.3f, 1.2f, 1.1f};
    const glm::vec3 forward = glm::normalize(glm::vec3{3.1f, 3.0f, 3.2f} - eye);
    const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3{0, 1, 0}));
    const glm::vec3 up = glm::cross(right, forward);
    std::vector<FieldRay> rays;
    for (int i = 0; i < 240 * 160; ++i) {
        const float x = (static_cast<float>(i % 240) + 0.5f) / 120.0f - 1.0f;
        const float y = 1.0f - (static_cast<float>(i / 240) + 0.5f) / 80.0f;
        rays.push_back(
            {.origin = eye, .direction = glm::normalize(forward + 0.9f * x * right + 0.6f * y * up)});
    }
    return rays;
}

/// Rays that leave by the opening and go on behind the roof, as a probe sees it, hit nothing: the roof ends
/// above its voxel. What is left are the texels on the rim, whose part of the picture falls with their size.
TEST_F(FieldTraceTest, RaysLeaveThroughAnOpeningInARoofOfOneVoxel) {
    struct Gate {
        std::uint32_t edge;
        double falseHit;
        double falseMiss;
        double right;
    };
    const BoxRoom hall = hallWithOpenRoof();
    const std::vector<FieldRay> rays = raysTowardsTheOpening();
    for (const Gate& gate : {Gate{128, 0.0055, 0.0050, 0.978}, Gate{256, 0.0035, 0.0020, 0.986},
                             Gate{512, 0.0018, 0.0011, 0.989}}) {
        const ProbeField field =
            makeRoomField(hall, {.resolution = {.depth = gate.edge}, .counts = {3, 2, 3}});
        PFVOX_ASSERT_VALUE(const gpu::GpuProbes, probes, uploadField(device(), field, {.voxelMetres = 0.1f}));
        const std::vector<FieldTrace> traces = trace(probes, rays, FieldTracing::Full);
        const double one = 1.0 / static_cast<double>(rays.size());
        double falseHit = 0.0;
        double falseMiss = 0.0;
        double right = 0.0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const float truth = hall.trace(rays[i].origin, rays[i].direction).distance;
            const bool hit = traces[i].answer == FieldAnswer::Hit;
            const bool miss = traces[i].answer == FieldAnswer::Miss;
            falseHit += hit && std::isinf(truth) ? one : 0.0;
            falseMiss += miss && !std::isinf(truth) ? one : 0.0;
            right +=
                (miss && std::isinf(truth)) || (hit && std::abs(traces[i].t - truth) <= 0.1f) ? one : 0.0;
        }
        const std::string name = "at_" + std::to_string(gate.edge);
        RecordProperty(name + "_false_hit_percent", std::to_string(100 * falseHit));
        RecordProperty(name + "_false_miss_percent", std::to_string(100 * falseMiss));
        RecordProperty(name + "_right_percent", std::to_string(100 * right));
        EXPECT_LE(falseHit, gate.falseHit) << gate.edge;
        EXPECT_LE(falseMiss, gate.falseMiss) << gate.edge;
        EXPECT_GE(right, gate.right) << gate.edge;
    }
}

}  // namespace
}  // namespace pfvox::test

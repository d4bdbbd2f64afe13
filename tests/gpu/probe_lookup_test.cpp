// The lookup of indirect light on the device: against known light, and against a slow twin for the compact
// layer.

#include <numeric>

#include "support/probe_query.hpp"
#include "support/room_field.hpp"

namespace pfvox::test {
namespace {

using gpu::ProbeLookup;
using gpu::ProbePoint;
using gpu::ProbeTier;

constexpr ProbeResolution kSmall{.depth = 256, .light = 128, .irradiance = 8, .moments = 14};

class ProbeLookupTest : public GpuTest {
  protected:
    static std::vector<ProbeLookup> lookUp(const ProbeField& field, const std::vector<SurfaceSample>& samples,
                                           gpu::GpuProbeSettings settings = {}) {
        const auto probes = uploadField(device(), field, settings);
        EXPECT_TRUE(probes) << describe(probes.error());
        const auto query = gpu::ProbeQuery::create(device());
        EXPECT_TRUE(query);
        std::vector<ProbePoint> points;
        for (const SurfaceSample& sample : samples) points.push_back({sample.position, sample.normal});
        auto found = query->lookUp(device(), *probes, points);
        EXPECT_TRUE(found);
        return found ? *std::move(found) : std::vector<ProbeLookup>{};
    }

    static bool hasValue(const ProbeLookup& found) {
        const float sum = found.weights.x + found.weights.y + found.weights.z;
        return found.tier != ProbeTier::None &&
               std::isfinite(found.indirect.x + found.indirect.y + found.indirect.z) &&
               std::abs(sum - 1.0f) < 1e-4f;
    }
};

TEST_F(ProbeLookupTest, EveryPointHasAValueAndMostAreExact) {
    const BoxRoom room(24);
    ProbeField field = makeRoomField(room, {.resolution = kSmall, .albedo = 1.0f});
    addProximity(field, room, {24, 10, 24});
    const std::vector<SurfaceSample> samples = roomSurface(room, 50000, 3);
    const std::vector<ProbeLookup> found = lookUp(field, samples);
    ASSERT_EQ(found.size(), samples.size());
    std::size_t without = 0;
    std::size_t exact = 0;
    double squares = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        without += hasValue(found[i]) ? 0u : 1u;
        if (found[i].tier != ProbeTier::Texels) continue;
        ++exact;
        const glm::vec3 apart = found[i].indirect - smoothLight(samples[i].position, samples[i].normal);
        squares += static_cast<double>(glm::dot(apart, apart)) / 3.0;
    }
    const double fraction = static_cast<double>(exact) / static_cast<double>(samples.size());
    const double rmse = std::sqrt(squares / static_cast<double>(exact));
    RecordProperty("texel_percent", std::to_string(100 * fraction));
    RecordProperty("texel_rmse", std::to_string(rmse));
    EXPECT_EQ(without, 0u);
    EXPECT_GE(fraction, 0.9);
    EXPECT_LE(rmse, 0.03);  // of a mean of 0.75: texels wider than what they blend
}

/// The floor ends a centimetre below the border of its cells, in whose upper neighbors there is nothing: it
/// is looked up in the cells that have its samples. One probe is active, and not among the eight around.
TEST_F(ProbeLookupTest, APlaneNearTheBorderOfItsCellsFindsItsProbes) {
    const BoxRoom room(0);
    ProbeField field = makeRoomField(room, {.resolution = kSmall, .albedo = 1.0f});
    for (std::size_t i = 1; i < field.probes.size(); ++i) {
        field.probes[i] = {};
        field.probes[i].record.state = ProbeState::Inactive;
    }
    addProximity(field, room,
                 ProximityGrid{.start = {-0.1f, -0.39f, -0.1f},
                               .step = {0.5f, 0.4f, 0.5f},
                               .counts = {21, 12, 21},
                               .probes = {}});
    std::vector<SurfaceSample> floor = roomSurface(room, 50000, 3);
    std::erase_if(floor, [](const SurfaceSample& sample) {
        const glm::vec3& p = sample.position;
        return sample.normal.y < 0.9f || p.x < 4.0f || p.x > 6.0f || p.z < 4.0f || p.z > 6.0f;
    });
    ASSERT_GT(floor.size(), 100u);
    for (const ProbeLookup& found : lookUp(field, floor, {.voxelMetres = 0.1f}))
        EXPECT_EQ(found.tier, ProbeTier::Texels);
}

/// What stands in for the maps of an inactive probe is never read: there is nothing at its addresses. Even
/// so, all points have a value, those too around which no probe is active.
TEST_F(ProbeLookupTest, InactiveProbesAreNotRead) {
    const BoxRoom room(8);
    const RoomFieldSettings settings{.resolution = {.depth = 64, .light = 64, .irradiance = 8, .moments = 14},
                                     .counts = {6, 2, 4},
                                     .light = [](glm::vec3, glm::vec3) { return glm::vec3{2.0f}; },
                                     .albedo = 1.0f};
    ProbeField field = makeRoomField(room, settings);
    for (std::size_t i = 0; i < field.probes.size(); ++i) {
        if (field.info.grid.placeOf(static_cast<std::uint32_t>(i)).x == 0) continue;
        field.probes[i] = {};
        field.probes[i].record.state = ProbeState::Inactive;
    }
    addProximity(field, room, {8, 4, 8});
    const std::vector<SurfaceSample> samples = roomSurface(room, 20000, 4);
    const std::vector<ProbeLookup> found = lookUp(field, samples);
    std::array<std::size_t, gpu::kProbeTierCount> tiers{};
    for (const ProbeLookup& lookup : found) {
        EXPECT_TRUE(hasValue(lookup));
        EXPECT_NEAR(lookup.indirect.x, 2.0f, 0.2f);
        ++tiers[static_cast<std::size_t>(lookup.tier)];
    }
    EXPECT_GT(tiers[static_cast<std::size_t>(ProbeTier::Texels)], 0u);
    EXPECT_GT(tiers[static_cast<std::size_t>(ProbeTier::Nearest)], 0u);
}

TEST_F(ProbeLookupTest, WithoutAnyActiveProbeItSaysSo) {
    const BoxRoom room(0);
    ProbeField field =
        makeRoomField(room, {.resolution = {.irradiance = 8, .moments = 14}, .counts = {2, 1, 1}});
    for (ProbeData& probe : field.probes) {
        probe = {};
        probe.record.state = ProbeState::Inactive;
    }
    for (const ProbeLookup& lookup : lookUp(field, roomSurface(room, 100, 4))) {
        EXPECT_EQ(lookup.tier, ProbeTier::None);
        EXPECT_EQ(lookup.indirect, glm::vec3{0.0f});
    }
}

/// The compact layer once more, from the functions that tell what a stored map means.
class CompactTwin {
  public:
    CompactTwin(const ProbeField& field, const SurfaceSample& point, double voxelMetres)
        : field_(field),
          grid_(field.info.grid),
          point_(point),
          biased_(glm::dvec3{point.position} +
                  std::min(2.0 * voxelMetres, 0.2 * std::min({grid_.step.x, grid_.step.y, grid_.step.z})) *
                      glm::dvec3{point.normal}) {}

    glm::vec3 light() {
        const glm::dvec3 at = (biased_ - glm::dvec3{grid_.start}) / glm::dvec3{grid_.step};
        const glm::dvec3 cell =
            glm::clamp(glm::floor(at), glm::dvec3{0.0}, glm::max(glm::dvec3{grid_.counts} - 2.0, 0.0));
        const glm::dvec3 fraction = glm::clamp(at - cell, 0.0, 1.0);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::ivec3 upper{corner & 1, corner >> 1 & 1, corner >> 2};
            const glm::dvec3 near =
                glm::max(glm::mix(1.0 - fraction, fraction, glm::dvec3{upper}), glm::dvec3{0.001});
            add(glm::ivec3{cell} + upper, near.x * near.y * near.z);
        }
        const glm::dvec3 root = sum_ / weights_;
        const glm::dvec3 last = glm::dvec3{grid_.counts} - 1.0;
        const glm::dvec3 beyond = glm::max(glm::max(-at, at - last), 0.0);
        const double outside = std::clamp(2.0 * std::max({beyond.x, beyond.y, beyond.z}) - 1.0, 0.0, 1.0);
        const double inside = 1.0 - outside * (1.0 - std::min(seen_ / 0.1, 1.0));
        if (inside >= 1.0) return glm::vec3{root * root};
        sum_ = glm::dvec3{0.0};
        weights_ = 0.0;
        for (int z = -2; z <= 3; ++z)
            for (int y = -2; y <= 3; ++y)
                for (int x = -2; x <= 3; ++x) {
                    const glm::ivec3 place = glm::ivec3{cell} + glm::ivec3{x, y, z};
                    if (glm::any(glm::lessThan(place, glm::ivec3{0})) ||
                        glm::any(glm::greaterThan(place, glm::ivec3{last})))
                        continue;
                    const glm::dvec3 steps = glm::dvec3{place} - glm::clamp(at, glm::dvec3{0.0}, last);
                    add(place, std::exp2(-glm::dot(steps, steps)));
                }
        const glm::dvec3 mixed = glm::mix(sum_ / weights_, root, inside);
        return glm::vec3{mixed * mixed};
    }

  private:
    void add(const glm::ivec3& place, double near) {
        const std::uint32_t index = grid_.indexOf(glm::uvec3{place});
        const ProbeData& probe = field_.probes[index];
        if (!probe.record.isActive()) return;
        const glm::dvec3 eye = glm::dvec3{grid_.pointOf(index) + probe.record.offset};
        const double facing =
            0.5 * glm::dot(glm::normalize(eye - glm::dvec3{point_.position}), glm::dvec3{point_.normal}) +
            0.5;
        const glm::dvec2 moments{lookupMoments(probe.moments, field_.info.resolution.moments,
                                               glm::normalize(glm::vec3{biased_ - eye}))};
        const double d = std::min(glm::length(biased_ - eye) / static_cast<double>(grid_.momentRange()), 1.0);
        double visible = 1.0;
        if (d > moments.x) {
            const double variance = std::max(moments.y - moments.x * moments.x, 1e-6);
            visible = std::pow(variance / (variance + (d - moments.x) * (d - moments.x)), 3);
        }
        seen_ += near * visible;
        double own = (facing * facing + 0.2) * visible;
        if (own < 0.2) own = own * own * own / 0.04;
        const double weight = near * std::max(own, 1e-4);
        weights_ += weight;
        sum_ += weight * glm::sqrt(glm::dvec3{lookupIrradiance(
                             probe.irradiance, field_.info.resolution.irradiance, point_.normal)});
    }

    const ProbeField& field_;
    const ProbeGrid& grid_;
    const SurfaceSample& point_;
    glm::dvec3 biased_;
    glm::dvec3 sum_{0.0};
    double weights_ = 0.0;
    double seen_ = 0.0;
};

TEST_F(ProbeLookupTest, CompactLayerIsWhatItsTwinComputes) {
    const BoxRoom room(24);
    const ProbeField field = makeRoomField(
        room, {.resolution = {.irradiance = 8, .moments = 14}, .counts = {5, 3, 4}, .albedo = 0.7f});
    std::vector<SurfaceSample> samples = roomSurface(room, 5000, 9);
    // Every other point outside of the grid, from half a step to four.
    for (std::size_t i = 0; i < samples.size(); i += 2) samples[i].position.x += room.size().x * 0.8f;
    const std::vector<ProbeLookup> found = lookUp(field, samples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        ASSERT_EQ(found[i].tier, ProbeTier::Compact);
        const glm::vec3 twin = CompactTwin(field, samples[i], 0.1).light();
        // Outside, distances are at their limit, and the variance is what is left of halves.
        const float tolerance = i % 2 == 0 ? 2e-2f : 2e-3f;
        EXPECT_LE(glm::length(found[i].indirect - twin), tolerance * glm::length(twin)) << i;
    }
}

/// Two rooms with a wall between them, light in one of them only.
class TwoRooms : public ProbeLookupTest {
  protected:
    struct Result {
        double lit = 0.0;
        double dark = 0.0;
    };
    static Result meansOf(float wallMetres, ProbeResolution resolution) {
        BoxRoom room(0);
        room.add({{5.0f - 0.5f * wallMetres, -0.1f, -0.1f}, {5.0f + 0.5f * wallMetres, 4.1f, 10.1f}});
        const LightAt light = [](glm::vec3 p, glm::vec3) { return glm::vec3{p.x < 5.0f ? 1.0f : 0.0f}; };
        ProbeField field = makeRoomField(
            room, {.resolution = resolution, .counts = {6, 3, 6}, .light = light, .albedo = 1.0f});
        if (resolution.depth != 0) addProximity(field, room, {20, 8, 20});
        const std::vector<SurfaceSample> samples = roomSurface(room, 20000, 6);
        const std::vector<ProbeLookup> found = lookUp(field, samples);
        Result result;
        std::array<double, 2> counts{};
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const bool lit = samples[i].position.x < 5.0f;
            counts[lit ? 0 : 1] += 1.0;
            (lit ? result.lit : result.dark) += static_cast<double>(found[i].indirect.x);
            EXPECT_TRUE(hasValue(found[i]));
        }
        result.lit /= counts[0];
        result.dark /= counts[1];
        RecordProperty("leak_percent", std::to_string(100 * result.dark / result.lit));
        return result;
    }
};

TEST_F(TwoRooms, NothingLeaksThroughAWallOfFourVoxels) {
    const Result result = meansOf(0.4f, kSmall);
    EXPECT_GT(result.lit, 0.9);
    EXPECT_LE(result.dark, 0.01 * result.lit);
}

TEST_F(TwoRooms, LittleLeaksThroughAWallOfOneVoxel) {
    const Result result = meansOf(0.1f, kSmall);
    EXPECT_LE(result.dark, 0.02 * result.lit);
}

TEST_F(TwoRooms, CompactLeaksThroughAWallOfFourVoxels) {
    const Result result = meansOf(0.4f, {.irradiance = 8, .moments = 14});
    EXPECT_LE(result.dark, 0.05 * result.lit);
}

/// A shard has no neighbors to blend with.
TEST_F(ProbeLookupTest, ShardsAreRefused) {
    const BoxRoom room(0);
    ProbeField field =
        makeRoomField(room, {.resolution = {.irradiance = 8, .moments = 14}, .counts = {2, 1, 1}});
    field.info.range.end = 1;
    field.probes.resize(1);
    const auto probes = uploadField(device(), field, {});
    ASSERT_FALSE(probes);
    EXPECT_EQ(probes.error().code, ErrorCode::BadStructure);
    EXPECT_NE(probes.error().message.find("probe-bake merge"), std::string::npos);
}

}  // namespace
}  // namespace pfvox::test

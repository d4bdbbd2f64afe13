// The proximity grid: what it takes for seen against rays, and what it chooses against a search over all
// pairs.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iostream>
#include <map>
#include <pfvox/proximity.hpp>

#include "support/box_room.hpp"

namespace pfvox {
namespace {

using test::BoxRoom;
using test::RoomHit;

/// The standard room with 32 probes, and its surfaces.
struct Scene {
    BoxRoom room;
    ProbeFieldInfo info;
    std::vector<ProbeRecord> records;
    std::vector<SurfaceSample> samples;
    ProximityGrid shape;

    Scene(std::uint32_t edge, glm::uvec3 counts, glm::uvec3 cells, std::uint32_t seed = 1) : room(24, seed) {
        info.grid = {.start = room.size() / (2.0f * glm::vec3{counts}),
                     .step = room.size() / glm::vec3{counts},
                     .counts = counts};
        info.resolution.depth = edge;
        info.depth = depthEncodingFor(glm::vec3{0}, room.size());
        records.resize(info.grid.probeCount());
        for (std::uint32_t i = 0; i < records.size(); ++i)
            if (room.isSolid(info.grid.pointOf(i))) records[i].state = ProbeState::Inactive;
        // Half a millimetre of room around the walls, so that rounding leaves no sample outside.
        shape = {.start = glm::vec3{-5e-4f},
                 .step = (room.size() + 1e-3f) / glm::vec3{cells},
                 .counts = cells,
                 .probes = {}};
        addSamples(seed);
    }

    /// Centers of random voxel faces that are not inside something: what a scene of voxels gives.
    void addSamples(std::uint32_t seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> uniform;
        std::vector<BoxRoom::Box> solids = room.boxes();
        solids.push_back({glm::vec3{0}, room.size()});
        for (std::size_t b = 0; b < solids.size(); ++b) {
            const bool isRoom = b + 1 == solids.size();
            for (int n = 0; n < (isRoom ? 6000 : 400); ++n) {
                const glm::vec3 extent = solids[b].max - solids[b].min;
                glm::vec3 p =
                    solids[b].min + extent * glm::vec3{uniform(random), uniform(random), uniform(random)};
                p = (glm::floor(p / BoxRoom::kVoxelMetres) + 0.5f) * BoxRoom::kVoxelMetres;
                const int axis = n % 3;
                const bool isUpper = n / 3 % 2 == 0;
                p[axis] = isUpper ? solids[b].max[axis] : solids[b].min[axis];
                glm::vec3 normal{0};
                normal[axis] = isUpper != isRoom ? 1.0f : -1.0f;
                if (!room.isSolid(p + 2e-3f * normal)) samples.push_back({p, normal});
            }
        }
    }

    std::vector<std::uint32_t> mapOf(std::uint32_t probe) const {
        return test::traceDepthNormal(room, info.grid.pointOf(probe), info.resolution.depth,
                                      DepthCoder(info.depth));
    }

    bool trulySees(std::uint32_t probe, const SurfaceSample& sample) const {
        const glm::vec3 toPoint = sample.position - info.grid.pointOf(probe);
        if (glm::dot(toPoint, sample.normal) >= 0) return false;
        const float distance = glm::length(toPoint);
        return room.trace(info.grid.pointOf(probe), toPoint / distance).distance > distance - 2e-3f;
    }

    ProximityInput input(const CellSurfaces& surfaces) const {
        return {.info = info,
                .records = records,
                .depthNormal = [this](std::uint32_t probe) -> Result<std::vector<std::uint32_t>> {
                    return mapOf(probe);
                },
                .shape = shape,
                .surfaces = surfaces};
    }
};

/// Points where rays end that start anywhere in the room and go anywhere: what a path finds.
std::vector<SurfaceSample> pointsWhereRaysEnd(const BoxRoom& room, std::size_t count) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform;
    std::normal_distribution<float> normal;
    std::vector<SurfaceSample> points;
    while (points.size() < count) {
        const glm::vec3 from = room.size() * glm::vec3{uniform(random), uniform(random), uniform(random)};
        const glm::vec3 direction = glm::normalize(glm::vec3{normal(random), normal(random), normal(random)});
        if (room.isSolid(from)) continue;
        const RoomHit hit = room.trace(from, direction);
        points.push_back({from + hit.distance * direction, hit.normal});
    }
    return points;
}

/// How often maps tell wrongly what their probe sees.
struct Judgement {
    std::uint64_t pairs = 0;
    std::uint64_t visible = 0;
    std::uint64_t lost = 0;
    std::uint64_t visibleNotGrazing = 0;
    std::uint64_t lostNotGrazing = 0;
    std::uint64_t wrong = 0;

    void add(bool visibly, bool sees, bool isGrazing) {
        ++pairs;
        if (!visibly) {
            wrong += sees ? 1u : 0u;
            return;
        }
        ++visible;
        lost += sees ? 0u : 1u;
        if (isGrazing) return;
        ++visibleNotGrazing;
        lostNotGrazing += sees ? 0u : 1u;
    }
    static double share(std::uint64_t part, std::uint64_t all) {
        return static_cast<double>(part) / static_cast<double>(all);
    }
    double lostFraction() const { return share(lost, visible); }
    double lostFractionNotGrazing() const { return share(lostNotGrazing, visibleNotGrazing); }
    double wrongFraction() const { return share(wrong, pairs); }
    void print(const char* points) const {
        std::cout << "  " << points << ": lost " << 100 * lostFraction() << " %, above 6 degrees "
                  << 100 * lostFractionNotGrazing() << " %, wrong " << 100 * wrongFraction() << " %\n";
    }
};

/// The gates of the design hold for points where rays end. Of voxel faces by area more is lost at less than
/// six degrees, where a texel spans a quarter of a metre and more: boxes of whole voxels end within a voxel
/// of the probes' own height.
TEST(Proximity, MapsTellWhatAProbeSees) {
    const Scene scene(1024, {4, 2, 4}, {1, 1, 1});
    const DepthCoder coder(scene.info.depth);
    const std::vector<SurfaceSample> ends = pointsWhereRaysEnd(scene.room, 6000);
    Judgement ofEnds;
    Judgement ofFaces;
    for (std::uint32_t probe = 0; probe < scene.records.size(); ++probe) {
        if (!scene.records[probe].isActive()) continue;
        const auto words = scene.mapOf(probe);
        const auto judge = [&](const SurfaceSample& sample, Judgement& judgement) {
            const glm::vec3 toPoint = sample.position - scene.info.grid.pointOf(probe);
            const bool isGrazing = -glm::dot(toPoint, sample.normal) < 0.1f * glm::length(toPoint);
            judgement.add(scene.trulySees(probe, sample),
                          mapSeesSurface(words, toPoint, sample.normal, 1024, coder), isGrazing);
        };
        for (const SurfaceSample& sample : ends) judge(sample, ofEnds);
        for (std::size_t i = 0; i < scene.samples.size(); i += 2) judge(scene.samples[i], ofFaces);
    }
    ofEnds.print("where rays end");
    ofFaces.print("voxel faces by area");
    ASSERT_GT(ofEnds.visible, 50000u);
    EXPECT_LE(ofEnds.lostFraction(), 0.005);
    EXPECT_LE(ofEnds.wrongFraction(), 0.001);
    ASSERT_GT(ofFaces.visibleNotGrazing, 50000u);
    EXPECT_LE(ofFaces.lostFractionNotGrazing(), 0.005);
    EXPECT_LE(ofFaces.lostFraction(), 0.012);
    EXPECT_LE(ofFaces.wrongFraction(), 0.001);
}

/// The rule of mapSeesSurface, by the directions of texels: a neighbor is what lies a texel further on the
/// octahedron's net.
bool texelsAroundSee(const std::vector<std::uint32_t>& words, const SurfaceSample& sample, glm::vec3 eye,
                     std::uint32_t edge, const DepthCoder& coder) {
    const glm::vec3 to = sample.position - eye;
    const glm::vec2 at = (octEncode(to) * 0.5f + 0.5f) * static_cast<float>(edge) - 0.5f;
    const glm::vec2 low = glm::floor(at);
    float agreeing = 0;
    for (const glm::vec2 step : {glm::vec2{0, 0}, glm::vec2{1, 0}, glm::vec2{0, 1}, glm::vec2{1, 1}}) {
        glm::vec2 net = (low + step + 0.5f) / static_cast<float>(edge) * 2.0f - 1.0f;
        // Over an edge of the net: in again on the same edge, mirrored.
        if (std::abs(net.x) > 1) net = {std::copysign(2.0f, net.x) - net.x, -net.y};
        if (std::abs(net.y) > 1) net = {-net.x, std::copysign(2.0f, net.y) - net.y};
        const std::uint32_t word = words[texelIndex(octDecode(net), edge)];
        const glm::vec2 weight = 1.0f - glm::abs(at - low - step);
        if (seesSurface(word, to, sample.normal, edge, coder)) agreeing += weight.x * weight.y;
    }
    return agreeing >= 0.45f;
}

/// The definition in pfvox/proximity.hpp, over all cells and all probes.
ProximityGrid bruteForce(const Scene& scene, const CellSurfaces& surfaces) {
    ProximityGrid grid = scene.shape;
    grid.probes.assign(grid.cellCount() * kProbesPerCell, kNoProbe);
    const DepthCoder coder(scene.info.depth);
    const std::uint32_t edge = scene.info.resolution.depth;
    std::vector<std::vector<std::uint32_t>> maps;
    for (std::uint32_t p = 0; p < scene.records.size(); ++p) maps.push_back(scene.mapOf(p));
    for (std::size_t slot = 0; slot < surfaces.cells.size(); ++slot) {
        const std::uint32_t cell = surfaces.cells[slot];
        const glm::vec3 low =
            grid.start + grid.step * glm::vec3{cell % grid.counts.x, cell / grid.counts.x % grid.counts.y,
                                               cell / grid.counts.x / grid.counts.y};
        const std::size_t first = surfaces.firstOfCell[slot];
        const std::size_t count = surfaces.firstOfCell[slot + 1] - first;
        const std::size_t kept = std::min<std::size_t>(count, 56);
        std::map<std::uint32_t, std::vector<bool>> seen;
        std::map<std::uint32_t, float> texels;
        for (std::uint32_t p = 0; p < scene.records.size(); ++p) {
            const glm::vec3 eye = scene.info.grid.pointOf(p);
            const glm::vec3 center = low + 0.5f * grid.step;
            if (!scene.records[p].isActive() ||
                glm::distance(eye, center) > 2 * glm::length(scene.info.grid.step))
                continue;
            std::vector<bool> bits;
            float sum = 0;
            int surfacesSeen = 0;
            for (std::size_t i = 0; i < kept; ++i) {
                const SurfaceSample& s = surfaces.samples[first + i * count / kept];
                bits.push_back(texelsAroundSee(maps[p], s, eye, edge, coder));
                if (!bits.back()) continue;
                const glm::vec3 way = s.position - eye;
                const float metres = std::max(glm::length(way), 1e-3f);
                const float width = metres * 4.5573f / static_cast<float>(edge);
                sum += std::abs(glm::dot(way, s.normal)) / (metres * width * width);
                ++surfacesSeen;
            }
            if (std::ranges::find(bits, true) == bits.end()) continue;
            for (int c = 0; c < 8; ++c) {
                const glm::vec3 corner = low + grid.step * glm::vec3{c & 1, c >> 1 & 1, c >> 2};
                const std::uint32_t code = depthCodeOf(maps[p][texelIndex(corner - eye, edge)]);
                bits.push_back(code == kDepthMissCode ||
                               coder.decode(code) + 0.01f >= glm::distance(corner, eye));
            }
            seen[p] = bits;
            texels[p] = sum / static_cast<float>(surfacesSeen);
        }
        std::vector<bool> covered(kept + 8);
        for (std::size_t n = 0; n < 4 && !seen.empty(); ++n) {
            std::uint32_t best = kNoProbe;
            std::pair<float, float> bestScore{-1.0f, 0.0f};
            for (const auto& [p, bits] : seen) {
                int fresh = 0;
                for (std::size_t i = 0; i < bits.size(); ++i) fresh += bits[i] && !covered[i] ? 1 : 0;
                const std::pair<float, float> score{static_cast<float>(fresh) * std::sqrt(texels[p]),
                                                    texels[p]};
                if (score > bestScore) {
                    bestScore = score;
                    best = p;
                }
            }
            for (std::size_t i = 0; i < covered.size(); ++i) covered[i] = covered[i] || seen[best][i];
            grid.probes[cell * kProbesPerCell + n] = best;
            seen.erase(best);
        }
    }
    return grid;
}

TEST(Proximity, ChoosesWhatASearchOverAllPairsChooses) {
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        const Scene scene(64, {5, 2, 4}, {9, 5, 8}, seed);
        const CellSurfaces surfaces = sortIntoCells(scene.samples, scene.shape);
        const auto build = buildProximityGrid(scene.input(surfaces));
        ASSERT_TRUE(build) << describe(build.error());
        // Sums of floats may differ in their last bit where the compiler contracts them: a handful of ties.
        const ProximityGrid expected = bruteForce(scene, surfaces);
        std::size_t differing = 0;
        for (std::size_t i = 0; i < expected.probes.size(); ++i)
            differing += expected.probes[i] != build->grid.probes[i] ? 1u : 0u;
        EXPECT_LE(differing, expected.probes.size() / 1000);
        for (std::size_t i = 0; i < expected.probes.size(); ++i) {
            if (build->grid.probes[i] != kNoProbe) {
                EXPECT_TRUE(scene.records[build->grid.probes[i]].isActive());
            }
        }
    }
}

TEST(Proximity, CoversWhatCanBeSeen) {
    const Scene scene(256, {5, 2, 5}, {20, 8, 20});
    const CellSurfaces surfaces = sortIntoCells(scene.samples, scene.shape);
    EXPECT_EQ(surfaces.samples.size(), scene.samples.size());
    const auto build = buildProximityGrid(scene.input(surfaces));
    ASSERT_TRUE(build) << describe(build.error());
    const ProximityReport& report = build->report;
    EXPECT_EQ(report.surfaceCells, surfaces.cells.size());
    EXPECT_GT(report.surfaceCells, 500u);
    EXPECT_LT(report.uncoveredCells, report.surfaceCells / 20);
    // Of the samples that any probe within reach sees, nearly all are seen by one of the four.
    std::uint64_t reachable = 0;
    for (const SurfaceSample& sample : scene.samples) {
        bool isSeen = false;
        for (std::uint32_t p = 0; p < scene.records.size() && !isSeen; ++p)
            isSeen = scene.records[p].isActive() && scene.trulySees(p, sample);
        reachable += isSeen ? 1u : 0u;
    }
    RecordProperty("seen", static_cast<int>(report.seenSamples));
    RecordProperty("reachable", static_cast<int>(reachable));
    EXPECT_GT(static_cast<double>(report.seenSamples), 0.97 * static_cast<double>(reachable));
    std::uint64_t named = 0;
    for (const std::uint32_t probe : build->grid.probes) named += probe != kNoProbe ? 1u : 0u;
    EXPECT_GT(named, 3 * report.surfaceCells);
    EXPECT_EQ(buildProximityGrid(scene.input(surfaces))->grid, build->grid);
}

TEST(Proximity, WorkGrowsWithSurfaceCellsAndTheirCandidatesOnly) {
    const Scene scene(16, {2, 2, 2}, {10, 4, 10});
    const std::vector<SurfaceSample> few(scene.samples.begin(), scene.samples.begin() + 5);
    CellSurfaces surfaces = sortIntoCells(few, scene.shape);
    const auto build = buildProximityGrid(scene.input(surfaces));
    ASSERT_TRUE(build);
    EXPECT_LE(build->report.pairsTested, surfaces.cells.size() * scene.records.size());

    // A long row of probes: only those near the cell are asked.
    Scene row(16, {4, 2, 4}, {10, 4, 10});
    row.info.grid = {.start = {5, 2, 5}, .step = {1, 1, 1}, .counts = {5000, 1, 1}};
    row.records.assign(5000, ProbeRecord{});
    int loaded = 0;
    ProximityInput input = row.input(surfaces);
    input.depthNormal = [&](std::uint32_t) -> Result<std::vector<std::uint32_t>> {
        ++loaded;
        return std::vector<std::uint32_t>(256);
    };
    ASSERT_TRUE(buildProximityGrid(input));
    EXPECT_LE(loaded, 8);
}

TEST(Proximity, FailuresAreReported) {
    const Scene scene(16, {2, 1, 2}, {4, 2, 4});
    const CellSurfaces surfaces = sortIntoCells(scene.samples, scene.shape);
    ProximityInput input = scene.input(surfaces);
    input.depthNormal = [](std::uint32_t) -> Result<std::vector<std::uint32_t>> {
        return std::vector<std::uint32_t>(7);
    };
    EXPECT_EQ(buildProximityGrid(input).error().code, ErrorCode::BadStructure);
    input.depthNormal = [](std::uint32_t) -> Result<std::vector<std::uint32_t>> {
        return fail(ErrorCode::ChecksumMismatch, "damaged");
    };
    EXPECT_EQ(buildProximityGrid(input).error().code, ErrorCode::ChecksumMismatch);
    ProximityInput fewer = scene.input(surfaces);
    fewer.records = fewer.records.subspan(1);
    EXPECT_EQ(buildProximityGrid(fewer).error().code, ErrorCode::BadStructure);
    ProbeFieldInfo compact = scene.info;
    compact.resolution.depth = 0;
    const ProximityInput flat{.info = compact,
                              .records = scene.records,
                              .depthNormal = {},
                              .shape = scene.shape,
                              .surfaces = surfaces};
    EXPECT_EQ(buildProximityGrid(flat).error().code, ErrorCode::BadStructure);
}

}  // namespace
}  // namespace pfvox

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <pfvox/probe_maths.hpp>
#include <pfvox/proximity.hpp>

#include "shared/probe_maths.glsl.h"

namespace pfvox {

namespace {

constexpr float kCandidateDiagonals = 2.0f;
constexpr std::size_t kCorners = 8;
constexpr std::uint64_t kCornerMask = ~std::uint64_t{0} << kMaxSamplesPerCell;
static_assert(kMaxSamplesPerCell + kCorners == 64, "a set of samples is one word");

/// What a probe sees of a cell: bits 0-55 surface samples, 56-63 corners.
struct View {
    std::size_t slot = 0;  ///< in CellSurfaces::cells
    std::uint64_t seen = 0;
    float texels = 0;  ///< a square metre, mean of the samples seen
};

struct Candidate {
    std::uint32_t probe = 0;
    std::uint64_t seen = 0;
    float texels = 0;
};

glm::vec3 cornerOf(const ProximityGrid& shape, std::uint32_t cell, std::size_t corner) {
    const glm::uvec3 place{cell % shape.counts.x, cell / shape.counts.x % shape.counts.y,
                           cell / shape.counts.x / shape.counts.y};
    const glm::uvec3 upper{corner & 1, corner >> 1 & 1, corner >> 2};
    return shape.start + shape.step * glm::vec3{place + upper};
}

/// The samples of a cell that count.
std::vector<SurfaceSample> countedSamples(const CellSurfaces& surfaces, std::size_t slot) {
    const std::size_t first = surfaces.firstOfCell[slot];
    const std::size_t count = surfaces.firstOfCell[slot + 1] - first;
    const std::size_t kept = std::min(count, kMaxSamplesPerCell);
    std::vector<SurfaceSample> samples;
    for (std::size_t i = 0; i < kept; ++i) samples.push_back(surfaces.samples[first + i * count / kept]);
    return samples;
}

/// One probe with its map.
class Eye {
  public:
    Eye(glm::vec3 position, std::vector<std::uint32_t> words, const ProbeFieldInfo& info)
        : position_(position), words_(std::move(words)), edge_(info.resolution.depth), coder_(info.depth) {}

    bool seesSample(const SurfaceSample& sample) const {
        const glm::vec3 toPoint = sample.position - position_;
        return toPoint != glm::vec3{0} && mapSeesSurface(words_, toPoint, sample.normal, edge_, coder_);
    }

    bool seesCorner(glm::vec3 corner) const {
        const glm::vec3 toPoint = corner - position_;
        if (toPoint == glm::vec3{0}) return true;
        const std::uint32_t word = wordTowards(toPoint);
        const float distance = glm::length(toPoint);
        return shared::isMiss(word) ||
               coder_.decode(depthCodeOf(word)) + shared::kSurfaceSlackMetres >= distance;
    }

    /// Of the sample's surface.
    float texelsPerSquareMetre(const SurfaceSample& sample) const {
        const glm::vec3 toPoint = sample.position - position_;
        const float metres = std::max(glm::length(toPoint), 1e-3f);
        const float width = metres * shared::texelAngle(edge_);
        return std::abs(glm::dot(toPoint, sample.normal)) / (metres * width * width);
    }

  private:
    std::uint32_t wordTowards(glm::vec3 toPoint) const { return words_[texelIndex(toPoint, edge_)]; }

    glm::vec3 position_;
    std::vector<std::uint32_t> words_;
    std::uint32_t edge_;
    DepthCoder coder_;
};

class ProximityBuilder {
  public:
    explicit ProximityBuilder(const ProximityInput& input)
        : input_(input), radius_(kCandidateDiagonals * glm::length(input.info.grid.step)) {}

    Result<ProximityBuild> run() {
        listCandidates();
        PFVOX_CHECK(lookFromProbes());
        ProximityBuild build{.grid = input_.shape, .report = report_};
        build.grid.probes.assign(build.grid.cellCount() * kProbesPerCell, kNoProbe);
        gather();
        for (std::size_t slot = 0; slot < byCell_.size(); ++slot) chooseProbes(slot, build);
        return build;
    }

  private:
    glm::vec3 positionOf(std::uint32_t probe) const {
        return input_.info.grid.pointOf(probe) + input_.records[probe].offset;
    }

    /// Goes from cells to the probes around them, so that empty cells and far probes cost nothing.
    void listCandidates() {
        cellsOfProbe_.resize(input_.records.size());
        const ProbeGrid& grid = input_.info.grid;
        for (std::size_t slot = 0; slot < input_.surfaces.cells.size(); ++slot) {
            const glm::vec3 center =
                cornerOf(input_.shape, input_.surfaces.cells[slot], 0) + 0.5f * input_.shape.step;
            // A relocated probe is less than a step away from its grid point.
            const glm::vec3 low = glm::floor((center - radius_ - grid.start) / grid.step) - 1.0f;
            const glm::vec3 high = glm::ceil((center + radius_ - grid.start) / grid.step) + 1.0f;
            const glm::vec3 last{grid.counts - 1u};
            if (glm::any(glm::lessThan(high, glm::vec3{0})) || glm::any(glm::greaterThan(low, last)))
                continue;
            const glm::uvec3 from{glm::clamp(low, glm::vec3{0}, last)};
            const glm::uvec3 to{glm::clamp(high, glm::vec3{0}, last)};
            for (std::uint32_t z = from.z; z <= to.z; ++z)
                for (std::uint32_t y = from.y; y <= to.y; ++y)
                    for (std::uint32_t x = from.x; x <= to.x; ++x) {
                        const std::uint32_t probe = grid.indexOf({x, y, z});
                        if (!input_.records[probe].isActive()) continue;
                        if (glm::distance(positionOf(probe), center) > radius_) continue;
                        cellsOfProbe_[probe].push_back(slot);
                        ++report_.pairsTested;
                    }
        }
    }

    Result<void> lookFromProbes() {
        views_.resize(cellsOfProbe_.size());
        std::vector<Result<void>> results(cellsOfProbe_.size());
        tbb::parallel_for(std::size_t{0}, cellsOfProbe_.size(), [&](std::size_t probe) {
            if (!cellsOfProbe_[probe].empty()) results[probe] = lookFrom(static_cast<std::uint32_t>(probe));
        });
        for (Result<void>& result : results) PFVOX_CHECK(std::move(result));
        return {};
    }

    Result<void> lookFrom(std::uint32_t probe) {
        PFVOX_TRY(auto, words, input_.depthNormal(probe));
        const std::uint64_t texels =
            std::uint64_t{input_.info.resolution.depth} * input_.info.resolution.depth;
        if (words.size() != texels) {
            return fail(ErrorCode::BadStructure, fmt::format("probe {}: a depth map of {} texels, not {}",
                                                             probe, words.size(), texels));
        }
        const Eye eye(positionOf(probe), std::move(words), input_.info);
        for (const std::size_t slot : cellsOfProbe_[probe]) {
            const View view = viewOf(eye, slot);
            if ((view.seen & ~kCornerMask) != 0) views_[probe].push_back(view);
        }
        return {};
    }

    View viewOf(const Eye& eye, std::size_t slot) const {
        View view{.slot = slot};
        const std::vector<SurfaceSample> samples = countedSamples(input_.surfaces, slot);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (!eye.seesSample(samples[i])) continue;
            view.seen |= std::uint64_t{1} << i;
            view.texels += eye.texelsPerSquareMetre(samples[i]);
        }
        if (view.seen == 0) return view;
        view.texels /= static_cast<float>(std::popcount(view.seen));
        for (std::size_t i = 0; i < kCorners; ++i) {
            const glm::vec3 corner = cornerOf(input_.shape, input_.surfaces.cells[slot], i);
            if (eye.seesCorner(corner)) view.seen |= std::uint64_t{1} << (kMaxSamplesPerCell + i);
        }
        return view;
    }

    /// From lists by probe to lists by cell, probes ascending.
    void gather() {
        byCell_.resize(input_.surfaces.cells.size());
        for (std::size_t probe = 0; probe < views_.size(); ++probe)
            for (const View& view : views_[probe])
                byCell_[view.slot].push_back({static_cast<std::uint32_t>(probe), view.seen, view.texels});
    }

    /// Samples that no other sees yet count, each by how fine a picture this probe has: by the width of its
    /// texels there.
    static float gainOf(const Candidate& candidate, std::uint64_t covered) {
        return static_cast<float>(std::popcount(candidate.seen & ~covered)) * std::sqrt(candidate.texels);
    }

    void chooseProbes(std::size_t slot, ProximityBuild& build) {
        std::vector<Candidate> candidates = byCell_[slot];
        std::uint32_t* const list =
            &build.grid.probes[std::size_t{input_.surfaces.cells[slot]} * kProbesPerCell];
        std::uint64_t covered = 0;
        for (std::size_t n = 0; n < kProbesPerCell && !candidates.empty(); ++n) {
            const auto isBetter = [&](const Candidate& a, const Candidate& b) {
                const float gainA = gainOf(a, covered);
                const float gainB = gainOf(b, covered);
                if (gainA != gainB) return gainA > gainB;
                if (a.texels != b.texels) return a.texels > b.texels;
                return a.probe < b.probe;
            };
            const auto best = std::ranges::min_element(candidates, isBetter);
            list[n] = best->probe;
            covered |= best->seen;
            candidates.erase(best);
        }
        const std::size_t count = input_.surfaces.firstOfCell[slot + 1] - input_.surfaces.firstOfCell[slot];
        const auto seenSurface = static_cast<std::uint64_t>(std::popcount(covered & ~kCornerMask));
        ++build.report.surfaceCells;
        build.report.uncoveredCells += seenSurface == 0 ? 1u : 0u;
        build.report.samples += std::min(count, kMaxSamplesPerCell);
        build.report.seenSamples += seenSurface;
    }

    const ProximityInput& input_;
    float radius_;
    ProximityReport report_;
    std::vector<std::vector<std::size_t>> cellsOfProbe_;  ///< slots
    std::vector<std::vector<View>> views_;                ///< by probe
    std::vector<std::vector<Candidate>> byCell_;          ///< by slot
};

}  // namespace

std::optional<std::uint32_t> cellOfSurface(const ProximityGrid& shape, const SurfaceSample& sample) {
    const glm::vec3 at =
        glm::floor(shared::proximityCoordinate(sample.position, sample.normal, shape.start, shape.step));
    if (glm::any(glm::lessThan(at, glm::vec3{0})) || !glm::all(glm::lessThan(at, glm::vec3{shape.counts})))
        return std::nullopt;
    const glm::uvec3 cell{at};
    return cell.x + shape.counts.x * (cell.y + shape.counts.y * cell.z);
}

CellSurfaces sortIntoCells(std::span<const SurfaceSample> samples, const ProximityGrid& shape) {
    std::vector<std::pair<std::uint32_t, std::size_t>> order;
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (const auto cell = cellOfSurface(shape, samples[i])) order.emplace_back(*cell, i);
    std::ranges::sort(order);
    CellSurfaces surfaces;
    for (const auto& [cell, i] : order) {
        if (surfaces.cells.empty() || surfaces.cells.back() != cell) {
            surfaces.cells.push_back(cell);
            surfaces.firstOfCell.push_back(surfaces.samples.size());
        }
        surfaces.samples.push_back(samples[i]);
    }
    surfaces.firstOfCell.push_back(surfaces.samples.size());
    return surfaces;
}

Result<ProximityBuild> buildProximityGrid(const ProximityInput& input) {
    if (input.info.resolution.depth == 0)
        return fail(ErrorCode::BadStructure, "a proximity grid needs probes with depth maps");
    if (input.records.size() != input.info.grid.probeCount()) {
        return fail(ErrorCode::BadStructure, fmt::format("{} records for {} probes", input.records.size(),
                                                         input.info.grid.probeCount()));
    }
    ProximityGrid empty = input.shape;
    empty.probes.clear();
    if (empty.cellCount() == 0) return ProximityBuild{.grid = empty, .report = {}};
    PFVOX_TRY(ProximityBuild, build, ProximityBuilder(input).run());
    PFVOX_CHECK(checkProximityGrid(input.info, build.grid));
    return build;
}

}  // namespace pfvox

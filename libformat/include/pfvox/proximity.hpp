// The proximity grid: for each cell with surface in it the four probes that see it best.
//
//     surface samples -> CellSurfaces; depth-normal maps -> [buildProximityGrid] -> ProximityGrid
//
// Candidates of a cell are the active probes within two diagonals of the probe grid's cell. Its samples are
// surface points and its eight corners. A probe sees a surface point when its texels around agree in distance
// and normal (mapSeesSurface), and a corner when its texel there sees nothing nearer. The first probe of a
// cell is the one that sees most samples, each next one the one that sees most of those that no earlier one
// sees, both weighed by how fine its picture of them is (the root of texels a square metre of the surface);
// of equals the finer one, then the one with the smaller index. Cells without surface name no probe.
//
// The work grows with cells that hold surface times their candidates, never with cells times probes; memory
// holds the maps of as many probes as there are threads.
#pragma once

#include <functional>
#include <optional>
#include <pfvox/pf_probe.hpp>

namespace pfvox {

/// A point on a surface, world space, metres.
struct SurfaceSample {
    glm::vec3 position{0.0f};  ///< metres
    glm::vec3 normal{0.0f};    ///< unit, outward
};

/// At most so many samples of a cell count: of more, so many at equal distances in their list.
inline constexpr std::size_t kMaxSamplesPerCell = 56;

/// Surface samples by cell of a grid.
struct CellSurfaces {
    std::vector<std::uint32_t> cells;      ///< those that hold surface, ascending
    std::vector<std::size_t> firstOfCell;  ///< one for each of them and one more: where its samples begin
    std::vector<SurfaceSample> samples;    ///< cell by cell
};
/// The cell that a point of a surface belongs to; none outside of the box. A point on a face between two
/// cells belongs to the one that its surface is seen from.
std::optional<std::uint32_t> cellOfSurface(const ProximityGrid& shape, const SurfaceSample& sample);

/// Sorts samples into cells, each in the order given; those outside the box are left out.
CellSurfaces sortIntoCells(std::span<const SurfaceSample> samples, const ProximityGrid& shape);
/// What a proximity grid is made from.
struct ProximityInput {
    const ProbeFieldInfo& info;            ///< needs depth maps; the range does not matter
    std::span<const ProbeRecord> records;  ///< of all probes of the grid
    /// The DepthNormal words of an active probe. Called once for each that is a candidate, from several
    /// threads.
    std::function<Result<std::vector<std::uint32_t>>(std::uint32_t probe)> depthNormal;
    const ProximityGrid& shape;    ///< start, step and counts of the result
    const CellSurfaces& surfaces;  ///< by cell of `shape`
};
/// How well the probes see the surfaces.
struct ProximityReport {
    std::uint64_t surfaceCells = 0;    ///< cells that hold surface
    std::uint64_t uncoveredCells = 0;  ///< hold surface of which no probe sees a sample
    std::uint64_t samples = 0;         ///< surface samples that counted
    std::uint64_t seenSamples = 0;     ///< of these, seen by a probe that their cell names
    std::uint64_t pairsTested = 0;     ///< of a cell and a candidate
};
/// The grid and how good it is.
struct ProximityBuild {
    ProximityGrid grid;
    ProximityReport report;
};

/// Errors: BadStructure (no depth maps, wrong number of records or words); those of checkProximityGrid and of
/// `depthNormal`.
Result<ProximityBuild> buildProximityGrid(const ProximityInput& input);

}  // namespace pfvox

// The sums of one probe's light map while it is being traced, and which of its tiles need more paths. On the CPU, in
// double precision and in a fixed order: what comes out does not depend on how the device's work was cut.
#pragma once

#include <pfvox/bake.hpp>
#include <span>
#include <vector>

#include "shared/bake.glsl.h"

namespace pfvox::bake {

/// One workgroup of bake_light.comp.
struct LightItem {
    std::uint32_t tile = 0;
    std::uint32_t batch = 0;
};

struct TileRules {
    std::uint32_t minBatches = 2;
    std::uint32_t maxBatches = 256;
    double noiseTarget = 0.0;  ///< 0 = minBatches and no more
    double noiseFloor = 0.01;
};

class TileSums {
  public:
    /// `seesSurface`: for each texel of the light map, row by row.
    TileSums(std::uint32_t edge, const std::vector<bool>& seesSurface, const TileRules& rules);

    /// The work of the next round: at first minBatches for each tile, then half as many again as a tile has, for those
    /// that are not yet quiet. Empty when all is done.
    std::vector<LightItem> nextRound();
    /// The sums of kTileTexels texels that one item of the round gave; items in the order of the round.
    void add(const LightItem& item, std::span<const glm::vec4> sums);

    /// I for each texel.
    std::vector<glm::vec3> means() const;
    /// Standard error of each texel's mean channel, from the spread of its batches; 0 where it sees no surface.
    std::vector<double> texelErrors() const;
    double meanError() const;        ///< relative standard error of the tiles' means, mean over those that see a surface
    double cappedTileShare() const;  ///< of these, those that stopped at maxBatches before they were quiet
    std::uint64_t samples() const;   ///< over all texels that see a surface
    std::uint64_t surfaceTexels() const;

  private:
    struct Texel {
        glm::dvec3 sum{0.0};
        double batchSum = 0.0;      ///< of the batches' mean values
        double batchSquares = 0.0;
    };
    struct Tile {
        std::uint32_t batches = 0;
        std::uint32_t surfaceTexels = 0;
        bool quiet = false;
    };
    std::size_t texelOf(std::uint32_t tile, std::uint32_t lane) const;
    static double squaredErrorOf(const Texel& texel, double batches);
    /// Standard error of the tile's mean over max(mean, floor), from the spread of its texels' batches.
    double errorOf(std::uint32_t tile) const;

    std::uint32_t edge_;
    TileRules rules_;
    std::vector<bool> seesSurface_;
    std::vector<Texel> texels_;
    std::vector<Tile> tiles_;
};

}  // namespace pfvox::bake

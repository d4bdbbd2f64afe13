#include "octree/lod_builder.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <cmath>
#include <pfvox/assert.hpp>
#include <pfvox/octree_walk.hpp>

#include "octree/lod_measure.hpp"
#include "shared/color.glsl.h"

namespace pfvox::octree {

namespace {

/// sRGB (IEC 61966-2-1) to linear light in 16 bits and back. Whole numbers make sums exact.
class LinearLight {
  public:
    LinearLight() {
        for (std::size_t i = 0; i < linear_.size(); ++i)
            linear_[i] = static_cast<std::uint16_t>(std::lround(decoded(static_cast<double>(i))));
        std::size_t next = 0;
        for (std::size_t i = 0; i < linear_.size(); ++i) {
            const double end = i == 255 ? 65536.0 : decoded(static_cast<double>(i) + 0.5);
            for (; static_cast<double>(next) < end; ++next) encoded_[next] = static_cast<std::uint8_t>(i);
        }
    }
    std::uint64_t decode(std::uint8_t value) const { return linear_[value]; }
    std::uint32_t encode(std::uint64_t linear) const { return encoded_[linear]; }

  private:
    static double decoded(double value) { return 65535.0 * shared::linearFromSrgb(value / 255.0); }
    std::array<std::uint16_t, 256> linear_{};
    std::array<std::uint8_t, 65536> encoded_{};
};

std::uint32_t rgbOf(const Material& m) {
    return m.baseColor.r | (std::uint32_t{m.baseColor.g} << 8) | (std::uint32_t{m.baseColor.b} << 16);
}

/// What all regions of a model share.
struct Model {
    const VoxelModel& source;
    const std::vector<Material>& materials;
    const OpacityGrid& opacity;
    const LinearLight& light;
};

/// Walks one region after the other, children before parents; one for each thread.
class RegionWalk {
  public:
    explicit RegionWalk(const Model& model) : model_(model) {
        for (std::uint32_t e = kBrickEdgeLog2; e <= kRegionEdgeLog2; ++e) shadows_.emplace_back(e);
    }

    void run(OctreeRegion& region) {
        region_ = &region;
        const glm::ivec3 corner = region.originVoxels & (kRegionEdge - 1);
        const glm::ivec3 coord = region.originVoxels >> kRegionEdgeLog2;
        place_ = {.region = model_.opacity.regionAt(coord), .cell = kNoCell};
        source_ = model_.source.regions()[place_.region].get();
        for (Histogram& h : histograms_) h.reset(region.palette.size());
        region.lod.colors.resize(region.tree.nodes.size());
        region.lod.materials.resize(region.tree.nodes.size());
        visit({.index = 0, .morton = mortonEncode(glm::uvec3{corner}), .edgeLog2 = region.tree.depth},
              kNoValue);
    }

  private:
    static constexpr std::uint32_t kNoCell = 0xffffffffu;

    /// A node and its cube: Morton code of its corner in the region, in voxels.
    struct Node {
        std::uint32_t index;
        std::uint32_t morton;
        std::uint32_t edgeLog2;
    };

    void visit(const Node& node, std::uint32_t inherited) {
        if (node.edgeLog2 <= kBrickEdgeLog2) enterBrick(node.morton >> (3 * kBrickEdgeLog2));
        Histogram& faces = histograms_[node.edgeLog2];
        faces.clear();
        if (node.edgeLog2 > kBrickEdgeLog2) shadow(node.edgeLog2).clear();
        const std::uint32_t below = node.edgeLog2 - 1;
        forEachChild(*region_, node.index, inherited, [&](const NodeChild& child, std::uint32_t value) {
            const std::uint32_t morton = node.morton + (child.slot << (3 * below));
            if (child.isLeaf) {
                faces.add(value, facesOfLeaf(morton, below, value));
                if (below >= kBrickEdgeLog2) shadow(node.edgeLog2).addSolid(child.slot);
                return;
            }
            visit({.index = child.index, .morton = morton, .edgeLog2 = below}, value);
            faces.add(histograms_[below]);
            if (below >= kBrickEdgeLog2) shadow(node.edgeLog2).add(child.slot, shadow(below));
        });
        region_->lod.colors[node.index] = meanColor(faces) | (coverage(node) << 24);
        region_->lod.materials[node.index] = dominantMaterial(faces);
    }

    Shadow& shadow(std::uint32_t edgeLog2) { return shadows_[edgeLog2 - kBrickEdgeLog2]; }

    /// Makes the brick at a cell the one that faces_ and occupied_ are about.
    void enterBrick(std::uint32_t cell) {
        if (place_.cell == cell) return;
        place_.cell = cell;
        const VoxelRegion::Cell content = source_->cell(cell);
        PFVOX_ASSERT(!content.empty());
        occupied_ = content.brick != nullptr ? content.brick->occupancy : kAllVoxels;
        faces_ = FaceCounts(occupied_, model_.opacity, place_);
        shadow(kBrickEdgeLog2).set(occupied_);
    }

    std::uint32_t facesOfLeaf(std::uint32_t morton, std::uint32_t edgeLog2, std::uint32_t value) const {
        if (edgeLog2 >= kBrickEdgeLog2) {
            return facesOfTile(model_.opacity, {place_.region, morton >> (3 * kBrickEdgeLog2)}, edgeLog2,
                               isOpaque(model_.materials[region_->palette[value]]));
        }
        const std::uint32_t voxels = 1u << (3 * edgeLog2);
        const std::uint64_t mask = voxels == 64 ? ~0ull : ((1ull << voxels) - 1) << (morton & 63u);
        return faces_.sum((morton >> 6) & 7u, mask);
    }

    /// Rounded up, so that nothing that is there has no coverage.
    std::uint32_t coverage(const Node& node) {
        const std::uint32_t all = 3u << (2 * node.edgeLog2);
        const std::uint64_t block = occupied_[(node.morton >> 6) & 7u];
        const std::uint32_t columns = node.edgeLog2 >= 3 ? shadow(node.edgeLog2).columns()
                                      : node.edgeLog2 == 2
                                          ? shadowColumns(block)
                                          : shadowColumnsOfOctet(block >> (node.morton & 63u) & 0xffu);
        return (255 * columns + all - 1) / all;
    }

    std::uint32_t meanColor(const Histogram& faces) const {
        const auto material = [&](std::uint32_t value) -> const Material& {
            return model_.materials[region_->palette[value]];
        };
        if (faces.used().empty()) return 0;
        if (faces.used().size() == 1) return rgbOf(material(faces.used()[0]));
        std::array<std::uint64_t, 3> sum{};
        std::uint64_t weight = 0;
        for (const std::uint32_t value : faces.used()) {
            const glm::u8vec4 color = material(value).baseColor;
            const std::uint64_t w = faces.faces(value);
            sum[0] += w * model_.light.decode(color.r);
            sum[1] += w * model_.light.decode(color.g);
            sum[2] += w * model_.light.decode(color.b);
            weight += w;
        }
        const auto mean = [&](std::size_t c) { return model_.light.encode((sum[c] + weight / 2) / weight); };
        return mean(0) | (mean(1) << 8) | (mean(2) << 16);
    }

    static std::uint16_t dominantMaterial(const Histogram& faces) {
        std::uint32_t best = 0;
        for (const std::uint32_t value : faces.used()) {
            const bool more = faces.faces(value) > faces.faces(best);
            if (more || (faces.faces(value) == faces.faces(best) && value < best)) best = value;
        }
        return static_cast<std::uint16_t>(best);
    }

    const Model& model_;
    OctreeRegion* region_ = nullptr;
    const VoxelRegion* source_ = nullptr;
    CellPlace place_{};  ///< of the brick that was entered last
    BrickMask occupied_{};
    FaceCounts faces_;
    std::array<Histogram, kRegionEdgeLog2 + 1> histograms_;  ///< by edgeLog2 of the node
    std::vector<Shadow> shadows_;                            ///< by edgeLog2 - 3
};

}  // namespace

void addLod(const VoxelModel& source, const std::vector<Material>& materials, OctreeModel& built) {
    static const LinearLight light;
    const OpacityGrid opacity(source, materials);
    const Model model{.source = source, .materials = materials, .opacity = opacity, .light = light};
    tbb::enumerable_thread_specific<RegionWalk> walks([&] { return RegionWalk(model); });
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, built.regions.size(), 1), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) walks.local().run(built.regions[i]);
    });
}

}  // namespace pfvox::octree

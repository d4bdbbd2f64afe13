#include "scene/face_table.hpp"

#include <tbb/parallel_for.h>

#include <array>
#include <bit>
#include <map>
#include <pfvox/assert.hpp>
#include <pfvox/octree_walk.hpp>

#include "shared/faces.glsl.h"

namespace pfvox::gpu::detail {

namespace {

using shared::WideNode;

constexpr std::uint32_t kRegionLevel = 4;  ///< 256 voxels
constexpr std::uint32_t kCellBits = 6;     ///< of a path, a level

/// Wide nodes by their number in the model.
class Nodes {
  public:
    explicit Nodes(const WideTree& tree) : tree_(tree) {}

    const WideNode& operator[](std::uint32_t index) const {
        const auto after =
            std::ranges::upper_bound(tree_.places, std::uint64_t{index}, {}, &WidePlace::firstNode);
        const auto piece = static_cast<std::size_t>(after - tree_.places.begin()) - 1;
        return tree_.pieces[piece].nodes[index - tree_.places[piece].firstNode];
    }

  private:
    const WideTree& tree_;
};

std::uint64_t cellsOf(const WideNode& node) {
    return node.maskLow | std::uint64_t{node.maskHigh} << 32;
}

/// What one part of the tree brings.
struct Part {
    std::vector<std::pair<std::uint32_t, glm::uvec2>> cells;  ///< by node
    std::vector<glm::uvec2> slots;
    std::vector<FaceNode> nodes;
    std::uint32_t directions = 0;

    std::uint32_t addSlots(std::uint32_t count) {
        const auto first = static_cast<std::uint32_t>(slots.size());
        slots.resize(slots.size() + count);
        return first;
    }
    void add(std::uint32_t node, const FaceNode& made) {
        cells.emplace_back(node,
                           glm::uvec2(made.directions | made.slot << shared::kFaceSlotShift, made.firstFace));
        nodes.push_back(made);
    }
    /// A node of which so many children have faces in these directions.
    void addInner(std::uint32_t node, std::uint32_t children, std::uint32_t faces) {
        if (faces == 0) return;
        const std::uint32_t slot = addSlots(static_cast<std::uint32_t>(std::popcount(faces)));
        add(node, {.slot = slot, .children = children, .firstFace = 0, .squares = 0, .directions = faces});
    }
};

/// One region's part. Bricks come in the order of their paths, which is that of the walk.
class RegionWalk {
  public:
    RegionWalk(const Nodes& nodes, const FaceIndex& index, const FaceRegion& region, Part& out)
        : nodes_(nodes), index_(index), next_(region.firstBrick), end_(region.endBrick), out_(out) {}

    /// The directions of its faces. `level`: its edge is 4^level voxels.
    std::uint32_t walk(std::uint32_t node, std::uint32_t level, std::uint32_t path) {
        if (next_ == end_) return 0;
        const std::uint32_t shift = kCellBits * (level - 1);
        if (index_.bricks[next_].path >> shift != path) return 0;
        if (level == 1) return brick(node);
        const WideNode& at = nodes_[node];
        if ((at.kind & shared::kWideKindMask) == shared::kWideSolid) return largeLeaf(node, level, path);
        std::uint32_t faces = 0;
        std::uint32_t children = 0;
        std::uint32_t child = at.child;
        for (std::uint64_t rest = cellsOf(at); rest != 0; rest &= rest - 1, ++child) {
            const auto cell = static_cast<std::uint32_t>(std::countr_zero(rest));
            const std::uint32_t found = walk(child, level - 1, path << kCellBits | cell);
            faces |= found;
            children += found != 0 ? 1 : 0;
        }
        out_.addInner(node, children, faces);
        return faces;
    }

  private:
    std::uint32_t brick(std::uint32_t node) {
        const FaceBrick& brick = index_.bricks[next_++];
        const auto count = static_cast<std::uint32_t>(std::popcount(brick.directions));
        const std::uint32_t slot = out_.addSlots(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint64_t mask = index_.masks[brick.firstMask + i];
            out_.slots[slot + i] = {static_cast<std::uint32_t>(mask), static_cast<std::uint32_t>(mask >> 32)};
        }
        out_.add(node, {.slot = slot,
                        .children = 0,
                        .firstFace = brick.firstFace,
                        .squares = 0,
                        .directions = brick.directions});
        return brick.directions;
    }

    /// The bits of a mask that lie in the plane of a side, in their order.
    static std::uint32_t squareOf(std::uint64_t mask, unsigned face) {
        const unsigned axis = face / 2;
        const unsigned plane = face % 2 != 0 ? 3 : 0;
        std::uint32_t square = 0;
        for (unsigned i = 0; i < 16; ++i) {
            std::array<unsigned, 3> at{};
            at[axis] = plane;
            at[axis == 0 ? 1 : 0] = i & 3u;
            at[axis == 2 ? 1 : 2] = i >> 2;
            square |= static_cast<std::uint32_t>(mask >> (at[0] + 4 * at[1] + 16 * at[2]) & 1u) << i;
        }
        return square;
    }

    std::uint32_t largeLeaf(std::uint32_t node, std::uint32_t level, std::uint32_t path) {
        const std::uint32_t shift = kCellBits * (level - 1);
        const std::uint32_t first = next_;
        std::uint32_t directions = 0;
        for (; next_ != end_ && index_.bricks[next_].path >> shift == path; ++next_)
            directions |= index_.bricks[next_].directions;
        const std::uint32_t edge = 1u << (2 * (level - 1));  // bricks
        const std::uint32_t squares = edge * edge;
        const std::uint32_t slot =
            out_.addSlots(static_cast<std::uint32_t>(std::popcount(directions)) * squares);
        const std::uint32_t firstFace = index_.bricks[first].firstFace;
        for (std::uint32_t i = first; i < next_; ++i) {
            const FaceBrick& brick = index_.bricks[i];
            const glm::uvec3 at = glm::uvec3(brick.corner() / 4) & (edge - 1);
            std::uint32_t face = brick.firstFace - firstFace;
            std::uint32_t mask = brick.firstMask;
            for (unsigned d = 0; d < 6; ++d) {
                if ((brick.directions >> d & 1u) == 0) continue;
                const std::uint32_t a = at[d / 2 == 0 ? 1 : 0];
                const std::uint32_t b = at[d / 2 == 2 ? 1 : 2];
                const std::uint64_t bits = index_.masks[mask++];
                out_.slots[slot + countBelow(directions, d) * squares + a + edge * b] = {squareOf(bits, d),
                                                                                         face};
                face += static_cast<std::uint32_t>(std::popcount(bits));
            }
        }
        out_.add(node, {.slot = slot,
                        .children = 0,
                        .firstFace = firstFace,
                        .squares = squares,
                        .directions = directions});
        return directions;
    }

    const Nodes& nodes_;
    const FaceIndex& index_;
    std::uint32_t next_;
    std::uint32_t end_;
    Part& out_;
};

/// The nodes above the regions.
class TopWalk {
  public:
    TopWalk(const OctreeModel& model, const WideTree& tree, const FaceIndex& index)
        : levels_(tree.levels), nodes_(tree), index_(index) {
        for (std::size_t i = 0; i < model.regions.size(); ++i) {
            const glm::ivec3 at = model.regions[i].originVoxels - model.originVoxels;
            regionAt_[{at.x, at.y, at.z}] = i;
        }
    }

    void run(FaceTable& table) {
        find(0, levels_, glm::ivec3(0));
        parts_.resize(roots_.size());
        tbb::parallel_for(std::size_t{0}, roots_.size(), [&](std::size_t i) {
            const Root& root = roots_[i];
            RegionWalk walk(nodes_, index_, index_.regions[root.region], parts_[i]);
            parts_[i].directions = walk.walk(root.node, std::min(levels_, kRegionLevel), 0);
        });
        join(0, levels_, table);
    }

  private:
    struct Root {
        std::uint32_t node = 0;
        std::size_t region = 0;
    };

    void find(std::uint32_t node, std::uint32_t level, glm::ivec3 corner) {
        if (level <= kRegionLevel) {
            roots_.push_back({node, regionAt_.at({corner.x, corner.y, corner.z})});
            return;
        }
        const WideNode& at = nodes_[node];
        std::uint32_t child = at.child;
        for (std::uint64_t rest = cellsOf(at); rest != 0; rest &= rest - 1, ++child) {
            const int cell = std::countr_zero(rest);
            const glm::ivec3 step{cell & 3, cell >> 2 & 3, cell >> 4};
            find(child, level - 1, corner + (step << static_cast<int>(2 * (level - 1))));
        }
    }

    std::uint32_t join(std::uint32_t node, std::uint32_t level, FaceTable& table) {
        if (level <= kRegionLevel) return take(parts_[nextPart_++], table);
        const WideNode& at = nodes_[node];
        std::uint32_t faces = 0;
        std::uint32_t children = 0;
        std::uint32_t child = at.child;
        for (std::uint64_t rest = cellsOf(at); rest != 0; rest &= rest - 1, ++child) {
            const std::uint32_t found = join(child, level - 1, table);
            faces |= found;
            children += found != 0 ? 1 : 0;
        }
        Part own;
        own.addInner(node, children, faces);
        take(own, table);
        return faces;
    }

    static std::uint32_t take(Part& part, FaceTable& table) {
        const auto first = static_cast<std::uint32_t>(table.slots.size());
        for (const auto& [node, cell] : part.cells)
            table.cells[node] = {cell.x + (first << shared::kFaceSlotShift), cell.y};
        table.slots.insert(table.slots.end(), part.slots.begin(), part.slots.end());
        for (FaceNode& made : part.nodes) {
            made.slot += first;
            table.nodes.push_back(made);
        }
        const std::uint32_t directions = part.directions;
        part = {};
        return directions;
    }

    std::uint32_t levels_;
    Nodes nodes_;
    const FaceIndex& index_;
    std::map<std::array<int, 3>, std::size_t> regionAt_;  ///< by its corner in the model's cube
    std::vector<Root> roots_;
    std::vector<Part> parts_;
    std::size_t nextPart_ = 0;
};

}  // namespace

Result<FaceTable> makeFaceTable(const OctreeModel& model, const WideTree& tree, FaceIndex index) {
    FaceTable table;
    table.cells.resize(tree.end.firstNode);
    TopWalk(model, tree, index).run(table);
    table.index = std::move(index);
    if (table.slots.size() >= std::size_t{1} << (32 - shared::kFaceSlotShift))
        return fail(ErrorCode::GpuOutOfMemory,
                    "model '" + model.name.str() + "' has more faces than one model on the GPU can have");
    return table;
}

}  // namespace pfvox::gpu::detail

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <array>
#include <bit>
#include <pfvox/face_index.hpp>
#include <pfvox/octree_walk.hpp>

namespace pfvox {

namespace {

using Mask = std::uint64_t;

constexpr int kSide = 4;
constexpr Mask kAll = ~Mask{0};

/// Two bits of a coordinate to each six of a path.
constexpr std::array<std::uint32_t, 64> makeSpread() {
    std::array<std::uint32_t, 64> table{};
    for (std::uint32_t i = 0; i < 64; ++i) table[i] = (i & 3u) | (i & 12u) << 4 | (i & 48u) << 8;
    return table;
}
constexpr std::array<std::uint32_t, 64> kSpread = makeSpread();

std::uint32_t pathOf(glm::ivec3 brick) {
    return kSpread[static_cast<std::size_t>(brick.x)] | kSpread[static_cast<std::size_t>(brick.y)] << 2 |
           kSpread[static_cast<std::size_t>(brick.z)] << 4;
}
glm::ivec3 brickAt(std::uint32_t path) {
    const auto gathered = [path](std::uint32_t shift) {
        const std::uint32_t p = path >> shift;
        return static_cast<int>((p & 3u) | (p >> 4 & 12u) | (p >> 8 & 48u));
    };
    return {gathered(0), gathered(2), gathered(4)};
}

constexpr Mask bitOf(glm::ivec3 voxel) {
    return Mask{1} << (voxel.x + kSide * voxel.y + kSide * kSide * voxel.z);
}

/// The voxels of a brick whose coordinate along the axis is 0.
constexpr std::array<Mask, 3> kLowest{0x1111111111111111u, 0x000f000f000f000fu, 0x000000000000ffffu};

/// For each voxel of a block the bit of its neighbor in the direction of `face`; `beside` is the block there.
Mask neighbors(Mask block, Mask beside, unsigned face) {
    const unsigned axis = face / 2;
    const unsigned step = 1u << (2 * axis);
    const Mask lowest = kLowest[axis];
    const Mask highest = lowest << (3 * step);
    if (face % 2 != 0) return ((block >> step) & ~highest) | ((beside & lowest) << (3 * step));
    return ((block << step) & ~lowest) | ((beside & highest) >> (3 * step));
}

/// What the voxels of a brick are for light.
struct BrickVoxels {
    Mask solid = 0;   ///< stop light
    Mask glass = 0;   ///< let it through
    Mask cloudy = 0;  ///< glass with a Lambert fraction
};

struct Kind {
    bool solid = false;
    bool cloudy = false;
};

class RegionFaces {
  public:
    RegionFaces(const OctreeModel& model, const OctreeRegion& region, std::span<const Kind> kinds)
        : model_(model), region_(region), kinds_(kinds) {}

    std::vector<FaceBrick> bricks;
    std::vector<Mask> masks;
    std::uint64_t faceCount = 0;

    void find() {
        if (region_.tree.nodes.empty()) return;
        edge_ = std::max(1, (1 << region_.tree.depth) / kSide);
        voxels_.resize(std::size_t{pathOf(glm::ivec3(edge_ - 1))} + 1);
        forEachLeaf(region_, [&](const Leaf& leaf) { fill(leaf); });
        for (std::uint32_t path = 0; path < voxels_.size(); ++path)
            if ((voxels_[path].solid | voxels_[path].cloudy) != 0) addBrick(path);
        voxels_ = {};
    }

  private:
    void fill(const Leaf& leaf) {
        const glm::ivec3 corner = leaf.corner - region_.originVoxels;
        const Kind kind = kinds_[leaf.material];
        const auto add = [&](std::uint32_t path, Mask mask) {
            BrickVoxels& voxels = voxels_[path];
            (kind.solid ? voxels.solid : voxels.glass) |= mask;
            if (kind.cloudy) voxels.cloudy |= mask;
        };
        if (leaf.edge() < kSide) {
            Mask mask = 0;
            const glm::ivec3 within = corner & (kSide - 1);
            for (int z = 0; z < leaf.edge(); ++z)
                for (int y = 0; y < leaf.edge(); ++y)
                    for (int x = 0; x < leaf.edge(); ++x) mask |= bitOf(within + glm::ivec3(x, y, z));
            return add(pathOf(corner / kSide), mask);
        }
        const int count = leaf.edge() / kSide;
        for (int z = 0; z < count; ++z)
            for (int y = 0; y < count; ++y)
                for (int x = 0; x < count; ++x) add(pathOf(corner / kSide + glm::ivec3(x, y, z)), kAll);
    }

    /// The brick beside one, where the region ends asked voxel by voxel.
    BrickVoxels beside(glm::ivec3 brick, unsigned face, Mask asking) const {
        const auto axis = static_cast<int>(face / 2);
        const bool up = face % 2 != 0;
        glm::ivec3 next = brick;
        next[axis] += up ? 1 : -1;
        if (next[axis] >= 0 && next[axis] < edge_) return voxels_[pathOf(next)];
        BrickVoxels found;
        for (Mask rest = asking; rest != 0; rest &= rest - 1) {
            const int k = std::countr_zero(rest);
            glm::ivec3 within{k & 3, k >> 2 & 3, k >> 4};
            if (within[axis] != (up ? kSide - 1 : 0)) continue;
            within[axis] = up ? 0 : kSide - 1;
            const auto material = model_.at(region_.originVoxels + kSide * next + within);
            if (material) (kinds_[*material].solid ? found.solid : found.glass) |= bitOf(within);
        }
        return found;
    }

    void addBrick(std::uint32_t path) {
        const BrickVoxels& voxels = voxels_[path];
        const glm::ivec3 brick = brickAt(path);
        FaceBrick made{.path = path,
                       .firstFace = static_cast<std::uint32_t>(faceCount),
                       .firstMask = static_cast<std::uint32_t>(masks.size()),
                       .directions = 0};
        for (unsigned face = 0; face < 6; ++face) {
            const BrickVoxels next = beside(brick, face, voxels.solid | voxels.cloudy);
            const Mask solid = neighbors(voxels.solid, next.solid, face);
            const Mask any = solid | neighbors(voxels.glass, next.glass, face);
            const Mask exposed = (voxels.solid & ~solid) | (voxels.cloudy & ~any);
            if (exposed == 0) continue;
            made.directions = static_cast<std::uint8_t>(made.directions | 1u << face);
            masks.push_back(exposed);
            faceCount += static_cast<unsigned>(std::popcount(exposed));
        }
        if (made.directions != 0) bricks.push_back(made);
    }

    const OctreeModel& model_;
    const OctreeRegion& region_;
    std::span<const Kind> kinds_;
    int edge_ = 0;                     ///< of the region's cube, bricks
    std::vector<BrickVoxels> voxels_;  ///< by path
};

}  // namespace

glm::ivec3 FaceBrick::corner() const {
    return kSide * brickAt(path);
}

std::vector<std::uint32_t> FaceIndex::fileOrder(std::size_t region) const {
    const FaceRegion& r = regions[region];
    std::vector<std::uint32_t> order;
    order.reserve(r.endFace - r.firstFace);
    for (unsigned direction = 0; direction < 6; ++direction) {
        for (std::uint32_t i = r.firstBrick; i < r.endBrick; ++i) {
            const FaceBrick& brick = bricks[i];
            if ((brick.directions >> direction & 1u) == 0) continue;
            const std::uint32_t before = countBelow(brick.directions, direction);
            std::uint32_t face = brick.firstFace - r.firstFace;
            for (std::uint32_t m = 0; m < before; ++m)
                face += static_cast<std::uint32_t>(std::popcount(masks[brick.firstMask + m]));
            const int count = std::popcount(masks[brick.firstMask + before]);
            for (int k = 0; k < count; ++k) order.push_back(face++);
        }
    }
    return order;
}

Result<FaceIndex> makeFaceIndex(const OctreeModel& model, std::span<const Material> materials) {
    std::vector<Kind> kinds;
    for (const Material& m : materials)
        kinds.push_back({.solid = !letsThrough(m), .cloudy = letsThrough(m) && m.transparency < 1.0f});
    std::vector<RegionFaces> found;
    for (const OctreeRegion& region : model.regions) found.emplace_back(model, region, kinds);
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) { found[i].find(); });
    FaceIndex index;
    std::uint64_t faces = 0;
    for (const RegionFaces& region : found) faces += region.faceCount;
    if (faces >= 0xffffffffu)
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("model '{}' has {} exposed faces; light is baked for at most 4 billion",
                                model.name.str(), faces));
    for (std::size_t i = 0; i < found.size(); ++i) {
        const auto firstBrick = static_cast<std::uint32_t>(index.bricks.size());
        const auto firstMask = static_cast<std::uint32_t>(index.masks.size());
        for (FaceBrick brick : found[i].bricks) {
            brick.firstFace += index.faceCount;
            brick.firstMask += firstMask;
            index.bricks.push_back(brick);
        }
        index.masks.insert(index.masks.end(), found[i].masks.begin(), found[i].masks.end());
        const std::uint32_t endFace = index.faceCount + static_cast<std::uint32_t>(found[i].faceCount);
        index.regions.push_back({.originVoxels = model.regions[i].originVoxels,
                                 .firstBrick = firstBrick,
                                 .endBrick = static_cast<std::uint32_t>(index.bricks.size()),
                                 .firstFace = index.faceCount,
                                 .endFace = endFace});
        index.faceCount = endFace;
    }
    return index;
}

}  // namespace pfvox

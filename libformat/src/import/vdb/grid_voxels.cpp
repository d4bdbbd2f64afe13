#include "import/vdb/grid_voxels.hpp"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <type_traits>

#include "import/vdb/index_frame.hpp"

namespace pfvox::import::vdb {

namespace {

/// Beyond it sums of coordinates no longer fit int32 in later stages.
constexpr std::int64_t kLargestCoordinate = std::int64_t{1} << 30;

/// Edge of a tile, by the level of the node that it replaces.
constexpr int kLeafLog2 = 3;
constexpr int kLowerLog2 = 7;
constexpr int kUpperLog2 = 12;

/// Which voxels are solid, and the number that an integer grid gives them.
template <class Value>
struct Rule {
    bool levelSet = false;
    double threshold = 0.0;

    bool solid(const Value& value, bool active) const {
        if constexpr (std::is_same_v<Value, bool>) {
            return active && value;
        } else if constexpr (std::is_floating_point_v<Value>) {
            return levelSet ? value < Value{0} : active && static_cast<double>(value) > threshold;
        } else if constexpr (std::is_integral_v<Value>) {
            return active && value != 0;
        } else {
            return active;
        }
    }
};

template <class TreeT>
class TreeWalker {
  public:
    using Value = typename TreeT::ValueType;
    using Leaf = typename TreeT::LeafNodeType;
    static constexpr bool kLabelled = std::is_integral_v<Value> && !std::is_same_v<Value, bool>;

    TreeWalker(const FillSettings& settings, Rule<Value> rule, LabelTable& labels, ModelBudget& budget,
               VoxelModel& model)
        : settings_(settings),
          rule_(rule),
          frame_(settings.upAxis),
          labels_(labels),
          budget_(budget),
          model_(model) {}

    Result<void> walk(const TreeT& tree) {
        const auto& root = tree.root();
        for (auto tile = root.cbeginValueAll(); tile; ++tile) {
            if (!rule_.solid(*tile, tile.isValueOn())) continue;
            PFVOX_CHECK(checkReach(tile.getCoord()));
            PFVOX_CHECK(writeTile(tile.getCoord(), kUpperLog2, *tile));
        }
        for (auto upper = root.cbeginChildOn(); upper; ++upper) {
            PFVOX_CHECK(walkUpper(*upper));
        }
        return budget_.check(model_);
    }

  private:
    template <class Node>
    Result<void> walkUpper(const Node& node) {
        for (auto lower = node.cbeginChildOn(); lower; ++lower) {
            PFVOX_CHECK(checkReach(lower->origin()));
            PFVOX_CHECK(walkLower(*lower));
        }
        return writeTiles(node, kLowerLog2);
    }

    template <class Node>
    Result<void> walkLower(const Node& node) {
        for (auto leaf = node.cbeginChildOn(); leaf; ++leaf) PFVOX_CHECK(writeLeaf(*leaf, leaf.getCoord()));
        return writeTiles(node, kLeafLog2);
    }

    template <class Node>
    Result<void> writeTiles(const Node& node, int edgeLog2) {
        for (auto tile = node.cbeginValueAll(); tile; ++tile) {
            if (!rule_.solid(*tile, tile.isValueOn())) continue;
            PFVOX_CHECK(checkReach(tile.getCoord()));
            PFVOX_CHECK(writeTile(tile.getCoord(), edgeLog2, *tile));
        }
        return {};
    }

    Result<void> checkReach(const openvdb::Coord& corner) const {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (std::int64_t{corner[axis]} < -kLargestCoordinate ||
                std::int64_t{corner[axis]} >= kLargestCoordinate) {
                return fail(
                    ErrorCode::LimitExceeded,
                    fmt::format("solid voxels at ({}, {}, {}): coordinates beyond 2^30 are not supported",
                                corner.x(), corner.y(), corner.z()));
            }
        }
        return {};
    }

    Result<void> writeTile(const openvdb::Coord& corner, int edgeLog2, const Value& value) {
        PFVOX_CHECK(budget_.step(model_));
        PFVOX_CHECK(budget_.checkTile(model_, edgeLog2));
        PFVOX_TRY(const auto, material, tileMaterial(corner, edgeLog2, value));
        if (material) {
            model_.fillTile(frame_.cube(corner, edgeLog2), edgeLog2, *material);
            return {};
        }
        if (edgeLog2 == kLeafLog2) {
            LeafMaterials materials;
            settings_.shader->shadeLeaf(corner, materials);
            Brick& brick = brickAt(corner);
            for (std::uint32_t i = 0; i < kBrickVoxels; ++i) brick.set(frame_.mortonOf(i), materials[i]);
            return {};
        }
        const int childLog2 = edgeLog2 == kUpperLog2 ? kLowerLog2 : kLeafLog2;
        const int children = 1 << (edgeLog2 - childLog2);
        for (int x = 0; x < children; ++x)
            for (int y = 0; y < children; ++y)
                for (int z = 0; z < children; ++z) {
                    const openvdb::Coord child =
                        corner.offsetBy(x << childLog2, y << childLog2, z << childLog2);
                    PFVOX_CHECK(writeTile(child, childLog2, value));
                }
        return {};
    }

    /// Nothing where the colors inside the tile differ.
    Result<std::optional<MaterialIndex>> tileMaterial(const openvdb::Coord& corner, int edgeLog2,
                                                      const Value& value) {
        if constexpr (kLabelled) {
            PFVOX_TRY(const auto, material, labelMaterial(value));
            return std::optional{material};
        }
        if (settings_.shader != nullptr) return settings_.shader->shadeTile(corner, edgeLog2);
        return std::optional{settings_.plainMaterial};
    }

    /// `origin` is the place in the tree: bool leaves have an own one, which the file may spoil.
    Result<void> writeLeaf(const Leaf& leaf, const openvdb::Coord& origin) {
        std::array<std::uint64_t, 8> occupancy{};
        std::uint32_t count = 0;
        for (std::uint32_t i = 0; i < kBrickVoxels; ++i) {
            if (!rule_.solid(leaf.getValue(i), leaf.isValueOn(i))) continue;
            const std::uint32_t m = frame_.mortonOf(i);
            occupancy[m >> 6] |= std::uint64_t{1} << (m & 63u);
            ++count;
        }
        if (count == 0) return {};
        PFVOX_CHECK(budget_.step(model_));
        if (!kLabelled && settings_.shader == nullptr) {
            writePlain(origin, occupancy, count);
            return {};
        }
        LeafMaterials materials;
        if constexpr (kLabelled) {
            PFVOX_CHECK(labelLeaf(leaf, materials));
        } else {
            settings_.shader->shadeLeaf(origin, materials);
        }
        Brick& brick = brickAt(origin);
        for (std::uint32_t i = 0; i < kBrickVoxels; ++i) {
            const std::uint32_t m = frame_.mortonOf(i);
            if (((occupancy[m >> 6] >> (m & 63u)) & 1u) != 0) brick.set(m, materials[i]);
        }
        return {};
    }

    void writePlain(const openvdb::Coord& origin, const std::array<std::uint64_t, 8>& occupancy,
                    std::uint32_t count) {
        if (count == kBrickVoxels) {
            model_.fillTile(frame_.cube(origin, kLeafLog2), kLeafLog2, settings_.plainMaterial);
            return;
        }
        Brick& brick = brickAt(origin);
        for (std::size_t word = 0; word < occupancy.size(); ++word) brick.occupancy[word] |= occupancy[word];
        brick.materials.fill(settings_.plainMaterial);
    }

    Result<void> labelLeaf(const Leaf& leaf, LeafMaterials& materials) requires kLabelled {
        for (std::uint32_t i = 0; i < kBrickVoxels; ++i) {
            const Value value = leaf.getValue(i);
            if (!rule_.solid(value, leaf.isValueOn(i))) continue;
            PFVOX_TRY(const auto, material, labelMaterial(value));
            materials[i] = material;
        }
        return {};
    }

    Result<MaterialIndex> labelMaterial(const Value& value) requires kLabelled {
        if (lastMaterial_ && value == lastLabel_) return *lastMaterial_;
        PFVOX_TRY(const auto, material, lookUpLabel(value));
        lastLabel_ = value;
        lastMaterial_ = material;
        return material;
    }

    Result<MaterialIndex> lookUpLabel(const Value& value) requires kLabelled {
        if (settings_.known != nullptr) {
            const auto known = settings_.known->find(static_cast<std::int64_t>(value));
            if (known != settings_.known->end()) return known->second;
        }
        const std::uint32_t material = labels_.materialOf(static_cast<std::int64_t>(value));
        if (material >= settings_.maxMaterials) {
            return fail(
                ErrorCode::LimitExceeded,
                fmt::format(
                    "more than {} different numbers (maxMaterials): is this grid really one of material ids?",
                    settings_.maxMaterials));
        }
        return static_cast<MaterialIndex>(material);
    }

    Brick& brickAt(const openvdb::Coord& origin) {
        const glm::ivec3 corner = frame_.cube(origin, kLeafLog2);
        const glm::uvec3 cell = (glm::uvec3{corner} >> 3u) & 31u;
        return model_.regionAt(corner >> kRegionEdgeLog2).brickAt(mortonEncode(cell));
    }

    const FillSettings& settings_;
    Rule<Value> rule_;
    IndexFrame frame_;
    LabelTable& labels_;
    ModelBudget& budget_;
    VoxelModel& model_;
    Value lastLabel_{};  ///< neighbors mostly have the same number
    std::optional<MaterialIndex> lastMaterial_;
};

/// Writers often leave the class of a level set unset or call it fog. Densities are never below zero, so an
/// active negative value under a positive background tells a signed distance.
template <class GridT>
bool looksLikeLevelSet(const GridT& grid) {
    if (!(grid.background() > 0)) return false;
    for (auto value = grid.cbeginValueOn(); value; ++value) {
        if (*value < 0) return true;
    }
    return false;
}

template <class GridT>
bool isLevelSet(const GridT& grid, Diagnostics& diagnostics) {
    if constexpr (std::is_floating_point_v<typename GridT::ValueType>) {
        if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) return true;
        if (!looksLikeLevelSet(grid)) return false;
        diagnostics.warn(
            "vdb-level-set-guessed",
            fmt::format("grid \"{}\" is not marked as a level set, but has negative values under a "
                        "positive background: taken as one",
                        grid.getName()));
        return true;
    }
    return false;
}

template <class GridT>
bool fillFrom(const openvdb::GridBase& base, const FillSettings& settings, LabelTable& labels,
              ModelBudget& budget, VoxelModel& model, Diagnostics& diagnostics, Result<void>& outcome) {
    if (!base.isType<GridT>()) return false;
    const auto& grid = static_cast<const GridT&>(base);
    const Rule<typename GridT::ValueType> rule{.levelSet = isLevelSet(grid, diagnostics),
                                               .threshold = settings.threshold};
    outcome = TreeWalker<typename GridT::TreeType>(settings, rule, labels, budget, model).walk(grid.tree());
    return true;
}

}  // namespace

std::vector<std::int64_t> LabelTable::labels() const {
    std::vector<std::int64_t> byMaterial(labels_.size());
    for (const auto& [label, index] : labels_) byMaterial[index] = label;
    return byMaterial;
}

Result<void> fillModel(const openvdb::GridBase& grid, const FillSettings& settings, LabelTable& labels,
                       ModelBudget& budget, VoxelModel& model, Diagnostics& diagnostics) {
    Result<void> outcome;
    const auto as = [&]<class GridT>(std::type_identity<GridT>) {
        return fillFrom<GridT>(grid, settings, labels, budget, model, diagnostics, outcome);
    };
    const bool known =
        as(std::type_identity<openvdb::FloatGrid>{}) || as(std::type_identity<openvdb::DoubleGrid>{}) ||
        as(std::type_identity<openvdb::BoolGrid>{}) || as(std::type_identity<openvdb::MaskGrid>{}) ||
        as(std::type_identity<openvdb::Int32Grid>{}) || as(std::type_identity<openvdb::Int64Grid>{}) ||
        as(std::type_identity<openvdb::Vec3SGrid>{}) || as(std::type_identity<openvdb::Vec3DGrid>{});
    if (!known)
        return fail(ErrorCode::UnsupportedFeature, "a grid of type " + grid.type() + " makes no voxel model");
    return outcome;
}

}  // namespace pfvox::import::vdb

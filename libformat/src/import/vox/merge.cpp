#include "import/vox/merge.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>

namespace pfvox::import::vox {

namespace {

/// Morton codes of the coordinates in a brick, spread for the x axis.
constexpr std::array<std::uint32_t, kBrickEdge> kSpread{0, 1, 8, 9, 64, 65, 72, 73};

constexpr std::uint32_t mortonInBrick(glm::ivec3 voxel) {
    const auto spread = [](int coordinate) {
        return kSpread[static_cast<std::size_t>(coordinate & (kBrickEdge - 1))];
    };
    return spread(voxel.x) | (spread(voxel.y) << 1) | (spread(voxel.z) << 2);
}

/// Writes voxels anywhere in a model, remembering the last brick, and keeps account of the memory this takes.
class ModelWriter {
  public:
    explicit ModelWriter(VoxelModel& model) : model_(model) {}

    /// Returns whether there was a voxel before.
    bool set(glm::ivec3 voxel, MaterialIndex material) {
        const glm::ivec3 cell = voxel >> kBrickEdgeLog2;
        if (brick_ == nullptr || cell != cell_) findBrick(cell);
        const std::uint32_t morton = mortonInBrick(voxel);
        const bool replaces = brick_->occupied(morton);
        brick_->set(morton, material);
        return replaces;
    }

    std::uint64_t memoryBytes() const {
        return bricks_ * sizeof(Brick) + model_.regions().size() * kRegionCells * sizeof(std::uint32_t);
    }

  private:
    void findBrick(glm::ivec3 cell) {
        constexpr int kCellsLog2 = kRegionEdgeLog2 - kBrickEdgeLog2;
        VoxelRegion& region = model_.regionAt(cell >> kCellsLog2);
        const std::size_t before = region.brickCount();
        brick_ = &region.brickAt(mortonEncode(glm::uvec3(cell & ((1 << kCellsLog2) - 1))));
        bricks_ += region.brickCount() - before;
        cell_ = cell;
    }

    VoxelModel& model_;
    glm::ivec3 cell_{0};
    Brick* brick_ = nullptr;
    std::uint64_t bricks_ = 0;
};

/// Where the voxels of a brick go, relative to its minimum corner.
using BrickOffsets = std::array<glm::ivec3, kBrickVoxels>;

BrickOffsets rotatedOffsets(const Rotation& rotation) {
    BrickOffsets offsets;
    for (std::uint32_t morton = 0; morton < kBrickVoxels; ++morton) {
        offsets[morton] = glm::ivec3(rotation * glm::i64vec3(mortonDecode(morton)));
    }
    return offsets;
}

std::uint64_t writeBrick(const Brick& brick, glm::ivec3 corner, const BrickOffsets& offsets,
                         ModelWriter& writer) {
    std::uint64_t replaced = 0;
    for (std::uint32_t word = 0; word < brick.occupancy.size(); ++word) {
        for (std::uint64_t bits = brick.occupancy[word]; bits != 0; bits &= bits - 1) {
            const std::uint32_t morton = word * 64 + static_cast<std::uint32_t>(std::countr_zero(bits));
            replaced += writer.set(corner + offsets[morton], brick.materials[morton]) ? 1u : 0u;
        }
    }
    return replaced;
}

/// A brick of a model and the voxel at its minimum corner.
struct PlacedBrick {
    const Brick* brick;
    glm::i64vec3 corner;
};

/// Gathered once a model, because a model may have many instances and the table of a region many empty cells.
std::vector<PlacedBrick> bricksOf(const VoxelModel& model) {
    std::vector<PlacedBrick> bricks;
    for (const auto& region : model.regions()) {
        for (std::uint32_t cell = 0; cell < region->cellEnd(); ++cell) {
            const Brick* brick = region->cell(cell).brick;
            if (brick == nullptr) continue;
            const glm::ivec3 corner =
                region->coord() * kRegionEdge + glm::ivec3(mortonDecode(cell)) * kBrickEdge;
            bricks.push_back({.brick = brick, .corner = glm::i64vec3(corner)});
        }
    }
    return bricks;
}

Result<void> checkLimits(const VoxelModel& model, const ModelWriter& writer, const Limits& limits) {
    if (model.regions().size() > limits.maxRegions) {
        return fail(
            ErrorCode::LimitExceeded,
            fmt::format("the merged model touches more than {} regions of 256^3 voxels (limit maxRegions); "
                        "import without merging",
                        limits.maxRegions));
    }
    if (writer.memoryBytes() > limits.maxMemoryBytes) {
        return fail(
            ErrorCode::LimitExceeded,
            fmt::format(
                "the merged model takes more than {} bytes (limit maxMemoryBytes); import without merging",
                limits.maxMemoryBytes));
    }
    return {};
}

Result<void> checkDepth(const VoxelModel& model, const Limits& limits) {
    const glm::i64vec3 size = model.bounds().size();
    const std::int64_t edge = std::max({size.x, size.y, size.z});
    if (edge > std::int64_t{1} << limits.maxModelDepth) {
        return fail(
            ErrorCode::LimitExceeded,
            fmt::format("the merged model would be {} voxels long; 2^{} are possible (limit maxModelDepth); "
                        "import without merging",
                        edge, limits.maxModelDepth));
    }
    return {};
}

}  // namespace

Result<MergedModel> mergeInstances(const std::vector<VoxelModel>& models,
                                   std::span<const GridInstance> instances, const Limits& limits) {
    MergedModel merged;
    ModelWriter writer(merged.model);
    std::vector<std::vector<PlacedBrick>> bricks(models.size());
    Rotation rotation;
    BrickOffsets offsets = rotatedOffsets(rotation);
    for (const GridInstance& instance : instances) {
        if (bricks[instance.model].empty()) bricks[instance.model] = bricksOf(models[instance.model]);
        if (instance.worldFromModel.rotation != rotation) {
            rotation = instance.worldFromModel.rotation;
            offsets = rotatedOffsets(rotation);
        }
        for (const PlacedBrick& placed : bricks[instance.model]) {
            const glm::ivec3 corner{instance.worldFromModel.applyToCell(placed.corner)};
            merged.replacedVoxels += writeBrick(*placed.brick, corner, offsets, writer);
        }
        PFVOX_CHECK(checkLimits(merged.model, writer, limits));
    }
    PFVOX_CHECK(checkDepth(merged.model, limits));
    return merged;
}

}  // namespace pfvox::import::vox

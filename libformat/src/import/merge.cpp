#include "import/merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "import/model_writer.hpp"

namespace pfvox::import {

namespace {

/// Sums of two such coordinates fit int32.
constexpr double kLargestTranslation = 1 << 29;

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

/// A brick of a model, or a solid cube, and the voxel at its minimum corner.
struct Piece {
    glm::i64vec3 corner;
    const Brick* brick;      ///< null: a solid cube
    int edge;                ///< of that cube
    MaterialIndex material;  ///< of that cube
};

/// Cells come in Morton order, so eight solid ones of one parent stand together at the end of the list once
/// the last has come: they become one cube, and eight such cubes again one, so that little is left to write
/// voxel by voxel where the cubes do not lie on the grid of cells.
void joinLastCubes(std::vector<Piece>& pieces, std::size_t first) {
    constexpr std::size_t kChildren = 8;
    while (pieces.size() - first >= kChildren) {
        const auto children = std::span(pieces).last(kChildren);
        const Piece& lowest = children.front();
        const std::int64_t parentEdge = std::int64_t{2} * lowest.edge;
        const bool aligned = lowest.corner % parentEdge == glm::i64vec3{0};
        const bool equal = std::ranges::all_of(children, [&](const Piece& p) {
            return p.brick == nullptr && p.edge == lowest.edge && p.material == lowest.material &&
                   glm::all(glm::lessThan(p.corner - lowest.corner, glm::i64vec3{parentEdge})) &&
                   glm::all(glm::greaterThanEqual(p.corner, lowest.corner));
        });
        if (!aligned || !equal) return;
        const Piece parent{.corner = lowest.corner,
                           .brick = nullptr,
                           .edge = static_cast<int>(parentEdge),
                           .material = lowest.material};
        pieces.erase(pieces.end() - static_cast<std::ptrdiff_t>(kChildren), pieces.end());
        pieces.push_back(parent);
    }
}

/// Gathered once a model, because a model may have many instances and the table of a region many empty cells.
std::vector<Piece> piecesOf(const VoxelModel& model) {
    std::vector<Piece> pieces;
    for (const auto& region : model.regions()) {
        const glm::i64vec3 origin = glm::i64vec3{region->coord()} * std::int64_t{kRegionEdge};
        if (const auto material = region->uniform()) {
            pieces.push_back(
                {.corner = origin, .brick = nullptr, .edge = kRegionEdge, .material = *material});
            continue;
        }
        const std::size_t first = pieces.size();
        for (std::uint32_t c = 0; c < region->cellEnd(); ++c) {
            const VoxelRegion::Cell cell = region->cell(c);
            if (cell.empty()) continue;
            pieces.push_back({.corner = origin + glm::i64vec3(mortonDecode(c)) * std::int64_t{kBrickEdge},
                              .brick = cell.brick,
                              .edge = kBrickEdge,
                              .material = cell.material.value_or(0)});
            if (cell.brick == nullptr) joinLastCubes(pieces, first);
        }
    }
    return pieces;
}

/// Minimum corner of the image of a cube.
glm::ivec3 cubeCorner(const GridTransform& transform, glm::i64vec3 corner, int edge) {
    return glm::ivec3{glm::min(transform.apply(corner), transform.apply(corner + std::int64_t{edge}))};
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

/// The transform in whole voxels, or nothing where it is none.
std::optional<GridTransform> gridTransformOf(const glm::dmat4& matrix) {
    // Over a thousand voxels this tolerance of the directions adds up to a thousandth of one.
    constexpr double kTolerance = 1e-6;
    constexpr double kTranslationTolerance = 1e-3;
    GridTransform transform;
    std::array<int, 3> rowsOfColumn{};
    for (std::uint8_t row = 0; row < 3; ++row) {
        int found = 0;
        for (std::uint8_t column = 0; column < 3; ++column) {
            const double entry = matrix[column][row];
            if (std::abs(entry) < kTolerance) continue;
            if (std::abs(std::abs(entry) - 1.0) >= kTolerance) return std::nullopt;
            transform.rotation.column[row] = column;
            transform.rotation.sign[row] = entry < 0.0 ? -1 : 1;
            ++rowsOfColumn[column];
            ++found;
        }
        const double whole = std::round(matrix[3][row]);
        if (found != 1 || !(std::abs(matrix[3][row] - whole) < kTranslationTolerance)) return std::nullopt;
        if (std::abs(whole) > kLargestTranslation) return std::nullopt;
        transform.translation[row] = static_cast<std::int64_t>(whole);
    }
    if (rowsOfColumn != std::array{1, 1, 1}) return std::nullopt;
    return transform;
}

bool isHidden(const VoxelAsset& asset, const Instance& instance) {
    return instance.hidden ||
           (instance.layer >= 0 && asset.layers.at(static_cast<std::size_t>(instance.layer)).hidden);
}

/// Where the voxels of every instance go on the grid of the first.
Result<std::vector<PlacedModel>> placeModels(const VoxelAsset& asset) {
    const glm::dmat4 firstFromWorld = glm::inverse(glm::dmat4{asset.instances.front().worldFromModel});
    std::vector<PlacedModel> placed;
    for (std::size_t i = 0; i < asset.instances.size(); ++i) {
        const Instance& instance = asset.instances[i];
        const auto transform = gridTransformOf(firstFromWorld * glm::dmat4{instance.worldFromModel});
        const VoxelBox box = asset.models[instance.model].bounds();
        const bool near =
            box.empty() ||
            (glm::all(glm::greaterThan(glm::dvec3{box.min}, glm::dvec3{-kLargestTranslation})) &&
             glm::all(glm::lessThan(glm::dvec3{box.max}, glm::dvec3{kLargestTranslation})));
        if (!transform || !near) {
            return fail(
                ErrorCode::UnsupportedFeature,
                fmt::format(
                    "instance {} ('{}') is not turned by quarter turns and moved by whole voxels against "
                    "the first ('{}'), or too far away: they do not share a grid; import without merging",
                    i, instance.name, asset.instances.front().name));
        }
        placed.push_back({.model = instance.model, .mergedFromModel = *transform});
    }
    return placed;
}

}  // namespace

Result<MergedModel> mergeModels(const std::vector<VoxelModel>& models, std::span<const PlacedModel> placed,
                                const Limits& limits) {
    MergedModel merged;
    ModelWriter writer(merged.model);
    std::vector<std::vector<Piece>> pieces(models.size());
    Rotation rotation;
    BrickOffsets offsets = rotatedOffsets(rotation);
    for (const PlacedModel& instance : placed) {
        const GridTransform& transform = instance.mergedFromModel;
        if (pieces[instance.model].empty()) pieces[instance.model] = piecesOf(models[instance.model]);
        if (transform.rotation != rotation) {
            rotation = transform.rotation;
            offsets = rotatedOffsets(rotation);
        }
        for (const Piece& piece : pieces[instance.model]) {
            if (piece.brick != nullptr) {
                const glm::ivec3 corner{transform.applyToCell(piece.corner)};
                merged.replacedVoxels += writeBrick(*piece.brick, corner, offsets, writer);
            } else {
                const glm::ivec3 corner = cubeCorner(transform, piece.corner, piece.edge);
                merged.replacedVoxels += writer.fillCube(corner, piece.edge, piece.material);
            }
        }
        PFVOX_CHECK(checkLimits(merged.model, writer, limits));
    }
    PFVOX_CHECK(checkDepth(merged.model, limits));
    return merged;
}

Result<void> mergeAsset(VoxelAsset& asset, const Limits& limits, Diagnostics& diagnostics) {
    const std::size_t count = asset.instances.size();
    std::erase_if(asset.instances, [&](const Instance& instance) { return isHidden(asset, instance); });
    if (asset.instances.empty()) {
        return fail(
            ErrorCode::NothingToConvert,
            fmt::format("all {} instances are hidden; import hidden ones too (includeHidden)", count));
    }
    if (asset.models.size() == 1 && asset.instances.size() == 1) return {};
    PFVOX_TRY(const auto, placed, placeModels(asset));
    PFVOX_TRY(MergedModel, merged, mergeModels(asset.models, placed, limits));
    if (merged.replacedVoxels > 0) {
        diagnostics.warn("merge-overlap",
                         fmt::format("{} voxels lie where a later instance has one too, which replaces them",
                                     merged.replacedVoxels));
    }
    const Affine worldFromMerged = asset.instances.front().worldFromModel;
    asset.instances.clear();
    asset.instances.push_back({.model = 0, .worldFromModel = worldFromMerged});
    asset.layers.clear();
    asset.models.clear();
    asset.models.push_back(std::move(merged.model));
    return {};
}

}  // namespace pfvox::import

// Fog volumes, level sets, masks and integer grids become models.
#include "import/vdb/vdb_import.hpp"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <ios>
#include <map>
#include <new>

#include "import/label_materials.hpp"
#include "import/vdb/grid_colors.hpp"
#include "import/vdb/grid_placement.hpp"
#include "import/vdb/grid_selection.hpp"
#include "import/vdb/grid_voxels.hpp"
#include "import/vdb/restored_materials.hpp"
#include "import/vdb/vdb_header.hpp"
#include "import/vdb/vdb_reader.hpp"
#include "import/vdb/vdb_tree_check.hpp"

namespace pfvox::import::vdb {

namespace {

/// Index of the material of grids that say nothing about looks.
constexpr MaterialIndex kPlainMaterial = 0;

class VdbImport {
  public:
    VdbImport(const SourceBytes& source, VdbHeader header, const ImportSettings& settings,
              const Limits& limits, Diagnostics& diagnostics)
        : bytes_(source.bytes),
          reader_(source.bytes, std::move(header)),
          settings_(settings),
          limits_(limits),
          diagnostics_(diagnostics),
          budget_(limits) {}

    Result<VoxelAsset> run() {
        PFVOX_TRY(const auto, selection, selectGrids(reader_.grids(), settings_.vdb.grids, diagnostics_));
        asset_.source.format = "vdb";
        asset_.materials.emplace_back();
        PFVOX_CHECK(loadColors(selection.color));
        PFVOX_CHECK(loadMaterials(selection.models));
        labels_.emplace(static_cast<MaterialIndex>(asset_.materials.size()));
        for (const std::size_t index : selection.models) PFVOX_CHECK(addInstance(index));
        for (const std::int64_t label : labels_->labels()) {
            asset_.materials.push_back(labelMaterial(label, fmt::format("{}", label)));
        }
        if (asset_.models.empty()) return fail(ErrorCode::NothingToConvert, emptyReason_);
        if (labels_->size() != 0) {
            diagnostics_.note("vdb-labels",
                              fmt::format("{} numbers of integer grids became materials with made-up colors",
                                          labels_->size()));
        }
        return std::move(asset_);
    }

  private:
    /// A grid whose bytes were looked through before OpenVDB builds it.
    Result<openvdb::GridBase::Ptr> read(std::size_t index) {
        PFVOX_CHECK(checkTree(bytes_, reader_.grids()[index], limits_));
        return reader_.read(index);
    }

    /// The vector grid of the colors, made of three where they are so; null where they cannot be used.
    Result<openvdb::GridBase::Ptr> readColors(const std::vector<std::size_t>& indices) {
        openvdb::GridPtrVec grids;
        for (const std::size_t index : indices) {
            PFVOX_TRY(auto, grid, read(reader_.treeOwner(index)));
            grids.push_back(std::move(grid));
        }
        const bool oneTransform = std::ranges::all_of(grids, [&](const openvdb::GridBase::Ptr& grid) {
            return grid->transform() == grids[0]->transform();
        });
        if (!oneTransform) {
            diagnostics_.warn(
                "vdb-color-transform",
                fmt::format("the grids of red, green and blue (\"{}\" and its like) have different "
                            "transforms: colors are left out",
                            grids[0]->getName()));
            return openvdb::GridBase::Ptr{};
        }
        openvdb::GridBase::Ptr colors = grids[0];
        if (grids.size() == 3) {
            const auto channel = [&](std::size_t i) {
                return openvdb::gridConstPtrCast<openvdb::FloatGrid>(grids[i]);
            };
            colors = joinChannels(*channel(0), *channel(1), *channel(2));
        }
        if (colors->activeVoxelCount() != 0) return colors;
        diagnostics_.warn("vdb-grid-empty", fmt::format("the color grid \"{}\" is empty: colors are left out",
                                                        colors->getName()));
        return openvdb::GridBase::Ptr{};
    }

    /// What an export of pfvox says of its numbers.
    Result<void> loadMaterials(const std::vector<std::size_t>& models) {
        for (const std::size_t index : models) {
            const std::size_t owner = reader_.treeOwner(index);
            if (restored_.contains(owner)) continue;
            auto table = parseMaterialTable(reader_.grids()[owner].ownText(metadata::kMaterials));
            if (table) {
                restored_.add(owner, *std::move(table));
            } else {
                diagnostics_.warn("vdb-materials-malformed",
                                  fmt::format("grid \"{}\": {}; its materials are made up",
                                              reader_.grids()[owner].displayName, table.error().message));
            }
        }
        return restored_.appendTo(asset_.materials, limits_);
    }

    Result<void> loadColors(const std::vector<std::size_t>& indices) {
        if (indices.empty()) return {};
        PFVOX_TRY(auto, grid, readColors(indices));
        if (grid == nullptr) return {};
        colorGrid_ = std::move(grid);
        colors_ = makeGridColors(colorGrid_, static_cast<MaterialIndex>(asset_.materials.size()));
        if (colors_.distinctColors > colors_.materials.size()) {
            diagnostics_.warn(
                "vdb-colors-quantised",
                fmt::format("{} colors of grid \"{}\" were joined to {}", colors_.distinctColors,
                            reader_.grids()[indices[0]].displayName, colors_.materials.size()));
        }
        if (colors_.clampedValues > 0) {
            diagnostics_.warn(
                "vdb-colors-clamped",
                fmt::format("{} values of grid \"{}\" have components outside of 0 to 1, which are clamped",
                            colors_.clampedValues, reader_.grids()[indices[0]].displayName));
        }
        asset_.materials.insert(asset_.materials.end(), colors_.materials.begin(), colors_.materials.end());
        return {};
    }

    /// One instance for each chosen grid; grids that share a tree share the model.
    Result<void> addInstance(std::size_t index) {
        const std::size_t owner = reader_.treeOwner(index);
        PFVOX_TRY(const openvdb::GridBase::Ptr, grid, read(index));
        auto known = modelOfGrid_.find(owner);
        if (known == modelOfGrid_.end()) {
            PFVOX_TRY(const openvdb::GridBase::Ptr, tree, owner == index ? grid : read(owner));
            PFVOX_TRY(const auto, model, addModel(owner, tree));
            known = modelOfGrid_.emplace(owner, model).first;
        }
        if (!known->second) return {};
        const GridDescriptor& descriptor = reader_.grids()[index];
        PFVOX_TRY(const Affine, worldFromModel, place(*grid, descriptor));
        Instance instance{
            .model = *known->second, .worldFromModel = worldFromModel, .name = descriptor.displayName};
        restoreInstance(descriptor, instance);
        asset_.instances.push_back(std::move(instance));
        return {};
    }

    /// Name, layer and visibility as an export of pfvox noted them.
    void restoreInstance(const GridDescriptor& grid, Instance& instance) {
        if (grid.ownText(metadata::kRole) != metadata::kMaterialRole) return;
        instance.name = grid.ownText(metadata::kInstance);
        instance.hidden = grid.ownText(metadata::kHidden) == "1" && !settings_.includeHidden;
        if (!grid.own.contains(metadata::kLayer)) return;
        const Layer layer{.name = std::string(grid.ownText(metadata::kLayer)),
                          .hidden = grid.ownText(metadata::kLayerHidden) == "1" && !settings_.includeHidden};
        const auto known = std::ranges::find(asset_.layers, layer);
        instance.layer = static_cast<std::int32_t>(known - asset_.layers.begin());
        if (known == asset_.layers.end()) asset_.layers.push_back(layer);
    }

    /// The index of the new model, or nothing when the grid has no solid voxel.
    Result<std::optional<std::uint32_t>> addModel(std::size_t owner, const openvdb::GridBase::Ptr& grid) {
        const GridDescriptor& descriptor = reader_.grids()[owner];
        VoxelModel model;
        const bool isOwn = descriptor.ownText(metadata::kRole) == metadata::kMaterialRole;
        model.name = isOwn ? std::string(descriptor.ownText(metadata::kModel)) : descriptor.displayName;
        FillSettings fill{.threshold = settings_.vdb.threshold,
                          .upAxis = settings_.vdb.upAxis,
                          .maxMaterials = limits_.maxMaterials,
                          .plainMaterial = kPlainMaterial,
                          .shader = shaderFor(*grid, descriptor),
                          .known = restored_.of(owner)};
        auto filled = fillModel(*grid, fill, *labels_, budget_, model, diagnostics_);
        if (!filled) {
            Error error = std::move(filled).error();
            error.context = fmt::format("grid \"{}\"", descriptor.displayName);
            return tl::make_unexpected(std::move(error));
        }
        if (model.regions().empty()) {
            reportEmpty(*grid, descriptor);
            return std::optional<std::uint32_t>{};
        }
        budget_.close(model);
        asset_.models.push_back(std::move(model));
        return std::optional{static_cast<std::uint32_t>(asset_.models.size() - 1)};
    }

    const Shader* shaderFor(const openvdb::GridBase& grid, const GridDescriptor& descriptor) {
        if (colors_.shader == nullptr || kindOf(descriptor) == GridKind::Integer) return nullptr;
        if (grid.transform() == colorGrid_->transform()) return colors_.shader.get();
        diagnostics_.warn(
            "vdb-color-transform",
            fmt::format("grid \"{}\" stays without colors: the color grid \"{}\" has another transform",
                        descriptor.displayName, colorGrid_->getName()));
        return nullptr;
    }

    void reportEmpty(const openvdb::GridBase& grid, const GridDescriptor& descriptor) {
        const bool noVoxels = grid.constBaseTree().activeVoxelCount() == 0;
        std::string reason =
            fmt::format("grid \"{}\" ({}) {}", descriptor.displayName, descriptor.type,
                        noVoxels ? "is empty: it has no active voxel"
                                 : fmt::format("has no solid voxel: none is above vdb.threshold = {}",
                                               settings_.vdb.threshold));
        diagnostics_.warn("vdb-grid-empty", reason);
        if (emptyReason_.empty()) emptyReason_ = std::move(reason);
    }

    Result<Affine> place(const openvdb::GridBase& grid, const GridDescriptor& descriptor) {
        const std::string& name = descriptor.displayName;
        if (!grid.transform().isLinear()) {
            return fail(ErrorCode::UnsupportedFeature,
                        fmt::format("grid \"{}\" lives in a frustum, whose voxels are no cubes: resample it "
                                    "to a uniform grid first",
                                    name));
        }
        Affine affine = worldFromModel(grid.transform(), settings_.vdb.upAxis);
        const double volume = std::abs(glm::determinant(glm::dmat3{affine}));
        if (!(volume > 0.0) || !std::isfinite(volume) || !std::isfinite(glm::dot(affine[3], affine[3]))) {
            return fail(ErrorCode::BadValue, fmt::format("the transform of grid \"{}\" is singular", name));
        }
        if (asset_.instances.empty()) {
            const auto noted = parseSize(descriptor.ownText(metadata::kVoxelSize));
            const double voxelSize = noted.value_or(std::cbrt(volume));
            // A wish of the user corrects the unit of the file, so it scales all positions as well.
            if (settings_.voxelSizeMetres) unit_ = *settings_.voxelSizeMetres / voxelSize;
            asset_.source.voxelSizeMetres = settings_.voxelSizeMetres.value_or(voxelSize);
        }
        for (int column = 0; column < 4; ++column) affine[column] *= unit_;
        return affine;
    }

    std::span<const std::byte> bytes_;
    VdbReader reader_;
    const ImportSettings& settings_;
    const Limits& limits_;
    Diagnostics& diagnostics_;
    ModelBudget budget_;
    VoxelAsset asset_;
    openvdb::GridBase::Ptr colorGrid_;
    GridColors colors_;
    RestoredMaterials restored_;
    std::optional<LabelTable> labels_;
    double unit_ = 1.0;  ///< metres of a unit of the file
    std::map<std::size_t, std::optional<std::uint32_t>> modelOfGrid_;
    std::string emptyReason_;
};

}  // namespace

/// The edge that no exception crosses.
Result<VoxelAsset> importVdb(const SourceBytes& source, const ImportSettings& settings, const Limits& limits,
                             Diagnostics& diagnostics) {
    PFVOX_TRY(auto, header, parseVdbHeader(source.bytes, limits, diagnostics));
    try {
        return VdbImport(source, std::move(header), settings, limits, diagnostics).run();
    } catch (const std::ios_base::failure&) {
        return fail(ErrorCode::Truncated, "the data of a grid ends before its tree is complete");
    } catch (const openvdb::LookupError& error) {
        return fail(ErrorCode::UnsupportedFeature, fmt::format("OpenVDB: {}", error.what()));
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::BadStructure,
                    "a grid asks for more memory than there is; the file is damaged");
    } catch (const std::exception& error) {
        return fail(ErrorCode::BadStructure, fmt::format("OpenVDB: {}", error.what()));
    }
}

}  // namespace pfvox::import::vdb

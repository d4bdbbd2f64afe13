// Fog volumes, level sets, masks and integer grids become models.
#include "import/vdb/vdb_import.hpp"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <ios>
#include <map>
#include <new>

#include "import/label_materials.hpp"
#include "import/vdb/grid_colors.hpp"
#include "import/vdb/grid_selection.hpp"
#include "import/vdb/grid_voxels.hpp"
#include "import/vdb/vdb_header.hpp"
#include "import/vdb/vdb_reader.hpp"
#include "import/vdb/vdb_tree_check.hpp"

namespace pfvox::import::vdb {

namespace {

/// Index of the material of grids that say nothing about looks.
constexpr MaterialIndex kPlainMaterial = 0;

/// OpenVDB's values sit at whole coordinates, so voxel i covers [i - 0.5, i + 0.5]; ours covers [i, i + 1].
Affine indexFromModel(UpAxis up) {
    Affine affine{1.0};
    if (up == UpAxis::Z) {
        affine[0] = {1.0, 0.0, 0.0};
        affine[1] = {0.0, 0.0, 1.0};
        affine[2] = {0.0, -1.0, 0.0};
    }
    affine[3] = glm::dvec3{-0.5};
    return affine;
}

/// The frame of the file, z or y up, to ours.
Affine worldFromFile(UpAxis up) {
    Affine affine{1.0};
    if (up == UpAxis::Z) {
        affine[1] = {0.0, 0.0, -1.0};
        affine[2] = {0.0, 1.0, 0.0};
    }
    return affine;
}

Affine fileFromIndex(const openvdb::math::Transform& transform) {
    const openvdb::math::Mat4d matrix = transform.baseMap()->getAffineMap()->getMat4();
    Affine affine;
    for (int row = 0; row < 4; ++row) {
        // OpenVDB multiplies row vectors from the left: its rows are our columns.
        for (int column = 0; column < 3; ++column) affine[row][column] = matrix(row, column);
    }
    return affine;
}

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
        PFVOX_TRY(const auto, selection,
                  selectGrids(reader_.grids(), settings_.vdb.grids, diagnostics_));
        asset_.source.format = "vdb";
        asset_.materials.emplace_back();
        if (selection.color) PFVOX_CHECK(loadColors(*selection.color));
        labels_.emplace(static_cast<MaterialIndex>(asset_.materials.size()));
        for (const std::size_t index : selection.models) PFVOX_CHECK(addInstance(index));
        for (const std::int64_t label : labels_->labels()) {
            asset_.materials.push_back(labelMaterial(label, fmt::format("{}", label)));
        }
        if (asset_.models.empty()) return fail(ErrorCode::NothingToConvert, emptyReason_);
        if (labels_->size() != 0) {
            diagnostics_.note("vdb-labels",
                              fmt::format("{} numbers of integer grids became materials with made-up colours",
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

    Result<void> loadColors(std::size_t index) {
        PFVOX_TRY(auto, grid, read(reader_.treeOwner(index)));
        colorGrid_ = std::move(grid);
        colors_ = makeGridColors(colorGrid_, static_cast<MaterialIndex>(asset_.materials.size()));
        if (colors_.distinctColors > colors_.materials.size()) {
            diagnostics_.warn(
                "vdb-colors-quantised",
                fmt::format("{} colours of grid \"{}\" were joined to {}", colors_.distinctColors,
                            reader_.grids()[index].displayName, colors_.materials.size()));
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
        Instance instance;
        instance.model = *known->second;
        instance.name = reader_.grids()[index].displayName;
        PFVOX_TRY(const Affine, worldFromModel, place(*grid, instance.name));
        instance.worldFromModel = worldFromModel;
        asset_.instances.push_back(std::move(instance));
        return {};
    }

    /// The index of the new model, or nothing when the grid has no solid voxel.
    Result<std::optional<std::uint32_t>> addModel(std::size_t owner, const openvdb::GridBase::Ptr& grid) {
        const GridDescriptor& descriptor = reader_.grids()[owner];
        VoxelModel model;
        model.name = descriptor.displayName;
        FillSettings fill{.threshold = settings_.vdb.threshold,
                               .upAxis = settings_.vdb.upAxis,
                               .maxMaterials = limits_.maxMaterials,
                               .plainMaterial = kPlainMaterial,
                               .shader = shaderFor(*grid, descriptor)};
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
            fmt::format("grid \"{}\" stays without colours: the colour grid \"{}\" has another transform",
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

    Result<Affine> place(const openvdb::GridBase& grid, const std::string& name) {
        if (!grid.transform().isLinear()) {
            return fail(ErrorCode::UnsupportedFeature,
                        fmt::format("grid \"{}\" lives in a frustum, whose voxels are no cubes: resample it "
                                    "to a uniform grid first",
                                    name));
        }
        const UpAxis up = settings_.vdb.upAxis;
        Affine affine =
            compose(worldFromFile(up), compose(fileFromIndex(grid.transform()), indexFromModel(up)));
        const double volume = std::abs(glm::determinant(glm::dmat3{affine}));
        if (!(volume > 0.0) || !std::isfinite(volume) || !std::isfinite(glm::dot(affine[3], affine[3]))) {
            return fail(ErrorCode::BadValue, fmt::format("the transform of grid \"{}\" is singular", name));
        }
        const double voxelSize = std::cbrt(volume);
        // A wish of the user corrects the unit of the file, so it scales positions as well.
        const double unit = settings_.voxelSizeMetres ? *settings_.voxelSizeMetres / voxelSize : 1.0;
        for (int column = 0; column < 4; ++column) affine[column] *= unit;
        if (asset_.instances.empty()) asset_.source.voxelSizeMetres = voxelSize * unit;
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
    std::optional<LabelTable> labels_;
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

// The way through this folder: octrees -> grids (vdb_grids) -> instances that share them -> a file
// (vdb_archive).
#include "export/vdb_export.hpp"

#include <fmt/format.h>

#include <cmath>
#include <new>
#include <optional>

#include "export/vdb_archive.hpp"
#include "export/vdb_grids.hpp"
#include "import/vdb/pfvox_metadata.hpp"

namespace pfvox::vdb_export {

namespace {

namespace metadata = import::vdb::metadata;

/// VDB's values sit at whole coordinates: voxel i covers [i - 1/2, i + 1/2] there and [i, i + 1] here.
Affine worldFromIndex(const Instance& instance) {
    Affine affine = instance.worldFromModel;
    affine[3] += (affine[0] + affine[1] + affine[2]) * 0.5;
    return affine;
}

/// From three columns and a translation. Scale and translation go in one after the other: OpenVDB takes a
/// matrix of both apart by a subtraction that loses digits.
openvdb::math::Transform::Ptr linearTransform(const Affine& affine) {
    using openvdb::math::Transform;
    const bool diagonal = affine[0].y == 0.0 && affine[0].z == 0.0 && affine[1].x == 0.0 &&
                          affine[1].z == 0.0 && affine[2].x == 0.0 && affine[2].y == 0.0;
    openvdb::math::Mat4d matrix = openvdb::math::Mat4d::identity();
    // OpenVDB multiplies row vectors from the left: its rows are our columns.
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) matrix(row, column) = affine[row][column];
    const openvdb::Vec3d translation(affine[3].x, affine[3].y, affine[3].z);
    if (!diagonal) {
        matrix.setTranslation(translation);
        return Transform::createLinearTransform(matrix);
    }
    Transform::Ptr transform = Transform::createLinearTransform(matrix);
    transform->postTranslate(translation);
    return transform;
}

bool isFinite(const Affine& affine) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row)
            if (!std::isfinite(affine[column][row])) return false;
    return true;
}

Result<openvdb::math::Transform::Ptr> transformOf(const Instance& instance, std::size_t index) {
    const Affine affine = worldFromIndex(instance);
    try {
        if (isFinite(affine)) return linearTransform(affine);
    } catch (const openvdb::ArithmeticError&) {
        // Falls through: OpenVDB asks for an inverse.
    }
    return fail(
        ErrorCode::UnsupportedFeature,
        fmt::format("instance {} ('{}') is flattened, or its voxels are too small: OpenVDB needs a volume of "
                    "more than 1e-15 cubic metres a voxel",
                    index, instance.name));
}

void setText(openvdb::MetaMap& map, std::string_view key, std::string_view value) {
    map.insertMeta(std::string(key), openvdb::StringMetadata(std::string(value)));
}

class VdbExport {
  public:
    VdbExport(const OctreeAsset& asset, const Limits& limits, Diagnostics& diagnostics)
        : asset_(asset), limits_(limits), diagnostics_(diagnostics), models_(asset.models.size()) {}

    Result<std::vector<std::byte>> run() {
        openvdb::initialize();
        std::size_t empty = 0;
        for (std::size_t i = 0; i < asset_.instances.size(); ++i) {
            PFVOX_TRY(const bool, placed, addInstance(i));
            if (!placed) ++empty;
        }
        if (grids_.empty()) return fail(ErrorCode::NothingToConvert, "no instance shows a voxel");
        report(empty);
        return vdb_export::writeVdb(grids_);
    }

  private:
    /// Whether there was something to place.
    Result<bool> addInstance(std::size_t index) {
        const Instance& instance = asset_.instances[index];
        std::optional<ModelGrids>& model = models_[instance.model];
        const bool first = !model;
        if (first) {
            PFVOX_TRY(ModelGrids, grids,
                      vdb_export::makeGrids(asset_.models[instance.model], asset_.materials, limits_,
                                            memoryBytes_));
            model = std::move(grids);
        }
        if (model->material == nullptr) return false;
        PFVOX_TRY(const auto, transform, transformOf(instance, index));
        addGrid(*model->density, "density", metadata::kDensityRole, instance, transform);
        addGrid(*model->color, "Cd", metadata::kColorRole, instance, transform);
        openvdb::GridBase& material =
            addGrid(*model->material, "material", metadata::kMaterialRole, instance, transform);
        if (first) setText(material, metadata::kMaterials, tableOf(*model));
        return true;
    }

    /// A grid of its own that shares the tree of `source`.
    template <class GridT>
    openvdb::GridBase& addGrid(GridT& source, const char* name, std::string_view role,
                               const Instance& instance, const openvdb::math::Transform::Ptr& transform) {
        const typename GridT::Ptr grid = source.copy();
        grid->setTransform(transform);  // a copy of it would lose digits
        grid->setName(name);
        setText(*grid, metadata::kRole, role);
        setText(*grid, metadata::kInstance, instance.name);
        setText(*grid, metadata::kModel, asset_.models[instance.model].name);
        setText(*grid, metadata::kVoxelSize, import::vdb::spelledSize(asset_.source.voxelSizeMetres));
        if (instance.hidden) setText(*grid, metadata::kHidden, "1");
        if (instance.layer >= 0 && static_cast<std::size_t>(instance.layer) < asset_.layers.size()) {
            const Layer& layer = asset_.layers[static_cast<std::size_t>(instance.layer)];
            setText(*grid, metadata::kLayer, layer.name);
            if (layer.hidden) setText(*grid, metadata::kLayerHidden, "1");
        }
        grids_.push_back(grid);
        return *grid;
    }

    std::string tableOf(const ModelGrids& model) const {
        import::vdb::MaterialTable table;
        for (const MaterialIndex m : model.materials) {
            table.emplace(import::vdb::labelOfMaterial(m), asset_.materials[m]);
        }
        return import::vdb::materialTable(table);
    }

    void report(std::size_t emptyInstances) {
        std::size_t unplaced = 0;
        for (const auto& model : models_) unplaced += model ? 0u : 1u;
        if (unplaced > 0) {
            diagnostics_.warn("export-vdb-unplaced",
                              fmt::format("{} models are shown by no instance and are left out", unplaced));
        }
        if (emptyInstances > 0) {
            diagnostics_.note(
                "export-vdb-empty",
                fmt::format("{} instances of models without voxels are left out", emptyInstances));
        }
        if (!asset_.cameras.empty()) {
            diagnostics_.note("export-vdb-cameras", "cameras have no place in a .vdb file");
        }
    }

    const OctreeAsset& asset_;
    const Limits& limits_;
    Diagnostics& diagnostics_;
    std::vector<std::optional<ModelGrids>> models_;
    openvdb::GridCPtrVec grids_;
    std::uint64_t memoryBytes_ = 0;
};

}  // namespace

/// The edge that no exception crosses.
Result<std::vector<std::byte>> exportVdb(const OctreeAsset& asset, const Limits& limits,
                                         Diagnostics& diagnostics) {
    try {
        return VdbExport(asset, limits, diagnostics).run();
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::LimitExceeded, "the grids of the .vdb file need more memory than there is");
    } catch (const std::exception& error) {
        return fail(ErrorCode::Internal, fmt::format("OpenVDB: {}", error.what()));
    }
}

}  // namespace pfvox::vdb_export

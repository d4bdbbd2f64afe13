// From the tree of a VDB grid to a VoxelModel. OpenVDB's leaf nodes are our bricks and its tiles ours:
// neither is taken apart.
#pragma once

#include <openvdb/Grid.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <pfvox/import.hpp>
#include <pfvox/voxel_model.hpp>

#include "import/model_budget.hpp"

namespace pfvox::import::vdb {

/// Materials of the voxels of a leaf node, in OpenVDB's order (x slowest).
using LeafMaterials = std::array<MaterialIndex, kBrickVoxels>;

/// Where the materials of a model come from when they depend on position: a color grid.
class Shader {
  public:
    Shader() = default;
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;
    virtual ~Shader() = default;

    /// The materials of the 8^3 voxels from `origin`.
    virtual void shadeLeaf(const openvdb::Coord& origin, LeafMaterials& out) const = 0;
    /// The one material of the aligned cube of edge 2^edgeLog2 (3, 7 or 12), or nothing where it has several.
    virtual std::optional<MaterialIndex> shadeTile(const openvdb::Coord& corner, int edgeLog2) const = 0;
};

/// Numbers of integer grids and their materials, in the order of their first appearance.
class LabelTable {
  public:
    explicit LabelTable(MaterialIndex firstMaterial) : first_(firstMaterial) {}
    /// The material of a number; may exceed 16 bits when there are too many.
    std::uint32_t materialOf(std::int64_t label) {
        return first_ + static_cast<std::uint32_t>(labels_.try_emplace(label, labels_.size()).first->second);
    }
    std::size_t size() const { return labels_.size(); }
    /// The numbers by material.
    std::vector<std::int64_t> labels() const;

  private:
    std::uint32_t first_;
    std::map<std::int64_t, std::size_t> labels_;
};

/// Numbers that have a material already, because the file tells it.
using KnownLabels = std::map<std::int64_t, MaterialIndex>;

struct FillSettings {
    double threshold = 0.0;  ///< of fog volumes
    UpAxis upAxis = UpAxis::Y;
    std::uint32_t maxMaterials = 0;
    MaterialIndex plainMaterial = 0;  ///< of grids without colors or numbers
    const Shader* shader = nullptr;
    const KnownLabels* known = nullptr;
};

/// Fills `model` with the solid voxels of a grid: of level sets those below zero, active or not; of all
/// others the active ones that are above the threshold (float, double), true (bool), or not zero (integers).
/// Errors: LimitExceeded (maxRegions, maxMemoryBytes, maxMaterials, coordinates beyond 2^30),
/// UnsupportedFeature.
Result<void> fillModel(const openvdb::GridBase& grid, const FillSettings& settings, LabelTable& labels,
                       ModelBudget& budget, VoxelModel& model, Diagnostics& diagnostics);

}  // namespace pfvox::import::vdb

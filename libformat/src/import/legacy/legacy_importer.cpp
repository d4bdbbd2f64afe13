// Importer of the thesis program's .pf_vox files: octree leaves become voxels and tiles again.

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "import/importer.hpp"
#include "import/legacy/legacy_layout.hpp"
#include "import/legacy/legacy_materials.hpp"
#include "import/model_budget.hpp"
#include "io/byte_cursor.hpp"

namespace pfvox::import {

namespace {

/// VoxelModel::fillTile takes no larger cube at once.
constexpr int kLargestTileEdgeLog2 = 15;

/// Walks the octree and fills a model in our axes.
///
/// The file has x, z, y of its source in this order, a mirror image. Source voxel (x, y, z) shall become (x,
/// z, -y - 1), so only the third axis of the file is turned around: z -> 2^depth - 1 - z. A cube stays
/// aligned under that, which is what keeps tiles whole; the source position goes into worldFromModel.
class LeafWriter {
  public:
    LeafWriter(const legacy::LegacyFile& file, const Limits& limits, VoxelModel& model)
        : file_(file), budget_(limits), model_(model) {}

    Result<void> run() {
        struct Cube {
            glm::ivec3 corner;
            int edgeLog2;  ///< of the children
        };
        std::vector<Cube> cubes(file_.nodes.size());
        cubes[0] = {.corner = glm::ivec3{0}, .edgeLog2 = static_cast<int>(file_.depth) - 1};
        std::size_t nextInner = 1;
        std::size_t nextLeaf = 0;
        for (std::size_t i = 0; i < file_.nodes.size(); ++i) {
            const legacy::Node& node = file_.nodes[i];
            const auto [corner, edgeLog2] = cubes[i];
            for (int slot = 0; slot < 8; ++slot) {
                if (((node.validMask >> slot) & 1) == 0) continue;
                const glm::ivec3 child =
                    corner + (glm::ivec3{slot & 1, (slot >> 1) & 1, slot >> 2} << edgeLog2);
                if (((node.leafMask >> slot) & 1) == 0) {
                    cubes[nextInner++] = {.corner = child, .edgeLog2 = edgeLog2 - 1};
                    continue;
                }
                PFVOX_CHECK(budget_.step(model_));
                PFVOX_CHECK(
                    write(child, edgeLog2, static_cast<MaterialIndex>(file_.leafMaterials[nextLeaf++])));
            }
        }
        return budget_.check(model_);
    }

    /// Upper corner of everything written, in the file's axes.
    glm::ivec3 upper() const { return upper_; }

  private:
    Result<void> write(glm::ivec3 corner, int edgeLog2, MaterialIndex material) {
        const int edge = 1 << edgeLog2;
        upper_ = glm::max(upper_, corner + edge);
        corner.z = (1 << file_.depth) - corner.z - edge;
        if (edgeLog2 >= kBrickEdgeLog2) {
            PFVOX_CHECK(budget_.checkTile(model_, edgeLog2));
            fillCube(corner, edgeLog2, material);
            return {};
        }
        for (int z = 0; z < edge; ++z)
            for (int y = 0; y < edge; ++y)
                for (int x = 0; x < edge; ++x) model_.set(corner + glm::ivec3{x, y, z}, material);
        return {};
    }

    void fillCube(glm::ivec3 corner, int edgeLog2, MaterialIndex material) {
        const int tileLog2 = std::min(edgeLog2, kLargestTileEdgeLog2);
        const int tiles = 1 << (edgeLog2 - tileLog2);
        for (int z = 0; z < tiles; ++z)
            for (int y = 0; y < tiles; ++y)
                for (int x = 0; x < tiles; ++x) {
                    model_.fillTile(corner + (glm::ivec3{x, y, z} << tileLog2), tileLog2, material);
                }
    }

    const legacy::LegacyFile& file_;
    ModelBudget budget_;
    VoxelModel& model_;
    glm::ivec3 upper_{0};
};

bool recognises(const SourceBytes& source) {
    std::string extension = source.file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
    if (extension != ".pf_vox" || io::asText(source.bytes).starts_with("PFVOX")) return false;
    return legacy::looksLikeLegacy(source.bytes);
}

/// The box in the header repeats what the leaves say: the only redundancy that covers the positions.
Result<void> checkExtent(const legacy::LegacyFile& file, glm::ivec3 upper) {
    const glm::vec3 measured = glm::vec3{upper} / static_cast<float>(1u << file.depth);
    if (file.extent == measured) return {};
    return failAt(
        ErrorCode::BadStructure, 4 + legacy::kMaterialBytes * file.materials.size() + 20, "AABB",
        fmt::format("the upper corner is ({}, {}, {}), but the leaf cubes reach ({}, {}, {})", file.extent.x,
                    file.extent.y, file.extent.z, measured.x, measured.y, measured.z));
}

Affine worldFromModel(const legacy::LegacyFile& file, double voxelSizeMetres) {
    const glm::dvec3 origin{file.originSwapped.x, file.originSwapped.y,
                            -file.originSwapped.z - (1 << file.depth)};
    Affine affine{voxelSizeMetres};
    affine[3] = origin * voxelSizeMetres;
    return affine;
}

Result<VoxelAsset> importLegacy(const SourceBytes& source, const ImportSettings& settings,
                                const Limits& limits, Diagnostics& diagnostics) {
    PFVOX_TRY(const legacy::LegacyFile, file, legacy::parseLegacy(source.bytes, limits));
    VoxelAsset asset;
    PFVOX_TRY(auto, materials, legacy::convertMaterials(file, diagnostics));
    asset.materials = std::move(materials);

    VoxelModel model;
    model.name = source.file.stem().string();
    LeafWriter writer(file, limits, model);
    PFVOX_CHECK(writer.run());
    PFVOX_CHECK(checkExtent(file, writer.upper()));

    asset.source.format = "legacy";
    asset.source.voxelSizeMetres = settings.voxelSizeMetres.value_or(kDefaultVoxelSizeMetres);
    Instance instance;
    instance.worldFromModel = worldFromModel(file, asset.source.voxelSizeMetres);
    instance.name = model.name;
    asset.instances.push_back(std::move(instance));
    asset.models.push_back(std::move(model));
    return asset;
}

}  // namespace

Importer legacyImporter() {
    return {.format = {.id = "legacy", .title = "PF_VOX of the thesis program", .extension = ".pf_vox"},
            .recognises = recognises,
            .import = importLegacy};
}

}  // namespace pfvox::import

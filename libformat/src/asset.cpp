#include <algorithm>
#include <cmath>
#include <map>
#include <pfvox/asset.hpp>
#include <pfvox/voxel_model.hpp>
#include <string_view>
#include <tuple>

namespace pfvox {

const char* toString(MaterialType type) {
    switch (type) {
        case MaterialType::Diffuse:
            return "diffuse";
        case MaterialType::Metal:
            return "metal";
        case MaterialType::Glass:
            return "glass";
        case MaterialType::Emit:
            return "emit";
        case MaterialType::Plastic:
            return "plastic";
        case MaterialType::Blend:
            return "blend";
        case MaterialType::Media:
            return "media";
    }
    return "unknown";
}

Material quantised(const Material& material) {
    const auto unorm16 = [](float v) { return std::round(std::clamp(v, 0.0f, 1.0f) * 65535.0f) / 65535.0f; };
    const auto snorm16 = [](float v) { return std::round(std::clamp(v, -1.0f, 1.0f) * 32767.0f) / 32767.0f; };
    Material q = material;
    for (const MaterialField& field : kMaterialFields) {
        float& value = q.*field.value;
        if (field.precision == Precision::Unorm16) value = unorm16(value);
        if (field.precision == Precision::Snorm16) value = snorm16(value);
    }
    return q;
}

bool isOpaque(const Material& material) {
    return material.type != MaterialType::Glass && material.type != MaterialType::Media &&
           material.transparency == 0.0f && material.baseColor.a == 255;
}

bool letsThrough(const Material& material) {
    const bool glass = material.type == MaterialType::Glass || material.type == MaterialType::Media ||
                       material.type == MaterialType::Blend;
    return glass && material.transparency > 0.0f && material.emissionStrength == 0.0f;
}

bool isHidden(const AssetInfo& asset, const Instance& instance) {
    if (instance.hidden) return true;
    const auto layer = static_cast<std::size_t>(instance.layer);
    return instance.layer >= 0 && layer < asset.layers.size() && asset.layers[layer].hidden;
}

namespace {

/// Calls visit(MaterialIndex&) for every brick voxel, tile and region that holds a material.
template <class Visit>
void forEachMaterial(VoxelAsset& asset, Visit visit) {
    for (VoxelModel& model : asset.models) {
        for (const auto& region : model.regions()) {
            if (const auto uniform = region->uniform()) {
                MaterialIndex m = *uniform;
                visit(m);
                if (m != *uniform) region->fill(m);
                continue;
            }
            for (std::uint32_t c = 0; c < region->cellEnd(); ++c) {
                const VoxelRegion::Cell cell = region->cell(c);
                if (cell.material) {
                    MaterialIndex m = *cell.material;
                    visit(m);
                    if (m != *cell.material) region->fillCell(c, m);
                } else if (cell.brick) {
                    Brick& brick = region->brickAt(c);
                    for (std::uint32_t word = 0; word < 8; ++word) {
                        for (std::uint64_t bits = brick.occupancy[word]; bits != 0; bits &= bits - 1) {
                            visit(brick.materials[word * 64 +
                                                  static_cast<std::uint32_t>(std::countr_zero(bits))]);
                        }
                    }
                }
            }
        }
    }
}

}  // namespace

void compactMaterials(VoxelAsset& asset) {
    std::vector<bool> used(asset.materials.size(), false);
    forEachMaterial(asset, [&](MaterialIndex& m) {
        if (m < used.size()) used[m] = true;
    });

    const auto key = [](const Material& m) {
        std::array<float, kMaterialFields.size()> numbers;
        std::ranges::transform(kMaterialFields, numbers.begin(),
                               [&](const MaterialField& field) { return m.*field.value; });
        return std::make_tuple(m.baseColor.x, m.baseColor.y, m.baseColor.z, m.baseColor.w, m.type, numbers,
                               m.name);
    };
    std::map<decltype(key(Material{})), MaterialIndex> known;
    std::vector<Material> kept;
    std::vector<MaterialIndex> newIndexOf(asset.materials.size());
    bool changed = false;
    for (std::size_t i = 0; i < asset.materials.size(); ++i) {
        if (!used[i]) continue;
        Material material = quantised(asset.materials[i]);
        const auto [entry, isNew] = known.emplace(key(material), static_cast<MaterialIndex>(kept.size()));
        if (isNew) kept.push_back(std::move(material));
        newIndexOf[i] = entry->second;
        changed = changed || entry->second != i;
    }
    asset.materials = std::move(kept);
    if (!changed) return;
    forEachMaterial(asset, [&](MaterialIndex& m) {
        if (m < newIndexOf.size()) m = newIndexOf[m];
    });
}

}  // namespace pfvox

#include "import/legacy/legacy_materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pfvox::import::legacy {

namespace {

/// Index = the thesis program's number; its type 6, "cloud", is a medium to us.
constexpr std::array kTypes{MaterialType::Diffuse, MaterialType::Metal, MaterialType::Glass,
                            MaterialType::Emit,    MaterialType::Blend, MaterialType::Media,
                            MaterialType::Media};

/// The file keeps 1 + the source's key, so 1 is what a source without the key left behind.
constexpr float kIndexOfRefractionAbsent = 1.0f;

bool finite(const Material& m) {
    const std::array values{m.metalness, m.roughness, m.specular,     m.indexOfRefraction, m.flux,
                            m.emission,  m.alpha,     m.transparency, m.density,           m.color.r,
                            m.color.g,   m.color.b,   m.color.a};
    return std::ranges::all_of(values, [](float v) { return std::isfinite(v); });
}

class Converter {
  public:
    pfvox::Material convert(const Material& source) {
        pfvox::Material material;
        material.type = kTypes[source.type];
        for (int c = 0; c < 4; ++c) {
            material.baseColor[c] = static_cast<std::uint8_t>(std::lround(unit(source.color[c]) * 255.0f));
        }
        // A diffuse record holds zeros for all that MagicaVoxel did not ask about; our defaults stand for
        // "not asked".
        if (material.type == MaterialType::Diffuse) return material;
        const bool metallic = material.type == MaterialType::Metal || material.type == MaterialType::Blend;
        const bool clear = material.type == MaterialType::Glass || material.type == MaterialType::Blend ||
                           material.type == MaterialType::Media;
        if (metallic) material.metalness = unit(source.metalness);
        material.roughness = unit(source.roughness);
        material.specular = unit(source.specular);
        if (source.indexOfRefraction > kIndexOfRefractionAbsent) {
            material.indexOfRefraction = source.indexOfRefraction;
        }
        if (clear) {
            material.transparency = transparency(source);
            material.density = std::max(source.density, 0.0f);
        }
        if (material.type == MaterialType::Emit) {
            material.emissionStrength =
                std::max(source.emission, 0.0f) * std::pow(10.0f, std::clamp(source.flux, 0.0f, 8.0f));
        }
        return material;
    }

    int clampedCount() const { return clampedCount_; }

  private:
    float unit(float value) {
        const float clamped = std::clamp(value, 0.0f, 1.0f);
        if (clamped != value) ++clampedCount_;
        return clamped;
    }

    /// As for .vox files: `_trans`, in older files `_alpha`.
    float transparency(const Material& source) {
        const float transparency = unit(source.transparency);
        return transparency == 0.0f ? unit(source.alpha) : transparency;
    }

    int clampedCount_ = 0;
};

}  // namespace

Result<std::vector<pfvox::Material>> convertMaterials(const LegacyFile& file, Diagnostics& diagnostics) {
    std::vector<pfvox::Material> materials;
    materials.reserve(file.materials.size());
    Converter converter;
    for (std::size_t i = 0; i < file.materials.size(); ++i) {
        const Material& source = file.materials[i];
        const std::uint64_t offset = 4 + kMaterialBytes * std::uint64_t{i};
        const std::string context = fmt::format("material {}", i);
        if (source.type >= kTypes.size()) {
            return failAt(ErrorCode::BadValue, offset, context,
                          fmt::format("type {} does not exist", source.type));
        }
        if (!finite(source))
            return failAt(ErrorCode::BadValue, offset, context, "holds a number that is not finite");
        materials.push_back(converter.convert(source));
    }
    if (converter.clampedCount() != 0) {
        diagnostics.warn(
            "legacy-material-range",
            fmt::format("{} material values lie outside [0, 1] and were clamped", converter.clampedCount()));
    }
    return materials;
}

}  // namespace pfvox::import::legacy

#include "export/vox_materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pfvox::vox_export {

namespace {

const char* typeName(MaterialType type) {
    switch (type) {
        case MaterialType::Metal:
            return "_metal";
        case MaterialType::Glass:
            return "_glass";
        case MaterialType::Emit:
            return "_emit";
        case MaterialType::Plastic:
            return "_plastic";
        case MaterialType::Blend:
            return "_blend";
        case MaterialType::Media:
            return "_media";
        case MaterialType::Diffuse:
            break;
    }
    return "_diffuse";
}

/// Strength = _emit x 10^_flux with _emit at most 1.
void addEmission(float strength, vox_file::VoxDict& dict) {
    const int flux = strength > 1.0f ? static_cast<int>(std::ceil(std::log10(strength))) : 0;
    dict.emplace_back("_emit", fmt::format("{}", strength / std::pow(10.0f, static_cast<float>(flux))));
    dict.emplace_back("_flux", fmt::format("{}", flux));
}

}  // namespace

vox_file::VoxDict matlOf(const Material& material) {
    vox_file::VoxDict dict{{"_type", typeName(material.type)}};
    const auto add = [&](const char* key, float value) { dict.emplace_back(key, fmt::format("{}", value)); };
    add("_rough", material.roughness);
    add("_spec", material.specular);
    add("_ior", material.indexOfRefraction - 1.0f);
    add("_metal", material.metalness);
    if (material.type == MaterialType::Emit) addEmission(material.emissionStrength, dict);
    add("_trans", material.transparency);
    add("_d", material.density);
    add("_g", material.phase);
    return dict;
}

}  // namespace pfvox::vox_export

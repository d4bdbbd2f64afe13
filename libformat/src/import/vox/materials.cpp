#include "import/vox/materials.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pfvox::import::vox {

namespace {

struct Range {
    float min;
    float max;
};
constexpr Range kFraction{0.0f, 1.0f};
constexpr Range kPositive{0.0f, std::numeric_limits<float>::max()};
constexpr float kMaxFlux = 30.0f;  // 10^30 still is a float

/// Reads numbers out of a MATL's table and remembers which keys were used and which were bad.
class PropertyReader {
  public:
    PropertyReader(const Dict& properties, MaterialRecord& record)
        : properties_(properties), record_(record) {}

    std::optional<float> number(std::string_view key, Range range) {
        const auto text = properties_.find(key);
        if (!text) return std::nullopt;
        used_.insert(key);
        const auto value = parseFloat(*text);
        if (!value) {
            record_.malformedKeys.emplace(key);
            return std::nullopt;
        }
        const float inRange = std::clamp(*value, range.min, range.max);
        if (inRange != *value) record_.malformedKeys.emplace(key);
        return inRange;
    }

    void markUsed(std::string_view key) { used_.insert(key); }

    void reportUnused() const {
        for (const auto& [key, value] : properties_.entries()) {
            if (!used_.contains(key)) record_.unmappedKeys.emplace(printableId(key));
        }
    }

  private:
    const Dict& properties_;
    MaterialRecord& record_;
    std::set<std::string_view> used_;
};

std::optional<MaterialType> typeFromName(std::string_view name) {
    if (name == "_diffuse") return MaterialType::Diffuse;
    if (name == "_metal") return MaterialType::Metal;
    if (name == "_glass") return MaterialType::Glass;
    if (name == "_emit") return MaterialType::Emit;
    if (name == "_plastic") return MaterialType::Plastic;
    if (name == "_blend") return MaterialType::Blend;
    if (name == "_media") return MaterialType::Media;
    return std::nullopt;
}

MaterialType readType(const Dict& properties, PropertyReader& reader, MaterialRecord& record) {
    reader.markUsed("_type");
    const auto name = properties.find("_type");
    if (!name) return MaterialType::Diffuse;
    const auto type = typeFromName(*name);
    if (!type) record.malformedKeys.emplace("_type");
    return type.value_or(MaterialType::Diffuse);
}

bool letsLightThrough(MaterialType type) {
    return type == MaterialType::Glass || type == MaterialType::Blend || type == MaterialType::Media;
}

/// Properties that only some types have: MagicaVoxel leaves values of an earlier type behind when the user
/// changes it, and those must not make a diffuse wall shine.
void keepPropertiesOfType(Material& material) {
    const MaterialType type = material.type;
    if (type != MaterialType::Metal && type != MaterialType::Blend) {
        material.metalness = 0.0f;
    }
    if (type != MaterialType::Emit) material.emissionStrength = 0.0f;
    if (!letsLightThrough(type)) {
        material.transparency = 0.0f;
        material.density = 0.0f;
        material.phase = 0.0f;
    }
}

float emissionStrength(PropertyReader& reader, std::optional<float> weight) {
    const auto emit = reader.number("_emit", kPositive);
    const float flux = reader.number("_flux", {-kMaxFlux, kMaxFlux}).value_or(0.0f);
    const float strength = emit.value_or(weight.value_or(0.0f)) * std::pow(10.0f, flux);
    return std::min(strength, std::numeric_limits<float>::max());
}

/// `_ri` is the index itself, `_ior` is the index less one.
float indexOfRefraction(PropertyReader& reader) {
    const auto index = reader.number("_ri", {1.0f, 100.0f});
    const auto lessOne = reader.number("_ior", {0.0f, 99.0f});
    if (index) return *index;
    return lessOne ? 1.0f + *lessOne : Material{}.indexOfRefraction;
}

/// `_sp` of newer files scales the highlight, 1 being neutral as 0.5 is for `_spec`.
float specular(PropertyReader& reader) {
    const auto spec = reader.number("_spec", kFraction);
    const auto scale = reader.number("_sp", {0.0f, 2.0f});
    if (spec) return *spec;
    return scale ? 0.5f * *scale : Material{}.specular;
}

Result<std::int32_t> readPaletteIndex(Chunk& chunk) {
    PFVOX_TRY(const std::int32_t, id, chunk.readInt("the material id"));
    if (id < 0 || id > 256) {
        return chunk.fail(
            ErrorCode::BadValue,
            fmt::format("material id {} is outside the palette (1 to 256); the file is damaged", id));
    }
    return id == 256 ? 0 : id;
}

}  // namespace

MaterialRecord materialFromDict(const Dict& properties) {
    MaterialRecord record;
    Material& material = record.material;
    PropertyReader reader(properties, record);
    material.type = readType(properties, reader, record);
    // The single strength of older files, whose meaning depends on the type.
    const auto weight = reader.number("_weight", kFraction);
    const auto metal = reader.number("_metal", kFraction);
    material.metalness = metal.value_or(weight.value_or(material.metalness));
    material.roughness = reader.number("_rough", kFraction).value_or(material.roughness);
    material.specular = specular(reader);
    material.indexOfRefraction = indexOfRefraction(reader);
    material.emissionStrength = emissionStrength(reader, weight);
    const auto trans = reader.number("_trans", kFraction);
    const auto alpha = reader.number("_alpha", kFraction);
    material.transparency = trans ? *trans : alpha ? *alpha : weight.value_or(material.transparency);
    material.density = reader.number("_d", kPositive).value_or(material.density);
    material.phase = reader.number("_g", {-1.0f, 1.0f}).value_or(material.phase);
    reader.reportUnused();
    keepPropertiesOfType(material);
    return record;
}

Result<MaterialChunk> readMatl(Chunk& chunk) {
    PFVOX_TRY(const std::int32_t, index, readPaletteIndex(chunk));
    PFVOX_TRY(const Dict, properties, chunk.readDict("the material's properties"));
    return MaterialChunk{.paletteIndex = index, .record = materialFromDict(properties)};
}

Result<MaterialChunk> readMatt(Chunk& chunk) {
    PFVOX_TRY(const std::int32_t, index, readPaletteIndex(chunk));
    PFVOX_TRY(const std::int32_t, type, chunk.readInt("the material type"));
    PFVOX_TRY(const float, weight, chunk.readFloat("the material weight"));
    PFVOX_TRY(const std::int32_t, propertyBits, chunk.readInt("the property bits"));

    // One float for each of the seven lowest bits that is set; the eighth is a flag alone.
    enum Property : std::size_t { Plastic, Roughness, Specular, Ior, Attenuation, Power, Glow, Count };
    constexpr std::array<const char*, Count> kNames{"plastic",     "roughness", "specular", "IOR",
                                                    "attenuation", "power",     "glow"};
    MaterialChunk result{.paletteIndex = index, .record = {}};
    MaterialRecord& record = result.record;
    const auto fraction = [&record](float value, const char* name) {
        const float inRange = std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0.0f;
        if (!(inRange == value)) record.malformedKeys.emplace(name);
        return inRange;
    };
    std::array<std::optional<float>, Count> values;
    for (std::size_t i = 0; i < Count; ++i) {
        if (((static_cast<std::uint32_t>(propertyBits) >> i) & 1u) == 0) continue;
        PFVOX_TRY(const float, value, chunk.readFloat(std::string("property ") + kNames[i]));
        values[i] = fraction(value, kNames[i]);
        if (i == Plastic || i >= Attenuation) record.unmappedKeys.emplace(kNames[i]);
    }

    constexpr std::array kTypes{MaterialType::Diffuse, MaterialType::Metal, MaterialType::Glass,
                                MaterialType::Emit};
    if (type < 0 || static_cast<std::size_t>(type) >= kTypes.size()) {
        return chunk.fail(
            ErrorCode::BadValue,
            fmt::format("material type {} does not exist (0 to 3 do); the file is damaged", type));
    }
    Material& material = record.material;
    material.type = kTypes[static_cast<std::size_t>(type)];
    const float strength = fraction(weight, "weight");
    material.metalness = material.emissionStrength = material.transparency = strength;
    material.roughness = values[Roughness].value_or(material.roughness);
    material.specular = values[Specular].value_or(material.specular);
    if (values[Ior]) material.indexOfRefraction = 1.0f + *values[Ior];
    keepPropertiesOfType(material);
    return result;
}

}  // namespace pfvox::import::vox

#include "import/vdb/pfvox_metadata.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

namespace pfvox::import::vdb {

namespace {

/// As many as a MaterialIndex tells apart.
constexpr std::size_t kMaxMaterials = 65536;

constexpr std::array kTypes{MaterialType::Diffuse, MaterialType::Metal,   MaterialType::Glass,
                            MaterialType::Emit,    MaterialType::Plastic, MaterialType::Blend,
                            MaterialType::Media};

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\') {
            out += "\\\\";
        } else if (c == '\n') {
            out += "\\n";
        } else {
            out += c;
        }
    }
    return out;
}

std::string unescaped(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escape = text[i] == '\\' && i + 1 < text.size();
        if (escape) ++i;
        out += escape && text[i] == 'n' ? '\n' : text[i];
    }
    return out;
}

template <class T>
bool parseNumber(std::string_view text, T& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size();
}

/// "#rrggbbaa"
bool parseColor(std::string_view text, glm::u8vec4& color) {
    std::uint32_t code = 0;
    if (text.size() != 9 || text[0] != '#') return false;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), code, 16);
    if (error != std::errc{} || end != text.data() + text.size()) return false;
    for (int i = 0; i < 4; ++i) color[i] = static_cast<std::uint8_t>(code >> (24 - 8 * i));
    return true;
}

bool parseType(std::string_view text, MaterialType& type) {
    for (const MaterialType known : kTypes) {
        if (text != toString(known)) continue;
        type = known;
        return true;
    }
    return false;
}

/// Keys of later versions are passed over.
bool parseField(std::string_view key, std::string_view value, Material& material) {
    if (key == "color") return parseColor(value, material.baseColor);
    if (key == "type") return parseType(value, material.type);
    for (const MaterialField& field : kMaterialFields) {
        if (key != field.key) continue;
        float number = 0.0f;
        if (!parseNumber(value, number) || !(number >= field.least && number <= field.most)) return false;
        material.*field.value = number;
    }
    return true;
}

/// The text up to the separator, which is taken off together with it.
std::string_view takeUntil(std::string_view& text, char separator) {
    const std::size_t end = text.find(separator);
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return part;
}

bool parseLine(std::string_view line, std::int64_t& label, Material& material) {
    constexpr std::string_view kName = "name=";
    if (!parseNumber(takeUntil(line, ' '), label)) return false;
    while (!line.empty()) {
        if (line.starts_with(kName)) {
            material.name = unescaped(line.substr(kName.size()));
            return true;
        }
        std::string_view field = takeUntil(line, ' ');
        const std::string_view key = takeUntil(field, '=');
        if (!parseField(key, field, material)) return false;
    }
    return true;
}

}  // namespace

std::string materialTable(const MaterialTable& materials) {
    const Material defaults;
    std::string table;
    for (const auto& [label, m] : materials) {
        const glm::u8vec4 c = m.baseColor;
        table += fmt::format("{} color=#{:02x}{:02x}{:02x}{:02x}", label, c.r, c.g, c.b, c.a);
        if (m.type != defaults.type) table += fmt::format(" type={}", toString(m.type));
        for (const MaterialField& field : kMaterialFields) {
            if (m.*field.value != defaults.*field.value) {
                table += fmt::format(" {}={}", field.key, m.*field.value);
            }
        }
        if (!m.name.empty()) table += fmt::format(" name={}", escaped(m.name));
        table += '\n';
    }
    return table;
}

Result<MaterialTable> parseMaterialTable(std::string_view text) {
    MaterialTable table;
    for (int number = 1; !text.empty(); ++number) {
        const std::string_view line = takeUntil(text, '\n');
        if (line.empty()) continue;
        std::int64_t label = 0;
        Material material;
        if (!parseLine(line, label, material)) {
            return fail(ErrorCode::BadValue, fmt::format("line {} of {} is no material: \"{}\"", number,
                                                         metadata::kMaterials, line));
        }
        table.insert_or_assign(label, std::move(material));
        if (table.size() > kMaxMaterials) {
            return fail(ErrorCode::BadValue,
                        fmt::format("{} has more than {} materials", metadata::kMaterials, kMaxMaterials));
        }
    }
    return table;
}

std::string spelledSize(double metres) {
    return fmt::format("{}", metres);
}

std::optional<double> parseSize(std::string_view text) {
    double metres = 0.0;
    if (!parseNumber(text, metres) || !std::isfinite(metres) || !(metres > 0.0)) return std::nullopt;
    return metres;
}

}  // namespace pfvox::import::vdb

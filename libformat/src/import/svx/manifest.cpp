#include "import/svx/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <pugixml.hpp>
#include <utility>

#include "import/svx/manifest_repair.hpp"

namespace pfvox::import::svx {

namespace {

constexpr std::uint32_t kMaxSubvoxelBits = 16;
constexpr std::size_t kMaxMetadataEntries = 64;

std::string place(std::string_view xml, std::ptrdiff_t offset) {
    const auto at = std::min(xml.size(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
    const std::string_view before = xml.substr(0, at);
    const auto line = 1 + std::ranges::count(before, '\n');
    const std::size_t lineStart = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
    return fmt::format("manifest.xml line {}, column {}", line, at - lineStart + 1);
}

/// Reads attributes; its errors name line and column of the element.
class ElementReader {
  public:
    ElementReader(std::string_view xml, pugi::xml_node element) : xml_(xml), element_(element) {}

    tl::unexpected<Error> fails(ErrorCode code, std::string message) const {
        return tl::make_unexpected(Error{
            .code = code, .message = std::move(message), .context = place(xml_, element_.offset_debug())});
    }

    bool has(const char* name) const { return !element_.attribute(name).empty(); }

    template <class T>
    Result<std::optional<T>> number(const char* name) const {
        const pugi::xml_attribute attribute = element_.attribute(name);
        if (attribute.empty()) return std::optional<T>{};
        const std::string_view text = trimmed(attribute.value());
        T value{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{} || end != text.data() + text.size() || !isFinite(value)) {
            return fails(ErrorCode::BadValue, fmt::format("{}=\"{}\" is not a number that fits", name, text));
        }
        return std::optional<T>{value};
    }

  private:
    static std::string_view trimmed(std::string_view text) {
        const std::size_t first = text.find_first_not_of(" \t\r\n");
        if (first == std::string_view::npos) return {};
        return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
    }
    static bool isFinite(double value) { return std::isfinite(value); }
    template <std::integral T>
    static bool isFinite(T) {
        return true;
    }

    std::string_view xml_;
    pugi::xml_node element_;
};

ChannelKind kindOf(std::string type) {
    std::ranges::transform(type, type.begin(), [](char c) {
        return c == '_' || c == ' ' ? '-' : (c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c);
    });
    if (type == "DENSITY") return ChannelKind::Density;
    if (type == "COLOR-RGB" || type == "COLOR" || type == "RGB") return ChannelKind::Color;
    if (type == "DENSITY-COLOR") return ChannelKind::DensityColor;
    if (type == "RED") return ChannelKind::Red;
    if (type == "GREEN") return ChannelKind::Green;
    if (type == "BLUE") return ChannelKind::Blue;
    if (type == "MATERIAL") return ChannelKind::Material;
    if (type == "CUSTOM") return ChannelKind::Custom;
    return ChannelKind::Other;
}

Result<void> readGridSize(const ElementReader& grid, Manifest& manifest, const Limits& limits,
                          Diagnostics& diagnostics) {
    constexpr std::array kNames{"gridSizeX", "gridSizeY", "gridSizeZ"};
    constexpr std::array kDraftNames{"nx", "ny", "nz"};
    const bool draft = !grid.has("gridSizeX") && grid.has("nx");
    if (draft)
        diagnostics.note("svx-draft-manifest",
                         "manifest.xml is of an early draft: nx, ny, nz give the grid size");
    const std::int64_t maxEdge = std::int64_t{1} << limits.maxModelDepth;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const char* name = draft ? kDraftNames[axis] : kNames[axis];
        PFVOX_TRY(const auto, size, grid.number<std::int64_t>(name));
        if (!size) return grid.fails(ErrorCode::BadStructure, fmt::format("<grid> has no {}", name));
        if (*size < 1)
            return grid.fails(ErrorCode::BadValue, fmt::format("{}=\"{}\" is less than 1", name, *size));
        if (*size > maxEdge) {
            return grid.fails(ErrorCode::LimitExceeded,
                              fmt::format("{}=\"{}\" is more than 2^{} (maxModelDepth)", name, *size,
                                          limits.maxModelDepth));
        }
        manifest.gridSize[static_cast<int>(axis)] = static_cast<int>(*size);
    }
    return {};
}

Result<void> readPlacement(const ElementReader& grid, Manifest& manifest) {
    constexpr std::array kNames{"originX", "originY", "originZ"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        PFVOX_TRY(const auto, origin, grid.number<double>(kNames[axis]));
        manifest.originMetres[static_cast<int>(axis)] = origin.value_or(0.0);
    }
    PFVOX_TRY(const auto, voxelSize, grid.number<double>("voxelSize"));
    if (voxelSize && !(*voxelSize > 0.0)) {
        return grid.fails(ErrorCode::BadValue, fmt::format("voxelSize=\"{}\" is not positive", *voxelSize));
    }
    manifest.voxelSizeMetres = voxelSize;
    return {};
}

Result<void> readSlicing(const ElementReader& grid, pugi::xml_node element, Manifest& manifest) {
    PFVOX_TRY(const auto, bits, grid.number<std::uint32_t>("subvoxelBits"));
    manifest.subvoxelBits = bits.value_or(manifest.subvoxelBits);
    if (manifest.subvoxelBits < 1 || manifest.subvoxelBits > kMaxSubvoxelBits) {
        return grid.fails(ErrorCode::BadValue,
                          fmt::format("subvoxelBits=\"{}\" is not 1 to 16", manifest.subvoxelBits));
    }
    const std::string_view axis = element.attribute("slicesOrientation").as_string("Y");
    if (axis.size() == 1) {
        const std::size_t index = std::string_view("XYZxyz").find(axis[0]);
        if (index != std::string_view::npos) {
            manifest.sliceAxis = static_cast<int>(index % 3);
            return {};
        }
    }
    return grid.fails(ErrorCode::BadValue, fmt::format("slicesOrientation=\"{}\" is not X, Y or Z", axis));
}

Result<void> readChannels(std::string_view xml, pugi::xml_node grid, Manifest& manifest) {
    for (const pugi::xml_node element : grid.child("channels").children("channel")) {
        const ElementReader reader(xml, element);
        Channel channel;
        channel.type = element.attribute("type").as_string();
        channel.kind = kindOf(channel.type);
        PFVOX_TRY(const auto, id, reader.number<std::int64_t>("id"));
        channel.id = id.value_or(0);
        PFVOX_TRY(const auto, bits, reader.number<std::uint32_t>("bits"));
        channel.bits = bits;
        auto slices = SlicePattern::parse(element.attribute("slices").as_string());
        if (!slices) return reader.fails(slices.error().code, std::move(slices).error().message);
        channel.slices = *std::move(slices);
        manifest.channels.push_back(std::move(channel));
    }
    return {};
}

void readMaterials(pugi::xml_node grid, Manifest& manifest) {
    for (const char* wrapper : {"materials", "material"}) {
        for (const pugi::xml_node element : grid.child(wrapper).children("material")) {
            manifest.materialUrns.emplace(element.attribute("id").as_llong(),
                                          element.attribute("urn").as_string());
        }
    }
    for (const pugi::xml_node element : grid.child("metadata").children("entry")) {
        if (manifest.metadata.size() == kMaxMetadataEntries) break;
        manifest.metadata.push_back(fmt::format("{}: {}", element.attribute("key").as_string(),
                                                element.attribute("value").as_string()));
    }
}

Result<Manifest> readManifest(std::string_view xml, const pugi::xml_document& document, const Limits& limits,
                              Diagnostics& diagnostics) {
    const pugi::xml_node element = document.child("grid");
    if (!element) {
        return tl::make_unexpected(Error{.code = ErrorCode::BadStructure,
                                         .message = "the root element is not <grid>",
                                         .context = place(xml, document.document_element().offset_debug())});
    }
    Manifest manifest;
    const ElementReader grid(xml, element);
    PFVOX_CHECK(readGridSize(grid, manifest, limits, diagnostics));
    PFVOX_CHECK(readPlacement(grid, manifest));
    PFVOX_CHECK(readSlicing(grid, element, manifest));
    PFVOX_CHECK(readChannels(xml, element, manifest));
    readMaterials(element, manifest);
    return manifest;
}

}  // namespace

Result<Manifest> parseManifest(std::string_view xml, const Limits& limits, Diagnostics& diagnostics) {
    // pugixml neither fetches nor expands entities of a DOCTYPE, so none can grow here.
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(xml.data(), xml.size());
    if (parsed) return readManifest(xml, document, limits, diagnostics);
    const Error error{.code = ErrorCode::BadStructure,
                      .message = parsed.description(),
                      .context = place(xml, parsed.offset)};
    const std::string repaired = repairedManifest(xml);
    if (!document.load_buffer(repaired.data(), repaired.size())) return tl::make_unexpected(error);
    diagnostics.warn("svx-manifest-repaired",
                     fmt::format("{}: {}; read after straightening quotes and closing elements",
                                 error.context, error.message));
    return readManifest(repaired, document, limits, diagnostics);
}

}  // namespace pfvox::import::svx

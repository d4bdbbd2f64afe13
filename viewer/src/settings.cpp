#include "settings.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <cmath>
#include <optional>
#include <pfvox/files.hpp>
#include <sstream>

#include "scene/toml_nesting.hpp"

namespace pfvox::viewer {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kMaxFileBytes = 4u << 20;
constexpr const char* kSettingsFile = "pfvox/pfview.toml";
constexpr const char* kCamerasFile = "pfvox/pfview-cameras.toml";

Result<toml::table> parsed(std::string_view text) {
    if (const auto place = scene::tooDeepAt(text))
        return fail(ErrorCode::BadStructure,
                    fmt::format("line {}: nested deeper than {}", place->line, scene::kMaxNesting));
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& error) {
        return fail(ErrorCode::BadStructure,
                    fmt::format("line {}: {}", error.source().begin.line, error.description()));
    }
}

/// Reads values of a table, each within its range.
class Reader {
  public:
    Reader(const toml::table& table, Diagnostics& diagnostics) : table_(table), diagnostics_(diagnostics) {}

    void number(const char* key, double low, double high, double& value) const {
        const auto node = table_[key];
        if (!node) return;
        const std::optional<double> found = node.value<double>();
        found&&* found >= low&&* found <= high ? value = *found : complain(key, value);
    }
    void edge(const char* key, std::uint32_t& value) const {
        double number = value;
        this->number(key, 64.0, 16384.0, number);
        value = static_cast<std::uint32_t>(number);
    }
    void flag(const char* key, bool& value) const {
        const auto node = table_[key];
        if (!node) return;
        const std::optional<bool> found = node.value_exact<bool>();
        if (found) value = *found;
        if (!found) complain(key, 0.0);
    }
    void mode(const char* key, CameraMode& value) const {
        const auto node = table_[key];
        if (!node) return;
        const std::string text = node.value_or(std::string());
        if (text == "orbit" || text == "fly") {
            value = text == "fly" ? CameraMode::Fly : CameraMode::Orbit;
        } else {
            complain(key, 0.0);
        }
    }
    void toneMap(const char* key, ToneMap& value) const {
        const auto node = table_[key];
        if (!node) return;
        const std::optional<ToneMap> found = toneMapFrom(node.value_or(std::string()));
        if (found) value = *found;
        if (!found) complain(key, 0.0);
    }

  private:
    double complain(const char* key, double kept) const {
        diagnostics_.warn("settings-bad-value", fmt::format("settings: {} has no usable value", key));
        return kept;
    }
    const toml::table& table_;
    Diagnostics& diagnostics_;
};

std::optional<glm::dvec3> vectorOf(const toml::node_view<const toml::node>& node) {
    const toml::array* const array = node.as_array();
    if (array == nullptr || array->size() != 3) return std::nullopt;
    glm::dvec3 v(0.0);
    for (glm::length_t i = 0; i < 3; ++i) {
        const std::optional<double> number = (*array)[static_cast<std::size_t>(i)].value<double>();
        if (!number || !(std::abs(*number) < 1e12)) return std::nullopt;
        v[i] = *number;
    }
    return v;
}

std::optional<ViewCamera> cameraOf(const toml::table& table) {
    const auto position = vectorOf(table["position"]);
    const auto target = vectorOf(table["target"]);
    const double fovY = table["fovYDegrees"].value_or(0.0);
    if (!position || !target || *position == *target || !(fovY >= 1.0 && fovY <= 170.0)) return std::nullopt;
    return ViewCamera{.position = *position, .target = *target, .fovYDegrees = fovY};
}

Result<std::string> textOf(const fs::path& file) {
    PFVOX_TRY(const io::FileBytes, bytes, io::readFile(file, kMaxFileBytes));
    return std::string(reinterpret_cast<const char*>(bytes.bytes().data()), bytes.bytes().size());
}

/// Reads and understands one file; a file that is not there gives the default.
template <class Parse>
auto remembered(const fs::path& file, Diagnostics& diagnostics, Parse parse) {
    const Result<std::string> text = textOf(file);
    if (!text && text.error().code == ErrorCode::FileNotFound) return parse("").value();
    auto value = text ? parse(*text) : parse("");
    if (text && value) return *std::move(value);
    Error error = text ? value.error() : text.error();
    error.file = file;
    diagnostics.warn("settings-unreadable", describe(error));
    return parse("").value();
}

}  // namespace

Result<Settings> parseSettings(std::string_view text, Diagnostics& diagnostics) {
    PFVOX_TRY(const toml::table, table, parsed(text));
    const Reader reader(table, diagnostics);
    Settings settings;
    reader.edge("windowWidth", settings.windowWidth);
    reader.edge("windowHeight", settings.windowHeight);
    reader.mode("cameraMode", settings.cameraMode);
    reader.flag("showWindows", settings.showWindows);
    reader.flag("antiAliasing", settings.antiAliasing);
    reader.number("renderScale", 0.25, 1.0, settings.renderScale);
    reader.number("lodPixels", 0.0, 16.0, settings.lodPixels);
    reader.number("exposureStops", -16.0, 16.0, settings.exposureStops);
    reader.toneMap("toneMap", settings.toneMap);
    reader.flag("modelGround", settings.modelGround);
    reader.flag("sceneGround", settings.sceneGround);
    reader.flag("showProbeGrid", settings.showProbeGrid);
    reader.flag("showBounds", settings.showBounds);
    return settings;
}

std::string settingsText(const Settings& settings) {
    return fmt::format(
        "windowWidth = {}\nwindowHeight = {}\ncameraMode = '{}'\nshowWindows = {}\nantiAliasing = {}\n"
        "renderScale = {:.6f}\nlodPixels = {:.6f}\nexposureStops = {:.6f}\ntoneMap = '{}'\n"
        "modelGround = {}\nsceneGround = {}\nshowProbeGrid = {}\nshowBounds = {}\n",
        settings.windowWidth, settings.windowHeight, settings.cameraMode == CameraMode::Fly ? "fly" : "orbit",
        settings.showWindows, settings.antiAliasing, settings.renderScale, settings.lodPixels,
        settings.exposureStops, toString(settings.toneMap), settings.modelGround, settings.sceneGround,
        settings.showProbeGrid, settings.showBounds);
}

Result<CameraMemory> parseCameras(std::string_view text) {
    PFVOX_TRY(const toml::table, table, parsed(text));
    CameraMemory cameras;
    for (const auto& [key, node] : table) {
        const toml::table* const entry = node.as_table();
        const auto camera = entry != nullptr ? cameraOf(*entry) : std::nullopt;
        if (camera && cameras.size() < kMaxRememberedCameras) cameras[std::string(key.str())] = *camera;
    }
    return cameras;
}

std::string camerasText(const CameraMemory& cameras) {
    toml::table table;
    const auto array = [](const glm::dvec3& v) { return toml::array{v.x, v.y, v.z}; };
    for (const auto& [file, camera] : cameras) {
        table.insert(file, toml::table{{"position", array(camera.position)},
                                       {"target", array(camera.target)},
                                       {"fovYDegrees", camera.fovYDegrees}});
    }
    std::ostringstream text;
    text << table << '\n';
    return text.str();
}

UserFolders userFolders(const char* configHome, const char* stateHome, const char* home) {
    const auto folder = [&](const char* named, const char* below) -> fs::path {
        if (named != nullptr && fs::path(named).is_absolute()) return named;
        if (home != nullptr && fs::path(home).is_absolute()) return fs::path(home) / below;
        return {};
    };
    return {.config = folder(configHome, ".config"), .state = folder(stateHome, ".local/state")};
}

Memory loadMemory(const UserFolders& folders, Diagnostics& diagnostics) {
    Memory memory;
    if (!folders.config.empty()) {
        memory.settings = remembered(folders.config / kSettingsFile, diagnostics,
                                     [&](std::string_view text) { return parseSettings(text, diagnostics); });
    }
    if (!folders.state.empty()) {
        memory.cameras = remembered(folders.state / kCamerasFile, diagnostics, parseCameras);
    }
    return memory;
}

Result<void> saveMemory(const UserFolders& folders, const Memory& memory) {
    const std::string settings = settingsText(memory.settings);
    const std::string cameras = camerasText(memory.cameras);
    if (!folders.config.empty())
        PFVOX_CHECK(
            io::writeFileAtomically(folders.config / kSettingsFile, std::as_bytes(std::span(settings))));
    if (!folders.state.empty())
        PFVOX_CHECK(io::writeFileAtomically(folders.state / kCamerasFile, std::as_bytes(std::span(cameras))));
    return {};
}

}  // namespace pfvox::viewer

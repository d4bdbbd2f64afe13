#include "scene/scene_parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <set>

#include "io/files.hpp"
#include "scene/toml_fields.hpp"

namespace pfvox::scene {

namespace {

constexpr Range kPosition{-1e9, 1e9};
constexpr Range kAngle{-1e6, 1e6};
constexpr Range kScale{-1e9, 1e9};
constexpr double kMinScale = 1e-6;
constexpr Range kVoxelSize{1e-6, 1e6};
constexpr Range kStep{1e-6, 1e9};
constexpr Range kDirection{-1e9, 1e9};
constexpr double kMinDirection = 1e-9;
constexpr Range kLight{0.0, 1e9};
constexpr Range kFovDegrees{1.0, 170.0};
constexpr std::uint32_t kMaxProximityEdge = 512;

PathPlace placeOf(const toml::source_region& region) {
    return {.begin = {region.begin.line, region.begin.column}, .end = {region.end.line, region.end.column}};
}

class SceneParser {
  public:
    explicit SceneParser(const Limits& limits) : limits_(limits) {}

    Result<ParsedScene> parse(const toml::table& document, const std::filesystem::path& file,
                              Diagnostics& diagnostics) {
        Scene& scene = parsed_.scene;
        TomlFields::Known known = probeKeys(scene.probes);
        known.insert(known.end(), {{"sun", [&](const toml::node& node) { readSun(node); }},
                                   {"sky", [&](const toml::node& node) { readSky(node); }},
                                   {"cameras", [&](const toml::node& node) { readCameras(node); }},
                                   {"models", [&](const toml::node& node) { readModels(node); }}});
        fields_.readTable(document, "a scene", known);
        PFVOX_CHECK(fields_.finish(file, diagnostics));
        return std::move(parsed_);
    }

  private:
    TomlFields::Known probeKeys(ProbeGridRequest& probes) {
        return {{"probeGridPos", fields_.vector("probeGridPos", probes.position, kPosition)},
                {"probeGridStep", [&](const toml::node& node) { readStep(node, probes); }},
                {"probeGridCount", [&](const toml::node& node) { readCount(node, probes); }},
                {"proximityGridSize",
                 fields_.counts("proximityGridSize", probes.proximityCells, kMaxProximityEdge)}};
    }

    void readStep(const toml::node& node, ProbeGridRequest& probes) {
        if (node.is_array()) return fields_.vector("probeGridStep", probes.stepMetres, kStep)(node);
        std::optional<double> step;
        fields_.number("probeGridStep", step, kStep)(node);
        if (step) probes.stepMetres = glm::dvec3(*step);
    }

    void readCount(const toml::node& node, ProbeGridRequest& probes) {
        glm::uvec3 count{0};
        fields_.counts("probeGridCount", count, kMaxProbesPerAxis)(node);
        if (count.x == 0) return;
        probes.count = count;
        const glm::u64vec3 wide(count);
        if (wide.x * wide.y * wide.z > kMaxProbes) {
            fields_.error(node.source(), fmt::format("probeGridCount: at most {} probes in all", kMaxProbes));
        }
    }

    void readSun(const toml::node& node) {
        Sun& sun = parsed_.scene.sun;
        readSection(node, "[sun]",
                    {{"direction", fields_.vector("direction", sun.direction, kDirection)},
                     {"irradiance", fields_.vector("irradiance", sun.irradiance, kLight)}});
        if (glm::length(sun.direction) < kMinDirection) {
            fields_.error(node.source(), "the direction of the sun has no length");
        }
    }

    void readSky(const toml::node& node) {
        Sky& sky = parsed_.scene.sky;
        std::optional<glm::dvec3> radiance;
        readSection(node, "[sky]",
                    {{"radiance", fields_.vector("radiance", radiance, kLight)},
                     {"zenith", fields_.vector("zenith", sky.zenith, kLight)},
                     {"horizon", fields_.vector("horizon", sky.horizon, kLight)},
                     {"ground", fields_.vector("ground", sky.ground, kLight)}});
        const toml::table* const table = node.as_table();
        if (table == nullptr || !table->contains("radiance")) return;
        if (table->contains("zenith") || table->contains("horizon") || table->contains("ground")) {
            fields_.error(node.source(), "a sky has either radiance or zenith, horizon and ground");
        }
        if (radiance) sky = {.zenith = *radiance, .horizon = *radiance, .ground = *radiance};
    }

    void readSection(const toml::node& node, std::string_view title, const TomlFields::Known& known) {
        if (const toml::table* table = node.as_table()) return fields_.readTable(*table, title, known);
        fields_.error(node.source(), fmt::format("write this as a section {}", title));
    }

    /// The tables of [[title]], or a complaint.
    std::vector<const toml::table*> tablesIn(const toml::node& node, std::string_view title) {
        const toml::array* const array = node.as_array();
        std::vector<const toml::table*> tables;
        for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
            if (const toml::table* table = array->get(i)->as_table()) tables.push_back(table);
        }
        if (array == nullptr || tables.size() != array->size()) {
            fields_.error(node.source(), fmt::format("write these as [[{}]] tables", title));
            return {};
        }
        if (tables.size() > limits_.maxModels) {
            fields_.error(
                tables[limits_.maxModels]->source(),
                fmt::format("{} {}, more than maxModels = {}", tables.size(), title, limits_.maxModels),
                ErrorCode::LimitExceeded);
            return {};
        }
        return tables;
    }

    void readCameras(const toml::node& node) {
        std::set<std::string> names;
        for (const toml::table* table : tablesIn(node, "cameras")) {
            Camera camera;
            fields_.readTable(
                *table, "[[cameras]]",
                {{"name", fields_.text("name", camera.name)},
                 {"position", fields_.vector("position", camera.position, kPosition)},
                 {"target", fields_.vector("target", camera.target, kPosition)},
                 {"fovYDegrees", fields_.number("fovYDegrees", camera.fovYDegrees, kFovDegrees)}});
            if (!table->contains("position") || !table->contains("target")) {
                fields_.error(table->source(), "a camera needs position and target");
            } else if (camera.position == camera.target) {
                fields_.error(table->source(), "position and target of the camera are the same");
            }
            if (!camera.name.empty() && !names.insert(camera.name).second) {
                fields_.warn(
                    table->source(), "scene-duplicate-camera",
                    fmt::format("another camera has the name '{}', too; the first one is found by it",
                                camera.name));
            }
            parsed_.scene.cameras.push_back(std::move(camera));
        }
    }

    void readModels(const toml::node& node) {
        for (const toml::table* table : tablesIn(node, "models")) readModel(*table);
    }

    void readModel(const toml::table& table) {
        SceneModel model;
        fields_.readTable(
            table, "[[models]]",
            {{"path", fields_.text("path", model.path)},
             {"name", fields_.text("name", model.name)},
             {"translateVec", fields_.vector("translateVec", model.translateMetres, kPosition)},
             {"rotateVec", fields_.vector("rotateVec", model.rotateRadians, kAngle)},
             {"scaleVec", [&](const toml::node& node) { readScale(node, model); }},
             {"metresPerVoxel", fields_.number("metresPerVoxel", model.metresPerVoxel, kVoxelSize)},
             {"visible", fields_.flag("visible", model.visible)}});
        const toml::node* const path = table.get("path");
        if (path == nullptr) {
            fields_.error(table.source(), "a model needs path = \"<file.pf_vox>\"");
        } else if (path->is_string() && model.path.empty()) {
            fields_.error(path->source(), "path is empty");
        }
        if (table.contains("scaleVec") && table.contains("metresPerVoxel")) {
            fields_.error(table.get("scaleVec")->source(),
                          "a model has either scaleVec or metresPerVoxel, not both");
        }
        parsed_.paths.push_back(path != nullptr ? placeOf(path->source()) : PathPlace{});
        parsed_.scene.models.push_back(std::move(model));
    }

    void readScale(const toml::node& node, SceneModel& model) {
        fields_.vector("scaleVec", model.cubeEdgeMetres, kScale)(node);
        if (!model.cubeEdgeMetres) return;
        const glm::dvec3 size = glm::abs(*model.cubeEdgeMetres);
        if (glm::min(size.x, glm::min(size.y, size.z)) < kMinScale) {
            fields_.error(
                node.source(),
                fmt::format("scaleVec cannot be inverted: each number is at least {} or at most -{}",
                            kMinScale, kMinScale));
        }
    }

    const Limits& limits_;
    TomlFields fields_;
    ParsedScene parsed_;
};

Error errorAt(ErrorCode code, const std::filesystem::path& file, TextPlace place, std::string message) {
    return {.code = code,
            .message = std::move(message),
            .file = file,
            .context = fmt::format("line {}, column {}", place.line, place.column)};
}

}  // namespace

std::string PathPlace::text() const {
    return fmt::format("line {}, column {}", begin.line, begin.column);
}

Result<ParsedScene> parseWithPlaces(std::string_view text, const std::filesystem::path& file,
                                    const Limits& limits, Diagnostics& diagnostics) {
    if (text.size() > kMaxSceneBytes) {
        return tl::make_unexpected(Error{
            .code = ErrorCode::LimitExceeded,
            .message = fmt::format("{} bytes; a scene file has at most {}", text.size(), kMaxSceneBytes),
            .file = file});
    }
    if (const auto place = tooDeepAt(text)) {
        return tl::make_unexpected(errorAt(ErrorCode::BadStructure, file, *place,
                                           fmt::format("nested more than {} levels deep", kMaxNesting)));
    }
    try {
        return SceneParser(limits).parse(toml::parse(text), file, diagnostics);
    } catch (const toml::parse_error& error) {
        const auto& begin = error.source().begin;
        return tl::make_unexpected(errorAt(ErrorCode::BadStructure, file, {begin.line, begin.column},
                                           std::string(error.description())));
    } catch (const std::bad_alloc&) {
        return tl::make_unexpected(Error{
            .code = ErrorCode::LimitExceeded, .message = "not enough memory for this scene", .file = file});
    }
}

Result<ParsedScene> readWithPlaces(const std::filesystem::path& file, const Limits& limits,
                                   Diagnostics& diagnostics) {
    PFVOX_TRY(const io::FileBytes, contents,
              io::readFile(file, std::min(limits.maxFileBytes, kMaxSceneBytes)));
    const auto bytes = contents.bytes();
    return parseWithPlaces({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file, limits,
                           diagnostics);
}

}  // namespace pfvox::scene

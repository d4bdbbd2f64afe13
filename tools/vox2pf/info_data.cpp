// The figures of vox2pf info and their JSON form (declared in info_report.hpp).

#include <algorithm>

#include "vox2pf/info_report.hpp"

namespace pfvox::tools {

namespace {

void addTo(OctreeStatistics& total, const OctreeStatistics& model) {
    total.voxels += model.voxels;
    total.nodes += model.nodes;
    total.leaves += model.leaves;
    total.values += model.values;
    total.farPointers += model.farPointers;
    total.gpuBytes += model.gpuBytes;
    for (std::size_t i = 0; i < model.voxelsOfMaterial.size(); ++i) {
        total.voxelsOfMaterial[i] += model.voxelsOfMaterial[i];
    }
}

template <class Vector>
Json vectorJson(const Vector& v) {
    return {v.x, v.y, v.z};
}

Json modelJson(const OctreeModel& model, const OctreeStatistics& counted) {
    Json json;
    json["name"] = model.name;
    json["sizeVoxels"] = vectorJson(model.bounds.size());
    json["depth"] = model.depth;
    json["regions"] = model.regions.size();
    json["voxels"] = counted.voxels;
    json["nodes"] = counted.nodes;
    json["leaves"] = counted.leaves;
    json["values"] = counted.values;
    json["farPointers"] = counted.farPointers;
    json["gpuBytes"] = counted.gpuBytes;
    return json;
}

Json instanceJson(const Instance& instance) {
    Json columns = Json::array();
    for (int column = 0; column < 4; ++column) columns.push_back(vectorJson(instance.worldFromModel[column]));
    Json json;
    json["name"] = instance.name;
    json["model"] = instance.model;
    json["layer"] = instance.layer;
    json["hidden"] = instance.hidden;
    json["worldFromModelColumns"] = columns;
    return json;
}

Json materialJson(const Material& material, std::uint64_t voxels) {
    const glm::u8vec4 color = material.baseColor;
    Json json;
    json["name"] = material.name;
    json["type"] = toString(material.type);
    json["baseColor"] = {color.r, color.g, color.b, color.a};
    for (const MaterialField& field : kMaterialFields) json[std::string(field.name)] = material.*field.value;
    json["voxels"] = voxels;
    return json;
}

Json sectionJson(const PfVoxSection& section) {
    Json json;
    json["name"] = section.fourcc;
    json["regionId"] = section.regionId == kWholeFile ? Json(nullptr) : Json(section.regionId);
    json["codec"] = section.codec;
    json["offsetBytes"] = section.offsetBytes;
    json["storedBytes"] = section.storedBytes;
    json["rawBytes"] = section.rawBytes;
    return json;
}

template <class Range, class Convert>
Json arrayJson(const Range& range, Convert convert) {
    Json json = Json::array();
    for (const auto& element : range) json.push_back(convert(element));
    return json;
}

}  // namespace

FileInfo makeFileInfo(std::filesystem::path file, PfVoxHeader header, OctreeAsset asset) {
    FileInfo info;
    info.file = std::move(file);
    info.header = std::move(header);
    info.asset = std::move(asset);
    const std::size_t materialCount = info.asset.materials.size();
    info.total.voxelsOfMaterial.resize(materialCount);
    for (const OctreeModel& model : info.asset.models) {
        info.models.push_back(statistics(model, materialCount));
        addTo(info.total, info.models.back());
    }
    for (const Instance& instance : info.asset.instances)
        info.instancedVoxels += info.models[instance.model].voxels;
    return info;
}

Json infoJson(const FileInfo& info) {
    Json json;
    json["file"] = info.file.string();
    json["formatVersion"] =
        std::to_string(info.header.versionMajor) + "." + std::to_string(info.header.versionMinor);
    json["features"] = info.header.featureNames();
    json["fileBytes"] = info.header.fileBytes;
    json["contentKey"] = info.header.contentKey.hex();
    json["source"] = {{"format", info.asset.source.format},
                      {"voxelSizeMetres", info.asset.source.voxelSizeMetres},
                      {"notes", info.asset.source.notes}};
    json["totals"] = {{"models", info.asset.models.size()},
                      {"instances", info.asset.instances.size()},
                      {"materials", info.asset.materials.size()},
                      {"voxels", info.total.voxels},
                      {"instancedVoxels", info.instancedVoxels},
                      {"nodes", info.total.nodes},
                      {"leaves", info.total.leaves},
                      {"gpuBytes", info.total.gpuBytes}};
    json["models"] = Json::array();
    for (std::size_t i = 0; i < info.models.size(); ++i) {
        json["models"].push_back(modelJson(info.asset.models[i], info.models[i]));
    }
    json["instances"] = arrayJson(info.asset.instances, instanceJson);
    json["layers"] = arrayJson(info.asset.layers, [](const Layer& layer) {
        return Json{{"name", layer.name}, {"hidden", layer.hidden}};
    });
    json["cameras"] = arrayJson(info.asset.cameras, [](const Camera& camera) {
        return Json{{"name", camera.name},
                    {"position", vectorJson(camera.position)},
                    {"target", vectorJson(camera.target)},
                    {"fovYDegrees", camera.fovYDegrees}};
    });
    json["materials"] = Json::array();
    for (std::size_t i = 0; i < info.asset.materials.size(); ++i) {
        json["materials"].push_back(materialJson(info.asset.materials[i], info.total.voxelsOfMaterial[i]));
    }
    json["sections"] = arrayJson(info.header.sections, sectionJson);
    return json;
}

}  // namespace pfvox::tools

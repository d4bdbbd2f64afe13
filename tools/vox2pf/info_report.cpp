#include "vox2pf/info_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "common/table.hpp"
#include "common/text.hpp"

namespace pfvox::tools {

namespace {

constexpr std::size_t kFewRows = 12;
constexpr std::size_t kIndent = 2;

std::string orDash(const std::string& name) {
    return name.empty() ? "-" : name;
}

std::string ratio(std::uint64_t part, std::uint64_t whole, std::string_view pattern) {
    if (whole == 0) return "-";
    return fmt::format(fmt::runtime(pattern), static_cast<double>(part) / static_cast<double>(whole));
}

/// "and 880 more; -v shows all"
std::string moreLine(std::size_t count, std::size_t shown) {
    if (shown >= count) return {};
    return fmt::format("{:{}}... and {} more; -v shows all\n", "", kIndent, formatCount(count - shown));
}

std::string headline(const FileInfo& info) {
    const SourceInfo& source = info.asset.source;
    std::string features;
    for (const std::string& name : info.header.featureNames()) features += ", " + name;
    return fmt::format("PF_VOX {}.{}{}, {}, from {}, {} m voxels, content key {}\n", info.header.versionMajor,
                       info.header.versionMinor, features, formatBytes(info.header.fileBytes),
                       escaped(orDash(source.format)), source.voxelSizeMetres, info.header.contentKey.hex());
}

std::string modelTable(const FileInfo& info, std::size_t maxRows) {
    Table table({{"#", Align::Right},
                 {"name"},
                 {"size"},
                 {"voxels", Align::Right},
                 {"nodes", Align::Right},
                 {"leaves", Align::Right},
                 {"regions", Align::Right},
                 {"GPU", Align::Right},
                 {"bytes/voxel", Align::Right}});
    const std::size_t shown = std::min(info.models.size(), maxRows);
    for (std::size_t i = 0; i < shown; ++i) {
        const OctreeModel& model = info.asset.models[i];
        const OctreeStatistics& counted = info.models[i];
        const glm::i64vec3 size = model.bounds.size();
        table.addRow({std::to_string(i), orDash(model.name),
                      fmt::format("{} x {} x {}", size.x, size.y, size.z), formatCount(counted.voxels),
                      formatCount(counted.nodes), formatCount(counted.leaves),
                      formatCount(model.regions.size()), formatBytes(counted.gpuBytes),
                      ratio(counted.gpuBytes, counted.voxels, "{:.3f}")});
    }
    return table.render(kIndent) + moreLine(info.models.size(), shown);
}

std::string instanceTable(const FileInfo& info, std::size_t maxRows) {
    Table table({{"#", Align::Right}, {"name"}, {"model"}, {"layer"}, {"position, m"}, {""}});
    const auto& instances = info.asset.instances;
    const std::size_t shown = std::min(instances.size(), maxRows);
    for (std::size_t i = 0; i < shown; ++i) {
        const Instance& instance = instances[i];
        const std::string& modelName = info.asset.models[instance.model].name;
        const bool hasLayer =
            instance.layer >= 0 && static_cast<std::size_t>(instance.layer) < info.asset.layers.size();
        const glm::dvec3 position = instance.worldFromModel[3];
        std::string remarks = instance.hidden ? "hidden" : "";
        if (glm::determinant(glm::dmat3(instance.worldFromModel)) < 0.0)
            remarks += remarks.empty() ? "mirrored" : ", mirrored";
        table.addRow(
            {std::to_string(i), orDash(instance.name),
             modelName.empty() ? std::to_string(instance.model)
                               : fmt::format("{} {}", instance.model, modelName),
             hasLayer ? orDash(info.asset.layers[static_cast<std::size_t>(instance.layer)].name) : "-",
             fmt::format("{:.2f} {:.2f} {:.2f}", position.x, position.y, position.z), remarks});
    }
    return table.render(kIndent) + moreLine(instances.size(), shown);
}

std::string materialTable(const FileInfo& info) {
    struct Group {
        std::size_t materials = 0;
        std::uint64_t voxels = 0;
    };
    std::map<MaterialType, Group> groups;
    for (std::size_t i = 0; i < info.asset.materials.size(); ++i) {
        Group& group = groups[info.asset.materials[i].type];
        ++group.materials;
        group.voxels += info.total.voxelsOfMaterial[i];
    }
    Table table(
        {{"type"}, {"materials", Align::Right}, {"voxels", Align::Right}, {"fraction", Align::Right}});
    for (const auto& [type, group] : groups) {
        table.addRow({toString(type), formatCount(group.materials), formatCount(group.voxels),
                      ratio(group.voxels * 100, info.total.voxels, "{:.2f} %")});
    }
    return table.render(kIndent);
}

std::string sectionTable(const FileInfo& info) {
    struct Group {
        std::string codec;
        std::size_t count = 0;
        std::uint64_t stored = 0;
        std::uint64_t raw = 0;
    };
    std::vector<std::pair<std::string, Group>> groups;  // in the order of the file
    for (const PfVoxSection& section : info.header.sections) {
        auto found = std::ranges::find(groups, section.fourcc, [](const auto& entry) { return entry.first; });
        if (found == groups.end())
            found = groups.insert(groups.end(), {section.fourcc, {.codec = section.codec}});
        Group& group = found->second;
        if (group.codec != section.codec) group.codec = "mixed";
        ++group.count;
        group.stored += section.storedBytes;
        group.raw += section.rawBytes;
    }
    Table table({{"section"},
                 {"count", Align::Right},
                 {"codec"},
                 {"stored", Align::Right},
                 {"raw", Align::Right},
                 {"of file", Align::Right}});
    for (const auto& [name, group] : groups) {
        table.addRow({name, formatCount(group.count), group.codec, formatBytes(group.stored),
                      formatBytes(group.raw), ratio(group.stored * 100, info.header.fileBytes, "{:.1f} %")});
    }
    return table.render(kIndent);
}

std::string totals(const FileInfo& info) {
    const OctreeStatistics& total = info.total;
    return fmt::format(
        "  {}, {} as placed; {}, {}\n  on disk {} bytes/voxel, on the GPU {} bytes/voxel ({})\n",
        plural(total.voxels, "voxel"), formatCount(info.instancedVoxels), plural(total.nodes, "node"),
        plural(total.leaves, "leaf") == "1 leaf" ? "1 leaf" : formatCount(total.leaves) + " leaves",
        ratio(info.header.fileBytes, total.voxels, "{:.3f}"), ratio(total.gpuBytes, total.voxels, "{:.3f}"),
        formatBytes(total.gpuBytes));
}

}  // namespace

std::string infoText(const FileInfo& info, const Reporter& reporter, bool complete) {
    const std::size_t maxRows = complete ? info.asset.instances.size() + info.models.size() : kFewRows;
    const auto title = [&](std::string_view word, std::size_t count) {
        return "\n" +
               reporter.styled(Reporter::Style::Strong, fmt::format("{} ({})", word, formatCount(count))) +
               "\n";
    };
    std::string text =
        reporter.styled(Reporter::Style::Strong, escaped(info.file.string())) + "\n" + headline(info);
    for (const Name& note : info.asset.source.notes) text += "  " + escaped(note) + "\n";
    text += title("Models", info.models.size()) + modelTable(info, maxRows);
    if (!info.asset.instances.empty()) {
        text += title("Instances", info.asset.instances.size()) + instanceTable(info, maxRows);
    }
    text += title("Materials", info.asset.materials.size()) + materialTable(info);
    text += title("Sections", info.header.sections.size()) + sectionTable(info);
    return text + "\n" + reporter.styled(Reporter::Style::Strong, "Total") + "\n" + totals(info);
}

}  // namespace pfvox::tools

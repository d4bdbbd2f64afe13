// Importer of SVX, the voxel format of AbFab3D and Shapeways: a zip of PNG slices and a manifest.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "import/importer.hpp"
#include "import/svx/manifest.hpp"
#include "import/svx/slice_reader.hpp"
#include "import/svx/svx_voxels.hpp"
#include "import/svx/zip_archive.hpp"
#include "io/byte_cursor.hpp"

namespace pfvox::import {

namespace {

constexpr std::uint64_t kMaxManifestBytes = 16 << 20;
/// SVX serves 3D printing; a larger voxel means that the writer did not give metres.
constexpr double kLargestUsualVoxelMetres = 0.01;

bool recognises(const SourceBytes& source) {
    const std::string_view text = io::asText(source.bytes);
    return text.starts_with("PK\x03\x04") || text.starts_with("PK\x05\x06");
}

Result<std::vector<std::byte>> readManifestBytes(const svx::ZipArchive& archive, Diagnostics& diagnostics) {
    const auto entry = archive.find("manifest.xml");
    if (!entry) {
        for (const std::string& name : archive.names()) {
            if (svx::lenientName(name).ends_with("/manifest.xml")) {
                return fail(
                    ErrorCode::BadStructure,
                    fmt::format(
                        "manifest.xml lies in a folder ({}): an SVX has it at the top; zip the content of "
                        "the folder, not the folder",
                        name));
            }
        }
        return fail(ErrorCode::UnsupportedFormat, "this is a zip archive without manifest.xml, not an SVX");
    }
    if (!entry->exactName)
        diagnostics.warn("svx-entry-names", "manifest.xml is spelled differently in the archive");
    return archive.read(entry->index, kMaxManifestBytes);
}

/// 0, 1, 2 for channels of red, green, blue.
std::optional<std::size_t> primaryOf(svx::ChannelKind kind) {
    switch (kind) {
        case svx::ChannelKind::Red:
            return 0;
        case svx::ChannelKind::Green:
            return 1;
        case svx::ChannelKind::Blue:
            return 2;
        default:
            return std::nullopt;
    }
}

/// Chooses the channels to use and reports the others.
Result<svx::ChannelPlan> planChannels(const svx::Manifest& manifest, Diagnostics& diagnostics) {
    svx::ChannelPlan plan;
    std::vector<std::string> skipped;
    std::array<const svx::Channel*, 3> primaries{};
    for (const svx::Channel& channel : manifest.channels) {
        const bool density = channel.kind == svx::ChannelKind::Density;
        const bool color =
            channel.kind == svx::ChannelKind::Color || channel.kind == svx::ChannelKind::DensityColor;
        if (density && plan.density == nullptr) {
            plan.density = &channel;
        } else if (color && plan.color == nullptr) {
            plan.color = &channel;
        } else if (const auto primary = primaryOf(channel.kind); primary && primaries[*primary] == nullptr) {
            primaries[*primary] = &channel;
        } else if (channel.kind == svx::ChannelKind::Material) {
            plan.materials.push_back(&channel);
        } else {
            skipped.push_back(channel.kind == svx::ChannelKind::Custom
                                  ? fmt::format("{} {}", channel.type, channel.id)
                                  : channel.type);
        }
    }
    if (plan.color == nullptr && std::ranges::find(primaries, nullptr) == primaries.end()) {
        plan.primaries = primaries;
    } else {
        for (const svx::Channel* channel : primaries) {
            if (channel != nullptr) skipped.push_back(channel->type);
        }
    }
    for (const std::string& name : skipped) {
        diagnostics.warn("svx-channel-skipped",
                         fmt::format("channel {} has no meaning for a voxel model and is left out", name));
    }
    if (plan.density == nullptr && !plan.hasColors() && plan.materials.empty()) {
        return fail(
            ErrorCode::NothingToConvert,
            "the manifest names no DENSITY, MATERIAL or COLOR-RGB channel that could make a voxel model");
    }
    if (plan.hasColors() && !plan.materials.empty()) {
        const bool densityColor = plan.color != nullptr && plan.color->kind == svx::ChannelKind::DensityColor;
        const bool needed = plan.density == nullptr && !densityColor;
        diagnostics.note("svx-materials-unused",
                         "colors are kept, material ids are not: a voxel has one material");
        if (!needed) plan.materials.clear();
    }
    return plan;
}

Affine worldFromModel(const svx::Manifest& manifest, double voxelSizeMetres) {
    // A wish of the user corrects the unit of the file, so it scales the origin as well.
    const double unit = voxelSizeMetres / manifest.voxelSizeMetres.value_or(voxelSizeMetres);
    Affine affine{voxelSizeMetres};
    affine[3] = manifest.originMetres * unit;
    return affine;
}

void placeModel(const SourceBytes& source, const svx::Manifest& manifest, const ImportSettings& settings,
                VoxelAsset& asset, Diagnostics& diagnostics) {
    const double fileSize = manifest.voxelSizeMetres.value_or(kDefaultVoxelSizeMetres);
    asset.source.format = "svx";
    asset.source.voxelSizeMetres = settings.voxelSizeMetres.value_or(fileSize);
    asset.source.notes.assign(manifest.metadata.begin(), manifest.metadata.end());
    if (!settings.voxelSizeMetres && manifest.voxelSizeMetres && fileSize > kLargestUsualVoxelMetres) {
        diagnostics.note(
            "svx-voxel-size",
            fmt::format("voxelSize is {} metres by the file; some writers mean another unit", fileSize));
    }
    asset.models.front().name = source.file.stem().string();
    Instance instance;
    instance.worldFromModel = worldFromModel(manifest, asset.source.voxelSizeMetres);
    instance.name = asset.models.front().name;
    asset.instances.push_back(std::move(instance));
}

Result<VoxelAsset> importSvx(const SourceBytes& source, const ImportSettings& settings, const Limits& limits,
                             Diagnostics& diagnostics) {
    if (!(settings.svx.threshold >= 0.0 && settings.svx.threshold <= 1.0)) {
        return fail(ErrorCode::BadValue,
                    fmt::format("svx.threshold is {}; it lies between 0 and 1", settings.svx.threshold));
    }
    PFVOX_TRY(const svx::ZipArchive, archive, svx::ZipArchive::open(source.bytes));
    PFVOX_TRY(const auto, xml, readManifestBytes(archive, diagnostics));
    PFVOX_TRY(const svx::Manifest, manifest, svx::parseManifest(io::asText(xml), limits, diagnostics));
    PFVOX_TRY(const svx::ChannelPlan, plan, planChannels(manifest, diagnostics));

    svx::SliceReader reader(archive, svx::SliceStack(manifest.gridSize, manifest.sliceAxis), limits,
                            diagnostics);
    if (plan.density != nullptr) PFVOX_CHECK(reader.checkPresence(*plan.density));
    if (plan.color != nullptr) PFVOX_CHECK(reader.checkPresence(*plan.color));
    for (const svx::Channel* channel : plan.primaries) {
        if (channel != nullptr) PFVOX_CHECK(reader.checkPresence(*channel));
    }
    for (const svx::Channel* channel : plan.materials) PFVOX_CHECK(reader.checkPresence(*channel));

    VoxelAsset asset;
    PFVOX_CHECK(svx::readVoxels(reader, plan, manifest, settings, limits, asset, diagnostics));
    placeModel(source, manifest, settings, asset, diagnostics);
    if (asset.models.front().regions().empty()) {
        return fail(
            ErrorCode::NothingToConvert,
            fmt::format("no voxel is as dense as svx.threshold = {} asks for", settings.svx.threshold));
    }
    return asset;
}

}  // namespace

Importer svxImporter() {
    return {.format = {.id = "svx", .title = "Simple Voxels", .extension = ".svx"},
            .recognises = recognises,
            .import = importSvx};
}

}  // namespace pfvox::import

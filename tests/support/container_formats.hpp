// PF_VOX and PF_PROBE as one: a small file of each with a feature of every kind, and what reads it.
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <pfvox/probe_file.hpp>

#include "support/pf_probe_surgery.hpp"
#include "support/pf_vox_surgery.hpp"
#include "support/voxel_models.hpp"

namespace pfvox::test {

/// A top tree of three regions, a hoisted value, an empty model, levels of detail.
inline Bytes voxSample(Profile profile) {
    std::vector<VoxelModel> models;
    models.push_back(patchyModel(11, 20));
    models.push_back(boxModel({250, 0, 0}, {262, 10, 3}, 1));
    models.emplace_back();
    const auto built = buildOctrees(assetOf(std::move(models)), Limits{}, {.lod = true});
    return encodePfVox(built.value(), {.profile = profile}).value();
}

struct ContainerFormat {
    const char* name;
    const char* magicWords;    ///< of the error where the magic is another
    const char* versionWords;  ///< of the error where the major version is 9
    const char* unknownSection;
    const Bytes& (*sample)();
    Bytes (*close)(OpenFile open);
    /// Reads the bytes and writes what was read. Errors: those of reading alone.
    Result<Bytes> (*decode)(const Bytes& file, const Limits& limits, Diagnostics& diagnostics);
    std::vector<Finding> (*validate)(const Bytes& file, const Limits& limits);
    /// Reads a file from disk; whether it could be.
    Result<void> (*load)(const std::filesystem::path& file, const Limits& limits);
};
inline std::ostream& operator<<(std::ostream& out, const ContainerFormat& format) {
    return out << format.name;
}

inline const ContainerFormat kVoxFormat{
    .name = "PfVox",
    .magicWords = "not a PF_VOX file",
    .versionWords = "PF_VOX 9.0",
    .unknownSection = "pfvox-unknown-section",
    .sample = []() -> const Bytes& {
        static const Bytes file = voxSample(Profile::Packed);
        return file;
    },
    .close = [](OpenFile open) { return closeFile(std::move(open)); },
    .decode = [](const Bytes& file, const Limits& limits, Diagnostics& diagnostics) -> Result<Bytes> {
        PFVOX_TRY(const OctreeAsset, asset, decodePfVox(file, limits, diagnostics));
        for (const OctreeModel& model : asset.models)
            static_cast<void>(statistics(model, asset.materials.size()));
        return encodePfVox(asset, {}).value();
    },
    .validate = [](const Bytes& file, const Limits& limits) { return validatePfVox(file, limits); },
    .load = [](const std::filesystem::path& file, const Limits& limits) -> Result<void> {
        DiagnosticList diagnostics;
        PFVOX_CHECK(loadPfVox(file, limits, diagnostics));
        return {};
    }};

inline const ContainerFormat kProbeFormat{
    .name = "PfProbe",
    .magicWords = "not a PF_PROBE file",
    .versionWords = "PF_PROBE 9.1",
    .unknownSection = "pfprobe-unknown-section",
    .sample = probeSample,
    .close = closeProbeFile,
    .decode = [](const Bytes& file, const Limits& limits, Diagnostics& diagnostics) -> Result<Bytes> {
        PFVOX_TRY(const ProbeField, field, decodePfProbe(file, limits, diagnostics));
        return encodePfProbe(field, {}).value();
    },
    .validate = [](const Bytes& file, const Limits& limits) { return validatePfProbe(file, limits); },
    .load = [](const std::filesystem::path& file, const Limits& limits) -> Result<void> {
        DiagnosticList diagnostics;
        PFVOX_CHECK(loadPfProbe(file, limits, diagnostics));
        return {};
    }};

/// A probe file with light on faces.
inline const ContainerFormat kFaceFormat = [] {
    ContainerFormat format = kProbeFormat;
    format.name = "PfProbeFaces";
    format.versionWords = "PF_PROBE 9.2";
    format.sample = faceSample;
    return format;
}();

}  // namespace pfvox::test

// Convert: the whole way from a source file to a PF_VOX file, and nothing else.
//
//     import -> compact materials -> hollow (optional) -> build and minimise -> encode -> atomic write
#pragma once

#include <array>
#include <filesystem>
#include <pfvox/import.hpp>
#include <pfvox/octree.hpp>
#include <pfvox/pf_vox.hpp>
#include <string_view>

namespace pfvox {
/// How a source becomes a file.
struct ConvertSettings {
    ImportSettings import;
    bool hollow = false;  ///< hollowSolids before the build
    BuildSettings build;
    int zstdLevel = 3;  ///< 1 to 19
    Profile profile = Profile::Packed;
};

/// A setting of a conversion in every form in which somebody meets it. From this table come the options of
/// the command line with their help, the keys of settings files, and the content key.
struct ConvertSetting {
    std::string_view section;  ///< of settings files
    std::string_view key;      ///< in that section
    std::string_view option;   ///< without "--"
    std::string_view value;    ///< what help calls the value; empty for switches
    std::string_view meaning;  ///< in help
    double low = 0.0;          ///< of numbers
    double high = 0.0;
    std::array<std::string_view, 2> choices = {};  ///< of enumerations, by value
};

/// Calls visit(ConvertSetting, field...) for every setting, with the field of each of `of`.
template <class Visit, class... Settings>
void forEachConvertSetting(const Visit& visit, Settings&... of) {
    using S = ConvertSetting;
    visit(S{"import", "merge", "merge", "", "flatten all instances into one model"}, of.import.merge...);
    visit(S{"import", "includeHidden", "include-hidden", "", "keep hidden layers and nodes, visible"},
          of.import.includeHidden...);
    visit(S{"import", "frame", "frame", "N", "animation frame, 0 or more", 0, 1'000'000}, of.import.frame...);
    visit(S{"import", "voxelSizeMetres", "voxel-size", "METERS", "edge of a voxel, 1e-6 to 1e6", 1e-6, 1e6},
          of.import.voxelSizeMetres...);
    visit(S{"import", "svxThreshold", "svx-threshold", "FRACTION",
            "SVX: density of a solid voxel, 0 to 1 of the largest", 0, 1},
          of.import.svx.threshold...);
    visit(S{"import", "vdbGrids", "vdb-grid", "NAME",
            "OpenVDB: import this grid and no others but those named so; may be given again"},
          of.import.vdb.grids...);
    visit(S{"import", "vdbThreshold", "vdb-threshold", "VALUE",
            "OpenVDB fog: a voxel is solid above this value", -1e30, 1e30},
          of.import.vdb.threshold...);
    visit(S{.section = "import",
            .key = "vdbUp",
            .option = "vdb-up",
            .value = "AXIS",
            .meaning = "OpenVDB: which axis points up, y or z",
            .choices = {"y", "z"}},
          of.import.vdb.upAxis...);
    visit(S{"build", "hollow", "hollow", "",
            "let voxels that cannot be seen take another material (lossy inside)"},
          of.hollow...);
    visit(S{"build", "lod", "lod", "", "add colors for level of detail, at about twice the size"},
          of.build.lod...);
    visit(S{"encode", "zstdLevel", "zstd-level", "N", "compression, 1 to 19: smaller and slower", 1, 19},
          of.zstdLevel...);
    visit(S{.section = "encode",
            .key = "profile",
            .option = "profile",
            .value = "NAME",
            .meaning = "packed: small; resident: raw words, nothing to decode",
            .choices = {"packed", "resident"}},
          of.profile...);
}

/// What a conversion did.
struct ConvertReport {
    std::uint64_t sourceBytes = 0;  ///< read
    std::uint64_t outputBytes = 0;  ///< written
    std::uint64_t voxels = 0;       ///< of all models, each counted once
    std::uint64_t hollowedVoxels =
        0;                        ///< of these, voxels that cannot be seen; 0 unless they were looked for
    std::uint64_t nodes = 0;      ///< of all trees
    std::uint64_t leaves = 0;     ///< of all trees
    std::uint32_t models = 0;     ///< after equal ones were joined
    std::uint32_t instances = 0;  ///< of models
    std::uint32_t materials = 0;  ///< after equal ones were joined
    double importSeconds = 0.0;   ///< reading and decoding the source
    double buildSeconds = 0.0;    ///< building the trees
    double encodeSeconds = 0.0;   ///< laying out and compressing
    double writeSeconds = 0.0;    ///< writing, with the sync
};

/// What the octrees of an asset tell: all but bytes, seconds and hollowedVoxels.
ConvertReport countsOf(const OctreeAsset& asset);

/// Rises whenever a conversion gives other bytes than before for some source and settings: what earlier
/// programs converted is then converted again. tests/golden/converter_revision_test.cpp asks for it.
inline constexpr int kConverterRevision = 3;

/// xxh3-128 of the source bytes, the settings and the versions of tool, converter and format.
ContentKey contentKey(std::span<const std::byte> source, const ConvertSettings& settings);

/// Converts source bytes to PF_VOX bytes. `source` names the file for messages and decides nothing else but
/// the extension. Errors: those of importBytes, buildOctrees and encodePfVox.
Result<std::vector<std::byte>> convertBytes(std::span<const std::byte> bytes,
                                            const std::filesystem::path& source,
                                            const ConvertSettings& settings, const Limits& limits,
                                            Diagnostics& diagnostics, ConvertReport& report);

/// Converts one file. The output appears complete or not at all; on failure a previous output stays as it
/// was. Errors: those of convertBytes, FileNotFound, FileNotReadable, FileNotWritable.
Result<ConvertReport> convertFile(const std::filesystem::path& source, const std::filesystem::path& output,
                                  const ConvertSettings& settings, const Limits& limits,
                                  Diagnostics& diagnostics);

}  // namespace pfvox

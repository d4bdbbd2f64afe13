// Convert: the whole way from a source file to a PF_VOX file, and nothing else.
//
//     import -> compact materials -> hollow (optional) -> build and minimise -> encode -> atomic write
#pragma once

#include <filesystem>
#include <pfvox/import.hpp>
#include <pfvox/octree.hpp>
#include <pfvox/pf_vox.hpp>

namespace pfvox {
/// How a source becomes a file.
struct ConvertSettings {
    ImportSettings import;              ///< how the source is read
    bool hollow = false;                ///< hollowSolids before the build
    BuildSettings build;                ///< how trees are built
    int zstdLevel = 3;                  ///< 1 to 19
    Profile profile = Profile::Packed;  ///< packed or resident
};
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
inline constexpr int kConverterRevision = 2;

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

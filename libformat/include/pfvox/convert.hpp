// Convert: the whole way from a source file to a PF_VOX file, and nothing else.
//
//     import -> compact materials -> hollow (optional) -> build and minimise -> encode -> atomic write
#pragma once

#include <filesystem>
#include <pfvox/import.hpp>
#include <pfvox/octree.hpp>
#include <pfvox/pf_vox.hpp>

namespace pfvox {

struct ConvertSettings {
    ImportSettings import;
    bool hollow = false;  ///< hollowSolids before the build
    BuildSettings build;
    int zstdLevel = 3;
    Profile profile = Profile::Packed;
};

struct ConvertReport {
    std::uint64_t sourceBytes = 0;
    std::uint64_t outputBytes = 0;
    std::uint64_t voxels = 0;  ///< of all models, each counted once
    std::uint64_t hollowedVoxels = 0;  ///< of these, voxels that cannot be seen; 0 unless they were looked for
    std::uint64_t nodes = 0;
    std::uint64_t leaves = 0;
    std::uint32_t models = 0;
    std::uint32_t instances = 0;
    std::uint32_t materials = 0;
    double importSeconds = 0.0;
    double buildSeconds = 0.0;
    double encodeSeconds = 0.0;
    double writeSeconds = 0.0;
};

/// xxh3-128 of the source bytes, the settings and the versions of tool and format.
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

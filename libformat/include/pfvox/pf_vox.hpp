// PF_VOX 1.0: the octree asset on disk. The bytes are described in docs/format-pf_vox.md.
//
//     OctreeAsset -> [encodePfVox] -> bytes -> file -> bytes -> [decodePfVox] -> OctreeAsset
//
// Everything in a file is untrusted: counts are checked against the bytes present and against Limits before
// anything is allocated, checksums are verified, and a broken file is refused with section and offset.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <pfvox/octree.hpp>
#include <span>
#include <string>
#include <vector>

namespace pfvox {

inline constexpr std::uint16_t kPfVoxVersionMajor = 1;  ///< another one cannot be read
inline constexpr std::uint16_t kPfVoxVersionMinor =
    1;  ///< the highest that is written; later ones can be read

/// Required feature bits of the header.
inline constexpr std::uint32_t kPfVoxResident = 1u << 0;  ///< "resident": Profile::Resident

/// Optional feature bits of the header.
inline constexpr std::uint32_t kPfVoxHollow = 1u << 0;  ///< "hollow": AssetInfo::hollowed

/// xxh3-128 of everything that decides the content of an output: inputs, settings, tool and format version.
/// All zero = unknown.
struct ContentKey {
    std::array<std::uint8_t, 16> bytes{};  ///< in the order of the hex text
    bool operator==(const ContentKey&) const = default;
    std::string hex() const;  ///< 32 lower case digits
};

/// Two forms of the same content. Which to use when: docs/decisions/007-resident.md.
enum class Profile : std::uint8_t {
    Packed,    ///< only what cannot be computed, compressed: smallest
    Resident,  ///< the words that the GPU reads, raw and aligned: 5 to 15 times as large, nothing to compute
};
/// How a file is written.
struct EncodeSettings {
    int zstdLevel = 3;                  ///< 1 to 19
    ContentKey contentKey;              ///< kept in the header, for builds that skip what is up to date
    Profile profile = Profile::Packed;  ///< packed or resident
};

/// The bytes of a PF_VOX file. Equal input and settings give equal bytes for any number of
/// threads. Errors: LimitExceeded when a count does not fit its field; BadReference when indices of the asset
/// do not fit together.
Result<std::vector<std::byte>> encodePfVox(const OctreeAsset& asset, const EncodeSettings& settings);

/// Reads a whole PF_VOX file. Regions are decoded in parallel in the calling TBB arena.
/// Errors: BadMagic, UnsupportedVersion, UnsupportedFeature, Truncated, BadValue, BadReference, BadStructure,
/// ChecksumMismatch, LimitExceeded; each with section and offset.
Result<OctreeAsset> decodePfVox(std::span<const std::byte> bytes, const Limits& limits,
                                Diagnostics& diagnostics);

/// decodePfVox on a file; errors name it. Further errors: FileNotFound, FileNotReadable.
Result<OctreeAsset> loadPfVox(const std::filesystem::path& file, const Limits& limits,
                              Diagnostics& diagnostics);

inline constexpr std::uint32_t kWholeFile = 0xffffffffu;  ///< a section that belongs to no model or region

/// One entry of the section table, for reports.
struct PfVoxSection {
    std::string fourcc;          ///< four characters: "NODE"
    std::uint32_t regionId = 0;  ///< kWholeFile when the section belongs to the whole file
    std::string codec;           ///< "raw" or "zstd"
    std::uint64_t offsetBytes = 0;
    std::uint64_t storedBytes = 0;  ///< as it lies there
    std::uint64_t rawBytes = 0;     ///< after decompression
};

/// Header and section table, without decoding anything else.
struct PfVoxHeader {
    std::uint16_t versionMajor = 0;      ///< of the file
    std::uint16_t versionMinor = 0;      ///< of the file
    std::uint32_t requiredFeatures = 0;  ///< bits that a reader must know
    std::uint32_t optionalFeatures = 0;  ///< bits that it may ignore
    std::uint64_t fileBytes = 0;         ///< as the header announces them
    ContentKey contentKey;               ///< of what it was made from
    std::vector<PfVoxSection> sections;  ///< in the order of the file

    /// The names of the features: "resident", "hollow"; unknown ones as "bit 7".
    std::vector<std::string> featureNames() const;
};
/// Errors: BadMagic, Truncated, UnsupportedVersion, UnsupportedFeature, ChecksumMismatch, BadStructure.
Result<PfVoxHeader> readPfVoxHeader(std::span<const std::byte> bytes);

/// One thing that is wrong with a file. `id` is the stable spelling of an ErrorCode.
struct Finding {
    std::string id;                            ///< stable; the spelling of an ErrorCode
    std::string context;                       ///< the section, empty when it is about the file as a whole
    std::optional<std::uint64_t> offsetBytes;  ///< in the file, where known
    std::string message;                       ///< what is wrong
};

/// Every finding, not only the first: decodes each section that can still be reached. Empty = valid.
std::vector<Finding> validatePfVox(std::span<const std::byte> bytes, const Limits& limits);

}  // namespace pfvox

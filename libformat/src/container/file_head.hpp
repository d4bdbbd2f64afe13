// FileHead: header and section table of a PF_VOX or PF_PROBE file that is not trusted.
#pragma once

#include <array>
#include <cstdint>
#include <pfvox/error.hpp>
#include <string>
#include <string_view>

#include "container/byte_source.hpp"
#include "container/layout.hpp"
#include "container/memory_budget.hpp"

namespace pfvox::container {

/// What tells one format from the other.
struct Format {
    std::string_view name;  ///< "PF_VOX"
    /// Five letters, then line ends and a control character that a text-mode transfer would change.
    std::array<std::uint8_t, 8> magic;
    std::uint16_t versionMajor;       ///< another one cannot be read
    std::uint32_t requiredFeatures;   ///< those that the reader knows
    std::string_view reader;          ///< the program that reads it
    std::string_view remedy;          ///< for a file that is damaged or too new
    std::string_view unknownSection;  ///< id of the note on a section that is skipped
};
inline constexpr Format kPfVox{.name = "PF_VOX",
                               .magic = {'P', 'F', 'V', 'O', 'X', '\r', '\n', 0x1a},
                               .versionMajor = 1,
                               .requiredFeatures = 1u << 0,  // kPfVoxResident
                               .reader = "vox2pf",
                               .remedy = "convert the source again",
                               .unknownSection = "pfvox-unknown-section"};
inline constexpr Format kPfProbe{.name = "PF_PROBE",
                                 .magic = {'P', 'F', 'P', 'R', 'B', '\r', '\n', 0x1a},
                                 .versionMajor = 1,
                                 .requiredFeatures = 0,
                                 .reader = "probe-bake",
                                 .remedy = "bake again",
                                 .unknownSection = "pfprobe-unknown-section"};

struct FileHead {
    layout::Header header{};
    Array<layout::Section> sections;
};

/// Checks magic, version, features, sizes, the hash over header and table, and that sections lie inside the
/// file, in order, aligned, without overlap and with zeros between them. Errors: BadMagic, Truncated,
/// UnsupportedVersion, UnsupportedFeature, ChecksumMismatch, BadStructure, LimitExceeded; those of the
/// source.
Result<FileHead> readHead(const ByteSource& source, const Format& format, MemoryBudget& budget);

std::string_view nameOf(const layout::Section& section);

/// "section MASK of region 3", for messages.
std::string describe(const layout::Section& section);

/// An Error at the section's place in the file.
tl::unexpected<Error> failInSection(const layout::Section& section, ErrorCode code, std::string message);
/// An error found in what a section holds, at its place, unless it has one. What the error was about becomes
/// part of the message.
Result<void> inSection(const layout::Section& section, Result<void> result);

}  // namespace pfvox::container

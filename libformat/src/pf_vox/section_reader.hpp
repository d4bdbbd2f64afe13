// SectionReader: header, section table and the raw bytes of sections, out of a file that is not trusted.
#pragma once

#include <cstdint>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <span>
#include <string>
#include <vector>

#include "pf_vox/layout.hpp"

namespace pfvox {

struct FileHead {
    layout::Header header{};
    std::vector<layout::Section> sections;
};

/// Checks magic, version, features, sizes, the hash over header and table, and that sections lie inside the
/// file, in order, aligned, without overlap and with zeros between them. Errors: BadMagic, Truncated,
/// UnsupportedVersion, UnsupportedFeature, ChecksumMismatch, BadStructure.
Result<FileHead> readHead(std::span<const std::byte> file);

/// "MASK of region 3", for messages.
std::string sectionName(const layout::Section& section);

/// An Error at the section's place in the file.
tl::unexpected<Error> failInSection(const layout::Section& section, ErrorCode code, std::string message);

/// The raw bytes of a section. `expectedBytes` is what the tables say; nothing is allocated before both
/// agree. Errors: BadStructure, LimitExceeded, ChecksumMismatch, UnsupportedFeature (codec).
Result<std::vector<std::uint8_t>> readSection(std::span<const std::byte> file, const layout::Section& section,
                                              std::uint64_t expectedBytes);

}  // namespace pfvox

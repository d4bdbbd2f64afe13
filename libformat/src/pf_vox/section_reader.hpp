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

/// The two halves of readSection: whether sizes and codec are what the tables say, and the raw bytes
/// themselves.
Result<void> checkSectionSize(std::span<const std::byte> file, const layout::Section& section,
                              std::uint64_t expectedBytes);
Result<void> fillFromSection(std::span<const std::byte> file, const layout::Section& section,
                             std::span<std::byte> raw);

/// Both halves, into memory that is there already.
template <class Word>
Result<void> readSectionInto(std::span<const std::byte> file, const layout::Section& section,
                             std::span<Word> raw) {
    PFVOX_CHECK(checkSectionSize(file, section, raw.size_bytes()));
    return fillFromSection(file, section, std::as_writable_bytes(raw));
}

/// The raw content of a section, as bytes or little-endian words. `expectedCount` is what the tables say;
/// nothing is allocated before both agree. Errors: BadStructure, ChecksumMismatch, UnsupportedFeature
/// (codec).
template <class Word = std::uint8_t>
Result<std::vector<Word>> readSection(std::span<const std::byte> file, const layout::Section& section,
                                      std::uint64_t expectedCount) {
    PFVOX_CHECK(checkSectionSize(file, section, expectedCount * sizeof(Word)));
    std::vector<Word> raw(expectedCount);
    PFVOX_CHECK(fillFromSection(file, section, std::as_writable_bytes(std::span(raw))));
    return raw;
}

}  // namespace pfvox

// SectionWriter: compresses sections, in parallel where there are many, and lays them out into one file.
#pragma once

#include <cstdint>
#include <pfvox/error.hpp>
#include <pfvox/pf_vox.hpp>
#include <string_view>
#include <vector>

#include "pf_vox/layout.hpp"

namespace pfvox {

/// A section before it has its place.
struct SectionContent {
    std::string_view fourcc;  ///< four characters
    std::uint32_t region = layout::kNoRegion;
    bool mustUnderstand = true;
    std::uint64_t count = 0;
    std::vector<std::uint8_t> raw = {};
};

/// The bytes of a whole file. A section is stored compressed only where that is smaller.
/// Errors: LimitExceeded when the section table outgrows its fields; Internal when zstd fails.
Result<std::vector<std::byte>> writeSections(std::vector<SectionContent> sections,
                                             const EncodeSettings& settings);

}  // namespace pfvox

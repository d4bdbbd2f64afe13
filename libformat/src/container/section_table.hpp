// SectionTable: finds sections by name and region, and refuses tables with doubles or unknown required
// sections.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "container/file_head.hpp"

namespace pfvox::container {

/// Which sections a format has.
struct SectionNames {
    std::span<const std::string_view> whole;          ///< of the whole file
    std::span<const std::string_view> ofRegion = {};  ///< of each region
};

class SectionTable {
  public:
    /// The head outlives the table. Errors: UnsupportedFeature (unknown required section), BadStructure
    /// (section twice, or for an absurd region), LimitExceeded.
    static Result<SectionTable> make(const FileHead& head, const Format& format, const SectionNames& names,
                                     MemoryBudget& budget, Diagnostics& diagnostics);

    /// The section of the whole file with this name, or null.
    const layout::Section* find(std::string_view name) const;
    /// The same. Errors: BadStructure where it is missing.
    Result<const layout::Section*> require(std::string_view name) const;

    /// A section of a region by its place among SectionNames::ofRegion, or null.
    const layout::Section* find(std::size_t part, std::size_t region) const {
        const auto& list = ofRegions_[part];
        return region < list.size() ? list[region] : nullptr;
    }
    Result<const layout::Section*> require(std::size_t part, std::size_t region) const;
    /// How many regions have sections: an upper limit of how many there can be.
    std::size_t regionCount() const;

  private:
    Result<void> addToRegion(std::size_t part, const layout::Section& section, std::size_t sectionCount);

    SectionNames names_;
    std::vector<const layout::Section*> whole_;
    std::vector<std::vector<const layout::Section*>> ofRegions_;  ///< by part, region
};

}  // namespace pfvox::container

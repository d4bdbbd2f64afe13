// SectionIndex: finds sections by name and region, and refuses tables with doubles or unknown required
// sections.
#pragma once

#include <array>
#include <pfvox/error.hpp>
#include <pfvox/pf_vox.hpp>
#include <string_view>
#include <vector>

#include "pf_vox/section_reader.hpp"

namespace pfvox {

/// The sections that belong to one region, in the order of kRegionSections: first those of a packed file,
/// then those of a resident one.
enum class RegionPart : std::uint8_t { Masks, Values, Lod, Nodes, Lookup, FarTable, ValueBytes, LodWords };
inline constexpr std::array<std::string_view, 8> kRegionSections{"MASK", "ATTR", "LODA", "NODE",
                                                                 "LOOK", "FARP", "VALU", "LODR"};
constexpr Profile profileOf(RegionPart part) {
    return part < RegionPart::Nodes ? Profile::Packed : Profile::Resident;
}

class SectionIndex {
  public:
    /// Errors: UnsupportedFeature (unknown required section), BadStructure (section twice, for an absurd
    /// region or of the other profile).
    static Result<SectionIndex> make(const FileHead& head, Diagnostics& diagnostics);

    Profile profile() const { return profile_; }

    /// The section of the whole file with this name, or null.
    const layout::Section* find(std::string_view fourcc) const;
    /// A section of a region, or null.
    const layout::Section* find(RegionPart part, std::size_t region) const {
        const auto& list = ofRegions_[static_cast<std::size_t>(part)];
        return region < list.size() ? list[region] : nullptr;
    }
    /// How many regions have sections: an upper limit of how many there can be.
    std::size_t regionCount() const;

  private:
    Result<void> addToRegion(RegionPart part, const layout::Section& section, std::size_t sectionCount);

    Profile profile_ = Profile::Packed;
    std::vector<const layout::Section*> whole_;
    std::array<std::vector<const layout::Section*>, kRegionSections.size()> ofRegions_;  ///< by part, region
};

}  // namespace pfvox

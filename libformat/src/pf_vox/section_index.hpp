// The sections of a PF_VOX file: which there are, and whether they are those of its profile.
#pragma once

#include <array>
#include <pfvox/pf_vox.hpp>
#include <string_view>

#include "container/section_reader.hpp"
#include "container/section_table.hpp"

namespace pfvox {

inline constexpr std::array<std::string_view, 12> kWholeFileSections{
    "MATL", "MODL", "REGN", "TOPT", "TOPN", "PALT", "INST", "INSX", "NAME", "META", "LAYR", "CAMR"};
/// The sections that belong to one region, in the order of kRegionSections: first those of a packed file,
/// then those of a resident one.
enum class RegionPart : std::uint8_t { Masks, Values, Lod, Nodes, Lookup, FarTable, ValueBytes, LodWords };
inline constexpr std::array<std::string_view, 8> kRegionSections{"MASK", "ATTR", "LODA", "NODE",
                                                                 "LOOK", "FARP", "VALU", "LODR"};

/// An open file: its sections and what reads them.
struct PfVoxSections {
    container::SectionReader reader;
    container::SectionTable table;
    Profile profile = Profile::Packed;

    const layout::Section* find(RegionPart part, std::size_t region) const {
        return table.find(static_cast<std::size_t>(part), region);
    }
    Result<const layout::Section*> require(RegionPart part, std::size_t region) const {
        return table.require(static_cast<std::size_t>(part), region);
    }
    /// A table of records. Errors: BadStructure (missing, wrong size), LimitExceeded, those of SectionReader.
    template <class Record>
    Result<container::Array<Record>> readTable(std::string_view name, std::uint64_t maxCount) const;
};

/// Errors: those of SectionTable::make; BadStructure for sections of the other profile.
Result<PfVoxSections> indexSections(const container::FileHead& head, container::SectionReader reader,
                                    Diagnostics& diagnostics);

/// Errors: LimitExceeded.
Result<void> checkCount(const layout::Section& section, std::uint64_t maxCount);

template <class Record>
Result<container::Array<Record>> PfVoxSections::readTable(std::string_view name,
                                                          std::uint64_t maxCount) const {
    PFVOX_TRY(const layout::Section*, section, table.require(name));
    PFVOX_CHECK(checkCount(*section, maxCount));
    return reader.read<Record>(*section, section->count);
}

}  // namespace pfvox

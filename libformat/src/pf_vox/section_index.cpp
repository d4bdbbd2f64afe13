#include "pf_vox/section_index.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>

namespace pfvox {

namespace {

constexpr std::array<std::string_view, 11> kWholeFileSections{"MATL", "MODL", "REGN", "TOPT", "TOPN", "PALT",
                                                              "INST", "NAME", "META", "LAYR", "CAMR"};

std::string_view nameOf(const layout::Section& section) {
    return {section.fourcc.data(), section.fourcc.size()};
}

}  // namespace

Result<void> SectionIndex::addToRegion(RegionPart part, const layout::Section& section,
                                       std::size_t sectionCount) {
    if (profileOf(part) != profile_)
        return failInSection(section, ErrorCode::BadStructure, "belongs to the other profile");
    if (profile_ == Profile::Resident && section.codec != layout::Codec::Raw)
        return failInSection(section, ErrorCode::BadStructure, "is compressed in a resident file");
    // A region needs at least one section of its own, so an honest id is below the number of sections.
    if (section.region >= sectionCount) {
        return failInSection(section, ErrorCode::BadStructure, "the region does not exist");
    }
    auto& list = ofRegions_[static_cast<std::size_t>(part)];
    if (list.size() <= section.region) list.resize(section.region + 1, nullptr);
    if (list[section.region] != nullptr)
        return failInSection(section, ErrorCode::BadStructure, "occurs twice");
    list[section.region] = &section;
    return {};
}

Result<SectionIndex> SectionIndex::make(const FileHead& head, Diagnostics& diagnostics) {
    SectionIndex index;
    if ((head.header.requiredFeatures & kPfVoxResident) != 0) index.profile_ = Profile::Resident;
    for (const layout::Section& section : head.sections) {
        const std::string_view name = nameOf(section);
        const auto part =
            static_cast<std::size_t>(std::ranges::find(kRegionSections, name) - kRegionSections.begin());
        if (part < kRegionSections.size()) {
            PFVOX_CHECK(index.addToRegion(static_cast<RegionPart>(part), section, head.sections.size()));
        } else if (std::ranges::find(kWholeFileSections, name) != kWholeFileSections.end()) {
            if (index.find(name) != nullptr)
                return failInSection(section, ErrorCode::BadStructure, "occurs twice");
            index.whole_.push_back(&section);
        } else if ((section.flags & layout::kSectionMustUnderstand) != 0) {
            return failInSection(section, ErrorCode::UnsupportedFeature,
                                 "unknown but required: a newer pfvox made this file");
        } else {
            diagnostics.note("pfvox-unknown-section",
                             fmt::format("{} is unknown and was skipped", sectionName(section)));
        }
    }
    return index;
}

std::size_t SectionIndex::regionCount() const {
    std::size_t count = 0;
    for (const auto& list : ofRegions_) count = std::max(count, list.size());
    return count;
}

const layout::Section* SectionIndex::find(std::string_view fourcc) const {
    const auto found = std::ranges::find(whole_, fourcc, [](const layout::Section* s) { return nameOf(*s); });
    return found == whole_.end() ? nullptr : *found;
}

}  // namespace pfvox

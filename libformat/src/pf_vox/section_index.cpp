#include "pf_vox/section_index.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>

namespace pfvox {

namespace {

constexpr std::array<std::string_view, 10> kWholeFileSections{"MATL", "MODL", "REGN", "TOPT", "PALT",
                                                              "INST", "NAME", "META", "LAYR", "CAMR"};

std::string_view nameOf(const layout::Section& section) {
    return {section.fourcc.data(), section.fourcc.size()};
}

}  // namespace

Result<SectionIndex> SectionIndex::make(const FileHead& head, Diagnostics& diagnostics) {
    SectionIndex index;
    for (const layout::Section& section : head.sections) {
        const std::string_view name = nameOf(section);
        const bool ofRegion = name == "MASK" || name == "ATTR";
        if (ofRegion) {
            // A region needs at least one section of its own, so an honest id is below the number of
            // sections.
            if (section.region >= head.sections.size()) {
                return failInSection(section, ErrorCode::BadStructure, "the region does not exist");
            }
            auto& list = name == "MASK" ? index.masks_ : index.attributes_;
            if (list.size() <= section.region) list.resize(section.region + 1, nullptr);
            if (list[section.region] != nullptr)
                return failInSection(section, ErrorCode::BadStructure, "occurs twice");
            list[section.region] = &section;
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

const layout::Section* SectionIndex::find(std::string_view fourcc) const {
    const auto found = std::ranges::find(whole_, fourcc, [](const layout::Section* s) { return nameOf(*s); });
    return found == whole_.end() ? nullptr : *found;
}

}  // namespace pfvox

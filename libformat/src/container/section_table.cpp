#include "container/section_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace pfvox::container {

using layout::Section;

Result<void> SectionTable::addToRegion(std::size_t part, const Section& section, std::size_t sectionCount) {
    // A region needs at least one section of its own, so an honest id is below the number of sections.
    if (section.region >= sectionCount)
        return failInSection(section, ErrorCode::BadStructure, "the region does not exist");
    auto& list = ofRegions_[part];
    if (list.empty()) list.reserve(sectionCount);
    if (list.size() <= section.region) list.resize(section.region + 1, nullptr);
    if (list[section.region] != nullptr)
        return failInSection(section, ErrorCode::BadStructure, "occurs twice");
    list[section.region] = &section;
    return {};
}

Result<SectionTable> SectionTable::make(const FileHead& head, const Format& format, const SectionNames& names,
                                        MemoryBudget& budget, Diagnostics& diagnostics) {
    SectionTable table;
    table.names_ = names;
    table.ofRegions_.resize(names.ofRegion.size());
    PFVOX_CHECK(budget.take(names.ofRegion.size() * head.sections.size(), sizeof(const Section*)));
    for (const Section& section : head.sections) {
        const std::string_view name = nameOf(section);
        const auto part = std::ranges::find(names.ofRegion, name) - names.ofRegion.begin();
        if (static_cast<std::size_t>(part) < names.ofRegion.size()) {
            PFVOX_CHECK(table.addToRegion(static_cast<std::size_t>(part), section, head.sections.size()));
        } else if (std::ranges::find(names.whole, name) != names.whole.end()) {
            if (table.find(name) != nullptr)
                return failInSection(section, ErrorCode::BadStructure, "occurs twice");
            table.whole_.push_back(&section);
        } else if ((section.flags & layout::kSectionMustUnderstand) != 0) {
            return failInSection(section, ErrorCode::UnsupportedFeature,
                                 "unknown but required: a newer pfvox made this file");
        } else {
            diagnostics.note(std::string(format.unknownSection),
                             fmt::format("{} is unknown and was skipped", describe(section)));
        }
    }
    return table;
}

std::size_t SectionTable::regionCount() const {
    std::size_t count = 0;
    for (const auto& list : ofRegions_) count = std::max(count, list.size());
    return count;
}

const Section* SectionTable::find(std::string_view name) const {
    const auto found = std::ranges::find(whole_, name, [](const Section* s) { return nameOf(*s); });
    return found == whole_.end() ? nullptr : *found;
}

Result<const Section*> SectionTable::require(std::string_view name) const {
    if (const Section* section = find(name)) return section;
    return fail(ErrorCode::BadStructure, fmt::format("section {} is missing", name));
}

Result<const Section*> SectionTable::require(std::size_t part, std::size_t region) const {
    if (const Section* section = find(part, region)) return section;
    return fail(ErrorCode::BadStructure,
                fmt::format("section {} of region {} is missing", names_.ofRegion[part], region));
}

}  // namespace pfvox::container

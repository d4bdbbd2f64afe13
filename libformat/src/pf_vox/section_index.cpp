#include "pf_vox/section_index.hpp"

#include <fmt/format.h>

namespace pfvox {

namespace {

constexpr Profile profileOf(RegionPart part) {
    return part < RegionPart::Nodes ? Profile::Packed : Profile::Resident;
}

}  // namespace

Result<void> checkCount(const layout::Section& section, std::uint64_t maxCount) {
    if (section.count <= maxCount) return {};
    return container::failInSection(
        section, ErrorCode::LimitExceeded,
        fmt::format("{} records, at most {} are accepted", section.count, maxCount));
}

Result<PfVoxSections> indexSections(const container::FileHead& head, container::SectionReader reader,
                                    Diagnostics& diagnostics) {
    const bool isResident = (head.header.requiredFeatures & kPfVoxResident) != 0;
    const Profile profile = isResident ? Profile::Resident : Profile::Packed;
    for (const layout::Section& section : head.sections) {
        const auto part =
            std::ranges::find(kRegionSections, container::nameOf(section)) - kRegionSections.begin();
        if (static_cast<std::size_t>(part) == kRegionSections.size()) continue;
        if (profileOf(static_cast<RegionPart>(part)) != profile)
            return container::failInSection(section, ErrorCode::BadStructure, "belongs to the other profile");
        if (isResident && section.codec != layout::Codec::Raw)
            return container::failInSection(section, ErrorCode::BadStructure,
                                            "is compressed in a resident file");
    }
    PFVOX_TRY(auto, table,
              container::SectionTable::make(head, container::kPfVox,
                                            {.whole = kWholeFileSections, .ofRegion = kRegionSections},
                                            reader.budget(), diagnostics));
    return PfVoxSections{.reader = reader, .table = std::move(table), .profile = profile};
}

}  // namespace pfvox

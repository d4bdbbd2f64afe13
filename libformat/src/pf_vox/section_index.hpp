// SectionIndex: finds sections by name and region, and refuses tables with doubles or unknown required
// sections.
#pragma once

#include <pfvox/error.hpp>
#include <string_view>
#include <vector>

#include "pf_vox/section_reader.hpp"

namespace pfvox {

class SectionIndex {
  public:
    /// Errors: UnsupportedFeature (unknown required section), BadStructure (section twice or for an absurd
    /// region).
    static Result<SectionIndex> make(const FileHead& head, Diagnostics& diagnostics);

    /// The section of the whole file with this name, or null.
    const layout::Section* find(std::string_view fourcc) const;
    /// MASK or ATTR of a region, or null.
    const layout::Section* mask(std::size_t region) const { return get(masks_, region); }
    const layout::Section* attributes(std::size_t region) const { return get(attributes_, region); }
    std::size_t regionCount() const { return std::max(masks_.size(), attributes_.size()); }

  private:
    static const layout::Section* get(const std::vector<const layout::Section*>& list, std::size_t region) {
        return region < list.size() ? list[region] : nullptr;
    }
    std::vector<const layout::Section*> whole_;
    std::vector<const layout::Section*> masks_;
    std::vector<const layout::Section*> attributes_;
};

}  // namespace pfvox

// TopTreeReader: TOPT or TOPN -> top trees, model after model.
#pragma once

#include <pfvox/octree.hpp>
#include <span>
#include <vector>

#include "pf_vox/section_index.hpp"

namespace pfvox {

class TopTreeReader {
  public:
    /// Reads the section, if any model has a top tree. Errors: BadStructure, those of readSection.
    static Result<TopTreeReader> make(std::span<const std::byte> file, const SectionIndex& index,
                                      const std::vector<layout::Model>& models);

    /// Fills the top tree of the next model that has one and checks that its regions lie in its leaves.
    /// Errors: BadStructure, at the section's place.
    Result<void> readNext(const layout::Model& record, std::span<const layout::Region> regions,
                          OctreeModel& model);

  private:
    Result<void> readTree(const layout::Model& record, NodeTree& tree);
    Result<void> readRegions(const layout::Model& record, std::span<const layout::Region> regions,
                             OctreeModel& model);

    const layout::Section* section_ = nullptr;
    Profile profile_ = Profile::Packed;
    std::vector<std::uint8_t> planes_;  ///< packed
    std::vector<std::uint32_t> words_;  ///< resident
    std::size_t next_ = 0;              ///< what was not read yet begins here
};

}  // namespace pfvox

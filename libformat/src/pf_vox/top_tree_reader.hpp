// TopTreeReader: TOPT or TOPN -> top trees, model after model.
#pragma once

#include <pfvox/octree.hpp>
#include <span>

#include "pf_vox/layout.hpp"
#include "pf_vox/section_index.hpp"

namespace pfvox {

class TopTreeReader {
  public:
    /// Reads the section, if any model has a top tree. Errors: BadStructure, those of SectionReader.
    static Result<TopTreeReader> make(const PfVoxSections& sections, std::span<const layout::Model> models);

    /// Fills the top tree of the next model that has one and checks that its regions lie in its leaves.
    /// Precondition: the records were checked. Errors: BadStructure, LimitExceeded, at the section's place.
    Result<void> readNext(const layout::Model& record, std::span<const layout::Region> regions,
                          OctreeModel& model);

  private:
    explicit TopTreeReader(container::MemoryBudget& budget) : budget_(&budget) {}
    Result<void> readTree(const layout::Model& record, NodeTree& tree);
    Result<void> readRegions(const layout::Model& record, std::span<const layout::Region> regions,
                             OctreeModel& model);

    container::MemoryBudget* budget_;
    const layout::Section* section_ = nullptr;
    Profile profile_ = Profile::Packed;
    container::Array<std::uint8_t> planes_;  ///< packed
    container::Array<std::uint32_t> words_;  ///< resident
    std::size_t next_ = 0;                   ///< what was not read yet begins here
};

}  // namespace pfvox

// RegionWriter: trees, values and levels of detail as sections, in either profile.
#pragma once

#include <pfvox/octree.hpp>
#include <pfvox/pf_vox.hpp>
#include <vector>

#include "container/section_writer.hpp"

namespace pfvox {

/// TOPT or TOPN without content, and the same with one more top tree.
container::SectionContent emptyTopTrees(Profile profile);
void appendTopTree(const NodeTree& tree, Profile profile, container::SectionContent& section);

/// Adds the sections of all regions, which are made in parallel; the place in `regions` is the region id.
void addRegionSections(const std::vector<const OctreeRegion*>& regions,
                       const std::vector<Material>& materials, Profile profile,
                       std::vector<container::SectionContent>& sections);

}  // namespace pfvox

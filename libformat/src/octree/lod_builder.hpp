// LodBuilder: mean color, coverage and dominant material of what can be seen of every node (NodeLod).
//
// Runs after the trees are built and does not touch them. Visible faces come from the masks of the voxel
// model, across the borders of bricks and regions; materials come from the tree, where a leaf has one value
// whatever its size.
#pragma once

#include <pfvox/octree.hpp>

namespace pfvox::octree {

/// Fills OctreeRegion::lod of every region. `built` must be the octree of `source`. Regions are treated in
/// parallel in the calling TBB arena; all sums are of whole numbers, so the result depends on neither order
/// nor threads.
void addLod(const VoxelModel& source, const std::vector<Material>& materials, OctreeModel& built);

}  // namespace pfvox::octree

#include <optional>
#include <pfvox/octree_walk.hpp>

namespace pfvox {

namespace {

/// Which voxels of a region hide faces, one bit each; of those beyond it the model is asked.
class HidingVoxels {
  public:
    HidingVoxels(const OctreeModel& model, const OctreeRegion& region, const std::vector<bool>& hides)
        : model_(model), hides_(hides), box_(region.bounds), size_(box_.max - box_.min) {
        bits_.resize(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                     static_cast<std::size_t>(size_.z));
        forEachLeaf(region, [&](const Leaf& leaf) {
            if (hides_[leaf.material]) fill(leaf);
        });
    }

    bool at(glm::ivec3 voxel) const {
        if (glm::all(glm::greaterThanEqual(voxel, box_.min)) && glm::all(glm::lessThan(voxel, box_.max)))
            return bits_[indexOf(voxel)];
        const std::optional<MaterialIndex> material = model_.at(voxel);
        return material && hides_[*material];
    }

  private:
    std::size_t indexOf(glm::ivec3 voxel) const {
        const glm::ivec3 p = voxel - box_.min;
        return static_cast<std::size_t>(p.x) +
               static_cast<std::size_t>(size_.x) *
                   (static_cast<std::size_t>(p.y) +
                    static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(p.z));
    }
    void fill(const Leaf& leaf) {
        for (int z = 0; z < leaf.edge(); ++z)
            for (int y = 0; y < leaf.edge(); ++y) {
                const std::size_t row = indexOf(leaf.corner + glm::ivec3(0, y, z));
                for (std::size_t x = 0; x < static_cast<std::size_t>(leaf.edge()); ++x) bits_[row + x] = true;
            }
    }

    const OctreeModel& model_;
    const std::vector<bool>& hides_;
    VoxelBox box_;
    glm::ivec3 size_;
    std::vector<bool> bits_;
};

/// The voxels on one side of a leaf.
template <class Visit>
void forEachVoxelOfSide(const Leaf& leaf, int face, const Visit& visit) {
    const int axis = face / 2;
    glm::ivec3 at(0);
    at[axis] = face % 2 != 0 ? leaf.edge() - 1 : 0;
    for (int j = 0; j < leaf.edge(); ++j) {
        for (int i = 0; i < leaf.edge(); ++i) {
            at[(axis + 1) % 3] = i;
            at[(axis + 2) % 3] = j;
            visit(leaf.corner + at);
        }
    }
}

bool anyWanted(const OctreeRegion& region, const std::vector<bool>& wanted) {
    for (const MaterialIndex material : region.palette)
        if (wanted[material]) return true;
    return false;
}

}  // namespace

void forEachExposedFace(const OctreeModel& model, const FaceFilter& filter,
                        const std::function<void(const VoxelFace&)>& visit) {
    for (const OctreeRegion& region : model.regions) {
        if (region.bounds.empty() || !anyWanted(region, filter.wanted)) continue;
        const HidingVoxels hiding(model, region, filter.hides);
        forEachLeaf(region, [&](const Leaf& leaf) {
            if (!filter.wanted[leaf.material]) return;
            for (int face = 0; face < 6; ++face) {
                glm::ivec3 outward(0);
                outward[face / 2] = face % 2 != 0 ? 1 : -1;
                forEachVoxelOfSide(leaf, face, [&](glm::ivec3 voxel) {
                    if (!hiding.at(voxel + outward))
                        visit({.voxel = voxel, .face = face, .material = leaf.material});
                });
            }
        });
    }
}

}  // namespace pfvox

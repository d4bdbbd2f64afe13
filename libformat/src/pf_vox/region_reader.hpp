// RegionReader: the sections of one region -> OctreeRegion. Its record in REGN was checked before.
#pragma once

#include <pfvox/octree.hpp>
#include <span>
#include <vector>

#include "pf_vox/section_index.hpp"

namespace pfvox {

/// Reads any region of one file; several threads may use it at once.
class RegionReader {
  public:
    RegionReader(std::span<const std::byte> file, const SectionIndex& index,
                 const std::vector<Material>& materials)
        : file_(file), index_(index), materials_(materials) {}

    /// Errors: BadStructure, BadReference, those of readSection; each with section and offset.
    Result<OctreeRegion> read(std::size_t id, const layout::Region& record,
                              std::span<const std::uint16_t> palettes) const;

  private:
    bool isPacked() const { return index_.profile() == Profile::Packed; }
    Result<const layout::Section*> require(RegionPart part, std::size_t id) const;
    Result<void> readPackedTree(std::size_t id, const layout::Region& record, OctreeRegion& region) const;
    Result<std::vector<std::uint32_t>> readWords(RegionPart part, std::size_t id, std::uint64_t count) const;
    Result<void> readResidentTree(std::size_t id, const layout::Region& record, OctreeRegion& region) const;
    Result<void> readValues(std::size_t id, const layout::Region& record, OctreeRegion& region) const;
    Result<void> readLod(std::size_t id, OctreeRegion& region) const;

    std::span<const std::byte> file_;
    const SectionIndex& index_;
    const std::vector<Material>& materials_;
};

}  // namespace pfvox

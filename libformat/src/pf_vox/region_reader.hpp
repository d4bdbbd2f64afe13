// RegionReader: the sections of one region -> OctreeRegion. Its record in REGN was checked before.
#pragma once

#include <memory>
#include <pfvox/octree.hpp>
#include <span>
#include <vector>

#include "octree/grow_buffer.hpp"
#include "octree/plane_linker.hpp"
#include "pf_vox/layout.hpp"
#include "pf_vox/section_index.hpp"

namespace pfvox {

/// Reads any region of one file; several threads may use it at once.
class RegionReader {
  public:
    /// What a thread reads with, from region to region.
    struct Scratch {
        octree::GrowBuffer<std::uint8_t> planes;
        octree::PlaneLinker linker;
    };

    /// Bytes of a MemoryPool that the region will take: counts that its sections confirm.
    /// Errors: BadStructure, UnsupportedFeature (codec).
    Result<std::size_t> poolBytes(std::size_t id, const layout::Region& record) const;

    RegionReader(std::span<const std::byte> file, const SectionIndex& index,
                 const std::vector<Material>& materials)
        : file_(file), index_(index), materials_(materials) {}

    /// Takes the memory of the trees from the pool, or from the heap where that is null.
    /// Errors: BadStructure, BadReference, those of readSection; each with section and offset.
    Result<OctreeRegion> read(std::size_t id, const layout::Region& record,
                              std::span<const std::uint16_t> palettes,
                              const std::shared_ptr<MemoryPool>& pool, Scratch& scratch) const;

  private:
    bool isPacked() const { return index_.profile() == Profile::Packed; }
    RegionPart valuesPart() const { return isPacked() ? RegionPart::Values : RegionPart::ValueBytes; }
    Result<const layout::Section*> require(RegionPart part, std::size_t id) const;
    Result<void> checkSize(RegionPart part, std::size_t id, std::uint64_t bytes) const;
    Result<void> readPackedTree(std::size_t id, const layout::Region& record, OctreeRegion& region,
                                Scratch& scratch) const;
    Result<void> readWords(RegionPart part, std::size_t id, std::size_t count,
                           PooledVector<std::uint32_t>& words) const;
    Result<void> readResidentTree(std::size_t id, const layout::Region& record, OctreeRegion& region) const;
    Result<void> readValues(std::size_t id, const layout::Region& record, OctreeRegion& region) const;
    Result<void> readLod(std::size_t id, OctreeRegion& region) const;

    std::span<const std::byte> file_;
    const SectionIndex& index_;
    const std::vector<Material>& materials_;
};

}  // namespace pfvox

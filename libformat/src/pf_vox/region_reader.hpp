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
        octree::GrowBuffer<std::uint8_t> bytes;  ///< of masks, then of levels of detail
        octree::PlaneLinker linker;
    };

    /// Bytes that the region will take: counts that its sections confirm.
    struct Sizes {
        std::uint64_t pooled = 0;   ///< of a MemoryPool
        std::uint64_t beside = 0;   ///< palette and level of detail
        std::uint64_t scratch = 0;  ///< while it is read
    };
    /// Errors: BadStructure, UnsupportedFeature (codec).
    Result<Sizes> sizesOf(std::size_t id, const layout::Region& record) const;

    RegionReader(const PfVoxSections& sections, std::span<const std::uint16_t> palettes,
                 const std::vector<Material>& materials)
        : sections_(sections), palettes_(palettes), materials_(materials) {}

    /// Takes the memory of the trees from the pool. Precondition: the sizes of the region were taken from the
    /// budget. Errors: BadStructure, BadReference, those of SectionReader; each with section and offset.
    Result<OctreeRegion> read(std::size_t id, const layout::Region& record,
                              const std::shared_ptr<MemoryPool>& pool, Scratch& scratch) const;

  private:
    bool isPacked() const { return sections_.profile == Profile::Packed; }
    RegionPart valuesPart() const { return isPacked() ? RegionPart::Values : RegionPart::ValueBytes; }
    RegionPart lodPart() const { return isPacked() ? RegionPart::Lod : RegionPart::LodWords; }
    std::uint64_t lodBytes(std::size_t id, const layout::Region& record) const;
    Result<void> checkSize(RegionPart part, std::size_t id, std::uint64_t bytes) const;
    Result<void> fill(RegionPart part, std::size_t id, std::span<std::byte> raw) const;
    Result<void> readPackedTree(std::size_t id, const layout::Region& record, OctreeRegion& region,
                                Scratch& scratch) const;
    Result<void> readWords(RegionPart part, std::size_t id, std::size_t count,
                           PooledVector<std::uint32_t>& words) const;
    Result<void> readResidentTree(std::size_t id, const layout::Region& record, OctreeRegion& region) const;
    Result<void> readValues(std::size_t id, const layout::Region& record, OctreeRegion& region) const;
    Result<void> readLod(std::size_t id, const layout::Region& record, OctreeRegion& region,
                         Scratch& scratch) const;

    const PfVoxSections& sections_;
    std::span<const std::uint16_t> palettes_;
    const std::vector<Material>& materials_;
};

}  // namespace pfvox

// LodCodec: NodeLod as bytes.
//
// Packed (LODA): planes, one behind the other, of n nodes: red, green, blue, coverage, low byte of the
// palette index and, where the palette has more than 256 entries, its high byte. The color is the difference
// (mod 256) to the base color of the node's material: 0 where only one material is visible, which is most of
// the time. Resident (LODR): as a GPU reads it: n words of color, then n 16-bit palette indices.
#pragma once

#include <cstdint>
#include <pfvox/error.hpp>
#include <pfvox/octree.hpp>
#include <span>
#include <vector>

namespace pfvox {

constexpr std::uint64_t packedLodBytes(std::uint64_t nodes, std::size_t valueBytes) {
    return nodes * (4 + valueBytes);
}
constexpr std::uint64_t residentLodBytes(std::uint64_t nodes) {
    return nodes * 6;
}

/// Preconditions: region.lod has an entry for each node; the palette names materials that exist.
std::vector<std::uint8_t> packLod(const OctreeRegion& region, const std::vector<Material>& materials);
std::vector<std::uint8_t> residentLod(const OctreeRegion& region);

/// Fills region.lod, whose nodes and palette must be there. Preconditions: bytes.size() is what the function
/// above says; the palette names materials that exist. Errors: BadReference where a palette index is outside
/// the palette.
Result<void> unpackLod(std::span<const std::uint8_t> bytes, const std::vector<Material>& materials,
                       OctreeRegion& region);
Result<void> readResidentLod(std::span<const std::uint8_t> bytes, OctreeRegion& region);

}  // namespace pfvox

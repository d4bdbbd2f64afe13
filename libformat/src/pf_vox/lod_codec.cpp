#include "pf_vox/lod_codec.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cstring>

namespace pfvox {

namespace {

/// The base colors of a palette, in the bytes of NodeLod::colors; no coverage.
std::vector<std::uint32_t> paletteColors(const OctreeRegion& region, const std::vector<Material>& materials) {
    std::vector<std::uint32_t> colors;
    colors.reserve(region.palette.size());
    for (const MaterialIndex m : region.palette) {
        const glm::u8vec4 c = materials[m].baseColor;
        colors.push_back(c.r | (std::uint32_t{c.g} << 8) | (std::uint32_t{c.b} << 16));
    }
    return colors;
}

std::uint8_t byteOf(std::uint32_t word, unsigned index) {
    return static_cast<std::uint8_t>(word >> (8 * index));
}

Result<void> checkMaterials(const OctreeRegion& region) {
    const std::uint32_t largest = std::ranges::max(region.lod.materials);
    if (largest < region.palette.size()) return {};
    return fail(ErrorCode::BadReference,
                fmt::format("material {} in a palette of {}", largest, region.palette.size()));
}

}  // namespace

std::vector<std::uint8_t> packLod(const OctreeRegion& region, const std::vector<Material>& materials) {
    const std::vector<std::uint32_t> baseColors = paletteColors(region, materials);
    const std::size_t n = region.lod.colors.size();
    std::vector<std::uint8_t> bytes(packedLodBytes(n, region.valueBytes()));
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t color = region.lod.colors[i];
        const std::uint32_t material = region.lod.materials[i];
        const std::uint32_t base = baseColors[material];
        for (unsigned c = 0; c < 3; ++c)
            bytes[c * n + i] = static_cast<std::uint8_t>(byteOf(color, c) - byteOf(base, c));
        bytes[3 * n + i] = byteOf(color, 3);
        bytes[4 * n + i] = byteOf(material, 0);
        if (region.valueBytes() == 2) bytes[5 * n + i] = byteOf(material, 1);
    }
    return bytes;
}

Result<void> unpackLod(std::span<const std::uint8_t> bytes, const std::vector<Material>& materials,
                       OctreeRegion& region) {
    const std::size_t n = region.tree.nodes.size();
    region.lod.materials.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const unsigned high = region.valueBytes() == 2 ? bytes[5 * n + i] : 0u;
        region.lod.materials[i] = static_cast<std::uint16_t>(bytes[4 * n + i] | (high << 8));
    }
    PFVOX_CHECK(checkMaterials(region));
    const std::vector<std::uint32_t> baseColors = paletteColors(region, materials);
    region.lod.colors.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t base = baseColors[region.lod.materials[i]];
        std::uint32_t color = std::uint32_t{bytes[3 * n + i]} << 24;
        for (unsigned c = 0; c < 3; ++c)
            color |= static_cast<std::uint32_t>(byteOf(bytes[c * n + i] + byteOf(base, c), 0)) << (8 * c);
        region.lod.colors[i] = color;
    }
    return {};
}

std::vector<std::uint8_t> residentLod(const OctreeRegion& region) {
    const std::size_t n = region.lod.colors.size();
    std::vector<std::uint8_t> bytes(residentLodBytes(n));
    std::memcpy(bytes.data(), region.lod.colors.data(), 4 * n);
    std::memcpy(bytes.data() + 4 * n, region.lod.materials.data(), 2 * n);
    return bytes;
}

Result<void> readResidentLod(std::span<const std::uint8_t> bytes, OctreeRegion& region) {
    const std::size_t n = region.tree.nodes.size();
    region.lod.colors.resize(n);
    region.lod.materials.resize(n);
    std::memcpy(region.lod.colors.data(), bytes.data(), 4 * n);
    std::memcpy(region.lod.materials.data(), bytes.data() + 4 * n, 2 * n);
    return checkMaterials(region);
}

}  // namespace pfvox

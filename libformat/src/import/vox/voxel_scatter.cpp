#include "import/vox/voxel_scatter.hpp"

#include <algorithm>

namespace pfvox::import::vox {

namespace {

constexpr Rotation kYUpFromZUp{.column = {0, 2, 1}, .sign = {1, 1, -1}};
constexpr std::size_t kByteValues = 256;

// One table entry: where a coordinate goes. Low 24 bits: its share of the voxel's Morton code in a region,
// whose upper 15 bits are the code of the cell and lower 9 that in the brick. Bits 24 to 26: region, relative
// to the first.
constexpr std::uint32_t kCellShift = 9;
constexpr std::uint32_t kVoxelMask = (1u << kCellShift) - 1;
constexpr std::uint32_t kRegionShift = 24;
constexpr std::uint32_t kOutside = 0x80000000u;

/// For each axis of the source and each value of a coordinate byte: its part of the target address.
struct AddressTables {
    std::array<std::array<std::uint32_t, kByteValues>, 3> address;
    glm::ivec3 firstRegion;
};

constexpr std::uint32_t spreadBits(std::uint32_t coordinate) {
    return mortonEncode({coordinate, 0, 0});
}

AddressTables makeTables(const GridTransform& targetFromSource, glm::ivec3 size) {
    AddressTables tables;
    for (std::size_t target = 0; target < 3; ++target) {
        const std::size_t source = targetFromSource.rotation.column[target];
        const bool mirrored = targetFromSource.rotation.sign[target] < 0;
        const auto offset = static_cast<std::int32_t>(targetFromSource.translation[static_cast<int>(target)]);
        const std::int32_t count = std::min<std::int32_t>(size[static_cast<int>(source)], kByteValues);
        const auto coordinateOf = [=](std::int32_t v) { return mirrored ? offset - 1 - v : offset + v; };
        const std::int32_t firstRegion =
            std::min(coordinateOf(0), coordinateOf(count - 1)) >> kRegionEdgeLog2;
        tables.firstRegion[static_cast<int>(target)] = firstRegion;
        auto& table = tables.address[source];
        table.fill(kOutside);
        for (std::int32_t v = 0; v < count; ++v) {
            const std::int32_t coordinate = coordinateOf(v);
            // 256 coordinates in a row touch two regions at most.
            const auto region = static_cast<std::uint32_t>((coordinate >> kRegionEdgeLog2) - firstRegion);
            const auto local = static_cast<std::uint32_t>(coordinate) & (kRegionEdge - 1);
            table[static_cast<std::size_t>(v)] =
                (spreadBits(local) << target) | (region << (kRegionShift + target));
        }
    }
    return tables;
}

}  // namespace

GridTransform modelFromVox(glm::ivec3 size) {
    return {.rotation = kYUpFromZUp, .translation = {0, 0, size.y}};
}

GridTransform worldFromVoxWorld() {
    return {.rotation = kYUpFromZUp, .translation = glm::i64vec3{0}};
}

ScatterReport scatterVoxels(const ModelRecord& record, VoxelModel& model) {
    const AddressTables tables = makeTables(modelFromVox(record.size), record.size);
    ScatterReport report;
    Brick* brick = nullptr;
    std::uint32_t brickAddress = kOutside;
    for (std::size_t at = 0; at < record.voxels.size(); at += kVoxelBytes) {
        std::array<std::uint8_t, kVoxelBytes> voxel;
        std::memcpy(voxel.data(), record.voxels.data() + at, kVoxelBytes);
        const std::uint32_t address =
            tables.address[0][voxel[0]] | tables.address[1][voxel[1]] | tables.address[2][voxel[2]];
        const std::uint8_t paletteIndex = voxel[3];
        if ((address & kOutside) != 0) {
            ++report.outside;
            continue;
        }
        if (paletteIndex == 0) {
            ++report.colorless;
            continue;
        }
        // Voxels come in runs, so most of them go to the brick of the one before.
        if (address >> kCellShift != brickAddress) {
            brickAddress = address >> kCellShift;
            const glm::ivec3 region{(address >> kRegionShift) & 1u, (address >> (kRegionShift + 1)) & 1u,
                                    (address >> (kRegionShift + 2)) & 1u};
            constexpr std::uint32_t kCellMask = static_cast<std::uint32_t>(kRegionCells) - 1;
            brick = &model.regionAt(tables.firstRegion + region).brickAt(brickAddress & kCellMask);
        }
        const std::uint32_t morton = address & kVoxelMask;
        report.duplicates += brick->occupied(morton) ? 1u : 0u;
        brick->set(morton, materialOfPaletteIndex(paletteIndex));
        report.usedIndices[paletteIndex] = true;
    }
    return report;
}

}  // namespace pfvox::import::vox

#include "import/vox/slab6.hpp"

#include "io/byte_cursor.hpp"

namespace pfvox::import::vox {

bool isSlab6(std::span<const std::byte> bytes) {
    constexpr std::int32_t kMaxEdge = 4096;
    constexpr std::uint64_t kHeaderBytes = 12;
    constexpr std::uint64_t kPaletteBytes = 768;
    io::ByteCursor cursor(bytes);
    std::uint64_t voxels = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const auto edge = cursor.read<std::int32_t>();
        if (!edge || *edge <= 0 || *edge > kMaxEdge) return false;
        voxels *= static_cast<std::uint64_t>(*edge);
    }
    return bytes.size() == kHeaderBytes + voxels + kPaletteBytes;
}

}  // namespace pfvox::import::vox

#include "import/legacy/legacy_layout.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "io/byte_cursor.hpp"

namespace pfvox::import::legacy {

namespace {

constexpr std::uint64_t kFixedBytes = 112;
constexpr std::uint32_t kNodeAndLookupBytes = 12;

/// Byte offsets of the parts, all known once the three counts are.
struct Layout {
    std::uint64_t materialCount = 0;
    std::uint64_t nodeCount = 0;
    std::uint64_t leafCount = 0;

    std::uint64_t header() const { return 4 + kMaterialBytes * materialCount; }
    std::uint64_t sizes() const { return header() + 44; }
    std::uint64_t leafMaterials() const { return sizes() + 24; }
    std::uint64_t lookupSize() const { return leafMaterials() + 4 * leafCount; }
    std::uint64_t page() const { return lookupSize() + 8 + 4 * nodeCount; }
    std::uint64_t nodes() const { return page() + 24; }
    std::uint64_t farSize() const { return nodes() + 8 * nodeCount; }
    std::uint64_t fileBytes() const { return farSize() + 8; }
};

/// Reads a value at a place that was checked to lie inside.
template <class T>
T valueAt(std::span<const std::byte> bytes, std::uint64_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

template <class T>
std::vector<T> arrayAt(std::span<const std::byte> bytes, std::uint64_t offset, std::uint64_t count) {
    std::vector<T> values(static_cast<std::size_t>(count));
    if (count != 0) std::memcpy(values.data(), bytes.data() + offset, values.size() * sizeof(T));
    return values;
}

Result<void> expectSize(std::span<const std::byte> bytes, std::uint64_t offset, const char* field,
                        std::uint64_t expected) {
    const auto found = valueAt<std::uint64_t>(bytes, offset);
    if (found == expected) return {};
    return failAt(ErrorCode::BadStructure, offset, field,
                  fmt::format("is {}, but the counts ask for {}", found, expected));
}

/// Finds M, N and L from the three size fields that hold them and proves them by the size of the file.
Result<Layout> measure(std::span<const std::byte> bytes, const Limits& limits) {
    io::ByteCursor cursor(bytes);
    const auto materialBytes = cursor.read<std::uint32_t>();
    if (!materialBytes) return failAt(ErrorCode::Truncated, 0, "materialsSize", "the file ends here");
    if (*materialBytes == 0 || *materialBytes % kMaterialBytes != 0) {
        return failAt(ErrorCode::BadValue, 0, "materialsSize",
                      fmt::format("{} bytes are no whole number of 60-byte materials", *materialBytes));
    }
    Layout layout{.materialCount = *materialBytes / kMaterialBytes};
    if (layout.materialCount > limits.maxMaterials) {
        return failAt(ErrorCode::LimitExceeded, 0, "materialsSize",
                      fmt::format("{} materials, more than maxMaterials = {}", layout.materialCount,
                                  limits.maxMaterials));
    }
    if (bytes.size() < layout.sizes() + 24) {
        return failAt(ErrorCode::Truncated, bytes.size(), "header",
                      fmt::format("the file ends inside the header for {} materials", layout.materialCount));
    }
    const auto leafBytes = valueAt<std::uint64_t>(bytes, layout.sizes() + 16);
    const std::uint64_t rest = bytes.size() - (layout.sizes() + 24);
    if (leafBytes % 4 != 0) {
        return failAt(ErrorCode::BadValue, layout.sizes() + 16, "attachmentsSize",
                      fmt::format("{} bytes are no whole number of 4-byte indices", leafBytes));
    }
    if (leafBytes > rest || rest - leafBytes < 40) {
        return failAt(
            ErrorCode::Truncated, bytes.size(), "attachments",
            fmt::format("{} bytes announced, {} bytes left for them and the tree", leafBytes, rest));
    }
    layout.leafCount = leafBytes / 4;
    layout.nodeCount = (rest - leafBytes - 40) / kNodeAndLookupBytes;
    if (layout.fileBytes() != bytes.size() || layout.nodeCount == 0) {
        return failAt(
            ErrorCode::Truncated, bytes.size(), "tree",
            fmt::format("{} bytes are left for the tree: no whole number of 12-byte nodes beside 40 bytes of "
                        "sizes; the file is cut or has bytes too many",
                        rest - leafBytes));
    }
    return layout;
}

Result<void> checkSizes(std::span<const std::byte> bytes, const Layout& layout) {
    const std::uint64_t treeBytes = 12 * layout.nodeCount + 4 * layout.leafCount;
    PFVOX_CHECK(expectSize(bytes, layout.sizes(), "svoSize", 56 + treeBytes));
    PFVOX_CHECK(expectSize(bytes, layout.sizes() + 8, "blockSize", 48 + treeBytes));
    PFVOX_CHECK(expectSize(bytes, layout.lookupSize(), "lookupSize", 4 * layout.nodeCount));
    PFVOX_CHECK(expectSize(bytes, layout.page(), "pageSize", 24 + 8 * layout.nodeCount));
    PFVOX_CHECK(expectSize(bytes, layout.page() + 16, "childDescriptorsSize", 8 * layout.nodeCount));
    PFVOX_CHECK(expectSize(bytes, layout.farSize(), "farPointersSize", 0));
    if (valueAt<std::uint32_t>(bytes, layout.header()) != layout.leafCount) {
        return failAt(ErrorCode::BadStructure, layout.header(), "voxelCount",
                      fmt::format("is {}, but {} leaf cubes have a material",
                                  valueAt<std::uint32_t>(bytes, layout.header()), layout.leafCount));
    }
    if (valueAt<std::uint32_t>(bytes, layout.page() + 8) != 2 * layout.nodeCount ||
        valueAt<std::uint32_t>(bytes, layout.page() + 12) != 3 * layout.nodeCount) {
        return failAt(ErrorCode::BadStructure, layout.page() + 8, "page pointers",
                      fmt::format("do not follow from {} nodes", layout.nodeCount));
    }
    return {};
}

Result<void> readPlacement(std::span<const std::byte> bytes, const Layout& layout, LegacyFile& file,
                           const Limits& limits) {
    file.depth = valueAt<std::uint32_t>(bytes, layout.header() + 4);
    if (file.depth == 0 || file.depth > limits.maxModelDepth) {
        return failAt(file.depth == 0 ? ErrorCode::BadValue : ErrorCode::LimitExceeded, layout.header() + 4,
                      "depth",
                      fmt::format("{} octree levels; 1 to {} are possible (maxModelDepth)", file.depth,
                                  limits.maxModelDepth));
    }
    const auto lower = valueAt<glm::vec3>(bytes, layout.header() + 8);
    if (lower != glm::vec3{0.0f}) {
        return failAt(ErrorCode::BadValue, layout.header() + 8, "AABB", "the lower corner is not zero");
    }
    file.extent = valueAt<glm::vec3>(bytes, layout.header() + 20);
    const auto center = valueAt<glm::vec3>(bytes, layout.header() + 32);
    constexpr float kLargestOrigin = 16777216.0f;  // beyond it float32 cannot tell voxels apart
    for (int axis = 0; axis < 3; ++axis) {
        if (!(std::abs(center[axis]) <= kLargestOrigin) || center[axis] != std::floor(center[axis])) {
            return failAt(ErrorCode::BadValue, layout.header() + 32, "center",
                          fmt::format("{} is no voxel position", center[axis]));
        }
    }
    file.originSwapped = glm::ivec3{center};
    return {};
}

tl::unexpected<Error> badNode(const Layout& layout, std::size_t index, std::string message) {
    return failAt(ErrorCode::BadStructure, layout.nodes() + 8 * index, fmt::format("node {}", index),
                  std::move(message));
}

/// The two pointers of every node follow from the masks before it. Demanding that makes the nodes a tree: no
/// cycle, no node shared and none left over.
Result<void> checkTree(const LegacyFile& file, const std::vector<std::uint32_t>& lookups,
                       const Layout& layout) {
    std::vector<std::uint8_t> level(file.nodes.size(),
                                    1);  // of a node's children; those of the root are at 1
    std::uint64_t firstChild = 1;
    std::uint64_t firstLeaf = 0;
    for (std::size_t i = 0; i < file.nodes.size(); ++i) {
        const Node& node = file.nodes[i];
        if (node.validMask == 0 || (node.leafMask & ~node.validMask) != 0 || node.unused != 0) {
            return badNode(
                layout, i,
                fmt::format("masks {:#04x} and {:#04x} do not fit together", node.leafMask, node.validMask));
        }
        if (i + std::uint64_t{node.childPointer} != firstChild) {
            return badNode(layout, i,
                           fmt::format("its children are at {}, expected at {}",
                                       i + std::uint64_t{node.childPointer}, firstChild));
        }
        const std::uint32_t lookup = lookups[i];
        if ((lookup & 0xffu) != node.leafMask || (node.leafMask != 0 && (lookup >> 8) != firstLeaf)) {
            return badNode(layout, i, fmt::format("its lookup word {:#010x} does not fit", lookup));
        }
        const auto innerMask = static_cast<std::uint8_t>(node.validMask & ~node.leafMask);
        const auto innerCount = static_cast<std::uint64_t>(std::popcount(innerMask));
        if (innerCount != 0 && level[i] >= file.depth) return badNode(layout, i, "lies below the last level");
        if (firstChild + innerCount > file.nodes.size()) {
            return badNode(layout, i, fmt::format("child {} does not exist", file.nodes.size()));
        }
        for (std::uint64_t c = 0; c < innerCount; ++c) {
            level[static_cast<std::size_t>(firstChild + c)] = static_cast<std::uint8_t>(level[i] + 1);
        }
        firstChild += innerCount;
        firstLeaf += static_cast<std::uint64_t>(std::popcount(node.leafMask));
    }
    if (firstChild != file.nodes.size() || firstLeaf != file.leafMaterials.size()) {
        return failAt(ErrorCode::BadStructure, layout.nodes(), "tree",
                      fmt::format("the masks ask for {} nodes and {} leaf cubes; the file has {} and {}",
                                  firstChild, firstLeaf, file.nodes.size(), file.leafMaterials.size()));
    }
    return {};
}

}  // namespace

bool looksLikeLegacy(std::span<const std::byte> bytes) {
    if (bytes.size() < kFixedBytes + kMaterialBytes) return false;
    const auto materialBytes = valueAt<std::uint32_t>(bytes, 0);
    const Layout layout{.materialCount = materialBytes / kMaterialBytes};
    if (materialBytes == 0 || materialBytes % kMaterialBytes != 0 || layout.sizes() > bytes.size())
        return false;
    return valueAt<glm::vec3>(bytes, layout.header() + 8) == glm::vec3{0.0f};
}

Result<LegacyFile> parseLegacy(std::span<const std::byte> bytes, const Limits& limits) {
    PFVOX_TRY(const Layout, layout, measure(bytes, limits));
    PFVOX_CHECK(checkSizes(bytes, layout));
    LegacyFile file;
    PFVOX_CHECK(readPlacement(bytes, layout, file, limits));
    file.materials = arrayAt<Material>(bytes, 4, layout.materialCount);
    file.leafMaterials = arrayAt<std::uint32_t>(bytes, layout.leafMaterials(), layout.leafCount);
    file.nodes = arrayAt<Node>(bytes, layout.nodes(), layout.nodeCount);
    for (std::size_t i = 0; i < file.leafMaterials.size(); ++i) {
        if (file.leafMaterials[i] >= file.materials.size()) {
            return failAt(ErrorCode::BadReference, layout.leafMaterials() + 4 * i, "attachments",
                          fmt::format("material {} does not exist; there are {}", file.leafMaterials[i],
                                      file.materials.size()));
        }
    }
    const auto lookups = arrayAt<std::uint32_t>(bytes, layout.lookupSize() + 8, layout.nodeCount);
    PFVOX_CHECK(checkTree(file, lookups, layout));
    return file;
}

}  // namespace pfvox::import::legacy

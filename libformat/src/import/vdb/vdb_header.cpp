#include "import/vdb/vdb_header.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "import/vdb/vdb_fields.hpp"
#include "import/vdb/vdb_tree_check.hpp"

namespace pfvox::import::vdb {

namespace {

constexpr std::uint32_t kNewestVersionOfLibrary = 224;
constexpr std::uint64_t kUuidBytes = 36;
constexpr std::uint64_t kSmallestDescriptorBytes = 3 * 4 + 3 * 8;
constexpr std::string_view kHalfFloatSuffix = "_HalfFloat";
constexpr char kSuffixSeparator = '\x1e';

/// Bytes of the linear transforms; matrices and vectors of doubles.
constexpr std::array<std::pair<std::string_view, std::uint64_t>, 7> kTransformBytes{
    {{"AffineMap", 128},
     {"UnitaryMap", 128},
     {"ScaleMap", 120},
     {"UniformScaleMap", 120},
     {"TranslationMap", 24},
     {"ScaleTranslateMap", 144},
     {"UniformScaleTranslateMap", 144}}};

struct Prelude {
    bool hasGridOffsets = false;
    std::uint32_t gridCount = 0;
};

Result<Prelude> readPrelude(Fields& fields, VdbHeader& header, const Limits& limits,
                            Diagnostics& diagnostics) {
    PFVOX_TRY(const auto, magic, fields.read<std::int64_t>("header"));
    if (magic != kMagic) return failAt(ErrorCode::BadMagic, 0, "header", "this is not an OpenVDB file");
    PFVOX_TRY(const auto, version, fields.read<std::uint32_t>("header"));
    if (version < kOldestFileVersion || version > kNewestFileVersion) {
        return failAt(
            ErrorCode::UnsupportedVersion, 8, "header",
            fmt::format(
                "file version {}; {} to {} can be read: save the file with another version of OpenVDB",
                version, kOldestFileVersion, kNewestFileVersion));
    }
    if (version > kNewestVersionOfLibrary) {
        diagnostics.warn("vdb-newer-version",
                         fmt::format("file version {} is newer than {}, which OpenVDB 10 writes", version,
                                     kNewestVersionOfLibrary));
    }
    PFVOX_TRY(const auto, major, fields.read<std::uint32_t>("header"));
    PFVOX_TRY(const auto, minor, fields.read<std::uint32_t>("header"));
    PFVOX_TRY(const auto, hasOffsets, fields.read<std::uint8_t>("header"));
    PFVOX_CHECK(fields.take(kUuidBytes, "header"));
    PFVOX_CHECK(fields.skipMetadata("file metadata"));
    header.fileVersion = version;
    header.libraryMajor = major;
    header.libraryMinor = minor;

    const std::uint64_t countAt = fields.offset();
    PFVOX_TRY(const auto, count, fields.read<std::int32_t>("grid count"));
    if (count < 0) return failAt(ErrorCode::BadValue, countAt, "grid count", fmt::format("{} grids", count));
    const Prelude prelude{.hasGridOffsets = hasOffsets != 0, .gridCount = static_cast<std::uint32_t>(count)};
    if (prelude.gridCount > limits.maxModels) {
        return failAt(ErrorCode::LimitExceeded, countAt, "grid count",
                      fmt::format("{} grids, more than maxModels = {}", count, limits.maxModels));
    }
    if (prelude.gridCount > fields.remaining() / kSmallestDescriptorBytes) {
        return failAt(
            ErrorCode::Truncated, countAt, "grid count",
            fmt::format("{} grids announced, {} bytes left in the file", count, fields.remaining()));
    }
    return prelude;
}

std::string displayNameOf(const std::string& uniqueName) {
    const std::size_t separator = uniqueName.find(kSuffixSeparator);
    if (separator == std::string::npos) return uniqueName;
    return fmt::format("{}[{}]", uniqueName.substr(0, separator), uniqueName.substr(separator + 1));
}

/// Names and type; the offsets follow.
Result<GridDescriptor> readNames(Fields& fields) {
    GridDescriptor grid;
    grid.descriptorPos = fields.offset();
    PFVOX_TRY(auto, name, fields.readString("grid name"));
    PFVOX_TRY(auto, type, fields.readString("grid type"));
    PFVOX_TRY(auto, parent, fields.readString("grid instance parent"));
    grid.displayName = displayNameOf(name);
    grid.uniqueName = std::move(name);
    grid.isHalf = type.ends_with(kHalfFloatSuffix);
    grid.type = grid.isHalf ? type.substr(0, type.size() - kHalfFloatSuffix.size()) : type;
    grid.instanceParent = std::move(parent);
    return grid;
}

Result<void> readOffsets(Fields& fields, std::span<const std::byte> bytes, GridDescriptor& grid) {
    const std::uint64_t at = fields.offset();
    PFVOX_TRY(const auto, gridPos, fields.read<std::uint64_t>("grid offsets"));
    PFVOX_TRY(const auto, blockPos, fields.read<std::uint64_t>("grid offsets"));
    PFVOX_TRY(const auto, endPos, fields.read<std::uint64_t>("grid offsets"));
    const bool hasTree = grid.instanceParent.empty();
    if (gridPos < fields.offset() || endPos < gridPos ||
        (hasTree && (blockPos < gridPos || endPos < blockPos))) {
        return failAt(ErrorCode::BadValue, at, "grid offsets",
                      fmt::format("{}, {}, {} of grid \"{}\" do not ascend", gridPos, blockPos, endPos,
                                  grid.displayName));
    }
    if (endPos > bytes.size()) {
        return failAt(ErrorCode::Truncated, at, "grid offsets",
                      fmt::format("grid \"{}\" reaches to byte {}, the file has {}", grid.displayName, endPos,
                                  bytes.size()));
    }
    grid.gridPos = gridPos;
    grid.endPos = endPos;
    return {};
}

/// What precedes the tree: compression flags, metadata, transform.
Result<void> readGridHead(std::span<const std::byte> bytes, GridDescriptor& grid) {
    Fields fields(bytes.first(static_cast<std::size_t>(grid.endPos)), grid.gridPos);
    PFVOX_TRY(const auto, compression, fields.read<std::uint32_t>("grid compression"));
    grid.compression = compression;
    PFVOX_TRY(auto, own, fields.readMetadata("grid metadata"));
    grid.own = std::move(own);
    PFVOX_TRY(auto, transform, fields.readString("grid transform"));
    grid.transformType = std::move(transform);
    for (const auto& [type, size] : kTransformBytes) {
        if (type != grid.transformType) continue;
        PFVOX_CHECK(fields.take(size, "grid transform"));
        grid.treePos = fields.offset();
    }
    return {};
}

/// Without offsets a grid begins right behind its descriptor and ends where its tree does.
Result<void> locateStreamed(Fields& fields, std::span<const std::byte> bytes, GridDescriptor& grid,
                            const Limits& limits) {
    PFVOX_CHECK(fields.take(3 * sizeof(std::uint64_t), "grid offsets"));
    grid.gridPos = fields.offset();
    grid.endPos = bytes.size();
    PFVOX_CHECK(readGridHead(bytes, grid));
    if (grid.treePos == 0) {
        return failAt(
            ErrorCode::UnsupportedFeature, grid.gridPos, "grid transform",
            fmt::format(
                "grid \"{}\" has a transform of type {}; in a file without grid offsets it cannot be skipped",
                grid.displayName, grid.transformType));
    }
    PFVOX_TRY(const auto, end, checkTree(bytes, grid, limits));
    grid.endPos = end;
    return {};
}

}  // namespace

std::string GridDescriptor::plainName() const {
    return uniqueName.substr(0, uniqueName.find(kSuffixSeparator));
}

std::string_view GridDescriptor::ownText(std::string_view key) const {
    const auto entry = own.find(key);
    return entry == own.end() ? std::string_view{} : std::string_view(entry->second);
}

Result<VdbHeader> parseVdbHeader(std::span<const std::byte> bytes, const Limits& limits,
                                 Diagnostics& diagnostics) {
    VdbHeader header;
    Fields fields(bytes, 0);
    PFVOX_TRY(const Prelude, prelude, readPrelude(fields, header, limits, diagnostics));
    for (std::uint32_t i = 0; i < prelude.gridCount; ++i) {
        PFVOX_TRY(auto, grid, readNames(fields));
        if (prelude.hasGridOffsets) {
            PFVOX_CHECK(readOffsets(fields, bytes, grid));
            PFVOX_CHECK(readGridHead(bytes, grid));
        } else {
            PFVOX_CHECK(locateStreamed(fields, bytes, grid, limits));
        }
        fields = Fields(bytes, grid.endPos);
        header.grids.push_back(std::move(grid));
    }
    return header;
}

}  // namespace pfvox::import::vdb

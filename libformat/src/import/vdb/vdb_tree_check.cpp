#include "import/vdb/vdb_tree_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "import/vdb/vdb_fields.hpp"

namespace pfvox::import::vdb {

namespace {

constexpr std::uint32_t kZip = 1;
constexpr std::uint32_t kActiveMask = 2;
constexpr std::uint32_t kBlosc = 4;

constexpr std::uint64_t kUpperValues = 32 * 32 * 32;
constexpr std::uint64_t kLowerValues = 16 * 16 * 16;
constexpr std::uint64_t kLeafValues = 8 * 8 * 8;
constexpr std::int32_t kUpperEdge = 4096;
constexpr std::uint64_t kNodeOverheadBytes = 128;

/// The byte before the values of a node: how its inactive values are stored.
enum InactiveValues : std::uint8_t {
    kOneExplicit = 2,
    kMaskOnly = 3,
    kMaskAndOne = 4,
    kMaskAndTwo = 5,
    kAllStored = 6,
};

struct ValueType {
    std::string_view name;
    std::uint32_t bytes;
    std::uint32_t halfBytes;  ///< when stored as half floats
};
constexpr std::array<ValueType, 8> kValueTypes{{{"float", 4, 2},
                                                {"double", 8, 2},
                                                {"bool", 1, 1},
                                                {"mask", 1, 1},
                                                {"int32", 4, 4},
                                                {"int64", 8, 8},
                                                {"vec3s", 12, 6},
                                                {"vec3d", 24, 6}}};

std::optional<ValueType> valueTypeOf(const GridDescriptor& grid) {
    for (const ValueType& type : kValueTypes) {
        if (grid.type == fmt::format("Tree_{}_5_4_3", type.name)) return type;
    }
    return std::nullopt;
}

std::uint64_t countBits(std::span<const std::byte> mask) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < mask.size(); i += sizeof(std::uint64_t)) {
        std::uint64_t word;
        std::memcpy(&word, mask.data() + i, sizeof(word));
        count += static_cast<std::uint64_t>(std::popcount(word));
    }
    return count;
}

class TreeCheck {
  public:
    TreeCheck(std::span<const std::byte> bytes, const GridDescriptor& grid, ValueType value,
              const Limits& limits)
        : fields_(bytes, grid.treePos), grid_(grid), value_(value), limits_(limits) {}

    Result<std::uint64_t> run() {
        const std::uint64_t start = fields_.offset();
        PFVOX_TRY(const auto, bufferCount, fields_.read<std::int32_t>("tree"));
        if (bufferCount != 1)
            return failAt(ErrorCode::BadValue, start, "tree", fmt::format("{} buffers", bufferCount));
        PFVOX_CHECK(checkRoot());
        for (std::uint64_t leaf = 0; leaf < leafCount_; ++leaf) PFVOX_CHECK(checkLeafBuffer());
        return fields_.offset();
    }

  private:
    Result<void> checkRoot() {
        PFVOX_CHECK(fields_.take(value_.bytes, "tree background"));
        PFVOX_TRY(const auto, tileCount, fields_.read<std::uint32_t>("tree root"));
        PFVOX_TRY(const auto, childCount, fields_.read<std::uint32_t>("tree root"));
        for (std::uint32_t i = 0; i < tileCount; ++i) {
            PFVOX_CHECK(readOrigin());
            PFVOX_CHECK(fields_.take(value_.bytes + 1, "tree root tile"));
        }
        for (std::uint32_t i = 0; i < childCount; ++i) {
            PFVOX_CHECK(readOrigin());
            PFVOX_CHECK(checkUpper());
        }
        std::ranges::sort(origins_);
        if (std::ranges::adjacent_find(origins_) != origins_.end()) {
            return failAt(ErrorCode::BadStructure, grid_.treePos, "tree root", "two entries have one place");
        }
        return {};
    }

    Result<void> readOrigin() {
        const std::uint64_t at = fields_.offset();
        using Origin = std::array<std::int32_t, 3>;
        PFVOX_TRY(const auto, origin, fields_.read<Origin>("tree root"));
        for (const std::int32_t c : origin) {
            if (c % kUpperEdge != 0) {
                return failAt(ErrorCode::BadValue, at, "tree root", fmt::format("an entry begins at {}", c));
            }
        }
        origins_.push_back(origin);
        return {};
    }

    Result<void> checkUpper() {
        PFVOX_TRY(const auto, children, checkInternal(kUpperValues));
        for (std::uint64_t i = 0; i < children; ++i) {
            PFVOX_TRY(const auto, leaves, checkInternal(kLowerValues));
            PFVOX_CHECK(account(leaves * (kLeafValues * value_.bytes + kNodeOverheadBytes)));
            PFVOX_CHECK(fields_.take(leaves * kLeafValues / 8, "tree leaf masks"));
            leafCount_ += leaves;
        }
        return {};
    }

    /// Masks and tile values of an internal node; returns the number of its children.
    Result<std::uint64_t> checkInternal(std::uint64_t valueCount) {
        PFVOX_TRY(const auto, childMask, fields_.take(valueCount / 8, "tree node masks"));
        PFVOX_TRY(const auto, valueMask, fields_.take(valueCount / 8, "tree node masks"));
        PFVOX_CHECK(account(valueCount * std::max<std::uint64_t>(8, value_.bytes) + kNodeOverheadBytes));
        PFVOX_CHECK(checkValues(valueCount, valueMask));
        return countBits(childMask);
    }

    Result<void> checkLeafBuffer() {
        PFVOX_TRY(const auto, mask, fields_.take(kLeafValues / 8, "leaf buffer"));
        constexpr std::uint64_t kOriginBytes = 12;
        if (value_.name == "mask") return skip(kOriginBytes);
        if (value_.name == "bool") return skip(kOriginBytes + kLeafValues / 8);
        return checkValues(kLeafValues, mask);
    }

    Result<void> skip(std::uint64_t count) {
        PFVOX_CHECK(fields_.take(count, "leaf buffer"));
        return {};
    }

    Result<void> checkValues(std::uint64_t valueCount, std::span<const std::byte> valueMask) {
        const std::uint64_t at = fields_.offset();
        PFVOX_TRY(const auto, inactive, fields_.read<std::uint8_t>("node values"));
        if (inactive > kAllStored) {
            return failAt(ErrorCode::BadValue, at, "node values",
                          fmt::format("unknown storage {}", inactive));
        }
        if (inactive == kOneExplicit || inactive == kMaskAndOne)
            PFVOX_CHECK(fields_.take(value_.bytes, "node values"));
        if (inactive == kMaskAndTwo) PFVOX_CHECK(fields_.take(2 * value_.bytes, "node values"));
        if (inactive == kMaskOnly || inactive == kMaskAndOne || inactive == kMaskAndTwo) {
            PFVOX_CHECK(fields_.take(valueCount / 8, "node values"));
        }
        const bool onlyActive = (grid_.compression & kActiveMask) != 0 && inactive != kAllStored;
        return checkBlock(onlyActive ? countBits(valueMask) : valueCount);
    }

    /// One run of stored values. Compressed ones have a size before them; zero or less means stored as they
    /// are, and OpenVDB reads that many bytes without looking at its buffer.
    Result<void> checkBlock(std::uint64_t count) {
        const bool halved = grid_.isHalf && value_.halfBytes != value_.bytes;
        const std::uint64_t rawBytes = count * (grid_.isHalf ? value_.halfBytes : value_.bytes);
        if (halved && count == 0) return {};
        if ((grid_.compression & (kZip | kBlosc)) == 0) {
            PFVOX_CHECK(fields_.take(rawBytes, "node values"));
            return {};
        }
        const std::uint64_t at = fields_.offset();
        PFVOX_TRY(const auto, stored, fields_.read<std::int64_t>("compressed values"));
        if (stored <= 0) {
            if (static_cast<std::uint64_t>(-(stored + 1)) + 1 != rawBytes &&
                !(stored == 0 && rawBytes == 0)) {
                return failAt(ErrorCode::BadStructure, at, "compressed values",
                              fmt::format("{} bytes stored for {}", stored, rawBytes));
            }
            PFVOX_CHECK(fields_.take(rawBytes, "compressed values"));
            return {};
        }
        PFVOX_TRY(const auto, block, fields_.take(static_cast<std::uint64_t>(stored), "compressed values"));
        if ((grid_.compression & kBlosc) == 0) return {};
        return checkBlosc(block, rawBytes, at);
    }

    /// Blosc believes the sizes in the header of a block.
    static Result<void> checkBlosc(std::span<const std::byte> block, std::uint64_t rawBytes,
                                   std::uint64_t at) {
        const auto sizes = readBloscSizes(block);
        if (sizes && sizes->rawBytes == rawBytes && sizes->packedBytes == block.size()) return {};
        return failAt(ErrorCode::BadStructure, at, "compressed values",
                      fmt::format("a blosc block of {} bytes for {} has other sizes in its header",
                                  block.size(), rawBytes));
    }

    Result<void> account(std::uint64_t bytes) {
        memoryBytes_ += bytes;
        if (memoryBytes_ <= limits_.maxMemoryBytes) return {};
        return failAt(
            ErrorCode::LimitExceeded, fields_.offset(), "tree",
            fmt::format("it takes more than {} bytes of memory (maxMemoryBytes)", limits_.maxMemoryBytes));
    }

    Fields fields_;
    const GridDescriptor& grid_;
    ValueType value_;
    const Limits& limits_;
    std::vector<std::array<std::int32_t, 3>> origins_;
    std::uint64_t leafCount_ = 0;
    std::uint64_t memoryBytes_ = 0;
};

}  // namespace

Result<std::uint64_t> checkTree(std::span<const std::byte> bytes, const GridDescriptor& grid,
                                const Limits& limits) {
    if (!grid.instanceParent.empty()) return grid.treePos;
    const auto value = valueTypeOf(grid);
    if (!value) {
        return fail(
            ErrorCode::UnsupportedFeature,
            fmt::format("grid \"{}\" is of type {}, which cannot be read", grid.displayName, grid.type));
    }
    auto end = TreeCheck(bytes, grid, *value, limits).run();
    if (!end) {
        Error error = std::move(end).error();
        error.context = fmt::format("grid \"{}\", {}", grid.displayName, error.context);
        return tl::make_unexpected(std::move(error));
    }
    return end;
}

}  // namespace pfvox::import::vdb

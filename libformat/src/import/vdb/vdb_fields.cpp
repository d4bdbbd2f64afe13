#include "import/vdb/vdb_fields.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace pfvox::import::vdb {

namespace {

/// OpenVDB reads values of these types by their own size, whatever the size field says.
constexpr std::array<std::pair<std::string_view, std::uint32_t>, 13> kFixedSizes{{{"bool", 1},
                                                                                  {"int32", 4},
                                                                                  {"float", 4},
                                                                                  {"int64", 8},
                                                                                  {"double", 8},
                                                                                  {"vec2i", 8},
                                                                                  {"vec2s", 8},
                                                                                  {"vec2d", 16},
                                                                                  {"vec3i", 12},
                                                                                  {"vec3s", 12},
                                                                                  {"vec3d", 24},
                                                                                  {"mat4s", 64},
                                                                                  {"mat4d", 128}}};

/// The index that File::write adds for delayed loading. We load nothing late, but OpenVDB unpacks it all the
/// same, and allocates what it says.
constexpr std::string_view kDelayedLoadType = "__delayedload";
/// A leaf node takes at least this much in the file.
constexpr std::uint64_t kSmallestLeafBytes = 64;

/// One array of the index: its packed size (0 = stored as it is) and the bytes. Blosc believes its own
/// header, and short arrays are padded before packing.
bool isSoundArray(io::ByteCursor& value, std::uint32_t packedBytes, std::uint64_t rawBytes) {
    constexpr std::uint64_t kPaddedBytes = 128;
    if (packedBytes == 0) return value.take(rawBytes).has_value();
    const auto block = value.take(packedBytes);
    if (!block) return false;
    const auto sizes = readBloscSizes(*block);
    if (!sizes || sizes->packedBytes != packedBytes) return false;
    return sizes->rawBytes == rawBytes || (rawBytes < kPaddedBytes && sizes->rawBytes == kPaddedBytes);
}

/// A byte and, unless left out, a 64-bit size for each leaf node.
bool isSoundDelayedLoad(io::ByteCursor value, std::uint64_t fileBytesLeft) {
    constexpr std::uint32_t kNoSizes = 0xffffffffu;
    if (value.remaining() == 0) return true;
    const auto leaves = value.read<std::uint32_t>();
    if (!leaves || *leaves > fileBytesLeft / kSmallestLeafBytes) return false;
    const auto packedMasks = value.read<std::uint32_t>();
    if (!packedMasks || !isSoundArray(value, *packedMasks, *leaves)) return false;
    const auto packedSizes = value.read<std::uint32_t>();
    if (!packedSizes) return false;
    return *packedSizes == kNoSizes || isSoundArray(value, *packedSizes, std::uint64_t{8} * *leaves);
}

}  // namespace

Result<std::span<const std::byte>> Fields::take(std::uint64_t count, const char* context) {
    const std::uint64_t at = offset();
    if (const auto part = cursor_.take(count)) return *part;
    return failAt(
        ErrorCode::Truncated, at, context,
        fmt::format("{} bytes announced, {} left in the file or the grid", count, cursor_.remaining()));
}

Result<std::string> Fields::readString(const char* context) {
    PFVOX_TRY(const auto, length, read<std::uint32_t>(context));
    PFVOX_TRY(const auto, text, take(length, context));
    return std::string(io::asText(text));
}

Result<void> Fields::skipMetadata(const char* context) {
    PFVOX_CHECK(readMetadata(context));
    return {};
}

Result<OwnMetadata> Fields::readMetadata(const char* context) {
    OwnMetadata own;
    PFVOX_TRY(const auto, count, read<std::int32_t>(context));
    for (std::int32_t i = 0; i < count; ++i) {
        PFVOX_TRY(auto, name, readString(context));
        PFVOX_TRY(const auto, type, readString(context));
        PFVOX_TRY(const auto, size, read<std::uint32_t>(context));
        PFVOX_CHECK(checkValue(name, type, size));
        PFVOX_TRY(const auto, value, take(size, context));
        if (type == "string" && name.starts_with(metadata::kPrefix)) {
            own.insert_or_assign(std::move(name), std::string(io::asText(value)));
        }
    }
    return own;
}

Result<void> Fields::checkValue(const std::string& name, const std::string& type, std::uint32_t size) const {
    for (const auto& [fixedType, fixedSize] : kFixedSizes) {
        if (type == fixedType && size != fixedSize) {
            return failAt(ErrorCode::BadValue, offset(), "metadata " + name,
                          fmt::format("{} bytes for a value of type {}", size, type));
        }
    }
    if (type != kDelayedLoadType) return {};
    auto rest = cursor_;
    const auto value = rest.sub(size);
    if (value && isSoundDelayedLoad(*value, cursor_.remaining())) return {};
    return failAt(ErrorCode::BadStructure, offset(), "metadata " + name, "its sizes contradict each other");
}

std::optional<BloscSizes> readBloscSizes(std::span<const std::byte> block) {
    io::ByteCursor header(block);
    const auto versionsAndFlags = header.read<std::uint32_t>();
    const auto rawBytes = header.read<std::uint32_t>();
    const auto splitBytes = header.read<std::uint32_t>();
    const auto packedBytes = header.read<std::uint32_t>();
    if (!versionsAndFlags || !rawBytes || !splitBytes || !packedBytes) return std::nullopt;
    return BloscSizes{.rawBytes = *rawBytes, .packedBytes = *packedBytes};
}

}  // namespace pfvox::import::vdb

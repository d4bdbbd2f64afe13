// Layout of what PF_VOX and PF_PROBE files have in common, byte for byte: header, then the section table,
// then sections. docs/format-pf_vox.md says the same in words; change both or none.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace pfvox::layout {

inline constexpr std::uint32_t kEndianTag = 0x01020304u;
inline constexpr std::uint64_t kAlignment = 64;
inline constexpr std::uint32_t kNoRegion = 0xffffffffu;
inline constexpr std::uint32_t kSectionMustUnderstand = 1u << 0;
enum class Codec : std::uint32_t { Raw = 0, Zstd = 1 };

struct Header {
    std::array<std::uint8_t, 8> magic;
    std::uint16_t versionMajor;
    std::uint16_t versionMinor;
    std::uint32_t endianTag;
    std::uint32_t requiredFeatures;
    std::uint32_t optionalFeatures;
    std::uint32_t tableOffset;
    std::uint32_t sectionCount;
    std::uint64_t fileBytes;
    std::uint64_t headHash;  ///< xxh3-64 of header (with this field 0) and section table
    std::array<std::uint8_t, 16> contentKey;
};
static_assert(sizeof(Header) == 64 && offsetof(Header, fileBytes) == 32 &&
              offsetof(Header, contentKey) == 48);

struct Section {
    std::array<char, 4> fourcc;
    std::uint32_t flags;
    Codec codec;
    std::uint32_t region;  ///< kNoRegion for sections of the whole file
    std::uint64_t offset;
    std::uint64_t storedBytes;
    std::uint64_t rawBytes;
    std::uint64_t count;    ///< records, nodes or values
    std::uint64_t rawHash;  ///< xxh3-64 of the raw bytes
    std::uint64_t reserved;
};
static_assert(sizeof(Section) == 64 && offsetof(Section, offset) == 16 && offsetof(Section, rawHash) == 48);

}  // namespace pfvox::layout

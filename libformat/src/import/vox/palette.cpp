#include "import/vox/palette.hpp"

#include <fmt/format.h>
#include <bitset>

namespace pfvox::import::vox {

Palette defaultPalette() {
    Palette palette{};
    std::size_t next = 1;
    for (int red = 0xff; red >= 0; red -= 0x33) {
        for (int green = 0xff; green >= 0; green -= 0x33) {
            for (int blue = 0xff; blue >= 0; blue -= 0x33) {
                if (red + green + blue == 0) continue;
                palette[next++] = {red, green, blue, 0xff};
            }
        }
    }
    constexpr std::array<std::uint8_t, 10> kRamp{0xee, 0xdd, 0xbb, 0xaa, 0x88, 0x77, 0x55, 0x44, 0x22, 0x11};
    constexpr std::array<std::array<std::uint8_t, 3>, 4> kHues{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}};
    for (const auto& [red, green, blue] : kHues) {
        for (const std::uint8_t level : kRamp) {
            palette[next++] = {level * red, level * green, level * blue, 0xff};
        }
    }
    return palette;
}

Result<Palette> readPalette(Chunk& chunk) {
    constexpr std::size_t kUsedEntries = kPaletteSize - 1;
    PFVOX_TRY(const std::span<const std::byte>, bytes, chunk.readBytes(kUsedEntries * 4, "the palette"));
    Palette palette{};
    std::memcpy(&palette[1], bytes.data(), bytes.size());
    return palette;
}

void checkIndexMap(Chunk& chunk, Diagnostics& diagnostics) {
    const auto map = chunk.readBytes(kPaletteSize, "the index map");
    std::bitset<kPaletteSize> shown;
    if (map) {
        for (const std::byte index : *map) shown.set(std::to_integer<std::size_t>(index));
    }
    if (shown.all()) return;
    diagnostics.report(
        {.severity = Severity::Warning,
         .id = "vox-imap-invalid",
         .message = "chunk IMAP is no permutation of the 256 palette entries; colors do not depend on it",
         .offsetBytes = chunk.offsetBytes()});
}

}  // namespace pfvox::import::vox

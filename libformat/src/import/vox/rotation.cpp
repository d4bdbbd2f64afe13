#include "import/vox/rotation.hpp"

namespace pfvox::import::vox {

std::optional<Rotation> decodeRotation(std::int32_t byte) {
    if (byte < 0 || byte > 127) return std::nullopt;
    const auto bits = static_cast<std::uint32_t>(byte);
    const auto first = static_cast<std::uint8_t>(bits & 3u);
    const auto second = static_cast<std::uint8_t>((bits >> 2) & 3u);
    if (first == 3 || second == 3 || first == second) return std::nullopt;
    const auto signOf = [bits](unsigned row) {
        return static_cast<std::int8_t>((bits >> (4 + row)) & 1u ? -1 : 1);
    };
    return Rotation{.column = {first, second, static_cast<std::uint8_t>(3 - first - second)},
                    .sign = {signOf(0), signOf(1), signOf(2)}};
}

}  // namespace pfvox::import::vox

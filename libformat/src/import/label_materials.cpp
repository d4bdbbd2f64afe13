#include "import/label_materials.hpp"

#include <array>

namespace pfvox::import {

Material labelMaterial(std::int64_t label, std::string name) {
    // Steps of the golden angle keep the hues of close numbers far apart. 32-bit fixed point: exact
    // everywhere.
    constexpr std::uint32_t kGoldenStep = 2654435769u;  // 2^32 / golden ratio
    const std::uint32_t turn = static_cast<std::uint32_t>(label) * kGoldenStep;
    const std::uint32_t sextant = static_cast<std::uint32_t>((std::uint64_t{turn} * 6) >> 32);
    const std::uint32_t within = static_cast<std::uint32_t>(((std::uint64_t{turn} * 6) & 0xffffffffu) >> 24);

    constexpr std::uint8_t kHigh = 230;
    constexpr std::uint8_t kLow = 70;
    const auto rising = static_cast<std::uint8_t>(kLow + (kHigh - kLow) * within / 255);
    const auto falling = static_cast<std::uint8_t>(kHigh - (kHigh - kLow) * within / 255);
    const std::array<glm::u8vec4, 6> wheel{{{kHigh, rising, kLow, 255},
                                            {falling, kHigh, kLow, 255},
                                            {kLow, kHigh, rising, 255},
                                            {kLow, falling, kHigh, 255},
                                            {rising, kLow, kHigh, 255},
                                            {kHigh, kLow, falling, 255}}};
    Material material;
    material.baseColor = wheel[sextant];
    material.name = std::move(name);
    return material;
}

}  // namespace pfvox::import

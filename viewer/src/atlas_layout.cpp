#include "atlas_layout.hpp"

#include <algorithm>

namespace pfvox::viewer {

std::optional<std::uint32_t> AtlasLayout::probeAt(glm::dvec2 pixel) const {
    if (pixel.x < 0.0 || pixel.y < 0.0) return std::nullopt;
    const glm::uvec2 place = glm::uvec2(pixel) / cell;
    const std::uint64_t number = place.x + std::uint64_t{columns} * place.y;
    if (place.x >= columns || number >= count) return std::nullopt;
    return first + static_cast<std::uint32_t>(number);
}

std::optional<glm::uvec2> AtlasLayout::cornerOf(std::uint32_t probe) const {
    if (probe < first || probe - first >= count) return std::nullopt;
    const std::uint32_t number = probe - first;
    return cell * glm::uvec2(number % columns, number / columns);
}

AtlasLayout atlasLayout(const PictureSettings& settings, std::uint32_t probes) {
    constexpr std::uint32_t kSmallestCell = 32;
    const std::uint32_t width = settings.width;
    const std::uint32_t height = settings.height;
    const std::uint32_t shortEdge = std::min(width, height);
    if (probes == 0) return {.cell = shortEdge};
    if (settings.atlas.probe >= 0)
        return {.first = std::min(static_cast<std::uint32_t>(settings.atlas.probe), probes - 1),
                .count = 1,
                .cell = shortEdge};
    const auto fits = [&](std::uint32_t cell) {
        return std::uint64_t{width / cell} * (height / cell) >= probes;
    };
    const std::uint32_t least = std::min(kSmallestCell, shortEdge);
    std::uint32_t cell = shortEdge;
    while (cell > least && !fits(cell)) --cell;
    const std::uint32_t perPage = std::max((width / cell) * (height / cell), 1u);
    const std::uint32_t pages = (probes + perPage - 1) / perPage;
    const std::uint32_t page = std::min(settings.atlas.page, pages - 1);
    return {.first = page * perPage,
            .count = std::min(perPage, probes - page * perPage),
            .columns = std::max(width / cell, 1u),
            .cell = cell,
            .page = page,
            .pages = pages};
}

}  // namespace pfvox::viewer

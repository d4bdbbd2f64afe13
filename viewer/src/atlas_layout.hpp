// AtlasLayout: where the maps of probes lie in the pictures of the atlas views.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "picture.hpp"

namespace pfvox::viewer {

/// Squares in rows from the upper left: the probes of one page in the order of their index.
struct AtlasLayout {
    std::uint32_t first = 0;  ///< index of the probe in the upper left
    std::uint32_t count = 0;  ///< of probes on the page
    std::uint32_t columns = 1;
    std::uint32_t cell = 1;   ///< edge of a square, pixels
    std::uint32_t page = 0;   ///< that is seen
    std::uint32_t pages = 1;  ///< that there are

    /// Whose map is at a place in pixels; nothing beside the maps.
    std::optional<std::uint32_t> probeAt(glm::dvec2 pixel) const;
    /// Upper left corner of a probe's map, pixels; nothing when it is on another page.
    std::optional<glm::uvec2> cornerOf(std::uint32_t probe) const;
};

/// The largest squares with which all `probes` fit, but none narrower than 32 pixels: then there are pages.
/// Behind the last page comes none: that is the last one again. One probe that is asked for fills the
/// picture.
AtlasLayout atlasLayout(const PictureSettings& settings, std::uint32_t probes);

}  // namespace pfvox::viewer

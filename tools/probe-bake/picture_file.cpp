#include "probe-bake/picture_file.hpp"

#include <spng.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <pfvox/files.hpp>
#include <vector>

#include "shared/color.glsl.h"

namespace pfvox::tools {

namespace {

std::uint8_t srgbByte(float linear) {
    const float c = std::clamp(std::isfinite(linear) ? linear : 0.0f, 0.0f, 1.0f);
    return static_cast<std::uint8_t>(std::lround(255.0f * shared::srgbFromLinear(c)));
}

struct FreeContext {
    void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
struct FreeBytes {
    void operator()(void* bytes) const { std::free(bytes); }
};

}  // namespace

Result<void> writePicture(const std::filesystem::path& file, glm::uvec2 size,
                          std::span<const glm::vec3> linear) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * linear.size());
    for (const glm::vec3& color : linear)
        for (const float channel : {color.x, color.y, color.z}) bytes.push_back(srgbByte(channel));
    const std::unique_ptr<spng_ctx, FreeContext> context(spng_ctx_new(SPNG_CTX_ENCODER));
    spng_ihdr header{};
    header.width = size.x;
    header.height = size.y;
    header.bit_depth = 8;
    header.color_type = SPNG_COLOR_TYPE_TRUECOLOR;
    spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
    int status = spng_set_ihdr(context.get(), &header);
    if (status == 0)
        status =
            spng_encode_image(context.get(), bytes.data(), bytes.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
    std::size_t pngBytes = 0;
    int fetched = 0;
    const std::unique_ptr<void, FreeBytes> png(
        status == 0 ? spng_get_png_buffer(context.get(), &pngBytes, &fetched) : nullptr);
    if (!png)
        return fail(ErrorCode::Internal,
                    std::string("PNG: ") + spng_strerror(status != 0 ? status : fetched));
    return io::writeFileAtomically(file, {static_cast<const std::byte*>(png.get()), pngBytes});
}

glm::vec3 heatColor(float value) {
    static const std::array<glm::vec3, 5> kStops{{{0.0f, 0.0f, 0.05f},
                                                  {0.02f, 0.08f, 0.45f},
                                                  {0.05f, 0.45f, 0.15f},
                                                  {0.9f, 0.6f, 0.05f},
                                                  {1.0f, 1.0f, 1.0f}}};
    const float at = 4.0f * std::clamp(std::isfinite(value) ? value : 1.0f, 0.0f, 1.0f);
    const auto low = static_cast<std::size_t>(std::min(at, 3.0f));
    return glm::mix(kStops[low], kStops[low + 1], at - static_cast<float>(low));
}

}  // namespace pfvox::tools

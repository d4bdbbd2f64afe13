#include <cmath>
#include <pfvox/probe_maths.hpp>

#include "shared/probe_maths.glsl.h"

namespace pfvox {

static_assert(kDepthMissCode == shared::kDepthMiss);

glm::vec2 octEncode(glm::vec3 direction) {
    return shared::octEncode(direction);
}
glm::vec3 octDecode(glm::vec2 octahedral) {
    return shared::octDecode(octahedral);
}
glm::vec3 directionOfTexel(std::uint32_t x, std::uint32_t y, std::uint32_t edge) {
    return shared::directionOfTexel(x, y, edge);
}
std::uint32_t texelIndex(glm::vec3 direction, std::uint32_t edge) {
    return shared::texelIndex(direction, edge);
}
float texelSolidAngle(std::uint32_t x, std::uint32_t y, std::uint32_t edge) {
    return shared::texelSolidAngle(x, y, edge);
}
glm::ivec2 borderSource(glm::ivec2 texel, int interior) {
    return shared::borderSource(texel, interior);
}

DepthCoder::DepthCoder(const DepthEncoding& encoding)
    : scale_(encoding.scale), logRange_(std::log(encoding.scale * encoding.farMetres + 1.0f)) {}

std::uint32_t DepthCoder::encode(float metres) const {
    return shared::depthCode(metres, scale_, logRange_);
}
float DepthCoder::decode(std::uint32_t code) const {
    return shared::depthOfCode(code, scale_, logRange_);
}

std::uint32_t packDepthNormal(std::uint32_t depthCode, glm::vec3 normal) {
    return shared::packDepthNormal(depthCode, normal);
}
std::uint32_t depthCodeOf(std::uint32_t word) {
    return shared::depthCodeOf(word);
}
glm::vec3 normalOf(std::uint32_t word) {
    return shared::normalOf(word);
}

std::uint32_t packLight(glm::vec3 light) {
    return shared::packLight(light);
}
glm::vec3 unpackLight(std::uint32_t word) {
    return shared::unpackLight(word);
}
std::uint32_t packMoments(glm::vec2 moments) {
    return shared::packMoments(moments);
}
glm::vec2 unpackMoments(std::uint32_t word) {
    return shared::unpackMoments(word);
}

bool seesSurface(std::uint32_t word, glm::vec3 toPoint, glm::vec3 normal, std::uint32_t edge,
                 const DepthCoder& coder) {
    return shared::seesSurface(word, toPoint, normal, edge, coder.scaleAndLogRange());
}

bool mapSeesSurface(std::span<const std::uint32_t> words, glm::vec3 toPoint, glm::vec3 normal,
                    std::uint32_t edge, const DepthCoder& coder) {
    const int last = static_cast<int>(edge) - 1;
    const glm::vec2 at = shared::texelCoordinate(toPoint, edge) - 0.5f;
    const glm::ivec2 low = glm::clamp(glm::ivec2{glm::floor(at)}, -1, last);
    const glm::vec2 fraction = glm::clamp(at - glm::vec2{low}, 0.0f, 1.0f);
    float agreement = 0;
    for (int i = 0; i < 4; ++i) {
        const glm::ivec2 upper{i & 1, i >> 1};
        // Coordinates of a map with border.
        const glm::uvec2 texel{shared::borderSource(low + upper + 1, last + 1)};
        if (!seesSurface(words[texel.x + edge * texel.y], toPoint, normal, edge, coder)) continue;
        const glm::vec2 near = glm::mix(1.0f - fraction, fraction, glm::vec2{upper});
        agreement += near.x * near.y;
    }
    return agreement >= shared::kSurfaceMinAgreement;
}

}  // namespace pfvox

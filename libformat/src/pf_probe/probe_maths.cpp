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

}  // namespace pfvox

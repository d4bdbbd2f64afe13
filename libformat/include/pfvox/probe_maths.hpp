// The maths of probe maps for users of the library. The formulas stand in shaders/shared/probe_maths.glsl.h,
// which shaders include; this is the same code, so that both sides agree. The sources of pfvox itself use
// that header.
//
// Distances in metres, directions and normals of unit length in world space. Nothing here can fail.
#pragma once

#include <pfvox/pf_probe.hpp>
#include <span>

namespace pfvox {

inline constexpr std::uint32_t kDepthMissCode = 65535;  ///< the texel sees no surface

/// Direction -> [-1, 1]^2 and back; +z in the middle.
glm::vec2 octEncode(glm::vec3 direction);
glm::vec3 octDecode(glm::vec2 octahedral);  ///< The unit vector at octahedral coordinates in [-1, 1]^2.
/// Of the center of texel (x, y) of a map of `edge` texels.
glm::vec3 directionOfTexel(std::uint32_t x, std::uint32_t y, std::uint32_t edge);
/// Word index of the texel that a direction falls into.
std::uint32_t texelIndex(glm::vec3 direction, std::uint32_t edge);
/// Steradians; all texels of a map sum to 4 pi.
float texelSolidAngle(std::uint32_t x, std::uint32_t y, std::uint32_t edge);
/// The interior texel that texel (x, y) of a map with border repeats; coordinates count from the border.
glm::ivec2 borderSource(glm::ivec2 texel, int interior);

/// Codes of distances, with what must be computed once.
class DepthCoder {
  public:
    explicit DepthCoder(const DepthEncoding& encoding);  ///< Precondition: scale and far are > 0.
    /// 0 to 65534; distances beyond Far have the code of Far.
    std::uint32_t encode(float metres) const;
    /// Precondition: code != kDepthMissCode.
    float decode(std::uint32_t code) const;
    /// What shaders and shared code take: scale and log(scale * Far + 1).
    glm::vec2 scaleAndLogRange() const { return {scale_, logRange_}; }

  private:
    float scale_;
    float logRange_;
};

/// Word of ProbeLayer::DepthNormal, and its parts.
std::uint32_t packDepthNormal(std::uint32_t depthCode, glm::vec3 normal);
std::uint32_t depthCodeOf(std::uint32_t word);  ///< 0 to 65535; 65535 = miss
glm::vec3 normalOf(std::uint32_t word);         ///< unit; of a DepthNormal word

/// Word of ProbeLayer::Light and Irradiance: R11G11B10F, nearest with ties to even; negative and NaN become
/// 0, what is too large the largest value (65024 red and green, 64512 blue).
std::uint32_t packLight(glm::vec3 light);
glm::vec3 unpackLight(std::uint32_t word);  ///< linear RGB

/// Word of ProbeLayer::Moments.
std::uint32_t packMoments(glm::vec2 moments);
glm::vec2 unpackMoments(std::uint32_t word);  ///< mean of d, mean of d^2

/// Whether a texel sees a surface point: the stored distance agrees within 1 cm and 0.75 texels, seen along
/// the surface, and the stored normal within 26 degrees. `word` is that of texelIndex(toPoint, edge);
/// `toPoint` leads from the probe, which must be active, to the point.
bool seesSurface(std::uint32_t word, glm::vec3 toPoint, glm::vec3 normal, std::uint32_t edge,
                 const DepthCoder& coder);
/// Whether a depth map sees a surface point: of the four texels around its direction, those that see it
/// (seesSurface) have at least 0.45 of the bilinear weight. `words` are the edge^2 of the map, row by row.
bool mapSeesSurface(std::span<const std::uint32_t> words, glm::vec3 toPoint, glm::vec3 normal,
                    std::uint32_t edge, const DepthCoder& coder);

}  // namespace pfvox

#include "probe_detail.hpp"

#include <algorithm>
#include <cmath>
#include <pfvox/probe_maths.hpp>

namespace pfvox::viewer {

namespace {

std::uint32_t pixelOf(const glm::vec3& color) {
    const glm::uvec3 bytes(255.0f * glm::clamp(color, 0.0f, 1.0f) + 0.5f);
    return bytes.r | bytes.g << 8 | bytes.b << 16 | 0xff000000u;
}

/// Every so-manieth texel; a stored border is left out.
template <class Words, class Color>
SmallMap smallMap(const Words& words, std::uint32_t resolution, std::uint32_t border, const Color& colorOf) {
    if (words.empty()) return {};
    const std::uint32_t interior = resolution - 2 * border;
    SmallMap map{.resolution = std::min(interior, kSmallMapResolution), .pixels = {}};
    for (std::uint32_t y = 0; y < map.resolution; ++y) {
        for (std::uint32_t x = 0; x < map.resolution; ++x) {
            const auto at = [&](std::uint32_t i) {
                return border + (2 * i + 1) * interior / (2 * map.resolution);
            };
            map.pixels.push_back(pixelOf(colorOf(words[at(y) * resolution + at(x)])));
        }
    }
    return map;
}

/// Mean over the sphere and largest value; texels of a border do not count.
void addLight(const std::vector<std::uint32_t>& words, std::uint32_t resolution, std::uint32_t border,
              ProbeDetail& detail) {
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    const std::uint32_t interior = resolution - 2 * border;
    for (std::uint32_t y = 0; y < interior; ++y) {
        for (std::uint32_t x = 0; x < interior; ++x) {
            const glm::vec3 light = unpackLight(words[(y + border) * resolution + x + border]);
            const double weight = texelSolidAngle(x, y, interior);
            sum += weight * glm::dvec3(light);
            weights += weight;
            detail.maxLight = glm::max(detail.maxLight, light);
        }
    }
    detail.meanLight = glm::vec3(sum / weights);
}

void addDepth(const std::vector<std::uint32_t>& words, std::uint32_t resolution, const DepthCoder& coder,
              ProbeDetail& detail) {
    std::uint32_t nearest = kDepthMissCode;
    double seen = 0.0;
    double all = 0.0;
    for (std::uint32_t i = 0; i < words.size(); ++i) {
        const std::uint32_t code = depthCodeOf(words[i]);
        const double weight = texelSolidAngle(i % resolution, i / resolution, resolution);
        all += weight;
        if (code == kDepthMissCode) continue;
        seen += weight;
        nearest = std::min(nearest, code);
    }
    detail.surfaceFraction = static_cast<float>(seen / all);
    if (nearest != kDepthMissCode) detail.minDepthMetres = coder.decode(nearest);
}

void addMaps(const ProbeData& data, const ProbeFieldInfo& info, ProbeDetail& detail) {
    const bool hasLight = !data.light.empty();
    const std::vector<std::uint32_t>& light = hasLight ? data.light : data.irradiance;
    const std::uint32_t lightResolution =
        info.resolution.edgeOf(hasLight ? ProbeLayer::Light : ProbeLayer::Irradiance);
    const std::uint32_t border = hasLight ? 0 : 1;
    if (!light.empty()) {
        addLight(light, lightResolution, border, detail);
        const float brightest = std::max({detail.maxLight.r, detail.maxLight.g, detail.maxLight.b, 1e-6f});
        detail.light = smallMap(light, lightResolution, border, [&](std::uint32_t word) {
            return glm::pow(unpackLight(word) / brightest, glm::vec3(1.0f / 2.2f));
        });
    }
    const std::uint32_t depthResolution = info.resolution.edgeOf(ProbeLayer::DepthNormal);
    if (data.depthNormal.empty()) return;
    addDepth(data.depthNormal, depthResolution, DepthCoder(info.depth), detail);
    detail.normals = smallMap(data.depthNormal, depthResolution, 0, [](std::uint32_t word) {
        return depthCodeOf(word) == kDepthMissCode ? glm::vec3(0.0f) : 0.5f * normalOf(word) + 0.5f;
    });
    detail.depth = smallMap(data.depthNormal, depthResolution, 0, [](std::uint32_t word) {
        return glm::vec3(1.0f - static_cast<float>(depthCodeOf(word)) / static_cast<float>(kDepthMissCode));
    });
}

}  // namespace

Result<ProbeDetail> readProbeDetail(const std::filesystem::path& file, std::uint32_t probe,
                                    Diagnostics& diagnostics) {
    PFVOX_TRY(const ProbeFileReader, reader, ProbeFileReader::open(file, Limits{}, diagnostics));
    if (!reader.info().range.contains(probe))
        return fail(ErrorCode::BadReference, file.string() + ": has no probe " + std::to_string(probe));
    ProbeDetail detail{.index = probe, .position = reader.positionOf(probe), .record = reader.record(probe)};
    if (!detail.record.isActive()) return detail;
    PFVOX_TRY(const ProbeData, data, reader.readProbe(probe));
    addMaps(data, reader.info(), detail);
    return detail;
}

}  // namespace pfvox::viewer

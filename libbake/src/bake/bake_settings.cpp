#include "bake/bake_settings.hpp"

#include <fmt/format.h>

#include <cmath>

#include "bake/probe_tracer.hpp"
#include "shared/faces.glsl.h"
#include "shared/probe_maths.glsl.h"

namespace pfvox::bake {

namespace {

Result<void> checkResolution(const ProbeResolution& resolution) {
    if (resolution.edgeOf(ProbeLayer::DepthNormal) % shared::kMinDepthBlock != 0)
        return fail(
            ErrorCode::BadValue,
            fmt::format("depth maps of {} texels: the resolution is a multiple of 16", resolution.depth));
    for (const ProbeLayer layer :
         {ProbeLayer::DepthNormal, ProbeLayer::Light, ProbeLayer::Irradiance, ProbeLayer::Moments})
        if (resolution.edgeOf(layer) > kMaxProbeResolution)
            return fail(ErrorCode::BadValue, fmt::format("{} maps have at most {} texels a side",
                                                         toString(layer), kMaxProbeResolution));
    if (resolution.bytesPerProbe() == 0) return fail(ErrorCode::BadValue, "a probe has at least one map");
    const TracedResolution traced = tracedResolution(resolution);
    if (traced.light % shared::kTileEdge != 0)
        return fail(ErrorCode::BadValue,
                    fmt::format("light maps of {} texels: the resolution is a multiple of 8", traced.light));
    if (traced.depth % traced.light != 0 || traced.depth / traced.light > shared::kMaxBlockEdge)
        return fail(
            ErrorCode::BadValue,
            fmt::format("depth maps of {} and light maps of {} texels: depth is 1, 2, 3 or 4 times light",
                        traced.depth, traced.light));
    return {};
}

bool isBatches(std::uint32_t samples) {
    return samples != 0 && samples % shared::kBatchSamples == 0;
}

/// 1, 4, 16 ... times as many.
bool isPowerOfFour(std::uint32_t more, std::uint32_t than) {
    while (than < more && than <= more / 4) than *= 4;
    return than == more;
}

Result<void> checkFaces(const FaceSettings& faces) {
    const auto isBatches = [](std::uint32_t rays) { return rays != 0 && rays % shared::kFaceBatchRays == 0; };
    if (!isBatches(faces.baseRays) || !isBatches(faces.minRays) || !isBatches(faces.maxRays))
        return fail(ErrorCode::BadValue,
                    fmt::format("{}, {} and {} rays of a face: all are multiples of {}", faces.baseRays,
                                faces.minRays, faces.maxRays, shared::kFaceBatchRays));
    if (!isPowerOfFour(faces.maxRays, faces.minRays) || faces.maxRays > (1u << 24) ||
        faces.baseRays > (1u << 16))
        return fail(ErrorCode::BadValue,
                    fmt::format("rays of a face from {} to {}: the second is 1, 4, 16 ... times the first",
                                faces.minRays, faces.maxRays));
    if (!(faces.noiseTarget >= 0.0f) || !std::isfinite(faces.noiseTarget))
        return fail(ErrorCode::BadValue, "the noise target of faces is a number from 0");
    return {};
}

}  // namespace

Result<void> checkSettings(const BakeSettings& settings, const ProbeGrid& grid) {
    PFVOX_CHECK(checkResolution(settings.resolution));
    if (settings.faces) PFVOX_CHECK(checkFaces(*settings.faces));
    if (!isBatches(settings.minSamples) || !isBatches(settings.maxSamples) ||
        settings.maxSamples < settings.minSamples || settings.maxSamples > (1u << 24))
        return fail(
            ErrorCode::BadValue,
            fmt::format("samples from {} to {}: both are multiples of 16, the first not above the second",
                        settings.minSamples, settings.maxSamples));
    if (!(settings.noiseTarget >= 0.0f) || !std::isfinite(settings.noiseTarget))
        return fail(ErrorCode::BadValue, "the noise target is a number from 0");
    if (!(settings.noiseFloor > 0.0f) || !std::isfinite(settings.noiseFloor))
        return fail(ErrorCode::BadValue, "the noise floor is a number above 0");
    if (!(settings.dispatchSeconds > 0.0))
        return fail(ErrorCode::BadValue, "the seconds of a dispatch are a number above 0");
    if (settings.zstdLevel < 1 || settings.zstdLevel > 19)
        return fail(ErrorCode::BadValue, fmt::format("zstd level {}: it is 1 to 19", settings.zstdLevel));
    if (settings.range &&
        (settings.range->first >= settings.range->end || settings.range->end > grid.probeCount()))
        return fail(ErrorCode::BadValue,
                    fmt::format("probes {} to {}: a range is not empty and within the grid's {} probes",
                                settings.range->first, settings.range->end, grid.probeCount()));
    return {};
}

}  // namespace pfvox::bake

namespace pfvox {

FaceSettings faceSettingsFor(const gpu::DeviceInfo& device) {
    FaceSettings settings;
    if (device.kind != gpu::DeviceKind::Software) return settings;
    settings.baseRays = 128;
    settings.minRays = 128;
    settings.maxRays = 512;
    settings.noiseTarget = 0.03f;
    return settings;
}

}  // namespace pfvox

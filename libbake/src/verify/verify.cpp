#include <algorithm>
#include <cmath>
#include <pfvox/assert.hpp>
#include <pfvox/verify.hpp>
#include <pfvox_shaders/shaders.hpp>

#include "bake/emitters.hpp"
#include "shared/bake.glsl.h"
#include "shared/verify.glsl.h"

namespace pfvox {

namespace {

/// Work of one dispatch: fills a large device, and is short enough for it.
constexpr std::uint64_t kPathsPerDispatch = 1u << 22;

shared::VerifyView viewOf(const Camera& camera, const gpu::Scene& scene, const VerifySettings& settings) {
    const glm::dvec3 toTarget = camera.target - camera.position;
    const glm::dvec3 forward = glm::length(toTarget) > 0.0 ? glm::normalize(toTarget) : glm::dvec3{0, 0, -1};
    const bool vertical = std::abs(forward.y) > 1.0 - 1e-9;
    const glm::dvec3 about = vertical ? glm::dvec3{0, 0, -1} : glm::dvec3{0, 1, 0};
    const glm::dvec3 right = glm::normalize(glm::cross(forward, about));
    const double tanY = std::tan(glm::radians(camera.fovYDegrees) / 2.0);
    const double aspect = static_cast<double>(settings.width) / settings.height;
    return {.position = scene.onDevice(camera.position),
            .width = settings.width,
            .forward = glm::vec3{forward},
            .height = settings.height,
            .right = glm::vec3{right * tanY * aspect},
            .reserved0 = 0,
            .up = glm::vec3{glm::cross(right, forward) * tanY},
            .reserved1 = 0};
}

/// What paths look for; nothing where they do not.
struct Lamps {
    gpu::Buffer faces;
    std::uint32_t count = 0;
    float power = 0.0f;

    static Result<Lamps> create(gpu::Device& device, const bake::EmitterList& list) {
        const auto count = static_cast<std::uint32_t>(list.faces.size());
        const std::uint64_t bytes = std::uint64_t{std::max(count, 1u)} * sizeof(shared::EmitterFace);
        PFVOX_TRY(gpu::Buffer, faces, device.createBuffer(bytes, "verify emitters"));
        if (count != 0) PFVOX_CHECK(device.upload(faces, 0, std::as_bytes(std::span(list.faces))));
        return Lamps{std::move(faces), count, list.power};
    }
};

shared::BakeScene bakeSceneOf(const VerifyInput& input, const VerifySettings& settings, const Lamps& lamps) {
    const Sun& sun = input.loaded.scene.sun;
    const Sky& sky = input.loaded.scene.sky;
    shared::BakeScene record{};
    record.scene = input.scene.address();
    record.emitters = lamps.faces.addressWords();
    record.emitterCount = lamps.count;
    record.emitterPower = lamps.power;
    record.maxBounces = settings.maxBounces;
    record.sampling = lamps.count != 0 ? shared::kSampleCombined : shared::kSampleDirections;
    record.sunDirection = glm::vec3{glm::normalize(sun.direction)};
    record.sunIrradiance = glm::vec3{sun.irradiance};
    record.skyZenith = glm::vec3{sky.zenith};
    record.skyHorizon = glm::vec3{sky.horizon};
    record.skyGround = glm::vec3{sky.ground};
    return record;
}

VerifiedPixel pixelOf(const shared::VerifyPixel& pixel, const glm::vec4& even, const glm::vec4& odd) {
    VerifiedPixel result;
    result.surface = pixel.lookup.w >= 0.0f;
    if (!result.surface) return result;
    result.lookup = glm::vec3{pixel.lookup};
    result.tier = static_cast<gpu::ProbeTier>(pixel.lookup.w);
    result.material = static_cast<MaterialType>(pixel.material);
    result.reference = glm::vec3{even + odd} / std::max(even.w + odd.w, 1.0f);
    result.noise = 0.5f * (glm::vec3{even} / std::max(even.w, 1.0f) - glm::vec3{odd} / std::max(odd.w, 1.0f));
    return result;
}

std::uint32_t groupsOf(std::uint32_t edge) {
    return (edge + shared::kVerifyGroupEdge - 1) / shared::kVerifyGroupEdge;
}

/// What a picture needs on the device.
struct Canvas {
    Lamps lamps;
    gpu::Buffer scene;
    gpu::Buffer view;
    gpu::Buffer pixels;
    shared::VerifyPush push;

    static Result<Canvas> create(gpu::Device& device, const VerifyInput& input,
                                 const VerifySettings& settings, const bake::EmitterList& emitters) {
        PFVOX_TRY(Lamps, lamps, Lamps::create(device, emitters));
        const std::uint64_t bytes =
            std::uint64_t{settings.width} * settings.height * sizeof(shared::VerifyPixel);
        PFVOX_TRY(gpu::Buffer, scene, device.createBuffer(sizeof(shared::BakeScene), "verify scene"));
        PFVOX_TRY(gpu::Buffer, view, device.createBuffer(sizeof(shared::VerifyView), "verify view"));
        PFVOX_TRY(gpu::Buffer, pixels, device.createBuffer(bytes, "verify pixels"));
        PFVOX_CHECK(device.upload(scene, 0, gpu::bytesOf(bakeSceneOf(input, settings, lamps))));
        PFVOX_CHECK(device.upload(view, 0, gpu::bytesOf(viewOf(input.camera, input.scene, settings))));
        const shared::VerifyPush push{
            .scene = scene.addressWords(),
            .field = input.probes != nullptr ? input.probes->address() : glm::uvec2(0),
            .view = view.addressWords(),
            .pixels = pixels.addressWords(),
            .faces = input.faces != nullptr ? input.faces->address() : glm::uvec2(0),
            .firstSample = 0,
            .sampleCount = 0,
            .firstRow = 0,
            .reserved0 = 0,
            .reserved1 = 0,
            .reserved2 = 0};
        return Canvas{std::move(lamps), std::move(scene), std::move(view), std::move(pixels), push};
    }

    Result<double> launch(gpu::Device& device, const gpu::Program& program, glm::uvec2 size) const {
        const gpu::Dispatch dispatch{.program = &program,
                                     .pushConstants = gpu::bytesOf(push),
                                     .groups = {groupsOf(size.x), groupsOf(size.y), 1}};
        return device.run({&dispatch, 1});
    }

    Result<std::vector<shared::VerifyPixel>> download(gpu::Device& device,
                                                      const VerifySettings& settings) const {
        std::vector<shared::VerifyPixel> found(std::size_t{settings.width} * settings.height);
        PFVOX_CHECK(device.download(pixels, 0, std::as_writable_bytes(std::span(found))));
        return found;
    }
};

}  // namespace

Result<ProbeVerifier> ProbeVerifier::create(gpu::Device& device) {
    const std::uint32_t hasGlass = 1;
    PFVOX_TRY(gpu::Program, program,
              device.createProgram(shaders::kVerifyProbes, sizeof(shared::VerifyPush), "verify probes",
                                   {&hasGlass, 1}));
    return ProbeVerifier(std::move(program));
}

Result<ReferencePicture> ProbeVerifier::trace(gpu::Device& device, const VerifyInput& input,
                                              const VerifySettings& settings, ReferencePicture begun) const {
    const std::size_t pixels = std::size_t{settings.width} * settings.height;
    PFVOX_ASSERT(begun.samples == 0 || (begun.even.size() == pixels && begun.odd.size() == pixels));
    if (begun.samples != 0 && begun.samples >= settings.samples) return begun;
    bake::EmitterList emitters;
    if (settings.emitterSampling)
        emitters = bake::makeEmitters(bake::placedModels(input.loaded, input.scene.origin()));
    PFVOX_TRY(Canvas, canvas, Canvas::create(device, input, settings, emitters));
    std::vector<shared::VerifyPixel> sums(pixels);
    for (std::size_t i = 0; begun.samples != 0 && i < pixels; ++i) {
        sums[i].even = begun.even[i];
        sums[i].odd = begun.odd[i];
    }
    PFVOX_CHECK(device.upload(canvas.pixels, 0, std::as_bytes(std::span(sums))));
    // llvmpipe bounds the loops of an invocation, all together: docs/decisions/013-baker.md.
    const bool software = device.info().kind == gpu::DeviceKind::Software;
    const std::uint32_t rows = software ? shared::kVerifyGroupEdge : settings.height;
    const std::uint64_t fitting = kPathsPerDispatch / settings.width / rows;
    const auto perDispatch =
        software ? 1u : static_cast<std::uint32_t>(std::clamp<std::uint64_t>(fitting, 1, settings.samples));
    shared::VerifyPush& push = canvas.push;
    for (push.firstSample = begun.samples; push.firstSample < settings.samples;
         push.firstSample += push.sampleCount) {
        push.sampleCount = std::min(perDispatch, settings.samples - push.firstSample);
        for (push.firstRow = 0; push.firstRow < settings.height; push.firstRow += rows) {
            PFVOX_TRY(const double, gpuMs, canvas.launch(device, program_, {settings.width, rows}));
            begun.gpuMs += gpuMs;
        }
    }
    PFVOX_TRY(const std::vector<shared::VerifyPixel>, found, canvas.download(device, settings));
    ReferencePicture picture{.width = settings.width,
                             .height = settings.height,
                             .even = {},
                             .odd = {},
                             .samples = settings.samples,
                             .gpuMs = begun.gpuMs};
    for (const shared::VerifyPixel& pixel : found) {
        picture.even.push_back(pixel.even);
        picture.odd.push_back(pixel.odd);
    }
    return picture;
}

Result<VerifiedPicture> ProbeVerifier::lookUp(gpu::Device& device, const VerifyInput& input,
                                              const ReferencePicture& reference) const {
    const VerifySettings settings{.width = reference.width, .height = reference.height};
    PFVOX_TRY(const Canvas, canvas, Canvas::create(device, input, settings, {}));
    VerifiedPicture picture{.width = reference.width, .height = reference.height, .pixels = {}};
    PFVOX_TRY(const double, gpuMs, canvas.launch(device, program_, {reference.width, reference.height}));
    picture.gpuMs = gpuMs;
    PFVOX_TRY(const std::vector<shared::VerifyPixel>, found, canvas.download(device, settings));
    for (std::size_t i = 0; i < found.size(); ++i)
        picture.pixels.push_back(pixelOf(found[i], reference.even[i], reference.odd[i]));
    return picture;
}

Result<VerifiedPicture> ProbeVerifier::render(gpu::Device& device, const VerifyInput& input,
                                              const VerifySettings& settings) const {
    PFVOX_TRY(const ReferencePicture, reference, trace(device, input, settings));
    PFVOX_TRY(VerifiedPicture, picture, lookUp(device, input, reference));
    picture.gpuMs += reference.gpuMs;
    return picture;
}

}  // namespace pfvox

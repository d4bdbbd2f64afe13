#include "faces/face_tracer.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <pfvox_shaders/shaders.hpp>

#include "faces/face_lists.hpp"

namespace pfvox::bake {

namespace {

/// Of the mean light of all faces: darker places may be as noisy as this.
constexpr double kNoiseFloor = 0.05;
/// What is left of the light when a sweep ends the solution, relative, on the face where most is left.
constexpr double kSolved = 1e-3;
/// After so many sweeps it is known how light the scene is, about.
constexpr std::uint32_t kSweepsForFloor = 2;
/// Links are counted in 32 bits.
constexpr std::uint64_t kMostLinks = 0xffffffffull;

bool isSoftware(const gpu::Device& device) {
    return device.info().kind == gpu::DeviceKind::Software;
}

template <class T>
std::uint64_t bytesFor(std::uint64_t count) {
    return std::max<std::uint64_t>(count, 1) * sizeof(T);
}

template <class T>
Result<void> put(gpu::Device& device, const gpu::Buffer& buffer, std::span<const T> items) {
    if (items.empty()) return {};
    return device.upload(buffer, 0, std::as_bytes(items));
}

template <class T>
Result<std::vector<T>> get(gpu::Device& device, const gpu::Buffer& buffer, std::size_t count) {
    std::vector<T> items(count);
    if (count != 0) PFVOX_CHECK(device.download(buffer, 0, std::as_writable_bytes(std::span(items))));
    return items;
}

double secondsOf(std::chrono::steady_clock::time_point since) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

/// As many links a face as were asked for, or as fit: a quarter of the device's memory at most.
std::uint32_t linksFor(const gpu::Device& device, std::uint64_t faces, const FaceSettings& settings) {
    const std::uint64_t memory =
        std::min(device.info().localMemoryBytes / 4, device.maxBufferBytes()) / sizeof(glm::uvec2);
    std::uint64_t links = settings.baseRays;
    while (links > shared::kFaceBatchRays && links * faces > std::min(memory, kMostLinks)) links /= 2;
    return static_cast<std::uint32_t>(links / shared::kFaceBatchRays * shared::kFaceBatchRays);
}

}  // namespace

Result<FaceTracer::Programs> FaceTracer::createPrograms(gpu::Device& device, const gpu::Scene& scene) {
    const std::array<std::uint32_t, 3> links{scene.statistics().hasGlass, scene.statistics().hasMirrors, 1};
    const std::array<std::uint32_t, 3> gather{links[0], links[1], 0};
    const auto create = [&](std::span<const std::uint32_t> spirv, std::string_view name,
                            std::span<const std::uint32_t> constants) {
        return device.createProgram(spirv, sizeof(shared::FacePush), name, constants);
    };
    const auto onlyGlass = std::span(links).first(1);
    PFVOX_TRY(gpu::Program, sun, create(shaders::kFaceSun, "sun on faces", onlyGlass));
    PFVOX_TRY(gpu::Program, linking, create(shaders::kFaceGather, "links of faces", links));
    PFVOX_TRY(gpu::Program, gathering, create(shaders::kFaceGather, "light of faces", gather));
    PFVOX_TRY(gpu::Program, sweep, create(shaders::kFaceSweep, "sweep over faces", onlyGlass));
    PFVOX_TRY(gpu::Program, noise, create(shaders::kFaceNoise, "noise of faces", onlyGlass));
    PFVOX_TRY(gpu::Program, divide, create(shaders::kFaceDivide, "division of faces", onlyGlass));
    return Programs{std::move(sun),   std::move(linking), std::move(gathering),
                    std::move(sweep), std::move(noise),   std::move(divide)};
}

Result<FaceTracer::Buffers> FaceTracer::createBuffers(gpu::Device& device, const gpu::Scene& scene,
                                                      std::uint32_t links) {
    const std::uint64_t faces = scene.faceCount();
    const FaceLists lists = listFaces(scene);
    const auto vectors = [&](std::string_view name) {
        return device.createBuffer(bytesFor<glm::vec4>(faces), name);
    };
    PFVOX_TRY(gpu::Buffer, bake, device.createBuffer(sizeof(shared::FaceBake), "face bake"));
    PFVOX_TRY(gpu::Buffer, control, device.createBuffer(sizeof(shared::FaceControl), "face control"));
    PFVOX_TRY(gpu::Buffer, frames,
              device.createBuffer(bytesFor<shared::FaceFrame>(lists.frames.size()), "face frames"));
    PFVOX_TRY(gpu::Buffer, records, device.createBuffer(bytesFor<shared::FaceRecord>(faces), "faces"));
    PFVOX_TRY(gpu::Buffer, sun, vectors("sun of faces"));
    PFVOX_TRY(gpu::Buffer, direct, vectors("direct light of faces"));
    PFVOX_TRY(gpu::Buffer, light0, vectors("light of faces"));
    PFVOX_TRY(gpu::Buffer, light1, vectors("light of faces"));
    PFVOX_TRY(gpu::Buffer, linked,
              device.createBuffer(bytesFor<glm::uvec2>(faces * links), "links of faces"));
    PFVOX_TRY(gpu::Buffer, levels, device.createBuffer(bytesFor<std::uint32_t>(faces), "levels of faces"));
    PFVOX_CHECK(put(device, frames, std::span<const shared::FaceFrame>(lists.frames)));
    PFVOX_CHECK(put(device, records, std::span<const shared::FaceRecord>(lists.records)));
    return Buffers{std::move(bake),
                   std::move(control),
                   std::move(frames),
                   std::move(records),
                   std::move(sun),
                   std::move(direct),
                   {std::move(light0), std::move(light1)},
                   std::move(linked),
                   std::move(levels)};
}

Result<FaceTracer> FaceTracer::create(gpu::Device& device, const gpu::Scene& scene, const Sun& sun,
                                      const Sky& sky, const EmitterList& emitters,
                                      const BakeSettings& settings) {
    PFVOX_TRY(BakeSceneBuffers, bakeScene,
              BakeSceneBuffers::create(device, scene, sun, sky, emitters, settings));
    PFVOX_TRY(Programs, programs, createPrograms(device, scene));
    const std::uint32_t links = linksFor(device, scene.faceCount(), *settings.faces);
    PFVOX_TRY(Buffers, buffers, createBuffers(device, scene, links));
    FaceTracer tracer(device, scene, std::move(bakeScene), std::move(programs), std::move(buffers), settings);
    tracer.linkCount_ = links;
    const bool software = isSoftware(device);
    tracer.pace_ = Pace(software ? 256 : std::size_t{1} << 16, std::size_t{1} << 24);
    PFVOX_CHECK(tracer.writeControl({}));
    return tracer;
}

Result<FaceTracer::Values> FaceTracer::createValues(std::span<const std::uint32_t> clusters,
                                                    std::span<const glm::uvec2> parts) {
    const std::uint32_t count = clusters.back();
    const std::uint64_t vectorBytes = bytesFor<glm::vec4>(count);
    PFVOX_TRY(gpu::Buffer, sums, device_->createBuffer(vectorBytes, "sums of values"));
    PFVOX_TRY(gpu::Buffer, quarters, device_->createBuffer(vectorBytes, "quarters of values"));
    PFVOX_TRY(gpu::Buffer, goals, device_->createBuffer(bytesFor<std::uint32_t>(count), "goals of values"));
    PFVOX_TRY(gpu::Buffer, starts, device_->createBuffer(clusters.size_bytes(), "clusters of values"));
    PFVOX_TRY(gpu::Buffer, noise, device_->createBuffer(clusters.size_bytes(), "noise of values"));
    PFVOX_CHECK(put(*device_, starts, clusters));
    const std::vector<std::uint32_t> wanted(count, settings_.faces->minRays / shared::kFaceBatchRays);
    PFVOX_CHECK(put(*device_, goals, std::span<const std::uint32_t>(wanted)));
    Values values{.sums = std::move(sums),
                  .quarters = std::move(quarters),
                  .goals = std::move(goals),
                  .clusters = std::move(starts),
                  .noise = std::move(noise),
                  .parts = std::nullopt,
                  .count = count,
                  .clusterCount = static_cast<std::uint32_t>(clusters.size() - 1)};
    if (!parts.empty()) {
        PFVOX_TRY(gpu::Buffer, made, device_->createBuffer(parts.size_bytes(), "parts of faces"));
        PFVOX_CHECK(put(*device_, made, parts));
        values.parts.emplace(std::move(made));
    }
    return values;
}

Result<void> FaceTracer::describe(const Values& values) {
    const shared::FaceBake record{
        .scene = bakeScene_.address(),
        .frames = buffers_.frames.addressWords(),
        .faces = buffers_.faces.addressWords(),
        .sun = buffers_.sun.addressWords(),
        .direct = buffers_.direct.addressWords(),
        .light = {buffers_.light[0].addressWords(), buffers_.light[1].addressWords()},
        .links = buffers_.links.addressWords(),
        .parts = values.parts ? values.parts->addressWords() : glm::uvec2(0),
        .sums = values.sums.addressWords(),
        .quarters = values.quarters.addressWords(),
        .goals = values.goals.addressWords(),
        .clusters = values.clusters.addressWords(),
        .noise = values.noise.addressWords(),
        .levels = buffers_.levels.addressWords(),
        .control = buffers_.control.addressWords(),
        .linkCount = linkCount_,
        .faceCount = scene_->faceCount(),
        .noiseTarget = settings_.faces->noiseTarget,
        .noiseFloor = noiseFloor_,
        .maxSteps = shared::kMaxGlassSteps,
        .reserved0 = 0};
    PFVOX_CHECK(device_->upload(buffers_.bake, 0, gpu::bytesOf(record)));
    return device_->flush();
}

Result<shared::FaceControl> FaceTracer::readControl() {
    shared::FaceControl control{};
    PFVOX_CHECK(
        device_->download(buffers_.control, 0, std::as_writable_bytes(std::span(&control, std::size_t{1}))));
    return control;
}

Result<void> FaceTracer::writeControl(const shared::FaceControl& control) {
    PFVOX_CHECK(device_->upload(buffers_.control, 0, gpu::bytesOf(control)));
    return device_->flush();
}

Result<std::uint64_t> FaceTracer::stepLimitRays() {
    PFVOX_TRY(const shared::FaceControl, control, readControl());
    return control.stepLimitRays;
}

Result<void> FaceTracer::launch(const Launch& work, BakePass& sum, const WorkDone& done) {
    const std::uint32_t batches = std::max(work.batchEnd - work.firstBatch, 1u);
    // llvmpipe bounds the loops of an invocation, all together: docs/decisions/013-baker.md.
    const std::uint32_t mostBatches = isSoftware(*device_) ? 2 : batches;
    for (std::uint32_t batch = work.firstBatch;;) {
        const std::uint32_t batchEnd = std::min(batch + mostBatches, std::max(work.batchEnd, batch));
        const std::size_t each = std::max(batchEnd - batch, 1u);
        for (std::uint32_t first = 0; first < work.count;) {
            const std::size_t fitting = std::max<std::size_t>(pace_.size() / each, work.perGroup);
            const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(work.count - first, fitting));
            const std::uint32_t groups = (count + work.perGroup - 1) / work.perGroup;
            const shared::FacePush push{.bake = buffers_.bake.addressWords(),
                                        .first = first,
                                        .count = count,
                                        .firstBatch = batch,
                                        .batchEnd = batchEnd,
                                        .source = work.source,
                                        .reserved0 = 0};
            const gpu::Dispatch dispatch{
                .program = work.program,
                .pushConstants = gpu::bytesOf(push),
                .groups = {std::min(groups, shared::kFaceRowGroups),
                           (groups + shared::kFaceRowGroups - 1) / shared::kFaceRowGroups, 1}};
            const auto began = std::chrono::steady_clock::now();
            PFVOX_TRY(const double, gpuMs, device_->run({&dispatch, 1}));
            const double seconds = secondsOf(began);
            PFVOX_TRY(const shared::FaceControl, control, readControl());
            const std::uint64_t rays = control.raysLow | std::uint64_t{control.raysHigh} << 32;
            const BakePass piece{.rays = rays - raysBefore_, .gpuMs = gpuMs};
            raysBefore_ = rays;
            sum.rays += piece.rays;
            sum.gpuMs += piece.gpuMs;
            if (piece.rays != 0) pace_.took(count * each, seconds, settings_.dispatchSeconds);
            PFVOX_CHECK(done(piece));
            first += count;
        }
        batch = batchEnd;
        if (batch >= work.batchEnd) return {};
    }
}

// ---- The base: links, and bounces through them ----

Result<void> FaceTracer::solve(const Values& values, TracedFaces& result, const WorkDone& done) {
    const std::uint32_t faces = scene_->faceCount();
    PFVOX_CHECK(launch({.program = &programs_.sun, .count = faces, .perGroup = shared::kFaceGroupValues},
                       result.sun, done));
    PFVOX_CHECK(launch({.program = &programs_.links,
                        .count = faces,
                        .perGroup = shared::kFaceGroupValues,
                        .batchEnd = linkCount_ / shared::kFaceBatchRays},
                       result.links, done));
    const std::uint32_t most =
        std::min(settings_.maxBounces.value_or(shared::kMaxPathBounces), shared::kMaxPathBounces);
    double before = 0.0;
    for (result.sweeps = 0; result.sweeps < most;) {
        PFVOX_TRY(shared::FaceControl, control, readControl());
        control.largestChange = 0;
        PFVOX_CHECK(writeControl(control));
        PFVOX_CHECK(launch({.program = &programs_.sweep,
                            .count = faces,
                            .perGroup = shared::kFaceGroupValues,
                            .source = source_},
                           result.solve, done));
        source_ = 1 - source_;
        ++result.sweeps;
        PFVOX_TRY(const shared::FaceControl, after, readControl());
        const auto change = static_cast<double>(std::bit_cast<float>(after.largestChange));
        const double ratio = before > 0.0 ? std::min(change / before, 0.99) : 0.99;
        if (change * ratio / (1.0 - ratio) < kSolved) break;
        before = change;
        if (result.sweeps == kSweepsForFloor) PFVOX_CHECK(findFloor(values));
    }
    return {};
}

Result<void> FaceTracer::findFloor(const Values& values) {
    const std::uint32_t faces = scene_->faceCount();
    PFVOX_TRY(const std::vector<glm::vec4>, light, get<glm::vec4>(*device_, buffers_.light[source_], faces));
    double sum = 0.0;
    for (const glm::vec4& l : light) sum += static_cast<double>(l.x + l.y + l.z) / 3.0;
    noiseFloor_ = static_cast<float>(std::max(kNoiseFloor * sum / std::max(faces, 1u), 1e-12));
    return describe(values);
}

// ---- The light of values ----

Result<void> FaceTracer::gather(const Values& values, TracedFaces& result, const WorkDone& done) {
    // A divided face has four values and more: a quarter of the rays each.
    const std::uint32_t whole = settings_.faces->maxRays / shared::kFaceBatchRays;
    const std::uint32_t least = settings_.faces->minRays / shared::kFaceBatchRays;
    const std::uint32_t most = values.parts ? std::max(whole / 4, least) : whole;
    std::uint32_t begin = 0;
    for (std::uint32_t end = least;; end = std::min(4 * end, most)) {
        PFVOX_CHECK(launch({.program = &programs_.gather,
                            .count = values.count,
                            .perGroup = shared::kFaceGroupValues,
                            .firstBatch = begin,
                            .batchEnd = end,
                            .source = source_},
                           result.gather, done));
        PFVOX_TRY(shared::FaceControl, control, readControl());
        control.unfinished = 0;
        PFVOX_CHECK(writeControl(control));
        PFVOX_CHECK(launch({.program = &programs_.noise,
                            .count = values.clusterCount,
                            .perGroup = shared::kFaceGroupSize,
                            .firstBatch = end,
                            .batchEnd = end,
                            .source = std::min(4 * end, most)},
                           result.gather, done));
        PFVOX_TRY(const shared::FaceControl, after, readControl());
        if (after.unfinished == 0 || end >= most) return {};
        begin = end;
    }
}

Result<std::vector<std::uint32_t>> FaceTracer::divide(const Values& values, TracedFaces& result,
                                                      const WorkDone& done) {
    for (std::uint32_t pass = 0; pass < 2; ++pass) {
        PFVOX_CHECK(launch({.program = &programs_.divide,
                            .count = values.count,
                            .perGroup = shared::kFaceGroupSize,
                            .source = pass},
                           result.gather, done));
    }
    return get<std::uint32_t>(*device_, buffers_.levels, values.count);
}

Result<TracedFaces> FaceTracer::run(const WorkDone& done) {
    TracedFaces result;
    const std::uint32_t faces = scene_->faceCount();
    if (faces == 0) {
        result.firstValue.push_back(0);
        return result;
    }
    PFVOX_TRY(const Values, whole, createValues(listFaces(*scene_).clusters, {}));
    PFVOX_CHECK(describe(whole));
    PFVOX_CHECK(solve(whole, result, done));
    PFVOX_CHECK(findFloor(whole));
    PFVOX_CHECK(gather(whole, result, done));
    std::vector<std::uint32_t> levels(faces, 0);
    if (settings_.faces->divide) {
        PFVOX_TRY(std::vector<std::uint32_t>, found, divide(whole, result, done));
        levels = std::move(found);
    }
    std::vector<glm::uvec2> parts;
    std::vector<std::uint32_t> clusters;
    for (std::uint32_t face = 0; face < faces; ++face) {
        if (levels[face] == 0) continue;
        clusters.push_back(static_cast<std::uint32_t>(parts.size()));
        for (std::uint32_t part = 0; part < 1u << (2 * levels[face]); ++part)
            parts.emplace_back(face, levels[face] << 8 | part);
    }
    result.dividedFaces = clusters.size();
    if (parts.empty()) return assemble(whole, std::nullopt, levels, std::move(result));
    clusters.push_back(static_cast<std::uint32_t>(parts.size()));
    PFVOX_TRY(std::optional<Values>, divided, createValues(clusters, parts));
    PFVOX_CHECK(describe(*divided));
    PFVOX_CHECK(gather(*divided, result, done));
    return assemble(whole, divided, levels, std::move(result));
}

Result<TracedFaces> FaceTracer::assemble(const Values& whole, const std::optional<Values>& divided,
                                         std::span<const std::uint32_t> levels, TracedFaces result) {
    const std::uint32_t faces = scene_->faceCount();
    PFVOX_TRY(const std::vector<glm::vec4>, sums, get<glm::vec4>(*device_, whole.sums, faces));
    PFVOX_TRY(const std::vector<float>, noise, get<float>(*device_, whole.noise, whole.clusterCount));
    PFVOX_TRY(const std::vector<std::uint32_t>, clusters,
              get<std::uint32_t>(*device_, whole.clusters, whole.clusterCount + std::size_t{1}));
    std::vector<glm::vec4> parts;
    if (divided) {
        PFVOX_TRY(std::vector<glm::vec4>, found, get<glm::vec4>(*device_, divided->sums, divided->count));
        parts = std::move(found);
    }
    result.light.levels.resize(faces);
    result.firstValue.resize(faces + std::size_t{1});
    std::uint64_t next = 0;
    for (std::uint32_t face = 0; face < faces; ++face) {
        const bool none = sums[face].w <= 0.0f;
        result.light.levels[face] = none ? kNoFaceValue : static_cast<std::uint8_t>(levels[face]);
        result.firstValue[face] = next;
        if (!none) next += std::uint64_t{1} << (2 * levels[face]);
    }
    result.firstValue[faces] = next;
    result.light.values.resize(next);
    std::size_t part = 0;
    const auto wordOf = [](const glm::vec4& sum) {
        return shared::packRgb9e5(glm::vec3(sum) / std::max(sum.w, 1.0f));
    };
    for (std::uint32_t face = 0; face < faces; ++face) {
        const std::uint64_t first = result.firstValue[face];
        if (levels[face] == 0) {
            if (result.light.levels[face] == 0) result.light.values[first] = wordOf(sums[face]);
            continue;
        }
        // A part that another instance covers has what the whole face has.
        for (std::uint32_t i = 0; i < 1u << (2 * levels[face]); ++i, ++part)
            result.light.values[first + i] = wordOf(parts[part].w > 0.0f ? parts[part] : sums[face]);
    }
    result.noise.resize(faces);
    double noiseSum = 0.0;
    for (std::uint32_t c = 0; c < whole.clusterCount; ++c) {
        for (std::uint32_t face = clusters[c]; face < clusters[c + 1]; ++face) result.noise[face] = noise[c];
        const auto count = static_cast<double>(clusters[c + 1] - clusters[c]);
        noiseSum += count * static_cast<double>(noise[c]);
        if (noise[c] > settings_.faces->noiseTarget) result.noisyValues += clusters[c + 1] - clusters[c];
    }
    result.meanNoise = noiseSum / std::max(faces, 1u);
    return result;
}

}  // namespace pfvox::bake

#include "faces/face_stage.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <pfvox/face_file.hpp>

#include "bake/content_hash.hpp"

namespace pfvox::bake {

namespace {

/// All chunks from the journal, or nothing: a part of the faces costs as much as all of them.
Result<std::vector<FaceChunk>> reused(const FaceStage& stage, ProbeFileWriter& writer) {
    std::vector<FaceChunk> chunks;
    const FaceChunkRange range = stage.info.range;
    if (!stage.settings.resume || range.size() != faceChunkPlaces(stage.info).size()) return chunks;
    for (std::uint32_t i = range.first; i < range.end; ++i)
        if (!writer.reuseFaces(i, chunkHash(stage.field, i))) return chunks;
    for (std::uint32_t i = range.first; i < range.end; ++i) {
        PFVOX_TRY(FaceChunk, chunk, writer.readFaceChunk(i));
        chunks.push_back(std::move(chunk));
    }
    return chunks;
}

FaceChunkRecord recordOf(const FaceStage& stage, const TracedFaces& traced, std::uint32_t chunk,
                         const std::vector<std::uint32_t>& faces) {
    double noise = 0.0;
    double capped = 0.0;
    for (const std::uint32_t face : faces) {
        noise += static_cast<double>(traced.noise[face]);
        capped += traced.noise[face] > stage.settings.faces->noiseTarget ? 1.0 : 0.0;
    }
    const auto count = static_cast<double>(std::max<std::size_t>(faces.size(), 1));
    return {.noise = static_cast<float>(noise / count),
            .cappedFraction = static_cast<float>(capped / count),
            .inputHash = chunkHash(stage.field, chunk)};
}

/// Compresses and writes in parallel; values become what they are in the file.
Result<void> write(const FaceStage& stage, const TracedFaces& traced, std::vector<FaceChunk>& chunks,
                   ProbeFileWriter& writer) {
    const std::vector<std::vector<std::uint32_t>> faces = facesOfChunks(stage.gpuScene, stage.info);
    std::mutex mutex;
    std::optional<Error> error;
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t i) {
        for (std::uint32_t& value : chunks[i].values)
            value = storedFaceValue(stage.info.settings.codec, value);
        const auto chunk = static_cast<std::uint32_t>(i);
        if (!stage.info.range.contains(chunk)) return;
        const Result<void> written =
            writer.appendFaces(chunk, chunks[i], recordOf(stage, traced, chunk, faces[i]));
        if (written) return;
        const std::scoped_lock lock(mutex);
        if (!error) error = written.error();
    });
    if (error) return tl::make_unexpected(*error);
    return {};
}

Result<std::vector<FaceChunk>> trace(const FaceStage& stage, ProbeFileWriter& writer, FaceReport& report,
                                     const WorkDone& done) {
    PFVOX_TRY(FaceTracer, tracer,
              FaceTracer::create(stage.device, stage.gpuScene, stage.scene.sun, stage.scene.sky,
                                 stage.emitters, stage.settings));
    PFVOX_TRY(const TracedFaces, traced, tracer.run(done));
    PFVOX_TRY(const std::uint64_t, lost, tracer.stepLimitRays());
    report.stepLimitRays = lost;
    report.sweeps = traced.sweeps;
    report.meanNoise = traced.meanNoise;
    report.noisyFraction = static_cast<double>(traced.noisyValues) /
                           static_cast<double>(std::max<std::uint64_t>(report.faces, 1));
    report.base = {.rays = traced.sun.rays + traced.links.rays,
                   .gpuMs = traced.sun.gpuMs + traced.links.gpuMs + traced.solve.gpuMs};
    report.light = traced.gather;
    std::vector<FaceChunk> chunks = faceChunks(stage.gpuScene, stage.info, traced.light);
    PFVOX_CHECK(write(stage, traced, chunks, writer));
    return chunks;
}

}  // namespace

FaceLightInfo faceInfoFor(const gpu::Scene& scene, const BakeSettings& settings,
                          const ProbeFieldInfo& probes) {
    FaceLightInfo info{.settings = faceBakeSettings(settings), .instances = faceInstancesOf(scene)};
    const std::uint64_t chunks = faceChunkPlaces(info).size();
    const std::uint64_t all = probes.grid.probeCount();
    const auto part = [&](std::uint32_t probe) { return static_cast<std::uint32_t>(chunks * probe / all); };
    info.range = {part(probes.range.first), part(probes.range.end)};
    return info;
}

Result<FaceValues> bakeFaceLight(const FaceStage& stage, ProbeFileWriter& writer, FaceReport& report,
                                 const WorkDone& done) {
    PFVOX_TRY(std::vector<FaceChunk>, chunks, reused(stage, writer));
    if (chunks.size() == faceChunkPlaces(stage.info).size()) {
        report.reused = report.faces;
    } else {
        PFVOX_TRY(std::vector<FaceChunk>, traced, trace(stage, writer, report, done));
        chunks = std::move(traced);
    }
    FaceValues light = faceValues(stage.gpuScene, stage.info, chunks);
    report.values = light.values.size();
    report.divided = static_cast<std::uint64_t>(std::ranges::count_if(
        light.levels, [](std::uint8_t level) { return level != 0 && level != kNoFaceValue; }));
    for (std::uint32_t i = stage.info.range.first; i < stage.info.range.end; ++i) {
        PFVOX_TRY(const FaceChunkRecord, record, writer.faceRecord(i));
        report.fileBytes += record.storedBytes;
    }
    return light;
}

}  // namespace pfvox::bake

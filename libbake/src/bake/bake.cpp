// bakeProbes: a group of probes at a time, tracing on this thread, small layers and writing on others.
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <chrono>
#include <mutex>
#include <pfvox/bake.hpp>
#include <pfvox/gpu_faces.hpp>
#include <pfvox/gpu_scene.hpp>
#include <pfvox/probe_file.hpp>

#include "bake/bake_settings.hpp"
#include "bake/content_hash.hpp"
#include "bake/probe_maps.hpp"
#include "bake/probe_placement.hpp"
#include "bake/surface_samples.hpp"
#include "faces/face_stage.hpp"

namespace pfvox {

namespace {

using namespace bake;
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What the threads behind the device have done.
struct Background {
    tbb::task_group tasks;
    std::mutex mutex;  ///< of all below
    std::optional<Error> error;
    double smallLayersMs = 0.0;
    double writeMs = 0.0;

    ~Background() { tasks.wait(); }
};

class Baker {
  public:
    Baker(gpu::Device& device, const LoadedScene& scene, const BakeSettings& settings, BakeObserver& observer,
          Diagnostics& diagnostics)
        : device_(device),
          scene_(scene),
          settings_(settings),
          observer_(observer),
          diagnostics_(diagnostics),
          info_(fieldInfo(scene, settings, device.info())),
          models_(placedModels(scene, scene.origin())),
          solids_(models_) {}

    Result<BakeReport> run(const std::filesystem::path& output) {
        const ContentKey key = bakeContentKey(scene_, settings_, device_.info());
        if (!settings_.force && isUpToDate(output, key)) {
            report_.upToDate = true;
            return report_;
        }
        warnAboutGrid();
        const EmitterList emitters = makeEmitters(models_);
        report_.emitterFaces = emitters.faces.size();
        PFVOX_TRY(const gpu::Scene, gpuScene,
                  gpu::Scene::build(device_, gpu::partsOf(scene_), diagnostics_,
                                    {.origin = scene_.origin(), .faces = settings_.faces.has_value()}));
        ProbeWriteSettings write{.encode = {.zstdLevel = settings_.zstdLevel, .contentKey = key},
                                 .resume = settings_.resume,
                                 .replaceReadOnly = settings_.force};
        if (settings_.faces) write.faces = faceInfoFor(gpuScene, settings_, info_);
        PFVOX_TRY(ProbeFileWriter, writer, ProbeFileWriter::open(output, info_, write, diagnostics_));
        std::optional<gpu::GpuFaces> faces;
        if (settings_.faces) {
            PFVOX_TRY(gpu::GpuFaces, baked, bakeFaces(gpuScene, *write.faces, emitters, writer));
            faces = std::move(baked);
        }
        PFVOX_TRY(ProbeTracer, tracer,
                  ProbeTracer::create(device_, gpuScene,
                                      {.sun = scene_.scene.sun,
                                       .sky = scene_.scene.sky,
                                       .emitters = emitters,
                                       .hasGlass = hasGlass(),
                                       .depth = info_.depth,
                                       .faces = faces ? &*faces : nullptr},
                                      settings_));
        PFVOX_CHECK(bakeAll(tracer, writer));
        PFVOX_TRY(const std::uint64_t, given, tracer.stepLimitRays());
        report_.stepLimitRays += given;
        PFVOX_CHECK(finish(writer, output));
        report_.totalMs = 1e3 * secondsSince(started_);
        return report_;
    }

  private:
    // --- Before ---

    bool isUpToDate(const std::filesystem::path& output, const ContentKey& key) {
        const ExistingBake existing = inspectBake(output, key, info_.range);
        if (existing.state == ExistingBake::State::Damaged) {
            diagnostics_.note("output-damaged",
                              "the existing output was damaged (" + existing.damage + "): baked again");
        }
        return existing.state == ExistingBake::State::UpToDate;
    }

    bool hasGlass() const {
        for (const PlacedModel& placed : models_)
            for (const Material& m : placed.asset->materials)
                if (letsThrough(m)) return true;
        return false;
    }

    void warnAboutGrid() {
        if (scene_.bounds.empty()) return;
        const glm::dvec3 low(info_.grid.start - kProximityReach * info_.grid.step);
        const glm::dvec3 high(info_.grid.pointOf(static_cast<std::uint32_t>(info_.grid.probeCount() - 1)) +
                              kProximityReach * info_.grid.step);
        const glm::dvec3 outside =
            glm::max(low - (scene_.bounds.min - scene_.origin()), scene_.bounds.max - scene_.origin() - high);
        const double most = std::max({outside.x, outside.y, outside.z});
        if (most <= 1e-6) return;
        diagnostics_.warn(
            "bake-grid-outside",
            fmt::format("models reach {:.3g} m further than a step around the probe grid: light there is "
                        "that of the irradiance maps of the nearest probes",
                        most));
    }

    // --- Faces ---

    Result<gpu::GpuFaces> bakeFaces(const gpu::Scene& gpuScene, const FaceLightInfo& info,
                                    const EmitterList& emitters, ProbeFileWriter& writer) {
        stage_ = BakeStage::Faces;
        report_.faces = FaceReport{.faces = gpuScene.faceCount()};
        const FaceStage stage{.device = device_,
                              .gpuScene = gpuScene,
                              .scene = scene_.scene,
                              .emitters = emitters,
                              .settings = settings_,
                              .info = info,
                              .field = fieldHash(info_, settings_)};
        auto light = bakeFaceLight(stage, writer, *report_.faces, workOf(facePass_));
        if (!light) return tl::make_unexpected(light.error());
        report_.stepLimitRays += report_.faces->stepLimitRays;
        stage_ = BakeStage::Probes;
        return gpu::GpuFaces::upload(device_, gpuScene, *light);
    }

    // --- Probes ---

    Result<void> bakeAll(ProbeTracer& tracer, ProbeFileWriter& writer) {
        const ContentKey field = fieldHash(info_, settings_);
        Background background;
        report_.probes = info_.range.size();
        records_.resize(info_.range.size());
        std::vector<std::uint32_t> group;
        for (std::uint32_t probe = info_.range.first; probe < info_.range.end; ++probe) {
            if (settings_.resume && writer.reuse(probe, probeHash(field, probe))) {
                PFVOX_TRY(const ProbeData, data, writer.readProbe(probe));
                records_[probe - info_.range.first] = data.record;
                ++report_.reused;
                PFVOX_CHECK(pieceDone());
            } else {
                group.push_back(probe);
            }
            if (group.size() < tracer.groupSize() && probe + 1 != info_.range.end) continue;
            PFVOX_CHECK(bakeGroup(group, field, tracer, writer, background));
            group.clear();
        }
        background.tasks.wait();
        PFVOX_CHECK(errorOf(background));
        report_.smallLayersMs = background.smallLayersMs;
        report_.writeMs = background.writeMs;
        if (surfaceTexels_ != 0)
            report_.meanSamples = static_cast<double>(samples_) / static_cast<double>(surfaceTexels_);
        return {};
    }

    static Result<void> errorOf(Background& background) {
        const std::scoped_lock lock(background.mutex);
        if (background.error) return tl::make_unexpected(*background.error);
        return {};
    }

    /// Places the probes; traces those that have a place, and gives them to the threads behind.
    Result<void> bakeGroup(std::span<const std::uint32_t> group, const ContentKey& field, ProbeTracer& tracer,
                           ProbeFileWriter& writer, Background& background) {
        std::vector<Placement> placements(group.size());
        tbb::parallel_for(std::size_t{0}, group.size(), [&](std::size_t i) {
            placements[i] = placeProbe(solids_, info_.grid, group[i], settings_.relocate);
        });
        std::vector<shared::BakeProbe> traced;
        for (std::size_t i = 0; i < group.size(); ++i) {
            ProbeRecord& record = records_[group[i] - info_.range.first];
            record = {.offset = placements[i].offset, .state = placements[i].state};
            if (record.isActive())
                traced.push_back(
                    {.position = info_.grid.pointOf(group[i]) + record.offset, .index = group[i]});
            else
                PFVOX_CHECK(
                    writer.append(group[i], {.record = record, .inputHash = probeHash(field, group[i])}));
        }
        if (!traced.empty()) {
            PFVOX_CHECK(tracer.see(traced, workOf(report_.geometry)));
            PFVOX_CHECK(tracer.light(workOf(report_.light)));
            background.tasks.wait();  // the group before: its maps lie in memory until they are written
            PFVOX_CHECK(errorOf(background));
        }
        for (std::uint32_t i = 0; i < traced.size(); ++i) {
            PFVOX_TRY(TracedProbe, maps, tracer.collect(i));
            const std::uint32_t probe = traced[i].index;
            ProbeRecord& record = records_[probe - info_.range.first];
            if (maps.tiles.meanError) record.error = static_cast<float>(*maps.tiles.meanError);
            record.noisyTileFraction = static_cast<float>(maps.tiles.noisyTileFraction);
            samples_ += maps.tiles.samples;
            surfaceTexels_ += maps.tiles.surfaceTexels;
            background.tasks.run([this, probe, record, input = probeHash(field, probe),
                                  shared = std::make_shared<const TracedProbe>(std::move(maps)), &writer,
                                  &background] {
                const Result<void> written = writeOne(probe, input, record, *shared, writer, background);
                if (written) return;
                const std::scoped_lock lock(background.mutex);
                if (!background.error) background.error = written.error();
            });
        }
        baked_ += group.size();
        PFVOX_CHECK(pieceDone());
        return errorOf(background);
    }

    Result<void> writeOne(std::uint32_t probe, const ContentKey& input, const ProbeRecord& record,
                          const TracedProbe& traced, ProbeFileWriter& writer, Background& background) const {
        const auto began = Clock::now();
        ProbeData data =
            makeMaps(traced, {.resolution = info_.resolution,
                              .momentRange = info_.grid.momentRange(),
                              .filterVoxelMetres = settings_.filter ? finestVoxelMetres(models_) : 0.0f});
        const double mapsMs = 1e3 * secondsSince(began);
        data.record = record;
        data.inputHash = input;
        PFVOX_CHECK(writer.append(probe, data));
        const std::scoped_lock lock(background.mutex);
        background.smallLayersMs += mapsMs;
        background.writeMs += 1e3 * secondsSince(began) - mapsMs;
        return {};
    }

    // --- What the observer hears ---

    WorkDone workOf(BakePass& sum) {
        return [this, &sum](const BakePass& piece) {
            sum.rays += piece.rays;
            sum.gpuMs += piece.gpuMs;
            return pieceDone();
        };
    }

    Result<void> pieceDone() {
        BakeProgress progress{.stage = stage_,
                              .faces = report_.faces ? report_.faces->faces : 0,
                              .probes = info_.range.size(),
                              .probesDone = baked_ + report_.reused,
                              .probesReused = report_.reused,
                              .rays = report_.geometry.rays + report_.light.rays + facePass_.rays,
                              .elapsedSeconds = secondsSince(started_),
                              .gpuMs = report_.geometry.gpuMs + report_.light.gpuMs,
                              .secondsLeft = std::nullopt};
        if (baked_ != 0)
            progress.secondsLeft = progress.elapsedSeconds / static_cast<double>(baked_) *
                                   static_cast<double>(progress.probes - progress.probesDone);
        observer_.progress(progress);
        if (!observer_.stopRequested()) return {};
        return fail(ErrorCode::Cancelled,
                    "stopped; what is finished is kept in the journal, and resuming takes it");
    }

    // --- After ---

    Result<void> finish(ProbeFileWriter& writer, const std::filesystem::path& output) {
        count(records_);
        std::optional<ProximityGrid> grid;
        if (settings_.proximity && info_.isWhole() && info_.resolution.depth != 0) {
            PFVOX_TRY(ProximityGrid, made, makeProximity(writer, records_));
            grid = std::move(made);
        }
        const auto began = Clock::now();
        PFVOX_CHECK(writer.finish(grid));
        report_.writeMs += 1e3 * secondsSince(began);
        std::error_code ignored;
        report_.fileBytes = std::filesystem::file_size(output, ignored);
        return {};
    }

    void count(std::span<const ProbeRecord> records) {
        report_.counts = countProbes(records);
        double errors = 0.0;
        double noisy = 0.0;
        std::uint64_t judged = 0;
        for (const ProbeRecord& record : records) {
            noisy += static_cast<double>(record.noisyTileFraction);
            if (!record.error) continue;
            const auto error = static_cast<double>(*record.error);
            errors += error;
            report_.maxError = std::max(report_.maxError.value_or(0.0), error);
            ++judged;
        }
        if (judged != 0) report_.meanError = errors / static_cast<double>(judged);
        if (info_.settings.isAdaptive() && report_.counts.active != 0)
            report_.noisyTileFraction = noisy / static_cast<double>(report_.counts.active);
    }

    Result<ProximityGrid> makeProximity(const ProbeFileWriter& writer, std::span<const ProbeRecord> records) {
        const auto began = Clock::now();
        const ProximityGrid shape =
            proximityShape(info_.grid, scene_.scene.probes.proximityCells, scene_.bounds);
        const CellSurfaces surfaces = sortIntoCells(surfaceSamples(models_, shape), shape);
        const auto depthNormal = [&](std::uint32_t probe) -> Result<std::vector<std::uint32_t>> {
            PFVOX_TRY(ProbeData, data, writer.readProbe(probe));
            return std::move(data.depthNormal);
        };
        PFVOX_TRY(ProximityBuild, built,
                  buildProximityGrid({.info = info_,
                                      .records = records,
                                      .depthNormal = depthNormal,
                                      .shape = shape,
                                      .surfaces = surfaces}));
        report_.proximity = built.report;
        report_.proximityMs = 1e3 * secondsSince(began);
        if (built.report.uncoveredCells != 0) {
            diagnostics_.note(
                "bake-uncovered-cells",
                fmt::format("{} of {} cells with surface are seen by no probe: light there comes from "
                            "the irradiance maps",
                            built.report.uncoveredCells, built.report.surfaceCells));
        }
        return std::move(built.grid);
    }

    Clock::time_point started_ = Clock::now();
    gpu::Device& device_;
    const LoadedScene& scene_;
    const BakeSettings& settings_;
    BakeObserver& observer_;
    Diagnostics& diagnostics_;
    ProbeFieldInfo info_;
    std::vector<PlacedModel> models_;
    SolidQuery solids_;
    BakeReport report_;
    std::vector<ProbeRecord> records_;  ///< from range.first on
    BakeStage stage_ = BakeStage::Probes;
    BakePass facePass_;
    std::uint64_t baked_ = 0;
    std::uint64_t samples_ = 0;
    std::uint64_t surfaceTexels_ = 0;
};

}  // namespace

Result<BakeReport> bakeProbes(gpu::Device& device, const LoadedScene& scene, const BakeSettings& settings,
                              const std::filesystem::path& output, BakeObserver& observer,
                              Diagnostics& diagnostics) {
    PFVOX_CHECK(checkSettings(settings, scene.probes));
    return Baker(device, scene, settings, observer, diagnostics).run(output);
}

}  // namespace pfvox

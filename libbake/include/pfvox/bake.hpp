// Bake: a scene becomes light on the faces of its voxels, and a field of probes.
//
//     LoadedScene -> [bakeProbes] -> out.pf_probe
//                     faces: links -> sweeps -> division -> final gather -> journal
//                     per probe: place -> what it sees -> light there -> small layers -> journal
//                     at the end: proximity grid -> file
//
// What is stored is I = E / pi of indirect light; the method is in docs/baking.md. Lengths are metres, light
// is linear RGB. One thread at a time for a device; the observer is called on the calling thread only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <pfvox/error.hpp>
#include <pfvox/gpu.hpp>
#include <pfvox/pf_probe.hpp>
#include <pfvox/proximity.hpp>
#include <pfvox/scene.hpp>
#include <string>

namespace pfvox {

/// Which direct light a path looks for. The two one-sided ways are for tests: all three have one expectation.
enum class LightSampling : std::uint8_t {
    Combined,    ///< emitters and directions, joined by the balance heuristic
    Emitters,    ///< emissive voxels by next-event estimation only
    Directions,  ///< emissive voxels only where a path runs into them
};
/// How light on faces is baked (docs/baking.md). Counts of rays are those of one value and multiples of 128.
struct FaceSettings {
    std::uint32_t baseRays = 256;   ///< kept as links between faces, on which bounces are solved
    std::uint32_t minRays = 256;    ///< of the final gather
    std::uint32_t maxRays = 16384;  ///< minRays times a power of four
    /// Neighbors on a surface have rays enough when the relative standard error of their light is below it.
    float noiseTarget = 0.005f;
    bool divide = true;  ///< several values a face beside lamps, where light bends, and at rims
};

/// What suits a device: less noise than the eye sees on a GPU, a picture within minutes without.
FaceSettings faceSettingsFor(const gpu::DeviceInfo& device);

/// How a bake is done.
struct BakeSettings {
    ProbeResolution resolution = resolutionOf(ProbeProfile::Default);  ///< of the maps
    /// Light on faces. The light of probes is then taken from it, not traced. Nothing = probes alone.
    std::optional<FaceSettings> faces;
    std::uint64_t seed = 0;
    std::uint32_t minSamples = 32;    ///< paths a texel; a multiple of 16
    std::uint32_t maxSamples = 4096;  ///< a multiple of 16, >= minSamples
    /// A tile of 8 x 8 texels stops when the standard error of its mean is under noiseTarget x max(mean,
    /// noiseFloor); 0 = every texel gets minSamples.
    float noiseTarget = 0.02f;
    float noiseFloor = 0.01f;  ///< radiance
    /// Reflections a path makes behind its texel: 0 = only light that reaches the texel's surface straight
    /// from emitters and sky. Nothing = no limit but roulette (and a cap of 128).
    std::optional<std::uint32_t> maxBounces;
    /// The probes to bake; the file is then a shard. Nothing = all.
    std::optional<ProbeRange> range;
    LightSampling sampling = LightSampling::Combined;
    bool stratified = true;  ///< Sobol points for the first two vertices; false, for tests: hashes for all
    bool relocate = true;    ///< move probes out of solids; false: those that touch one are inactive
    bool filter = true;  ///< take noise out of the light maps (docs/baking.md); false: each texel has its own
                         ///< paths only
    bool proximity = true;          ///< make the proximity grid; shards have none
    int zstdLevel = 1;              ///< 1 to 19
    bool resume = false;            ///< take finished probes from the journal beside the output
    bool force = false;             ///< bake even if the output is there and says it has this content already
    double dispatchSeconds = 0.25;  ///< device work is cut into pieces of about this length
    std::string toolName = "pfvox";
};

/// What a bake works on.
enum class BakeStage : std::uint8_t { Faces, Probes };

/// Where a bake stands.
struct BakeProgress {
    BakeStage stage = BakeStage::Probes;
    std::uint64_t faces = 0;         ///< of the scene, where their light is baked
    std::uint64_t probes = 0;        ///< to be baked in all
    std::uint64_t probesDone = 0;    ///< those that the journal had counted
    std::uint64_t probesReused = 0;  ///< of these, taken from the journal
    std::uint64_t rays = 0;
    double elapsedSeconds = 0.0;
    double gpuMs = 0.0;
    /// From the time of the probes baked so far; nothing before the first.
    std::optional<double> secondsLeft;
};
/// What a bake tells while it runs, and how it is stopped. Called from the thread that bakes.
class BakeObserver {
  public:
    BakeObserver() = default;
    BakeObserver(const BakeObserver&) = delete;
    BakeObserver& operator=(const BakeObserver&) = delete;
    virtual ~BakeObserver() = default;

    /// After each piece of device work.
    virtual void progress(const BakeProgress& progress) { static_cast<void>(progress); }
    /// Asked after each piece of device work. True: the bake ends with Cancelled; what is finished is in the
    /// journal.
    virtual bool stopRequested() { return false; }
};

/// Rays and device time of one pass.
struct BakePass {
    std::uint64_t rays = 0;
    double gpuMs = 0.0;
};
/// Light on faces: what was done and what came of it.
struct FaceReport {
    std::uint64_t faces = 0;
    std::uint64_t reused = 0;   ///< whose light was taken from the journal
    std::uint64_t divided = 0;  ///< with several values
    std::uint64_t values = 0;
    std::uint32_t sweeps = 0;    ///< of the light through the links
    double meanNoise = 0.0;      ///< relative standard error
    double noisyFraction = 0.0;  ///< of the faces: stopped at maxRays
    std::uint64_t fileBytes = 0;
    BakePass base;   ///< sun, links, sweeps
    BakePass light;  ///< final gather
    std::uint64_t stepLimitRays = 0;
};

/// What a bake did and what came of it.
struct BakeReport {
    std::optional<FaceReport> faces;
    bool upToDate = false;  ///< the output had this content already: nothing was done, the rest is empty
    BakePass geometry;
    BakePass light;              ///< paths, shadow rays counted
    double smallLayersMs = 0.0;  ///< CPU: irradiance, moments, min maps, summed over threads
    double proximityMs = 0.0;    ///< CPU, wall clock: the proximity grid
    double writeMs = 0.0;        ///< compression and journal, summed over threads; then copying into the file
    double totalMs = 0.0;
    std::uint64_t probes = 0;
    std::uint64_t reused = 0;  ///< taken from the journal
    ProbeCounts counts;
    std::uint64_t emitterFaces = 0;   ///< exposed faces of emissive voxels
    std::uint64_t stepLimitRays = 0;  ///< given up by the traversal; 0 in valid data
    /// Relative standard error of I, mean over the probes of which it is known; nothing = of none
    /// (ProbeRecord::error).
    std::optional<double> meanError;
    std::optional<double> maxError;           ///< the largest of these
    std::optional<double> noisyTileFraction;  ///< tiles that stopped at maxSamples, mean over active probes;
                                              ///< nothing = not adaptive
    std::optional<double>
        meanSamples;  ///< paths a texel that sees a surface, of probes baked in this run; nothing = none was
    ProximityReport proximity;  ///< uncoveredCells among it
    std::uint64_t fileBytes = 0;
};

/// Of everything in a scene that decides the light: models, transforms, materials, sun and sky. Cameras,
/// names and the probe grid are not in it.
ContentKey sceneContentHash(const LoadedScene& scene);

/// What a bake of this scene with these settings on this device puts into the header of its file: with an
/// equal key and an output that holds it and the same probes there is nothing to do. Shards have the key of
/// the whole.
ContentKey bakeContentKey(const LoadedScene& scene, const BakeSettings& settings,
                          const gpu::DeviceInfo& device);

/// What lies at the place of an output.
struct ExistingBake {
    enum class State : std::uint8_t {
        None,          ///< nothing
        Unreadable,    ///< no complete PF_PROBE file of this version
        OtherProbes,   ///< of another range
        OtherContent,  ///< made from something else
        Damaged,       ///< a map, or what stands before the maps, is not what its hash says
        UpToDate,      ///< the right one; the hash of every map was checked
    };
    State state = State::None;
    std::uint64_t fileBytes = 0;  ///< where it is a PF_PROBE file
    ProbeCounts counts;           ///< where it is up to date
    std::string damage;           ///< which map, where one is damaged
};

/// Reads all of the output that is there, in the calling TBB arena. `key`: bakeContentKey(); `range`: of the
/// bake.
ExistingBake inspectBake(const std::filesystem::path& output, const ContentKey& key, const ProbeRange& range);

/// Errors: BadValue (settings out of range, with their name), Cancelled (the observer asked to stop; resume
/// takes the finished probes), FileNotWritable, GpuOutOfMemory, GpuLost, those of gpu::Scene::build and
/// ProbeFileWriter. Diagnostics: bake-grid-outside (models stand out of the grid by more than a step),
/// bake-uncovered-cells, output-damaged (a note), and those of the journal.
Result<BakeReport> bakeProbes(gpu::Device& device, const LoadedScene& scene, const BakeSettings& settings,
                              const std::filesystem::path& output, BakeObserver& observer,
                              Diagnostics& diagnostics);

}  // namespace pfvox

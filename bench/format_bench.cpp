// Rates and sizes of libformat on the measured models: scatter into bricks, build, encode, decode.
// Run: bench_format [--benchmark_filter=shell]
#include <pfvox/hollow.hpp>
#include <pfvox/octree.hpp>
#include <pfvox/pf_vox.hpp>

#include "bench_support.hpp"

namespace pfvox::bench {
namespace {

VoxelAsset scatter(const MeasuredModel& source) {
    VoxelAsset asset;
    asset.materials.resize(static_cast<std::size_t>(source.materialCount));
    asset.models.emplace_back();
    asset.models[0].insert(source.voxels);
    return asset;
}

void scatterBricks(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    for (auto _ : state) {
        VoxelAsset asset = scatter(source);
        benchmark::DoNotOptimize(asset);
    }
    setRate(state, source);
}

void buildFromBricks(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    const VoxelAsset asset = scatter(source);
    OctreeAsset built;
    for (auto _ : state) built = buildOctrees(asset, Limits{}).value();
    setRate(state, source);
    const OctreeStatistics s = statistics(built.models[0], built.materials.size());
    const auto voxels = static_cast<double>(s.voxels);
    state.counters["voxels"] = voxels;
    state.counters["nodes"] = static_cast<double>(s.nodes);
    state.counters["values/voxel"] = static_cast<double>(s.values) / voxels;
    setBytesPerVoxel(state, "gpu_B/voxel", s.gpuBytes, source);
}

/// From the list to the octree by way of a VoxelModel, as an importer does that has further plans for the
/// voxels.
void buildThroughModel(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    OctreeAsset built;
    for (auto _ : state) {
        startAfresh(state, built);
        built = buildOctrees(scatter(source), Limits{}).value();
    }
    setRate(state, source);
}

/// From the list to the octree: the "complete build" of docs/performance.md.
void completeBuild(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    const auto materials = static_cast<std::size_t>(source.materialCount);
    OctreeModel built;
    for (auto _ : state) {
        startAfresh(state, built);
        built = buildOctree({.voxels = source.voxels}, materials, Limits{}).value();
    }
    setRate(state, source);
}

void encode(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    const OctreeAsset built = buildOctrees(scatter(source), Limits{}).value();
    std::vector<std::byte> bytes;
    for (auto _ : state) bytes = encodePfVox(built, {.zstdLevel = static_cast<int>(state.range(0))}).value();
    setRate(state, source);
    setBytesPerVoxel(state, "disk_B/voxel", bytes.size(), source);
}

void buildWithLod(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    const VoxelAsset asset = scatter(source);
    OctreeAsset built;
    for (auto _ : state) built = buildOctrees(asset, Limits{}, {.lod = true}).value();
    setRate(state, source);
    const std::vector<std::byte> bytes = encodePfVox(built, {}).value();
    setBytesPerVoxel(state, "disk_B/voxel", bytes.size(), source);
}

void hollow(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    VoxelAsset asset = scatter(source);
    HollowReport report;
    for (auto _ : state) report = hollowSolids(asset);
    setRate(state, source);
    state.counters["hidden"] = static_cast<double>(report.hiddenVoxels);
    const std::vector<std::byte> bytes = encodePfVox(buildOctrees(asset, Limits{}).value(), {}).value();
    setBytesPerVoxel(state, "disk_B/voxel", bytes.size(), source);
}

void decodeProfile(benchmark::State& state, const std::string& name, Profile profile) {
    const MeasuredModel& source = model(name);
    const std::vector<std::byte> bytes =
        encodePfVox(buildOctrees(scatter(source), Limits{}).value(), {.profile = profile}).value();
    DiagnosticList diagnostics;
    for (auto _ : state) {
        OctreeAsset asset = decodePfVox(bytes, Limits{}, diagnostics).value();
        benchmark::DoNotOptimize(asset);
    }
    setRate(state, source);
    setBytesPerVoxel(state, "disk_B/voxel", bytes.size(), source);
}

void decode(benchmark::State& state, const std::string& name) {
    decodeProfile(state, name, Profile::Packed);
}
void decodeResident(benchmark::State& state, const std::string& name) {
    decodeProfile(state, name, Profile::Resident);
}

void registerAll() {
    for (const std::string name : kMeasuredModelNames) {
        addBenchmark(name, "scatter", scatterBricks);
        addBenchmark(name, "build", buildFromBricks);
        addBenchmark(name, "build_lod", buildWithLod);
        addBenchmark(name, "hollow", hollow);
        addBenchmark(name, "complete", completeBuild);
        addBenchmark(name, "through_model", buildThroughModel);
        addBenchmark(name, "encode", encode)->Arg(3)->Arg(9);
        addBenchmark(name, "decode", decode);
        addBenchmark(name, "decode_resident", decodeResident);
    }
}

}  // namespace
}  // namespace pfvox::bench

int main(int argc, char** argv) {
    pfvox::bench::registerAll();
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

// Rates and sizes of libformat on the three measured models: scatter into bricks, build, encode, decode.
// Run: bench_format [--benchmark_filter=shell]
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <map>
#include <memory>
#include <pfvox/hollow.hpp>
#include <pfvox/octree.hpp>
#include <pfvox/pf_vox.hpp>

#include "measured_models.hpp"

namespace pfvox::bench {
namespace {

const MeasuredModel& model(const std::string& name) {
    static std::map<std::string, MeasuredModel> cache;
    auto [entry, isNew] = cache.try_emplace(name);
    if (isNew) entry->second = makeMeasuredModel(name);
    return entry->second;
}

VoxelAsset scatter(const MeasuredModel& source) {
    VoxelAsset asset;
    asset.materials.resize(static_cast<std::size_t>(source.materialCount));
    asset.models.emplace_back();
    for (const PackedVoxel& v : source.voxels) asset.models[0].set({v.x, v.y, v.z}, v.material);
    return asset;
}

void setRate(benchmark::State& state, const MeasuredModel& source) {
    state.counters["Mvoxels/s"] = benchmark::Counter(static_cast<double>(source.voxels.size()) / 1e6,
                                                     benchmark::Counter::kIsIterationInvariantRate);
}

void scatterBricks(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    for (auto _ : state) {
        VoxelAsset asset = scatter(source);
        benchmark::DoNotOptimize(asset);
    }
    setRate(state, source);
}

void buildOctree(benchmark::State& state, const std::string& name) {
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
    state.counters["gpu_B/voxel"] = static_cast<double>(s.gpuBytes) / voxels;
}

void completeBuild(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    for (auto _ : state) {
        OctreeAsset built = buildOctrees(scatter(source), Limits{}).value();
        benchmark::DoNotOptimize(built);
    }
    setRate(state, source);
}

void encode(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    const OctreeAsset built = buildOctrees(scatter(source), Limits{}).value();
    std::vector<std::byte> bytes;
    for (auto _ : state) bytes = encodePfVox(built, {.zstdLevel = static_cast<int>(state.range(0))}).value();
    setRate(state, source);
    state.counters["disk_B/voxel"] = static_cast<double>(bytes.size()) / static_cast<double>(source.voxels.size());
}

void buildWithLod(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    const VoxelAsset asset = scatter(source);
    OctreeAsset built;
    for (auto _ : state) built = buildOctrees(asset, Limits{}, {.lod = true}).value();
    setRate(state, source);
    const std::vector<std::byte> bytes = encodePfVox(built, {}).value();
    state.counters["disk_B/voxel"] = static_cast<double>(bytes.size()) / static_cast<double>(source.voxels.size());
}

void hollow(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    VoxelAsset asset = scatter(source);
    HollowReport report;
    for (auto _ : state) report = hollowSolids(asset);
    setRate(state, source);
    state.counters["hidden"] = static_cast<double>(report.hiddenVoxels);
    const std::vector<std::byte> bytes = encodePfVox(buildOctrees(asset, Limits{}).value(), {}).value();
    state.counters["disk_B/voxel"] = static_cast<double>(bytes.size()) / static_cast<double>(source.voxels.size());
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
    state.counters["disk_B/voxel"] = static_cast<double>(bytes.size()) / static_cast<double>(source.voxels.size());
}

void decode(benchmark::State& state, const std::string& name) { decodeProfile(state, name, Profile::Packed); }
void decodeResident(benchmark::State& state, const std::string& name) {
    decodeProfile(state, name, Profile::Resident);
}

void registerAll() {
    for (const std::string name : {"sphere", "shell", "terrain"}) {
        const auto add = [&](const char* what, auto function) {
            return benchmark::RegisterBenchmark((name + "/" + what).c_str(), function, name)
                ->Unit(benchmark::kMillisecond)
                ->UseRealTime();
        };
        add("scatter", scatterBricks);
        add("build", buildOctree);
        add("build_lod", buildWithLod);
        add("hollow", hollow);
        add("complete", completeBuild);
        add("encode", encode)->Arg(3)->Arg(9);
        add("decode", decode);
        add("decode_resident", decodeResident);
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

// The same lists of voxels in OpenVDB and NanoVDB, as their own tools build, store and load them.
// bench/run-format sets the figures beside those of bench_format.
//
// OpenVDB keeps materials in an Int32 grid (it has no smaller integer) and is written with its default
// compression (blosc and active mask in Debian's package). NanoVDB is built by its GridBuilder with values of
// one byte.
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <filesystem>

#define NANOVDB_USE_ZIP
#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/IO.h>

#include "bench_support.hpp"

namespace pfvox::bench {
namespace {

namespace fs = std::filesystem;

/// A file name of this process; the file goes when the object does.
class TemporaryFile {
  public:
    explicit TemporaryFile(const std::string& extension)
        : path_(fs::temp_directory_path() / ("pfvox-bench-" + std::to_string(getpid()) + extension)) {}
    ~TemporaryFile() {
        std::error_code ignored;
        fs::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    std::string path() const { return path_.string(); }
    std::size_t size() const { return fs::file_size(path_); }

  private:
    fs::path path_;
};

// --- OpenVDB ---

openvdb::Int32Grid::Ptr openVdbOf(std::span<const PackedVoxel> voxels) {
    auto grid = openvdb::Int32Grid::create(0);
    auto accessor = grid->getAccessor();
    for (const PackedVoxel& v : voxels) accessor.setValueOn({v.x, v.y, v.z}, v.material + 1);
    return grid;
}

/// The fastest way that OpenVDB offers for a list: one grid for each thread over its share of the list, whose
/// nodes are then merged without copying. The lists run slab by slab, so that shares hardly overlap.
openvdb::Int32Grid::Ptr openVdbOf(std::span<const PackedVoxel> voxels, std::size_t threads) {
    std::vector<openvdb::Int32Grid::Ptr> grids(threads);
    tbb::parallel_for(std::size_t{0}, threads, [&](std::size_t i) {
        const std::size_t first = voxels.size() * i / threads;
        grids[i] = openVdbOf(voxels.subspan(first, voxels.size() * (i + 1) / threads - first));
    });
    for (std::size_t i = 1; i < threads; ++i) grids[0]->tree().merge(grids[i]->tree());
    return grids[0];
}

void buildOpenVdb(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    const auto threads = static_cast<std::size_t>(state.range(0));
    openvdb::Int32Grid::Ptr grid;
    for (auto _ : state) {
        startAfresh(state, grid);
        grid = openVdbOf(source.voxels, threads);
    }
    if (grid->activeVoxelCount() != source.voxels.size()) state.SkipWithError("voxels were lost");
    setRate(state, source);
    setBytesPerVoxel(state, "memory_B/voxel", grid->memUsage(), source);
}

void loadOpenVdb(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    const TemporaryFile file(".vdb");
    openvdb::io::File(file.path()).write({openVdbOf(source.voxels)});
    for (auto _ : state) {
        openvdb::io::File reader(file.path());
        reader.open(false);  // no delayed loading: the values are wanted now
        auto grid = reader.readGrid(reader.beginName().gridName());
        benchmark::DoNotOptimize(grid);
    }
    setBytesPerVoxel(state, "disk_B/voxel", file.size(), source);
}

// --- NanoVDB ---

nanovdb::GridHandle<> nanoVdbOf(std::span<const PackedVoxel> voxels) {
    nanovdb::GridBuilder<std::uint8_t> builder(0);
    auto accessor = builder.getAccessor();
    for (const PackedVoxel& v : voxels) {
        accessor.setValue({v.x, v.y, v.z}, static_cast<std::uint8_t>(v.material + 1));
    }
    return builder.getHandle();
}

void buildNanoVdb(benchmark::State& state, const std::string& name) {
    const MeasuredModel& source = model(name);
    nanovdb::GridHandle<> grid;
    for (auto _ : state) {
        startAfresh(state, grid);
        grid = nanoVdbOf(source.voxels);
    }
    setRate(state, source);
    setBytesPerVoxel(state, "memory_B/voxel", grid.size(), source);
}

void loadNanoVdb(benchmark::State& state, const std::string& name, nanovdb::io::Codec codec) {
    const MeasuredModel& source = model(name);
    const TemporaryFile file(".nvdb");
    nanovdb::GridHandle<> written = nanoVdbOf(source.voxels);
    // Files of version 10 have no name for values of one byte, and the writer refuses grids without one. It
    // stores bytes as they are, so that any other name will do for measuring.
    reinterpret_cast<nanovdb::GridData*>(written.data())->mGridType = nanovdb::GridType::UInt32;
    nanovdb::io::writeGrid(file.path(), written, codec);
    for (auto _ : state) {
        auto grid = nanovdb::io::readGrid(file.path());
        benchmark::DoNotOptimize(grid);
    }
    setBytesPerVoxel(state, "disk_B/voxel", file.size(), source);
}

void registerAll() {
    for (const std::string name : kMeasuredModelNames) {
        addBenchmark(name, "openvdb_build", buildOpenVdb)->Arg(1)->Arg(2);
        addBenchmark(name, "openvdb_load", loadOpenVdb);
        addBenchmark(name, "nanovdb_build", buildNanoVdb);
        addBenchmark(name, "nanovdb_load_raw", [](benchmark::State& state, const std::string& of) {
            loadNanoVdb(state, of, nanovdb::io::Codec::NONE);
        });
        addBenchmark(name, "nanovdb_load_zip", [](benchmark::State& state, const std::string& of) {
            loadNanoVdb(state, of, nanovdb::io::Codec::ZIP);
        });
    }
}

}  // namespace
}  // namespace pfvox::bench

int main(int argc, char** argv) {
    openvdb::initialize();
    pfvox::bench::registerAll();
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

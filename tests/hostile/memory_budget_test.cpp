// What files make readers allocate: never more than Limits::maxMemoryBytes, and where memory ends there is an
// Error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>
#include <algorithm>

#include <functional>
#include <thread>

#include "support/allocations.hpp"
#include "support/container_formats.hpp"
#include "support/temp_folder.hpp"

namespace pfvox {
namespace {

using test::AllocationPeak;
using test::Bytes;
using test::ContainerFormat;
using test::OpenFile;

constexpr std::uint64_t kMiB = 1u << 20;

std::string asText(const Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A one-voxel model for each name and place that a test wants.
OctreeAsset smallAsset() {
    std::vector<VoxelModel> models;
    models.push_back(test::boxModel({0, 0, 0}, {1, 1, 1}, 0));
    return buildOctrees(test::assetOf(std::move(models)), Limits{}).value();
}

Result<OctreeAsset> decodeWithin(const Bytes& file, std::uint64_t limitBytes) {
    DiagnosticList diagnostics;
    return decodePfVox(file, {.maxMemoryBytes = limitBytes}, diagnostics);
}

class MemoryBudget : public testing::TestWithParam<const ContainerFormat*> {};

/// Each section alone becomes one that unpacks to 48 MiB.
TEST_P(MemoryBudget, BombsAreRefusedBeforeTheyUnpack) {
    constexpr std::uint64_t kLimit = 8 * kMiB;
    const std::size_t count = test::openFile(GetParam()->sample()).parts.size();
    for (std::size_t i = 0; i < count; ++i) {
        OpenFile open = test::openFile(GetParam()->sample());
        OpenFile::Part& part = open.parts[i];
        const std::string_view name(part.entry.fourcc.data(), 4);
        if (name == "DATA" || name == "FDAT") continue;
        SCOPED_TRACE(std::string(part.entry.fourcc.data(), 4));
        const std::size_t recordBytes = std::max<std::size_t>(part.raw.size() / part.entry.count, 1);
        part.raw.assign(48 * kMiB / recordBytes * recordBytes, 0);
        part.entry.count = part.raw.size() / recordBytes;
        const Bytes bomb = test::closeFile(std::move(open), true);
        ASSERT_LT(bomb.size(), kMiB);
        DiagnosticList diagnostics;
        const AllocationPeak peak;
        const auto decoded = GetParam()->decode(bomb, {.maxMemoryBytes = kLimit}, diagnostics);
        EXPECT_FALSE(decoded);
        EXPECT_FALSE(GetParam()->validate(bomb, {.maxMemoryBytes = kLimit}).empty());
        EXPECT_LT(peak.growthBytes(), kLimit + kMiB);
    }
}

/// What is drawn from the budget is at least what is allocated: at the smallest limit with which a file can
/// be read, reading it takes that and the file itself.
TEST_P(MemoryBudget, SmallestLimitIsWhatReadingTakes) {
    const test::TempFolder folder;
    const bool isVox = GetParam() == &test::kVoxFormat;
    std::vector<Bytes> files;
    if (isVox) {
        std::vector<VoxelModel> models;
        models.push_back(test::randomModel(3, {0, 0, 0}, {300, 40, 40}, 0.5, 4));
        models.push_back(test::randomModel(4, {0, 0, 0}, {100, 100, 100}, 0.3, 4));
        const auto asset = buildOctrees(test::assetOf(std::move(models)), Limits{}, {.lod = true}).value();
        files.push_back(encodePfVox(asset, {}).value());
        files.push_back(encodePfVox(asset, {.profile = Profile::Resident}).value());
    } else if (GetParam() == &test::kFaceFormat) {
        ProbeField field = test::probeField(test::noProbesInfo(), false);
        field.faces = FaceLight{};
        field.faces->info.facesPerChunk = 40000;
        field.faces->info.instances = {{.index = {}, .faceCounts = std::vector<std::uint32_t>(20000, 30)}};
        field.faces->info.range.end = 15;
        for (std::uint32_t chunk = 0; chunk < 15; ++chunk) {
            field.faces->chunks.push_back({.levels = {}, .values = {}});
            field.faces->info.chunks.emplace_back();
            FaceChunk& light = field.faces->chunks.back();
            light.levels.resize(faceChunkPlaces(field.faces->info)[chunk].faceCount);
            for (std::uint32_t i = 0; i < light.levels.size(); ++i)
                light.values.push_back(14u << 27 | test::mix(chunk, i) % (1u << 27));
        }
        files.push_back(encodePfProbe(field, {}).value());
    } else {
        files.push_back(
            encodePfProbe(test::probeField(test::probeInfo({8, 4, 4}, {64, 64, 8, 14})), {}).value());
    }
    // What each thread keeps for itself, whatever a file says: contexts of the decompressor, queues of tasks.
    const std::uint64_t slack = kMiB * std::max(2u, std::thread::hardware_concurrency());
    for (const Bytes& file : files) {
        const auto path = folder / "file";
        test::writeText(path, asText(file));
        std::uint64_t tooSmall = 0;
        std::uint64_t enough = 1ull << 32;
        while (enough - tooSmall > 4096) {
            const std::uint64_t limit = (tooSmall + enough) / 2;
            (GetParam()->load(path, {.maxMemoryBytes = limit}) ? enough : tooSmall) = limit;
        }
        EXPECT_GT(enough, kMiB) << "too little to tell";
        const AllocationPeak peak;
        ASSERT_TRUE(GetParam()->load(path, {.maxMemoryBytes = enough}));
        EXPECT_LT(peak.growthBytes(), enough + file.size() + slack);
        EXPECT_GT(peak.growthBytes(), enough / 4) << "far more is drawn than allocated";
        const AllocationPeak validating;
        EXPECT_THAT(GetParam()->validate(file, {.maxMemoryBytes = enough}), testing::IsEmpty());
        EXPECT_LT(validating.growthBytes(), enough + slack);
    }
}

INSTANTIATE_TEST_SUITE_P(AllFormats, MemoryBudget,
                         testing::Values(&test::kVoxFormat, &test::kProbeFormat, &test::kFaceFormat),
                         [](const auto& tested) { return std::string(tested.param->name); });

/// A file of about a kilobyte: instances, layers, materials, models and notes that all have one name of 1
/// MiB.
TEST(SharedNames, AreHeldOnce) {
    constexpr std::size_t kCount = 1500;
    OctreeAsset asset = smallAsset();
    const Name name = std::string(kMiB, 'x');
    for (Instance& instance : asset.instances) instance.name = name;
    asset.instances.resize(kCount, asset.instances[0]);
    asset.layers.assign(kCount, {.name = name});
    asset.source.notes.assign(kCount, name);
    for (Material& material : asset.materials) material.name = name;
    asset.models[0].name = name;
    const Bytes file = encodePfVox(asset, {}).value();
    EXPECT_LT(file.size(), 4096u);
    const AllocationPeak peak;
    const auto decoded = decodeWithin(file, 64 * kMiB);
    ASSERT_TRUE(decoded) << describe(decoded.error());
    EXPECT_LT(peak.growthBytes(), 4 * kMiB);
    EXPECT_EQ(decoded->instances[kCount - 1].name, name);
    EXPECT_EQ(decoded->instances[0].name.data(), decoded->source.notes[7].data());
}

TEST(SharedNames, OutliveTheirAsset) {
    const Bytes file = encodePfVox(smallAsset(), {}).value();
    Name kept;
    {
        const auto decoded = decodeWithin(file, kMiB);
        kept = decoded.value().instances[0].name;
    }
    EXPECT_EQ(kept, "instance");
}

/// Cameras have names of their own: as many as the budget holds.
TEST(SharedNames, OfCamerasAreDrawnFromTheBudget) {
    OctreeAsset asset = smallAsset();
    asset.cameras.resize(100, asset.cameras[0]);
    for (Camera& camera : asset.cameras) camera.name.assign(kMiB, 'x');
    const Bytes file = encodePfVox(asset, {}).value();
    asset = {};
    const AllocationPeak peak;
    const auto decoded = decodeWithin(file, 16 * kMiB);
    ASSERT_FALSE(decoded);
    EXPECT_EQ(decoded.error().code, ErrorCode::LimitExceeded);
    EXPECT_LT(peak.growthBytes(), 17 * kMiB);
}

/// Regions may share palettes in the file, but each has one in memory.
TEST(SharedPalettes, AreDrawnFromTheBudget) {
    constexpr std::size_t kModels = 1000;
    constexpr std::size_t kEntries = 65536;
    std::vector<VoxelModel> models;
    for (std::size_t i = 0; i < kModels; ++i) models.push_back(test::boxModel({0, 0, 0}, {1, 1, 1}, 0));
    OpenFile open =
        test::openFile(encodePfVox(buildOctrees(test::assetOf(std::move(models)), {}).value(), {}).value());
    OpenFile::Part& palettes = open.part("PALT");
    palettes.raw.assign(2 * kEntries, 0);
    palettes.entry.count = kEntries;
    for (std::uint32_t i = 0; i < kModels; ++i) {
        open.edit<layout::Region>("REGN", i, [](layout::Region& r) {
            r.paletteFirst = 0;
            r.paletteCount = kEntries;
        });
        open.part("ATTR", i).raw.assign(2, 0);
    }
    const Bytes file = test::closeFile(std::move(open), true);
    EXPECT_LT(file.size(), kMiB);
    EXPECT_TRUE(decodeWithin(file, 1024 * kMiB));
    const AllocationPeak peak;
    const auto decoded = decodeWithin(file, 64 * kMiB);
    ASSERT_FALSE(decoded);
    EXPECT_EQ(decoded.error().code, ErrorCode::LimitExceeded);
    EXPECT_LT(peak.growthBytes(), 65 * kMiB);
}

/// Nearly all of 2^32 probes are missing; messages name ranges.
TEST(MergeOfAHugeGrid, ListsNoProbes) {
    const test::TempFolder folder;
    ProbeFieldInfo info = test::probeInfo({65535, 65535, 1}, {0, 0, 1, 0});
    info.range = {5, 7};
    test::writeText(folder / "a", asText(encodePfProbe(test::probeField(info, false), {}).value()));
    const std::vector<std::filesystem::path> shards{folder / "a"};
    DiagnosticList diagnostics;
    const AllocationPeak peak;
    const auto merged = mergeProbeFields(shards, folder / "out", {}, Limits{}, diagnostics);
    ASSERT_FALSE(merged);
    EXPECT_THAT(merged.error().message, testing::HasSubstr("0:5, 7:4294836225"));
    EXPECT_LT(peak.growthBytes(), kMiB);
}

struct Work {
    const char* name;
    std::function<Result<void>()> run;
};

template <class T>
Result<void> ended(const Result<T>& result) {
    if (!result) return tl::make_unexpected(result.error());
    return {};
}

/// Where any single allocation fails, the caller gets an Error, and no exception comes out.
void failEachAllocation(const Work& work) {
    SCOPED_TRACE(work.name);
    ASSERT_TRUE(work.run()) << describe(work.run().error());
    std::size_t failures = 0;
    for (std::uint64_t before = 0;; ++before) {
        Result<void> result;
        bool happened = false;
        {
            const test::FailingAllocation failing(before);
            try {
                result = work.run();
            } catch (const std::exception&) {
                FAIL() << "allocation " << before << ": an exception comes out";
            }
            happened = failing.happened();
        }
        if (!happened) break;
        if (result) continue;  // memory that could be done without
        ++failures;
        ASSERT_EQ(result.error().code, ErrorCode::LimitExceeded) << describe(result.error());
    }
    EXPECT_GT(failures, 0u);
}

TEST(OutOfMemory, IsAnErrorOfEveryReaderAndWriter) {
    const test::TempFolder folder;
    const Bytes& vox = test::kVoxFormat.sample();
    const Bytes& probes = test::kProbeFormat.sample();
    test::writeText(folder / "vox", asText(vox));
    test::writeText(folder / "probes", asText(probes));
    DiagnosticList ignored;
    const OctreeAsset asset = decodePfVox(vox, Limits{}, ignored).value();
    const ProbeField field = decodePfProbe(probes, Limits{}, ignored).value();
    const auto reader = ProbeFileReader::open(folder / "probes", Limits{}, ignored).value();
    const auto found = [](const std::vector<Finding>& findings) -> Result<void> {
        if (findings.empty()) return {};
        EXPECT_EQ(findings[0].id, "limit-exceeded");
        return fail(ErrorCode::LimitExceeded, findings[0].message);
    };
    const std::filesystem::path voxFile = folder / "vox";
    const std::filesystem::path probeFile = folder / "probes";
    const std::filesystem::path mergedFile = folder / "merged";
    const std::filesystem::path bakedFile = folder / "baked";
    const std::vector<std::filesystem::path> shards{probeFile};
    const std::vector<Work> works{
        {"decodePfVox", [&] { return ended(decodePfVox(vox, Limits{}, ignored)); }},
        {"loadPfVox", [&] { return ended(loadPfVox(voxFile, Limits{}, ignored)); }},
        {"readPfVoxHeader", [&] { return ended(readPfVoxHeader(vox)); }},
        {"validatePfVox", [&] { return found(validatePfVox(vox, Limits{})); }},
        {"encodePfVox", [&] { return ended(encodePfVox(asset, {})); }},
        {"decodePfProbe", [&] { return ended(decodePfProbe(probes, Limits{}, ignored)); }},
        {"loadPfProbe", [&] { return ended(loadPfProbe(probeFile, Limits{}, ignored)); }},
        {"validatePfProbe", [&] { return found(validatePfProbe(probes, Limits{})); }},
        {"validatePfProbeFile", [&] { return found(validatePfProbeFile(probeFile, Limits{})); }},
        {"encodePfProbe", [&] { return ended(encodePfProbe(field, {})); }},
        {"readProbe", [&] { return ended(reader.readProbe(1)); }},
        {"readStored", [&] { return ended(reader.readStored(0, ProbeLayer::DepthNormal)); }},
        {"mergeProbeFields", [&] { return mergeProbeFields(shards, mergedFile, {}, Limits{}, ignored); }},
        {"ProbeFileWriter", [&]() -> Result<void> {
             PFVOX_TRY(auto, writer, ProbeFileWriter::open(bakedFile, field.info, {}, ignored));
             for (std::uint32_t i = 0; i < field.probes.size(); ++i)
                 PFVOX_CHECK(writer.append(i, field.probes[i]));
             PFVOX_CHECK(writer.readProbe(0));
             return writer.finish(field.proximity);
         }}};
    tbb::task_arena arena(1);
    arena.execute([&] {
        for (const Work& work : works) failEachAllocation(work);
    });
}

}  // namespace
}  // namespace pfvox

#include "pf_vox/asset_reader.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <fmt/format.h>
#include <algorithm>
#include <numeric>

#include "pf_vox/info_reader.hpp"
#include "pf_vox/lod_codec.hpp"
#include "pf_vox/region_reader.hpp"
#include "pf_vox/section_index.hpp"
#include "pf_vox/top_tree_reader.hpp"

namespace pfvox {

namespace {

/// The tables that say where every region is, checked against each other.
struct Tables {
    std::vector<layout::Model> models;
    std::vector<layout::Region> regions;
    std::vector<std::uint16_t> palettes;
};

Result<void> checkRegionRecord(const layout::Region& r, std::size_t paletteSize) {
    if (r.depth == 0 || r.depth > layout::kMaxRegionDepth) {
        return fail(ErrorCode::BadValue, fmt::format("depth {}", r.depth));
    }
    if (r.nodeCount == 0 || r.nodeCount > layout::kMaxRegionNodes || r.branchCount > r.nodeCount) {
        return fail(ErrorCode::BadValue, fmt::format("{} nodes", r.nodeCount));
    }
    if (r.valueCount == 0 || r.valueCount > layout::kMaxRegionValues) {
        return fail(ErrorCode::BadValue, fmt::format("{} values", r.valueCount));
    }
    if (r.paletteCount == 0 || r.paletteFirst > paletteSize ||
        r.paletteCount > paletteSize - r.paletteFirst) {
        return fail(ErrorCode::BadReference, "palette outside PALT");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (r.boundsMin[axis] >= r.boundsMax[axis] || r.boundsMax[axis] > 1u << r.depth) {
            return fail(ErrorCode::BadValue, "bounds outside the region");
        }
    }
    return {};
}

Result<void> checkModelRecord(const layout::Model& m, std::uint64_t nextRegion, std::size_t regionCount,
                              const Limits& limits) {
    if (m.firstRegion != nextRegion || m.regionCount > regionCount - nextRegion) {
        return fail(ErrorCode::BadReference, "its regions do not follow those of the model before");
    }
    if (m.depth > limits.maxModelDepth) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("{} levels, more than maxModelDepth = {}", m.depth, limits.maxModelDepth));
    }
    if (m.regionCount > limits.maxRegions) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("{} regions, more than maxRegions = {}", m.regionCount, limits.maxRegions));
    }
    if (m.topBranchCount > m.topNodeCount)
        return fail(ErrorCode::BadValue, "more branches than nodes in its top tree");
    const bool hasTopTree = m.topNodeCount != 0;
    if (hasTopTree != (m.regionCount > 1) || hasTopTree != (m.depth > layout::kMaxRegionDepth)) {
        return fail(ErrorCode::BadStructure, "top tree, depth and number of regions contradict each other");
    }
    return {};
}

/// What the octrees will take, so that nothing is allocated for a file that is too large.
std::uint64_t decodedBytes(const Tables& tables, const SectionIndex& index) {
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < tables.regions.size(); ++i) {
        const layout::Region& r = tables.regions[i];
        bytes +=
            8ull * r.nodeCount + 4ull * r.farCount + (r.paletteCount <= 256 ? 1ull : 2ull) * r.valueCount;
        if (index.find(RegionPart::Lod, i) != nullptr) bytes += residentLodBytes(r.nodeCount);
    }
    return bytes;
}

Result<Tables> readTables(std::span<const std::byte> file, const SectionIndex& index, const Limits& limits) {
    Tables tables;
    PFVOX_TRY(auto, models, readRecords<layout::Model>(file, index, "MODL", limits.maxModels));
    PFVOX_TRY(auto, regions, readRecords<layout::Region>(file, index, "REGN", index.regionCount()));
    PFVOX_TRY(auto, palettes,
              readRecords<std::uint16_t>(file, index, "PALT", 65536ull * index.regionCount()));
    tables.models = std::move(models);
    tables.regions = std::move(regions);
    tables.palettes = std::move(palettes);

    const auto inRecord = [&](Result<void> result, const char* fourcc, std::size_t i) {
        if (!result) {
            Error& error = result.error();
            error.context = fmt::format("section {} record {}", fourcc, i);
            error.offsetBytes = index.find(fourcc)->offset;
        }
        return result;
    };
    for (std::size_t i = 0; i < tables.regions.size(); ++i) {
        PFVOX_CHECK(inRecord(checkRegionRecord(tables.regions[i], tables.palettes.size()), "REGN", i));
    }
    std::uint64_t nextRegion = 0;
    for (std::size_t i = 0; i < tables.models.size(); ++i) {
        const layout::Model& m = tables.models[i];
        PFVOX_CHECK(inRecord(checkModelRecord(m, nextRegion, tables.regions.size(), limits), "MODL", i));
        nextRegion += m.regionCount;
    }
    if (nextRegion != tables.regions.size()) {
        return failInSection(
            *index.find("REGN"), ErrorCode::BadStructure,
            fmt::format("{} regions belong to no model", tables.regions.size() - nextRegion));
    }
    if (const std::uint64_t bytes = decodedBytes(tables, index); bytes > limits.maxMemoryBytes) {
        return failInSection(
            *index.find("REGN"), ErrorCode::LimitExceeded,
            fmt::format("decodes to {} bytes, more than maxMemoryBytes = {}", bytes, limits.maxMemoryBytes));
    }
    return tables;
}

glm::ivec3 toVec(const std::array<std::int32_t, 3>& a) {
    return {a[0], a[1], a[2]};
}

/// Model without the content of its regions.
OctreeModel modelFromRecord(const layout::Model& record, const NameList& names) {
    OctreeModel model;
    model.name = names.at(record.name);
    model.depth = record.depth;
    model.originVoxels = toVec(record.origin);
    model.voxelCount = record.voxelCount;
    if (record.regionCount != 0) model.bounds = {toVec(record.boundsMin), toVec(record.boundsMax)};
    model.regions.resize(record.regionCount);
    return model;
}

/// What only a walk over all leaves can tell: voxel counts and boxes.
Result<void> checkContent(const OctreeModel& model) {
    const VoxelModel voxels = toVoxelModel(model);
    if (const std::uint64_t count = voxels.voxelCount(); count != model.voxelCount) {
        return fail(ErrorCode::BadStructure, fmt::format("model '{}' announces {} voxels and has {}",
                                                         model.name, model.voxelCount, count));
    }
    if (!model.regions.empty() && voxels.bounds() != model.bounds) {
        return fail(ErrorCode::BadStructure,
                    fmt::format("model '{}' has another bounding box than announced", model.name));
    }
    return {};
}

/// The state of one reading.
class Reading {
  public:
    Reading(std::span<const std::byte> file, const Limits& limits, FaultPolicy policy)
        : file_(file), limits_(limits), policy_(policy) {}

    ReadOutcome run(Diagnostics& diagnostics) {
        readAll(diagnostics);
        return std::move(outcome_);
    }

  private:
    /// Takes note of a failure; true when reading may go on.
    bool accept(const Result<void>& result) {
        if (result) return true;
        outcome_.faults.push_back(result.error());
        return policy_ == FaultPolicy::CollectAll;
    }

    void readAll(Diagnostics& diagnostics) {
        const auto head = readHead(file_);
        if (!head) return static_cast<void>(outcome_.faults.push_back(head.error()));
        outcome_.asset.hollowed = (head->header.optionalFeatures & kPfVoxHollow) != 0;
        const auto index = SectionIndex::make(*head, diagnostics);
        if (!index) return static_cast<void>(outcome_.faults.push_back(index.error()));
        NameList names;
        if (!accept(readInfo(file_, *index, limits_, names, outcome_.asset))) return;
        const auto tables = readTables(file_, *index, limits_);
        if (!tables) return static_cast<void>(outcome_.faults.push_back(tables.error()));
        if (!readModels(*tables, *index, names)) return;
        if (!readRegions(*tables, *index)) return;
        if (!accept(checkReferences(*index))) return;
        if (policy_ == FaultPolicy::CollectAll && outcome_.faults.empty()) {
            for (const OctreeModel& model : outcome_.asset.models) accept(checkContent(model));
        }
    }

    bool readModels(const Tables& tables, const SectionIndex& index, const NameList& names) {
        auto topTrees = TopTreeReader::make(file_, index, tables.models);
        if (!topTrees) {
            outcome_.faults.push_back(topTrees.error());
            return false;
        }
        for (const layout::Model& record : tables.models) {
            OctreeModel& model = outcome_.asset.models.emplace_back(modelFromRecord(record, names));
            const auto regions = std::span(tables.regions).subspan(record.firstRegion, record.regionCount);
            if (record.topNodeCount != 0 && !accept(topTrees->readNext(record, regions, model))) return false;
        }
        return true;
    }

    /// Memory for all regions whose sections have the announced sizes; the others get their errors now.
    static std::shared_ptr<MemoryPool> makePool(const Tables& tables, const RegionReader& reader,
                                                std::vector<Result<void>>& results) {
        std::size_t bytes = 0;
        for (std::size_t i = 0; i < tables.regions.size(); ++i) {
            const auto ofRegion = reader.poolBytes(i, tables.regions[i]);
            if (ofRegion) {
                bytes += *ofRegion;
            } else {
                results[i] = tl::make_unexpected(ofRegion.error());
            }
        }
        return std::make_shared<MemoryPool>(bytes);
    }

    bool readRegions(const Tables& tables, const SectionIndex& index) {
        std::vector<OctreeRegion*> targets;
        for (OctreeModel& model : outcome_.asset.models) {
            for (OctreeRegion& region : model.regions) targets.push_back(&region);
        }
        std::vector<Result<void>> results(targets.size());
        const RegionReader reader(file_, index, outcome_.asset.materials);
        const auto pool = makePool(tables, reader, results);
        tbb::enumerable_thread_specific<RegionReader::Scratch> scratch;
        tbb::parallel_for(std::size_t{0}, targets.size(), [&](std::size_t i) {
            if (!results[i]) return;
            auto region = reader.read(i, tables.regions[i], tables.palettes, pool, scratch.local());
            if (region) {
                *targets[i] = *std::move(region);
            } else {
                results[i] = tl::make_unexpected(std::move(region).error());
            }
        });
        return std::ranges::all_of(results, [&](const Result<void>& r) { return accept(r); });
    }

    /// References between tables that were read apart from each other.
    Result<void> checkReferences(const SectionIndex& index) {
        const OctreeAsset& asset = outcome_.asset;
        const auto hasInstance = std::ranges::find_if(
            asset.instances, [&](const Instance& i) { return i.model >= asset.models.size(); });
        if (hasInstance != asset.instances.end()) {
            return failInSection(
                *index.find("INST"), ErrorCode::BadReference,
                fmt::format("an instance of model {} of {}", hasInstance->model, asset.models.size()));
        }
        for (const OctreeModel& model : asset.models) {
            for (const OctreeRegion& region : model.regions) {
                if (!region.palette.empty() && std::ranges::max(region.palette) >= asset.materials.size()) {
                    return failInSection(*index.find("PALT"), ErrorCode::BadReference,
                                         "a material does not exist");
                }
            }
        }
        return {};
    }

    std::span<const std::byte> file_;
    const Limits& limits_;
    FaultPolicy policy_;
    ReadOutcome outcome_;
};

}  // namespace

ReadOutcome readAsset(std::span<const std::byte> file, const Limits& limits, FaultPolicy policy,
                      Diagnostics& diagnostics) {
    return Reading(file, limits, policy).run(diagnostics);
}

}  // namespace pfvox

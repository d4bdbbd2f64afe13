#include "pf_vox/asset_reader.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <pfvox/octree_walk.hpp>

#include "container/findings.hpp"
#include "pf_vox/info_reader.hpp"
#include "pf_vox/region_reader.hpp"
#include "pf_vox/top_tree_reader.hpp"

namespace pfvox {

namespace {

/// The tables that say where every region is.
struct ModelRecords {
    container::Array<layout::Model> models;
    container::Array<layout::Region> regions;
    container::Array<std::uint16_t> palettes;

    ModelTables tables() const { return {models, regions, palettes}; }
};

Result<ModelRecords> readModelRecords(const PfVoxSections& sections, const Limits& limits) {
    PFVOX_TRY(auto, models, sections.readTable<layout::Model>("MODL", limits.maxModels));
    PFVOX_TRY(auto, regions, sections.readTable<layout::Region>("REGN", sections.table.regionCount()));
    PFVOX_TRY(auto, palettes,
              sections.readTable<std::uint16_t>("PALT", 65536ull * sections.table.regionCount()));
    return ModelRecords{std::move(models), std::move(regions), std::move(palettes)};
}

glm::ivec3 toVec(const std::array<std::int32_t, 3>& a) {
    return {a[0], a[1], a[2]};
}

/// Model without the content of its regions.
Result<OctreeModel> modelFromRecord(const layout::Model& record, const NamePool& names,
                                    container::MemoryBudget& budget) {
    OctreeModel model;
    model.name = names.at(record.name);
    model.depth = record.depth;
    model.originVoxels = toVec(record.origin);
    model.voxelCount = record.voxelCount;
    if (record.regionCount != 0) model.bounds = {toVec(record.boundsMin), toVec(record.boundsMax)};
    PFVOX_CHECK(budget.resize(model.regions, record.regionCount));
    return model;
}

/// What only a walk over all leaves can tell: voxel count and box.
Result<void> checkContent(const OctreeRegion& region) {
    std::uint64_t count = 0;
    VoxelBox bounds;
    forEachLeaf(region, [&](const Leaf& leaf) {
        count += std::uint64_t{1} << (3 * leaf.edgeLog2);
        bounds.include({leaf.corner, leaf.corner + leaf.edge()});
    });
    if (count != region.voxelCount) {
        return fail(ErrorCode::BadStructure,
                    fmt::format("announces {} voxels and has {}", region.voxelCount, count));
    }
    if (bounds != region.bounds)
        return fail(ErrorCode::BadStructure, "has another bounding box than announced");
    return {};
}

/// The state of one reading.
class Reading {
  public:
    Reading(const container::ByteSource& source, const Limits& limits, FaultPolicy policy)
        : source_(source), limits_(limits), policy_(policy), budget_(limits.maxMemoryBytes) {}

    ReadOutcome run(Diagnostics& diagnostics) {
        if (const auto result = readAll(diagnostics); !result) accept(result.error());
        return std::move(outcome_);
    }

  private:
    /// Takes note of a fault; true when reading may go on.
    bool accept(Error fault) {
        outcome_.faults.push_back(std::move(fault));
        return policy_ == FaultPolicy::CollectAll && outcome_.faults.size() < container::kMaxFindings;
    }

    /// An error ends the reading; faults that leave something to check do so by policy.
    Result<void> readAll(Diagnostics& diagnostics) {
        PFVOX_TRY(const auto, head, container::readHead(source_, container::kPfVox, budget_));
        outcome_.asset.hollowed = (head.header.optionalFeatures & kPfVoxHollow) != 0;
        PFVOX_TRY(const PfVoxSections, sections,
                  indexSections(head, container::SectionReader(source_, budget_), diagnostics));
        auto info = readInfo(sections, limits_);
        if (!info && !accept(info.error())) return {};
        PFVOX_TRY(const ModelRecords, records, readModelRecords(sections, limits_));
        if (!checkRecords(info ? &*info : nullptr, records, sections, diagnostics)) return {};
        if (info) PFVOX_CHECK(makeInfo(*info, budget_, outcome_.asset));
        PFVOX_TRY(const bool, areTreesWhole, readModels(records, sections, info ? info->names : NamePool()));
        if (areTreesWhole) PFVOX_CHECK(readRegions(records, sections));
        if (policy_ == FaultPolicy::CollectAll && outcome_.faults.empty()) checkContents(sections);
        return {};
    }

    /// False when reading must end: beyond, the tables of models are believed.
    bool checkRecords(const InfoRecords* info, const ModelRecords& records, const PfVoxSections& sections,
                      Diagnostics& diagnostics) {
        const FaultSink sink = [&](std::string_view fourcc, Error fault) {
            fault.offsetBytes = sections.table.find(fourcc)->offset;
            return accept(std::move(fault));
        };
        if (info != nullptr) {
            if (!checkInfo(info->tables(), sink) || !checkNames(info->names, sections, diagnostics))
                return false;
            if (!checkPlacements(info->instances, records.models.size(), sink)) return false;
        }
        const std::size_t before = outcome_.faults.size();
        const std::size_t materials = info != nullptr ? info->materials.size() : layout::kMaxPalette;
        return checkModels(records.tables(), materials, limits_, sink) && outcome_.faults.size() == before;
    }

    /// Earlier versions stored names as they found them: they are read, but not valid.
    bool checkNames(const NamePool& names, const PfVoxSections& sections, Diagnostics& diagnostics) {
        const auto foreign = names.firstForeign();
        if (!foreign) return true;
        const layout::Section& section = *sections.table.find("NAME");
        std::string message = fmt::format("name {} is not UTF-8", *foreign);
        if (policy_ == FaultPolicy::CollectAll) {
            return accept(container::failInSection(section, ErrorCode::BadValue, std::move(message)).value());
        }
        diagnostics.report({.severity = Severity::Warning,
                            .id = "pfvox-name-encoding",
                            .message = message + " and was read as Windows-1252",
                            .offsetBytes = section.offset});
        return true;
    }

    /// False where top trees are damaged.
    Result<bool> readModels(const ModelRecords& records, const PfVoxSections& sections,
                            const NamePool& names) {
        PFVOX_TRY(auto, topTrees, TopTreeReader::make(sections, records.models));
        std::vector<OctreeModel>& models = outcome_.asset.models;
        PFVOX_CHECK(budget_.reserve(models, records.models.size()));
        bool areWhole = true;
        for (const layout::Model& record : records.models) {
            PFVOX_TRY(OctreeModel, made, modelFromRecord(record, names, budget_));
            OctreeModel& model = models.emplace_back(std::move(made));
            if (record.topNodeCount == 0) continue;
            const auto regions = std::span(records.regions).subspan(record.firstRegion, record.regionCount);
            const auto read = topTrees.readNext(record, regions, model);
            if (read) continue;
            areWhole = false;
            if (!accept(read.error())) break;
        }
        return areWhole || policy_ == FaultPolicy::CollectAll;
    }

    Result<void> readRegions(const ModelRecords& records, const PfVoxSections& sections) {
        std::vector<OctreeRegion*> targets;
        PFVOX_CHECK(budget_.reserve(targets, records.regions.size()));
        for (OctreeModel& model : outcome_.asset.models) {
            for (OctreeRegion& region : model.regions) targets.push_back(&region);
        }
        std::map<std::size_t, Error> faults;  // by region
        const RegionReader reader(sections, records.palettes, outcome_.asset.materials);
        PFVOX_TRY(const auto, pool, makePool(records, reader, *sections.table.find("REGN"), faults));
        std::mutex mutex;
        tbb::enumerable_thread_specific<RegionReader::Scratch> scratch;
        tbb::parallel_for(std::size_t{0}, targets.size(), [&](std::size_t i) {
            {
                const std::scoped_lock lock(mutex);
                if (faults.contains(i)) return;
            }
            auto region = reader.read(i, records.regions[i], pool, scratch.local());
            if (region) {
                *targets[i] = *std::move(region);
            } else {
                const std::scoped_lock lock(mutex);
                faults.emplace(i, std::move(region).error());
            }
        });
        for (auto& [region, fault] : faults) {
            if (!accept(std::move(fault))) break;
        }
        return {};
    }

    /// Memory for all regions whose sections have the announced sizes; the others get their errors now.
    Result<std::shared_ptr<MemoryPool>> makePool(const ModelRecords& records, const RegionReader& reader,
                                                 const layout::Section& regionTable,
                                                 std::map<std::size_t, Error>& faults) {
        std::uint64_t pooled = 0;
        std::uint64_t beside = 0;
        std::uint64_t scratch = 0;
        for (std::size_t i = 0; i < records.regions.size(); ++i) {
            const auto sizes = reader.sizesOf(i, records.regions[i]);
            if (!sizes) {
                faults.emplace(i, sizes.error());
                continue;
            }
            pooled += sizes->pooled;
            beside += sizes->beside;
            scratch = std::max(scratch, sizes->scratch);
        }
        const auto threads = static_cast<std::uint64_t>(tbb::this_task_arena::max_concurrency());
        scratch *= std::min<std::uint64_t>(threads, records.regions.size());
        PFVOX_CHECK(container::inSection(regionTable, budget_.take(pooled + beside + scratch)));
        return std::make_shared<MemoryPool>(pooled);
    }

    void checkContents(const PfVoxSections& sections) {
        const layout::Section& section = *sections.table.find("REGN");
        std::size_t index = 0;
        for (const OctreeModel& model : outcome_.asset.models) {
            for (const OctreeRegion& region : model.regions) {
                const auto checked = checkContent(region);
                if (!checked &&
                    !accept(failAt(checked.error().code, section.offset,
                                   fmt::format("section REGN record {}", index), checked.error().message)
                                .value()))
                    return;
                ++index;
            }
        }
    }

    const container::ByteSource& source_;
    const Limits& limits_;
    FaultPolicy policy_;
    container::MemoryBudget budget_;
    ReadOutcome outcome_;
};

}  // namespace

ReadOutcome readAsset(std::span<const std::byte> file, const Limits& limits, FaultPolicy policy,
                      Diagnostics& diagnostics) {
    return Reading(container::MemorySource(file), limits, policy).run(diagnostics);
}

}  // namespace pfvox

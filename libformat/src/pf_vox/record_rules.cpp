#include "pf_vox/record_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <pfvox/asset.hpp>

#include "container/field_rules.hpp"

namespace pfvox {

namespace {

using container::FieldRule;
using container::kMaxFloat;
using I64Box = std::array<std::array<std::int64_t, 3>, 2>;

constexpr double kMaxInt = std::numeric_limits<std::int32_t>::max();

constexpr std::array kMaterialRules{
    PFVOX_RULE(layout::Material, type, 0, static_cast<double>(MaterialType::Media)),
    PFVOX_RULE(layout::Material, indexOfRefraction, 1, kMaxFloat),
    PFVOX_RULE(layout::Material, emissionStrength, 0, kMaxFloat),
    PFVOX_RULE(layout::Material, density, 0, kMaxFloat)};
constexpr std::array kInstanceRules{PFVOX_RULE(layout::Instance, worldFromModel, -kMaxFloat, kMaxFloat),
                                    PFVOX_RULE(layout::Instance, layer, -1, kMaxInt)};
constexpr std::array kPlaceRules{PFVOX_RULE(layout::Place, translation, -double{kMaxFloat}, kMaxFloat)};
constexpr std::array kCameraRules{PFVOX_RULE(layout::Camera, position, -kMaxFloat, kMaxFloat),
                                  PFVOX_RULE(layout::Camera, target, -kMaxFloat, kMaxFloat),
                                  PFVOX_RULE(layout::Camera, fovYDegrees, 1, 179)};
constexpr std::array kMetaRules{PFVOX_RULE(layout::Meta, voxelSizeMetres,
                                           std::numeric_limits<double>::denorm_min(),
                                           std::numeric_limits<double>::max())};
constexpr std::array kModelRules{PFVOX_RULE(layout::Model, depth, 0, layout::kMaxModelDepth)};
constexpr std::array kRegionRules{PFVOX_RULE(layout::Region, depth, 1, layout::kMaxRegionDepth),
                                  PFVOX_RULE(layout::Region, nodeCount, 1, layout::kMaxRegionNodes),
                                  PFVOX_RULE(layout::Region, valueCount, 1, layout::kMaxRegionValues),
                                  PFVOX_RULE(layout::Region, voxelCount, 1, kMaxInt)};

/// Hands faults on with their records; remembers whether to go on.
class Checker {
  public:
    explicit Checker(const FaultSink& sink) : sink_(sink) {}

    bool goesOn() const { return goesOn_; }

    /// True where there was no fault.
    bool check(std::string_view fourcc, std::size_t record, Result<void> result) {
        if (result || !goesOn_) return result.has_value();
        Error& fault = result.error();
        fault.context = fmt::format("section {} record {}", fourcc, record);
        goesOn_ = sink_(fourcc, std::move(fault));
        return false;
    }

    template <class Record>
    void checkAll(std::string_view fourcc, std::span<const Record> records,
                  std::span<const FieldRule> rules) {
        for (std::size_t i = 0; i < records.size() && goesOn_; ++i)
            check(fourcc, i, container::checkFields(rules, &records[i]));
    }

  private:
    const FaultSink& sink_;
    bool goesOn_ = true;
};

Result<void> checkRegion(const layout::Region& r, std::size_t paletteSize) {
    PFVOX_CHECK(container::checkFields(kRegionRules, &r));
    if (r.branchCount > r.nodeCount)
        return fail(ErrorCode::BadValue, fmt::format("{} branches of {} nodes", r.branchCount, r.nodeCount));
    if (r.paletteCount == 0 || r.paletteFirst > paletteSize || r.paletteCount > paletteSize - r.paletteFirst)
        return fail(ErrorCode::BadReference, "palette outside PALT");
    if (r.paletteCount > layout::kMaxPalette) {
        return fail(ErrorCode::BadValue,
                    fmt::format("a palette of {} entries, more than values can name", r.paletteCount));
    }
    std::uint64_t volume = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (r.boundsMin[axis] >= r.boundsMax[axis] || r.boundsMax[axis] > 1u << r.depth)
            return fail(ErrorCode::BadValue, "bounds outside the region");
        volume *= static_cast<std::uint64_t>(r.boundsMax[axis] - r.boundsMin[axis]);
    }
    if (r.voxelCount > volume) {
        return fail(ErrorCode::BadStructure,
                    fmt::format("{} voxels within bounds of {}", r.voxelCount, volume));
    }
    return {};
}

Result<void> checkModel(const layout::Model& m, std::uint64_t nextRegion, std::size_t regionCount,
                        const Limits& limits) {
    if (m.firstRegion != nextRegion || m.regionCount > regionCount - nextRegion)
        return fail(ErrorCode::BadReference, "its regions do not follow those of the model before");
    if (m.depth > limits.maxModelDepth) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("{} levels, more than maxModelDepth = {}", m.depth, limits.maxModelDepth));
    }
    if (m.regionCount > limits.maxRegions) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("{} regions, more than maxRegions = {}", m.regionCount, limits.maxRegions));
    }
    PFVOX_CHECK(container::checkFields(kModelRules, &m));
    for (const std::int32_t origin : m.origin) {
        if (std::int64_t{origin} + (std::int64_t{1} << m.depth) > std::numeric_limits<std::int32_t>::max()) {
            return fail(
                ErrorCode::BadValue,
                fmt::format("origin is {}: a cube of 2^{} voxels from there on ends beyond 2^31 - 1; move "
                            "the model nearer to its origin",
                            origin, m.depth));
        }
    }
    if (m.topBranchCount > m.topNodeCount)
        return fail(ErrorCode::BadValue, "more branches than nodes in its top tree");
    const bool hasTopTree = m.topNodeCount != 0;
    if (hasTopTree != (m.regionCount > 1) || hasTopTree != (m.depth > layout::kMaxRegionDepth))
        return fail(ErrorCode::BadStructure, "top tree, depth and number of regions contradict each other");
    return {};
}

/// Together the regions must be what the model says about itself: lookups go by the model first.
Result<void> checkRegionsOf(const layout::Model& m, std::span<const layout::Region> regions) {
    if (regions.size() == 1 && (regions[0].origin != m.origin || regions[0].depth != m.depth))
        return fail(ErrorCode::BadStructure, "its only region has another origin or depth");
    std::uint64_t voxels = 0;
    I64Box bounds{};
    for (std::size_t i = 0; i < regions.size(); ++i) {
        const layout::Region& r = regions[i];
        voxels += r.voxelCount;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t least = std::int64_t{r.origin[axis]} + r.boundsMin[axis];
            const std::int64_t most = std::int64_t{r.origin[axis]} + r.boundsMax[axis];
            bounds[0][axis] = i == 0 ? least : std::min(bounds[0][axis], least);
            bounds[1][axis] = i == 0 ? most : std::max(bounds[1][axis], most);
        }
    }
    if (voxels != m.voxelCount) {
        return fail(ErrorCode::BadStructure,
                    fmt::format("{} voxels are announced, its regions have {}", m.voxelCount, voxels));
    }
    if (!std::ranges::equal(m.boundsMin, bounds[0]) || !std::ranges::equal(m.boundsMax, bounds[1]))
        return fail(ErrorCode::BadStructure, "its bounding box is not that of its regions");
    return {};
}

}  // namespace

bool checkInfo(const InfoTables& tables, const FaultSink& sink) {
    Checker checker(sink);
    checker.checkAll("MATL", tables.materials, kMaterialRules);
    checker.checkAll("INST", tables.instances, kInstanceRules);
    for (std::size_t i = 0; i < tables.instances.size() && checker.goesOn(); ++i) {
        const std::int32_t layer = tables.instances[i].layer;
        if (layer >= 0 && static_cast<std::size_t>(layer) >= tables.layerCount)
            checker.check("INST", i,
                          fail(ErrorCode::BadReference,
                               fmt::format("lies on layer {} of {}", layer, tables.layerCount)));
    }
    checker.checkAll("INSX", tables.places, kPlaceRules);
    for (std::size_t i = 0; i < tables.places.size() && checker.goesOn(); ++i) {
        for (std::size_t row = 0; row < 3; ++row) {
            if (static_cast<float>(tables.places[i].translation[row]) ==
                tables.instances[i].worldFromModel[4 * row + 3])
                continue;
            checker.check("INSX", i, fail(ErrorCode::BadStructure, "is not the place of its instance"));
            break;
        }
    }
    checker.checkAll("CAMR", tables.cameras, kCameraRules);
    for (std::size_t i = 0; i < tables.cameras.size() && checker.goesOn(); ++i) {
        if (tables.cameras[i].position == tables.cameras[i].target)
            checker.check("CAMR", i, fail(ErrorCode::BadValue, "looks at the place where it stands"));
    }
    checker.checkAll("META", std::span(&tables.meta, 1), kMetaRules);
    return checker.goesOn();
}

bool checkModels(const ModelTables& tables, std::size_t materialCount, const Limits& limits,
                 const FaultSink& sink) {
    Checker checker(sink);
    for (std::size_t i = 0; i < tables.regions.size() && checker.goesOn(); ++i)
        checker.check("REGN", i, checkRegion(tables.regions[i], tables.palettes.size()));
    std::uint64_t nextRegion = 0;
    for (std::size_t i = 0; i < tables.models.size() && checker.goesOn(); ++i) {
        const layout::Model& m = tables.models[i];
        if (!checker.check("MODL", i, checkModel(m, nextRegion, tables.regions.size(), limits))) return false;
        checker.check("MODL", i, checkRegionsOf(m, tables.regions.subspan(nextRegion, m.regionCount)));
        nextRegion += m.regionCount;
    }
    if (checker.goesOn() && nextRegion != tables.regions.size()) {
        checker.check("REGN", nextRegion,
                      fail(ErrorCode::BadStructure,
                           fmt::format("{} regions belong to no model", tables.regions.size() - nextRegion)));
    }
    for (std::size_t i = 0; i < tables.palettes.size() && checker.goesOn(); ++i) {
        if (tables.palettes[i] >= materialCount)
            checker.check("PALT", i,
                          fail(ErrorCode::BadReference, fmt::format("material {} of {} does not exist",
                                                                    tables.palettes[i], materialCount)));
    }
    return checker.goesOn();
}

bool checkPlacements(std::span<const layout::Instance> instances, std::size_t modelCount,
                     const FaultSink& sink) {
    Checker checker(sink);
    for (std::size_t i = 0; i < instances.size() && checker.goesOn(); ++i) {
        if (instances[i].model >= modelCount)
            checker.check(
                "INST", i,
                fail(ErrorCode::BadReference, fmt::format("places model {}, but there are {} models",
                                                          instances[i].model, modelCount)));
    }
    return checker.goesOn();
}

}  // namespace pfvox

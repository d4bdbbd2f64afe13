// PF_VOX files that lie in what is theirs alone (container_hostile_test.cpp has the rest): every field that a
// reader could trust with its hash repaired, so that the check behind the hash is what is tested.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <pfvox/pf_vox.hpp>
#include <random>

#include "support/container_formats.hpp"

namespace pfvox {
namespace {

using test::Bytes;
using test::OpenFile;

const Bytes& sampleFile() {
    return test::kVoxFormat.sample();
}

const Bytes& residentFile() {
    static const Bytes file = test::voxSample(Profile::Resident);
    return file;
}

Result<OctreeAsset> decode(const Bytes& file, const Limits& limits = {}) {
    DiagnosticList diagnostics;
    return decodePfVox(file, limits, diagnostics);
}

/// Decoding must fail with this code, and validate must have a finding with the same.
void expectRefused(const Bytes& file, ErrorCode code, const std::string& words = "") {
    const auto asset = decode(file);
    ASSERT_FALSE(asset) << "accepted, expected " << toString(code);
    EXPECT_EQ(asset.error().code, code) << describe(asset.error());
    EXPECT_THAT(describe(asset.error()), testing::HasSubstr(words));
    const std::vector<Finding> findings = validatePfVox(file, Limits{});
    ASSERT_FALSE(findings.empty());
    EXPECT_EQ(findings[0].id, toString(code)) << findings[0].message;
}

struct Lie {
    const char* name;
    ErrorCode code;
    std::function<void(OpenFile&)> tell;
};

template <class Record>
std::function<void(OpenFile&)> edit(const char* fourcc, std::size_t i, std::function<void(Record&)> change) {
    return [=](OpenFile& open) { open.edit<Record>(fourcc, i, change); };
}

std::vector<Lie> lies() {
    using layout::Instance;
    using layout::Material;
    using layout::Model;
    using layout::Region;
    const auto region = [](std::function<void(Region&)> change) {
        return edit<Region>("REGN", 0, std::move(change));
    };
    const auto model = [](std::function<void(Model&)> change) {
        return edit<Model>("MODL", 1, std::move(change));
    };
    const auto drop = [](const char* fourcc, std::uint32_t id = layout::kNoRegion) {
        return [=](OpenFile& open) {
            const layout::Section gone = open.part(fourcc, id).entry;
            std::erase_if(open.parts, [&](const OpenFile::Part& p) {
                return p.entry.fourcc == gone.fourcc && p.entry.region == gone.region;
            });
        };
    };
    const auto poke = [](const char* fourcc, std::uint32_t id, std::size_t at, std::uint8_t value) {
        return [=](OpenFile& open) { open.part(fourcc, id).raw.at(at) = value; };
    };
    return {
        {"four billion nodes", ErrorCode::BadValue, region([](Region& r) { r.nodeCount = 0xffffffffu; })},
        {"no nodes", ErrorCode::BadValue, region([](Region& r) { r.nodeCount = 0; })},
        {"one node more", ErrorCode::BadStructure, region([](Region& r) { ++r.nodeCount; })},
        {"one branch more", ErrorCode::BadStructure, region([](Region& r) { ++r.branchCount; })},
        {"depth nine", ErrorCode::BadValue, region([](Region& r) { r.depth = 9; })},
        {"depth zero", ErrorCode::BadValue, region([](Region& r) { r.depth = 0; })},
        {"too flat for its nodes", ErrorCode::BadStructure, region([](Region& r) {
             r.depth = 1;
             r.boundsMin = {0, 0, 0};
             r.boundsMax = {1, 1, 1};
         })},
        {"far pointers that are not there", ErrorCode::BadStructure,
         region([](Region& r) { r.farCount = 7; })},
        {"four billion values", ErrorCode::BadValue, region([](Region& r) { r.valueCount = 0xffffffffu; })},
        {"one value less", ErrorCode::BadStructure, region([](Region& r) { --r.valueCount; })},
        {"palette outside", ErrorCode::BadReference, region([](Region& r) { r.paletteFirst = 0xfffffff0u; })},
        {"palette too long", ErrorCode::BadReference,
         region([](Region& r) { r.paletteCount = 0xffffffffu; })},
        {"palette empty", ErrorCode::BadReference, region([](Region& r) { r.paletteCount = 0; })},
        {"palette shorter than its values", ErrorCode::BadReference,
         region([](Region& r) { r.paletteCount = 1; })},
        {"bounds outside", ErrorCode::BadValue, region([](Region& r) {
             r.boundsMax = {300, 300, 300};
         })},
        {"bounds inverted", ErrorCode::BadValue,
         region([](Region& r) { std::swap(r.boundsMin, r.boundsMax); })},
        {"region elsewhere than its leaf", ErrorCode::BadStructure,
         edit<Region>("REGN", 1, [](Region& r) { r.origin[0] += 256; })},
        {"regions of another model", ErrorCode::BadReference, model([](Model& m) { m.firstRegion = 0; })},
        {"four billion regions", ErrorCode::BadReference,
         model([](Model& m) { m.regionCount = 0xffffffffu; })},
        {"depth 200", ErrorCode::LimitExceeded, model([](Model& m) { m.depth = 200; })},
        {"top tree without depth", ErrorCode::BadStructure, model([](Model& m) { m.depth = 8; })},
        {"top tree of no nodes", ErrorCode::BadStructure, model([](Model& m) { m.topNodeCount = 0; })},
        {"top tree of too many nodes", ErrorCode::BadStructure,
         model([](Model& m) { m.topNodeCount = 1000; })},
        {"top tree with one leaf less", ErrorCode::BadStructure, poke("TOPT", layout::kNoRegion, 1, 1)},
        {"node without children", ErrorCode::BadStructure,
         [](OpenFile& open) { open.part("MASK", 0).raw.back() = 0; }},
        {"root without inner children", ErrorCode::BadStructure, poke("MASK", 0, 0, 0)},
        {"value outside its palette", ErrorCode::BadReference, poke("ATTR", 0, 0, 200)},
        {"level of detail of a material outside its palette", ErrorCode::BadReference,
         [](OpenFile& open) { open.part("LODA", 0).raw.back() = 200; }},
        {"level of detail of another number of nodes", ErrorCode::BadStructure,
         [](OpenFile& open) { open.part("LODA", 0).raw.pop_back(); }},
        {"level of detail twice", ErrorCode::BadStructure,
         [](OpenFile& open) { open.parts.push_back(open.part("LODA", 0)); }},
        {"nodes of the other profile", ErrorCode::BadStructure,
         [](OpenFile& open) { open.parts.push_back(test::openFile(residentFile()).part("NODE", 0)); }},
        {"resident by its header only", ErrorCode::BadStructure,
         [](OpenFile& open) { open.header.requiredFeatures = kPfVoxResident; }},
        {"material that does not exist", ErrorCode::BadReference, poke("PALT", layout::kNoRegion, 0, 77)},
        {"instance of no model", ErrorCode::BadReference,
         edit<Instance>("INST", 1, [](Instance& i) { i.model = 12; })},
        {"instance on a layer that does not exist", ErrorCode::BadReference,
         edit<Instance>("INST", 1, [](Instance& i) { i.layer = 2; })},
        {"layer before none", ErrorCode::BadValue,
         edit<Instance>("INST", 1, [](Instance& i) { i.layer = -2; })},
        {"camera at no place", ErrorCode::BadValue,
         edit<layout::Camera>("CAMR", 0, [](layout::Camera& c) { c.position[1] = std::nanf(""); })},
        {"camera that sees nothing", ErrorCode::BadValue,
         edit<layout::Camera>("CAMR", 0, [](layout::Camera& c) { c.fovYDegrees = 0; })},
        {"camera that looks at itself", ErrorCode::BadValue,
         edit<layout::Camera>("CAMR", 0, [](layout::Camera& c) { c.target = c.position; })},
        {"light that takes light away", ErrorCode::BadValue,
         edit<Material>("MATL", 2, [](Material& m) { m.emissionStrength = -5; })},
        {"index of refraction below that of nothing", ErrorCode::BadValue,
         edit<Material>("MATL", 3, [](Material& m) { m.indexOfRefraction = -1; })},
        {"density of infinity", ErrorCode::BadValue,
         edit<Material>("MATL", 0, [](Material& m) { m.density = INFINITY; })},
        {"model at the end of int32", ErrorCode::BadValue,
         [](OpenFile& open) {
             open.edit<Model>("MODL", 0, [](Model& m) { m.origin[0] = 0x7ffffff0; });
             open.edit<Region>("REGN", 0, [](Region& r) { r.origin[0] = 0x7ffffff0; });
         }},
        {"top tree at the end of int32", ErrorCode::BadValue, model([](Model& m) {
             m.origin = {0x7fffff00, 0x7fffff00, 0x7fffff00};
         })},
        {"model beside its only region", ErrorCode::BadStructure,
         edit<Model>("MODL", 0, [](Model& m) { m.origin[2] += 8; })},
        {"model that is deeper than its only region", ErrorCode::BadStructure,
         edit<Model>("MODL", 0, [](Model& m) { ++m.depth; })},
        {"region that has left its model", ErrorCode::BadStructure,
         region([](Region& r) { r.origin[1] += 64; })},
        {"other bounds than those of the regions", ErrorCode::BadStructure,
         model([](Model& m) { ++m.boundsMax[0]; })},
        {"other voxels than those of the regions", ErrorCode::BadStructure,
         model([](Model& m) { ++m.voxelCount; })},
        {"more voxels than the bounds hold", ErrorCode::BadStructure,
         region([](Region& r) { r.voxelCount = 1u << 24; })},
        {"transform that is no number", ErrorCode::BadValue,
         edit<Instance>("INST", 0, [](Instance& i) { i.worldFromModel[3] = std::nanf(""); })},
        {"material of unknown type", ErrorCode::BadValue,
         edit<Material>("MATL", 0, [](Material& m) { m.type = 99; })},
        {"name table that points outside", ErrorCode::BadStructure, poke("NAME", layout::kNoRegion, 7, 0x7f)},
        {"voxel size zero", ErrorCode::BadValue,
         [](OpenFile& open) { std::fill_n(open.part("META").raw.begin(), 8, std::uint8_t{0}); }},
        {"no materials table", ErrorCode::BadStructure, drop("MATL")},
        {"no models table", ErrorCode::BadStructure, drop("MODL")},
        {"no top trees", ErrorCode::BadStructure, drop("TOPT")},
        {"no masks of a region", ErrorCode::BadStructure, drop("MASK", 1)},
        {"no values of a region", ErrorCode::BadStructure, drop("ATTR", 2)},
        {"section twice", ErrorCode::BadStructure,
         [](OpenFile& open) { open.parts.push_back(open.part("MATL")); }},
        {"masks of a region that does not exist", ErrorCode::BadStructure,
         [](OpenFile& open) { open.part("MASK", 2).entry.region = 0xfffffff0u; }},
        {"count that does not fit the bytes", ErrorCode::BadStructure,
         [](OpenFile& open) { open.part("MODL").entry.count = 2; }},
        {"more models than the limit", ErrorCode::LimitExceeded,
         [](OpenFile& open) { open.part("MODL").entry.count = 1ull << 60; }},
    };
}

TEST(PfVoxHostile, LiesWithRepairedHashes) {
    for (const Lie& lie : lies()) {
        SCOPED_TRACE(lie.name);
        OpenFile open = test::openFile(sampleFile());
        lie.tell(open);
        expectRefused(test::closeFile(std::move(open)), lie.code);
    }
}

/// Adds to a word of a resident section.
std::function<void(OpenFile&)> addToWord(const char* fourcc, std::uint32_t id, std::size_t at,
                                         std::uint32_t amount) {
    return [=](OpenFile& open) {
        std::uint8_t* place = open.part(fourcc, id).raw.data() + 4 * at;
        std::uint32_t word = 0;
        std::memcpy(&word, place, sizeof word);
        word += amount;
        std::memcpy(place, &word, sizeof word);
    };
}

std::vector<Lie> residentLies() {
    using layout::Region;
    const auto drop = [](const char* fourcc) {
        return [=](OpenFile& open) {
            const OpenFile::Part* gone = &open.part(fourcc, fourcc[0] == 'T' ? layout::kNoRegion : 0);
            open.parts.erase(open.parts.begin() + (gone - open.parts.data()));
        };
    };
    constexpr std::uint32_t kPointerOne = 1u << node::kPointerShift;
    return {
        {"root that points too far", ErrorCode::BadStructure, addToWord("NODE", 0, 0, kPointerOne)},
        {"root that points to itself", ErrorCode::BadStructure, addToWord("NODE", 0, 0, 0u - kPointerOne)},
        {"pointer behind the end", ErrorCode::BadStructure, addToWord("NODE", 0, 0, 0x7000u * kPointerOne)},
        {"far bit without a far table", ErrorCode::BadStructure, addToWord("NODE", 0, 0, node::kFarBit)},
        {"leaf that is not valid", ErrorCode::BadStructure,
         [](OpenFile& open) { open.part("NODE", 0).raw.at(1) = 0; }},
        {"last node that points on", ErrorCode::BadStructure,
         [](OpenFile& open) { open.part("NODE", 0).raw.back() = 0x40; }},
        {"node without children", ErrorCode::BadStructure,
         [](OpenFile& open) { std::fill_n(open.part("NODE", 0).raw.end() - 4, 4, std::uint8_t{0}); }},
        {"value pointer off by one", ErrorCode::BadStructure, addToWord("LOOK", 0, 1, 1u << 8)},
        {"value of no child", ErrorCode::BadStructure,
         [](OpenFile& open) {
             auto& nodes = open.part("NODE", 1).raw;
             auto& look = open.part("LOOK", 1).raw;
             for (std::size_t i = 0; i < nodes.size(); i += 4) {
                 if (nodes[i + 1] != 0xff && look[i] != 0) look[i] = 0xff;
             }
         }},
        {"leaf without a value", ErrorCode::BadStructure,
         [](OpenFile& open) { open.part("LOOK", 1).raw.at(0) = 0; }},
        {"value outside its palette", ErrorCode::BadReference,
         [](OpenFile& open) { open.part("VALU", 0).raw.at(0) = 200; }},
        {"top tree that points to itself", ErrorCode::BadStructure,
         addToWord("TOPN", layout::kNoRegion, 0, kPointerOne)},
        {"more nodes than there are", ErrorCode::BadStructure,
         edit<Region>("REGN", 0, [](Region& r) { ++r.nodeCount; })},
        {"other number of branches", ErrorCode::BadStructure,
         edit<Region>("REGN", 0, [](Region& r) { ++r.branchCount; })},
        {"too flat for its nodes", ErrorCode::BadStructure,
         edit<Region>("REGN", 0,
                      [](Region& r) {
                          r.depth = 1;
                          r.boundsMin = {0, 0, 0};
                          r.boundsMax = {1, 1, 1};
                      })},
        {"far pointers that are not there", ErrorCode::BadStructure,
         edit<Region>("REGN", 0, [](Region& r) { r.farCount = 7; })},
        {"level of detail outside its palette", ErrorCode::BadReference,
         [](OpenFile& open) { open.part("LODR", 0).raw.back() = 200; }},
        {"no nodes", ErrorCode::BadStructure, drop("NODE")},
        {"no lookup", ErrorCode::BadStructure, drop("LOOK")},
        {"no values", ErrorCode::BadStructure, drop("VALU")},
        {"no top tree", ErrorCode::BadStructure, drop("TOPN")},
        {"packed by its header", ErrorCode::BadStructure,
         [](OpenFile& open) { open.header.requiredFeatures = 0; }},
    };
}

TEST(PfVoxHostile, ResidentLiesWithRepairedHashes) {
    ASSERT_TRUE(decode(test::closeFile(test::openFile(residentFile()))));
    for (const Lie& lie : residentLies()) {
        SCOPED_TRACE(lie.name);
        OpenFile open = test::openFile(residentFile());
        lie.tell(open);
        expectRefused(test::closeFile(std::move(open)), lie.code);
    }
}

/// Words that are accepted must be those that the builder's rules give: the masks alone decide.
TEST(PfVoxHostile, DamagedResidentWordsAreRefusedOrWhatTheMasksSay) {
    std::mt19937 random(6);
    std::size_t accepted = 0;
    for (int round = 0; round < 4000; ++round) {
        OpenFile open = test::openFile(residentFile());
        const char* names[] = {"NODE", "LOOK", "VALU"};
        OpenFile::Part& part = open.part(names[random() % 3], static_cast<std::uint32_t>(random() % 3));
        const std::size_t at = random() % part.raw.size();
        part.raw[at] = static_cast<std::uint8_t>(part.raw[at] ^ (1u << random() % 8));
        const auto asset = decode(test::closeFile(std::move(open)));
        if (!asset) continue;
        ++accepted;
        const auto packed = encodePfVox(*asset, {});
        ASSERT_TRUE(packed);
        const auto again = decode(*packed);
        ASSERT_TRUE(again) << describe(again.error());
        for (std::size_t m = 0; m < asset->models.size(); ++m) {
            for (std::size_t r = 0; r < asset->models[m].regions.size(); ++r) {
                EXPECT_EQ(again->models[m].regions[r].tree.nodes, asset->models[m].regions[r].tree.nodes);
                EXPECT_EQ(again->models[m].regions[r].lookup, asset->models[m].regions[r].lookup);
            }
        }
    }
    EXPECT_GT(accepted, 0u);
}

TEST(PfVoxHostile, LimitsAreKept) {
    const auto refusedWith = [&](const Limits& limits) {
        const auto asset = decode(sampleFile(), limits);
        return !asset && asset.error().code == ErrorCode::LimitExceeded;
    };
    EXPECT_TRUE(refusedWith({.maxMemoryBytes = 100}));
    EXPECT_TRUE(refusedWith({.maxModels = 2}));
    EXPECT_TRUE(refusedWith({.maxInstances = 1}));
    EXPECT_TRUE(refusedWith({.maxMaterials = 3}));
    EXPECT_TRUE(refusedWith({.maxRegions = 1}));
    EXPECT_TRUE(refusedWith({.maxModelDepth = 8}));
    EXPECT_FALSE(refusedWith({}));
}

TEST(PfVoxHostile, ValidateReportsEveryFinding) {
    OpenFile open = test::openFile(sampleFile());
    open.part("ATTR", 0).raw[0] = 200;
    open.part("MASK", 1).raw[0] = 0;
    open.edit<layout::Instance>("INST", 1, [](layout::Instance& i) { i.model = 12; });
    const std::vector<Finding> findings = validatePfVox(test::closeFile(std::move(open)), Limits{});
    EXPECT_EQ(findings.size(), 3u);
}

/// Counts and boxes that agree with each other and not with the voxels.
TEST(PfVoxHostile, ValidateNoticesWrongCountsAndBounds) {
    OpenFile open = test::openFile(sampleFile());
    open.edit<layout::Model>("MODL", 0, [](layout::Model& m) { --m.voxelCount; });
    open.edit<layout::Region>("REGN", 0, [](layout::Region& r) { --r.voxelCount; });
    const Bytes file = test::closeFile(std::move(open));
    EXPECT_TRUE(decode(file));
    const std::vector<Finding> findings = validatePfVox(file, Limits{});
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].context, "section REGN record 0");
    EXPECT_THAT(findings[0].message, testing::HasSubstr("voxels and has"));

    open = test::openFile(sampleFile());
    open.edit<layout::Model>("MODL", 1, [](layout::Model& m) { ++m.boundsMax[1]; });
    open.edit<layout::Region>("REGN", 1, [](layout::Region& r) { ++r.boundsMax[1]; });
    open.edit<layout::Region>("REGN", 2, [](layout::Region& r) { ++r.boundsMax[1]; });
    const std::vector<Finding> boxes = validatePfVox(test::closeFile(std::move(open)), Limits{});
    ASSERT_EQ(boxes.size(), 2u);
    EXPECT_EQ(boxes[1].context, "section REGN record 2");
    EXPECT_THAT(boxes[1].message, testing::HasSubstr("bounding box"));
}

/// Earlier versions stored names as they found them: they are read, but not valid, and not written again.
TEST(PfVoxHostile, NamesThatAreNotUtf8) {
    OpenFile open = test::openFile(sampleFile());
    std::vector<std::uint8_t>& names = open.part("NAME").raw;
    const std::string brick = "brick";
    const auto at = std::search(names.begin(), names.end(), brick.begin(), brick.end());
    ASSERT_NE(at, names.end());
    *at = 0xfc;
    const Bytes file = test::closeFile(std::move(open));
    DiagnosticList diagnostics;
    const auto asset = decodePfVox(file, Limits{}, diagnostics);
    ASSERT_TRUE(asset) << describe(asset.error());
    EXPECT_EQ(asset->materials[0].name, "ürick");
    ASSERT_EQ(diagnostics.entries().size(), 1u);
    EXPECT_EQ(diagnostics.entries()[0].id, "pfvox-name-encoding");
    const auto findings = validatePfVox(file, Limits{});
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].context, "section NAME");

    OctreeAsset raw = *asset;
    raw.materials[0].name = "\xfcrick";
    EXPECT_EQ(encodePfVox(raw, {}).error().code, ErrorCode::BadValue);
}

/// What readers refuse is not written: the same table of rules is asked.
TEST(PfVoxHostile, WritersRefuseWhatReadersDo) {
    const auto refused = [](const std::function<void(OctreeAsset&)>& change) {
        OctreeAsset asset = decode(sampleFile()).value();
        change(asset);
        const auto file = encodePfVox(asset, {});
        return file ? std::string("written") : describe(file.error());
    };
    using testing::HasSubstr;
    EXPECT_EQ(refused([](OctreeAsset&) {}), "written");
    EXPECT_THAT(refused([](OctreeAsset& a) { a.materials[1].emissionStrength = -5; }),
                HasSubstr("section MATL record 1: emissionStrength is -5"));
    EXPECT_THAT(refused([](OctreeAsset& a) { a.materials[0].indexOfRefraction = -1; }),
                HasSubstr("indexOfRefraction is -1"));
    EXPECT_THAT(refused([](OctreeAsset& a) { a.cameras[0].position.x = 1e300; }),
                HasSubstr("section CAMR record 0: position is inf"));
    EXPECT_THAT(refused([](OctreeAsset& a) { a.cameras[0].fovYDegrees = 180; }),
                HasSubstr("fovYDegrees is 180: 1 to 179"));
    EXPECT_THAT(refused([](OctreeAsset& a) { a.cameras[0].target = a.cameras[0].position; }),
                HasSubstr("looks at the place where it stands"));
    EXPECT_THAT(refused([](OctreeAsset& a) { a.instances[1].layer = 2; }), HasSubstr("layer 2 of 2"));
    EXPECT_THAT(refused([](OctreeAsset& a) { a.instances[1].model = 3; }), HasSubstr("places model 3"));
    EXPECT_THAT(refused([](OctreeAsset& a) { a.source.voxelSizeMetres = 0; }), HasSubstr("voxelSizeMetres"));
    EXPECT_THAT(refused([](OctreeAsset& a) { ++a.models[0].voxelCount; }), HasSubstr("its regions have"));
    EXPECT_THAT(refused([](OctreeAsset& a) { a.models[0].originVoxels.x += 8; }),
                HasSubstr("another origin or depth"));
    EXPECT_THAT(refused([](OctreeAsset& a) { a.models[1].originVoxels.z = 0x7fffff00; }),
                HasSubstr("nearer to its origin"));
    EXPECT_THAT(refused([](OctreeAsset& a) { a.models[0].regions[0].palette[0] = 9; }),
                HasSubstr("material"));
}

}  // namespace
}  // namespace pfvox

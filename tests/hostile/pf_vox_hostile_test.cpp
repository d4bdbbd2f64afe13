// PF_VOX files that lie: every prefix, every flipped bit, and every field that a reader could trust with its
// hash repaired, so that the check behind the hash is what is tested.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <pfvox/pf_vox.hpp>
#include <random>

#include "support/pf_vox_surgery.hpp"
#include "support/voxel_models.hpp"

namespace pfvox {
namespace {

using test::Bytes;
using test::OpenFile;

/// A small file with a feature of every kind: a top tree of three regions, a hoisted value, an empty model,
/// levels of detail.
Bytes makeSampleFile(Profile profile) {
    std::vector<VoxelModel> models;
    models.push_back(test::patchyModel(11, 20));
    models.push_back(test::boxModel({250, 0, 0}, {262, 10, 3}, 1));
    models.emplace_back();
    const auto built = buildOctrees(test::assetOf(std::move(models)), Limits{}, {.lod = true});
    return encodePfVox(built.value(), {.profile = profile}).value();
}

const Bytes& sampleFile() {
    static const Bytes file = makeSampleFile(Profile::Packed);
    return file;
}

const Bytes& residentFile() {
    static const Bytes file = makeSampleFile(Profile::Resident);
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

TEST(PfVoxHostile, EveryPrefixIsRefused) {
    const Bytes& file = sampleFile();
    for (std::size_t size = 0; size < file.size(); ++size) {
        const Bytes prefix(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
        const auto asset = decode(prefix);
        ASSERT_FALSE(asset) << "prefix of " << size << " bytes";
        ASSERT_TRUE(asset.error().code == ErrorCode::Truncated || asset.error().code == ErrorCode::BadMagic)
            << describe(asset.error());
    }
}

TEST(PfVoxHostile, AByteTooManyIsRefused) {
    Bytes file = sampleFile();
    file.push_back(std::byte{0});
    expectRefused(file, ErrorCode::BadStructure, "1 bytes follow the end");
}

TEST(PfVoxHostile, EveryFlippedBitIsNoticedOrChangesNothing) {
    const Bytes original = sampleFile();
    Bytes file = original;
    std::size_t harmless = 0;
    for (std::size_t i = 0; i < file.size(); ++i) {
        for (int bit = 0; bit < 8; ++bit) {
            file[i] ^= std::byte{1} << bit;
            // zstd frames have bits without meaning: what it decodes to must be what was encoded.
            if (const auto asset = decode(file)) {
                ASSERT_EQ(encodePfVox(*asset, {}).value(), original) << "byte " << i << " bit " << bit;
                ++harmless;
            }
            file[i] = original[i];
        }
    }
    EXPECT_LT(harmless, original.size() * 8 / 100);
}

TEST(PfVoxHostile, RandomDamageBehindTheHashesNeverCrashes) {
    std::mt19937 random(5);
    std::size_t accepted = 0;
    for (int round = 0; round < 4000; ++round) {
        OpenFile open = test::openFile(sampleFile());
        OpenFile::Part& part = open.parts[random() % open.parts.size()];
        if (part.raw.empty()) continue;
        for (std::uint64_t n = 1 + random() % 3; n > 0; --n) {
            part.raw[random() % part.raw.size()] = static_cast<std::uint8_t>(random());
        }
        const auto asset = decode(test::closeFile(std::move(open)));
        if (!asset) continue;
        ++accepted;
        for (const OctreeModel& model : asset->models)
            static_cast<void>(statistics(model, asset->materials.size()));
    }
    EXPECT_GT(accepted, 0u);  // colors and names may be anything: the test reached behind the hashes
}

TEST(PfVoxHostile, SampleSurvivesSurgery) {
    EXPECT_TRUE(decode(test::closeFile(test::openFile(sampleFile()))));
}

TEST(PfVoxHostile, ForeignFiles) {
    const std::string text = "hello world, this is a text";
    Bytes bytes(text.size());
    std::memcpy(bytes.data(), text.data(), text.size());
    expectRefused(bytes, ErrorCode::BadMagic, "not a PF_VOX file");
    expectRefused({}, ErrorCode::BadMagic);
}

TEST(PfVoxHostile, OtherVersionsAndFeaturesAreNamed) {
    Bytes file = sampleFile();
    file[offsetof(layout::Header, versionMajor)] = std::byte{9};
    test::repairHead(file);
    expectRefused(file, ErrorCode::UnsupportedVersion, "PF_VOX 9.0");

    file = sampleFile();
    file[offsetof(layout::Header, requiredFeatures)] = std::byte{0x10};
    test::repairHead(file);
    expectRefused(file, ErrorCode::UnsupportedFeature, "0x10");
}

TEST(PfVoxHostile, UnknownSections) {
    OpenFile open = test::openFile(sampleFile());
    open.parts.push_back(
        {.entry = {.fourcc = {'X', 'T', 'R', 'A'}, .region = layout::kNoRegion}, .raw = {1, 2, 3}});
    DiagnosticList diagnostics;
    EXPECT_TRUE(decodePfVox(test::closeFile(open), Limits{}, diagnostics));
    ASSERT_EQ(diagnostics.entries().size(), 1u);
    EXPECT_EQ(diagnostics.entries()[0].id, "pfvox-unknown-section");

    open.parts.back().entry.flags = layout::kSectionMustUnderstand;
    expectRefused(test::closeFile(open), ErrorCode::UnsupportedFeature, "XTRA");
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

/// Changes the table entry of the first compressed section.
Bytes withTableEntry(const std::function<void(layout::Section&)>& change) {
    Bytes file = sampleFile();
    OpenFile open = test::openFile(file);
    for (std::size_t i = 0; i < open.parts.size(); ++i) {
        if (open.parts[i].entry.codec != layout::Codec::Zstd) continue;
        change(open.parts[i].entry);
        std::memcpy(file.data() + sizeof(layout::Header) + i * sizeof(layout::Section), &open.parts[i].entry,
                    sizeof(layout::Section));
        break;
    }
    test::repairHead(file);
    return file;
}

TEST(PfVoxHostile, SectionTableThatLies) {
    using layout::Section;
    expectRefused(withTableEntry([](Section& s) { s.offset = 1ull << 62; }), ErrorCode::BadStructure);
    expectRefused(withTableEntry([](Section& s) { s.storedBytes = ~0ull; }), ErrorCode::BadStructure);
    expectRefused(withTableEntry([](Section& s) { s.offset = 64; }), ErrorCode::BadStructure, "overlaps");
    expectRefused(withTableEntry([](Section& s) { s.offset += 1; }), ErrorCode::BadStructure, "aligned");
    expectRefused(withTableEntry([](Section& s) { s.rawBytes = 1ull << 40; }), ErrorCode::BadStructure);
    expectRefused(withTableEntry([](Section& s) { s.codec = layout::Codec{7}; }),
                  ErrorCode::UnsupportedFeature);
    expectRefused(withTableEntry([](Section& s) { s.rawHash ^= 1; }), ErrorCode::ChecksumMismatch);
    Bytes many = sampleFile();
    const std::uint32_t count = 0xffffffffu;
    std::memcpy(many.data() + offsetof(layout::Header, sectionCount), &count, sizeof count);
    expectRefused(many, ErrorCode::BadStructure, "4294967295 sections");
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

TEST(PfVoxHostile, ValidateNoticesWrongCountsAndBounds) {
    OpenFile open = test::openFile(sampleFile());
    open.edit<layout::Model>("MODL", 0, [](layout::Model& m) { ++m.voxelCount; });
    open.edit<layout::Model>("MODL", 1, [](layout::Model& m) { ++m.boundsMax[0]; });
    const std::vector<Finding> findings = validatePfVox(test::closeFile(std::move(open)), Limits{});
    ASSERT_EQ(findings.size(), 2u);
    EXPECT_THAT(findings[0].message, testing::HasSubstr("voxels"));
    EXPECT_THAT(findings[1].message, testing::HasSubstr("bounding box"));
}

}  // namespace
}  // namespace pfvox

// PF_PROBE files that lie in what is theirs alone (container_hostile_test.cpp has the rest): every field that
// a reader could trust with its hash repaired, so that the check behind the hash is what is tested.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <pfvox/probe_file.hpp>
#include <random>

#include "pf_probe/frame_codec.hpp"
#include "support/pf_probe_surgery.hpp"

namespace pfvox {
namespace {

using test::Bytes;
using test::OpenFile;
namespace pl = probe_layout;

const Bytes& sampleFile() {
    return test::probeSample();
}

Result<ProbeField> decode(const Bytes& file, const Limits& limits = {}) {
    DiagnosticList diagnostics;
    return decodePfProbe(file, limits, diagnostics);
}

/// Decoding must fail with this code, and validate must have a finding with the same.
void expectRefused(const Bytes& file, ErrorCode code, const std::string& words = "") {
    const auto field = decode(file);
    ASSERT_FALSE(field) << "accepted, expected " << toString(code);
    EXPECT_EQ(field.error().code, code) << describe(field.error());
    EXPECT_THAT(describe(field.error()), testing::HasSubstr(words));
    const std::vector<Finding> findings = validatePfProbe(file, Limits{});
    ASSERT_FALSE(findings.empty());
    EXPECT_EQ(findings[0].id, toString(code)) << findings[0].message;
}

TEST(PfProbeHostile, FramesOfOtherSizesBehindTheHashes) {
    // The zstd frame of another map: whole and valid, but not of this size.
    DiagnosticList diagnostics;
    const auto reader = ProbeFileReader::overBytes(sampleFile(), Limits{}, diagnostics).value();
    const auto other = reader.readStored(0, ProbeLayer::MinDepth).value();
    ASSERT_EQ(reader.frame(0, ProbeLayer::DepthNormal).codec, "predicted");
    const auto stored = reader.readStored(1, ProbeLayer::DepthNormal).value();
    std::vector<std::byte> words(reader.info().resolution.bytesOf(ProbeLayer::Light));
    const probe_layout::Frame frame{static_cast<std::uint32_t>(stored.size()), pl::FrameCodec::Predicted, 0};
    container::MemoryBudget budget(1 << 20);
    const auto unpacked = probe::unpackFrame(ProbeLayer::Light, frame, stored, words, budget);
    ASSERT_FALSE(unpacked);
    EXPECT_EQ(unpacked.error().code, ErrorCode::BadStructure);
    EXPECT_FALSE(probe::unpackFrame(ProbeLayer::Light, frame, {}, words, budget));
    EXPECT_FALSE(probe::unpackFrame(ProbeLayer::Light, {0, pl::FrameCodec::Raw, 0}, other, words, budget));
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
    using enum ErrorCode;
    const auto info = [](std::function<void(pl::Info&)> change) {
        return edit<pl::Info>("INFO", 0, std::move(change));
    };
    const auto record = [](std::size_t i, std::function<void(pl::Record&)> change) {
        return edit<pl::Record>("PROB", i, std::move(change));
    };
    const auto frame = [](std::size_t i, std::function<void(pl::Frame&)> change) {
        return edit<pl::Frame>("FRAM", i, std::move(change));
    };
    const auto proximity = [](std::function<void(pl::Proximity&)> change) {
        return edit<pl::Proximity>("PROX", 0, std::move(change));
    };
    const auto drop = [](const char* fourcc) {
        return [=](OpenFile& open) {
            const OpenFile::Part* gone = &open.part(fourcc);
            open.parts.erase(open.parts.begin() + (gone - open.parts.data()));
        };
    };
    const auto cell = [](std::size_t cellIndex, std::array<std::uint16_t, 4> list) {
        return [=](OpenFile& open) {
            std::memcpy(open.part("PROX").raw.data() + sizeof(pl::Proximity) + cellIndex * sizeof list,
                        list.data(), sizeof list);
        };
    };
    const float kNan = std::nanf("");
    return {
        {"grid of no probes", BadValue, info([](pl::Info& i) { i.gridCounts[1] = 0; })},
        {"grid of 2^96 probes", BadValue, info([](pl::Info& i) {
             i.gridCounts = {~0u, ~0u, ~0u};
         })},
        {"grid of 2^64 probes, which wraps to 0", BadValue, info([](pl::Info& i) {
             i.gridCounts = {1u << 31, 1u << 31, 4};
         })},
        {"grid of 2^32 probes", BadValue, info([](pl::Info& i) {
             i.gridCounts = {1u << 16, 1u << 16, 1};
         })},
        {"step of NaN", BadValue, info([=](pl::Info& i) { i.gridStep[0] = kNan; })},
        {"step backwards", BadValue, info([](pl::Info& i) { i.gridStep[2] = -1; })},
        {"start at infinity", BadValue, info([](pl::Info& i) { i.gridStart[2] = INFINITY; })},
        {"range outside the grid", BadValue, info([](pl::Info& i) { i.rangeEnd = 13; })},
        {"range backwards", BadValue, info([](pl::Info& i) { i.rangeFirst = 12; })},
        {"range with fewer probes", BadStructure, info([](pl::Info& i) { i.rangeEnd = 11; })},
        {"more probes than records", BadStructure, info([](pl::Info& i) {
             i.gridCounts = {4000000, 1, 1};
             i.rangeEnd = 4000000;
         })},
        {"maps of 2^32 texels", BadValue, info([](pl::Info& i) { i.lightResolution = 65536; })},
        {"edge that is no multiple of 16", BadValue, info([](pl::Info& i) { i.depthResolution = 40; })},
        {"larger maps than the frames hold", BadStructure,
         info([](pl::Info& i) { i.lightResolution = 8192; })},
        {"smaller maps than the frames hold", BadStructure, info([](pl::Info& i) { i.lightResolution = 2; })},
        {"a layer less", BadStructure, info([](pl::Info& i) { i.momentsResolution = 0; })},
        {"no layers", BadValue, info([](pl::Info& i) {
             i.depthResolution = i.lightResolution = i.irradianceResolution = i.momentsResolution = 0;
         })},
        {"Far of 0", BadValue, info([](pl::Info& i) { i.depthFarMetres = 0; })},
        {"scale of NaN", BadValue, info([=](pl::Info& i) { i.depthScale = kNan; })},
        {"depth range that overflows", BadValue,
         info([](pl::Info& i) { i.depthScale = i.depthFarMetres = 3e38f; })},
        {"unknown kind of light", BadValue, info([](pl::Info& i) { i.lightContent |= 1u << 30; })},
        {"noise of NaN", BadValue, info([=](pl::Info& i) { i.noiseTarget = kNan; })},
        {"name longer than the section", BadStructure, info([](pl::Info& i) { i.deviceNameBytes = ~0u; })},
        {"names shorter than the section", BadStructure, info([](pl::Info& i) { i.toolNameBytes -= 1; })},
        {"reserved field of INFO", BadValue, info([](pl::Info& i) { i.reserved = 1; })},
        {"state 9", BadValue, record(0, [](pl::Record& r) { r.state = 9; })},
        {"offset of an active probe", BadValue, record(0, [](pl::Record& r) { r.offset[0] = 1; })},
        {"offset of NaN", BadValue, record(4, [=](pl::Record& r) { r.offset[0] = kNan; })},
        {"negative error", BadValue, record(0, [](pl::Record& r) { r.error = -1; })},
        {"share above 1", BadValue, record(0, [](pl::Record& r) { r.noisyTileFraction = 1.5f; })},
        {"unknown flags", BadValue, record(0, [](pl::Record& r) { r.flags = 1; })},
        {"reserved field of a record", BadValue, record(0, [](pl::Record& r) { r.reserved = 1; })},
        {"inactive probe with maps", BadStructure, record(0, [](pl::Record& r) { r.state = 1; })},
        {"active probe without maps", BadStructure, record(3, [](pl::Record& r) { r.state = 0; })},
        {"frame of 4 GiB", BadStructure, frame(0, [](pl::Frame& f) { f.storedBytes = ~0u; })},
        {"frame of one byte", BadStructure, frame(0, [](pl::Frame& f) { f.storedBytes = 1; })},
        {"codec 2", UnsupportedFeature,
         frame(1, [](pl::Frame& f) { f.codec = static_cast<pl::FrameCodec>(2); })},
        {"compressed as raw", BadStructure, frame(0, [](pl::Frame& f) { f.codec = pl::FrameCodec::Raw; })},
        {"hash of another map", ChecksumMismatch, frame(0, [](pl::Frame& f) { f.rawHash ^= 1; })},
        {"frames of one probe less", BadStructure,
         [](OpenFile& open) {
             OpenFile::Part& part = open.part("FRAM");
             part.raw.resize(part.raw.size() - 5 * sizeof(pl::Frame));
             part.entry.count -= 5;
         }},
        {"maps shorter than their frames", BadStructure,
         [](OpenFile& open) { open.part("DATA").raw.pop_back(); }},
        {"maps longer than their frames", BadStructure,
         [](OpenFile& open) { open.part("DATA").raw.push_back(0); }},
        {"count of DATA", BadStructure, [](OpenFile& open) { open.part("DATA").entry.count = 1; }},
        {"2^60 records", BadStructure, [](OpenFile& open) { open.part("PROB").entry.count = 1ull << 60; }},
        {"no INFO", BadStructure, drop("INFO")},
        {"no PROB", BadStructure, drop("PROB")},
        {"no INPT", BadStructure, drop("INPT")},
        {"no FRAM", BadStructure, drop("FRAM")},
        {"no DATA", BadStructure, drop("DATA")},
        {"section twice", BadStructure, [](OpenFile& open) { open.parts.push_back(open.part("PROB")); }},
        {"grid of 2^96 cells", BadValue, proximity([](pl::Proximity& p) {
             p.counts = {~0u, ~0u, ~0u};
         })},
        {"one cell more", BadStructure, proximity([](pl::Proximity& p) { ++p.counts[0]; })},
        {"cells of no size", BadValue, proximity([](pl::Proximity& p) { p.step[1] = 0; })},
        {"indices of 8 bits", BadValue, proximity([](pl::Proximity& p) { p.indexBits = 8; })},
        {"wide indices of few probes", BadValue, proximity([](pl::Proximity& p) { p.indexBits = 32; })},
        {"another count of cells", BadStructure, [](OpenFile& open) { open.part("PROX").entry.count = 5; }},
        {"half an index", BadStructure, [](OpenFile& open) { open.part("PROX").raw.pop_back(); }},
        {"cell that names a probe outside", BadReference, cell(0, {12, 0xffff, 0xffff, 0xffff})},
        {"cell that names an inactive probe", BadReference, cell(0, {3, 0xffff, 0xffff, 0xffff})},
        {"cell that names a probe twice", BadStructure, cell(0, {1, 1, 0xffff, 0xffff})},
        {"cell with a gap", BadStructure, cell(0, {1, 0xffff, 2, 0xffff})},
    };
}

TEST(PfProbeHostile, LiesWithRepairedHashes) {
    for (const Lie& lie : lies()) {
        SCOPED_TRACE(lie.name);
        OpenFile open = test::openFile(sampleFile());
        lie.tell(open);
        expectRefused(test::closeProbeFile(std::move(open)), lie.code);
    }
}

TEST(PfProbeHostile, HashOfAProbeThatIsNotItsOwn) {
    OpenFile open = test::openFile(sampleFile());
    open.edit<pl::Record>("PROB", 2, [](pl::Record& r) { r.hash ^= 1; });
    expectRefused(test::closeFile(std::move(open)), ErrorCode::ChecksumMismatch, "probe 2");
}

TEST(PfProbeHostile, ValidateComparesLayersThatFollowFromEachOther) {
    struct Case {
        const char* context;
        std::function<void(ProbeData&)> break_;
    };
    const std::vector<Case> cases{
        {"min-depth of probe 1", [](ProbeData& p) { p.minDepth[0] -= 1; }},
        {"min-depth of probe 1", [](ProbeData& p) { p.depthNormal[77] &= 0xffff0000u; }},
        {"irradiance of probe 1", [](ProbeData& p) { p.irradiance[0] ^= 1; }},
        {"moments of probe 1", [](ProbeData& p) { p.moments[15] ^= 1; }},
    };
    for (const Case& c : cases) {
        ProbeField field = decode(sampleFile()).value();
        c.break_(field.probes[1]);
        const Bytes file = encodePfProbe(field, {}).value();
        EXPECT_TRUE(decode(file));
        const auto findings = validatePfProbe(file, Limits{});
        ASSERT_EQ(findings.size(), 1u);
        EXPECT_EQ(findings[0].context, c.context);
        EXPECT_EQ(findings[0].id, "bad-structure");
    }
}

}  // namespace
}  // namespace pfvox

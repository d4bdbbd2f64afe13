// Light on faces that lies: in the tables of a file with their hashes repaired, and in the journal of a bake.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <pfvox/probe_file.hpp>

#include "faces/chunk_codec.hpp"
#include "support/pf_probe_surgery.hpp"
#include "support/temp_folder.hpp"

namespace pfvox {
namespace {

using test::Bytes;
using test::OpenFile;
namespace pl = probe_layout;

constexpr std::size_t kSettings = 10;
constexpr std::size_t kInstances = 4;
constexpr std::size_t kRegions = 7;
constexpr std::size_t kSettingsAt = sizeof(pl::Faces);
constexpr std::size_t kInstancesAt = kSettingsAt + kSettings * sizeof(pl::Setting);
constexpr std::size_t kRegionsAt = kInstancesAt + kInstances * sizeof(pl::FaceInstance);
constexpr std::size_t kChunksAt = kRegionsAt + kRegions * sizeof(std::uint32_t);

Result<ProbeField> decode(const Bytes& file, const Limits& limits = {}) {
    DiagnosticList diagnostics;
    return decodePfProbe(file, limits, diagnostics);
}

struct Lie {
    const char* name;
    ErrorCode code;
    std::function<void(OpenFile&)> tell;
};

/// A record of FACE at this place.
template <class Record>
std::function<void(OpenFile&)> edit(std::size_t at, std::function<void(Record&)> change) {
    return [=](OpenFile& open) {
        std::vector<std::uint8_t>& raw = open.part("FACE").raw;
        Record record;
        std::memcpy(&record, raw.data() + at, sizeof record);
        change(record);
        std::memcpy(raw.data() + at, &record, sizeof record);
    };
}

std::vector<Lie> lies() {
    using enum ErrorCode;
    const auto fixed = [](std::function<void(pl::Faces&)> change) {
        return edit<pl::Faces>(0, std::move(change));
    };
    const auto setting = [](std::size_t i, std::function<void(pl::Setting&)> change) {
        return edit<pl::Setting>(kSettingsAt + i * sizeof(pl::Setting), std::move(change));
    };
    const auto instance = [](std::function<void(pl::FaceInstance&)> change) {
        return edit<pl::FaceInstance>(kInstancesAt, std::move(change));
    };
    const auto region = [](std::size_t i, std::uint32_t count) {
        return edit<std::uint32_t>(kRegionsAt + i * sizeof count, [=](std::uint32_t& c) { c = count; });
    };
    const auto chunk = [](std::function<void(pl::FaceChunk&)> change) {
        return edit<pl::FaceChunk>(kChunksAt + sizeof(pl::FaceChunk), std::move(change));
    };
    return {
        {"chunks of no faces", BadValue, fixed([](pl::Faces& f) { f.facesPerChunk = 0; })},
        {"chunks of 2^32 faces", BadValue, fixed([](pl::Faces& f) { f.facesPerChunk = ~0u; })},
        {"other chunks", BadValue, fixed([](pl::Faces& f) { f.facesPerChunk = 60; })},
        {"a chunk too many", BadValue, fixed([](pl::Faces& f) { f.rangeEnd = 4; })},
        {"2^32 chunks", BadValue, fixed([](pl::Faces& f) { f.rangeEnd = ~0u; })},
        {"a chunk less", BadStructure, fixed([](pl::Faces& f) { f.rangeEnd = 2; })},
        {"range backwards", BadValue, fixed([](pl::Faces& f) { f.rangeFirst = 4; })},
        {"2^32 settings", BadStructure, fixed([](pl::Faces& f) { f.settingCount = ~0u; })},
        {"a setting less", BadStructure, fixed([](pl::Faces& f) { f.settingCount = 9; })},
        {"2^32 instances", BadStructure, fixed([](pl::Faces& f) { f.instanceCount = ~0u; })},
        {"2^32 regions", BadStructure, fixed([](pl::Faces& f) { f.regionCount = ~0u; })},
        {"regions of no instance", BadStructure, fixed([](pl::Faces& f) { f.regionCount = 8; })},
        {"fewer regions", BadStructure, fixed([](pl::Faces& f) { f.regionCount = 6; })},
        {"instance of 2^32 regions", BadStructure,
         instance([](pl::FaceInstance& i) { i.regionCount = ~0u; })},
        {"instance of one region less", BadStructure,
         instance([](pl::FaceInstance& i) { i.regionCount = 2; })},
        {"region of 2^32 faces", BadValue, region(0, ~0u)},
        {"a region without faces", BadValue, region(3, 0)},
        {"a face more", BadStructure, region(0, 11)},
        {"codec 2", BadValue, setting(9, [](pl::Setting& s) { s.value = 2; })},
        {"the other codec", BadStructure, setting(9, [](pl::Setting& s) { s.value = 1; })},
        {"no codec", BadStructure, setting(9, [](pl::Setting& s) { s.id = 99; })},
        {"setting twice", BadStructure, setting(9, [](pl::Setting& s) { s.id = 22; })},
        {"noise target of NaN", BadValue, setting(7, [](pl::Setting& s) { s.value = 0x7fc00000u; })},
        {"half divided", BadValue, setting(8, [](pl::Setting& s) { s.value = 2; })},
        {"reserved field", BadValue, setting(0, [](pl::Setting& s) { s.reserved = 1; })},
        {"noise of NaN", BadValue, chunk([](pl::FaceChunk& c) { c.noise = std::nanf(""); })},
        {"negative noise", BadValue, chunk([](pl::FaceChunk& c) { c.noise = -1; })},
        {"share above 1", BadValue, chunk([](pl::FaceChunk& c) { c.cappedFraction = 1.25f; })},
        {"no levels", BadStructure, chunk([](pl::FaceChunk& c) { c.levelBytes = 0; })},
        {"levels of 4 GiB", BadStructure, chunk([](pl::FaceChunk& c) { c.levelBytes = ~0u; })},
        {"a byte of levels more", BadStructure, chunk([](pl::FaceChunk& c) { ++c.levelBytes; })},
        {"2^32 values", BadStructure, chunk([](pl::FaceChunk& c) { c.valueCount = ~0u; })},
        {"no values", BadStructure, chunk([](pl::FaceChunk& c) { c.valueCount = 0; })},
        {"a value more", BadStructure, chunk([](pl::FaceChunk& c) { ++c.valueCount; })},
        {"a plane of 4 GiB", BadStructure, chunk([](pl::FaceChunk& c) { c.storedBytes[1] = ~0u; })},
        {"a plane too many", BadStructure, chunk([](pl::FaceChunk& c) { c.storedBytes[5] = 1; })},
        {"a plane of nothing", BadStructure, chunk([](pl::FaceChunk& c) { c.storedBytes[2] = 0; })},
        {"planes that end elsewhere", BadStructure, chunk([](pl::FaceChunk& c) {
             --c.storedBytes[1];
             ++c.storedBytes[0];
         })},
        {"another hash", ChecksumMismatch, chunk([](pl::FaceChunk& c) { c.hash ^= 1; })},
        {"a byte more in FACE", BadStructure, [](OpenFile& open) { open.part("FACE").raw.push_back(0); }},
        {"a byte less in FACE", BadStructure, [](OpenFile& open) { open.part("FACE").raw.pop_back(); }},
        {"half a header", BadStructure, [](OpenFile& open) { open.part("FACE").raw.resize(20); }},
        {"count of FACE", BadStructure, [](OpenFile& open) { open.part("FACE").entry.count = 2; }},
        {"count of FDAT", BadStructure, [](OpenFile& open) { open.part("FDAT").entry.count = 2; }},
        {"a byte more in FDAT", BadStructure, [](OpenFile& open) { open.part("FDAT").raw.push_back(0); }},
        {"a byte less in FDAT", BadStructure, [](OpenFile& open) { open.part("FDAT").raw.pop_back(); }},
    };
}

TEST(FaceHostile, LiesWithRepairedHashes) {
    {
        const OpenFile open = test::openFile(test::faceSample());
        const auto& raw = open.parts[open.parts.size() - 3].raw;
        ASSERT_EQ(raw.size(), kChunksAt + 3 * sizeof(pl::FaceChunk));
    }
    for (const Lie& lie : lies()) {
        SCOPED_TRACE(lie.name);
        OpenFile open = test::openFile(test::faceSample());
        lie.tell(open);
        const Bytes file = test::closeProbeFile(std::move(open));
        const auto field = decode(file);
        ASSERT_FALSE(field);
        EXPECT_EQ(field.error().code, lie.code) << describe(field.error());
        EXPECT_TRUE(field.error().offsetBytes) << describe(field.error());
        const std::vector<Finding> findings = validatePfProbe(file, Limits{});
        ASSERT_FALSE(findings.empty());
        EXPECT_EQ(findings[0].id, toString(lie.code)) << findings[0].message;
    }
}

TEST(FaceHostile, NeitherProbesNorFaces) {
    OpenFile open = test::openFile(test::faceSample());
    ProbeField field = decode(test::faceSample()).value();
    field.info = test::noProbesInfo();
    field.probes.clear();
    open = test::openFile(encodePfProbe(field, {}).value());
    std::erase_if(open.parts, [](const OpenFile::Part& part) {
        const std::string_view name(part.entry.fourcc.data(), 4);
        return name == "FACE" || name == "FDAT";
    });
    const auto refused = decode(test::closeProbeFile(std::move(open)));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::BadValue);
    field.faces.reset();
    EXPECT_FALSE(encodePfProbe(field, {}));
}

/// What stands in the frames of a chunk behind their hash: a codec that meets it must refuse it.
TEST(FaceHostile, FramesBehindTheHash) {
    const FaceLightInfo info = test::faceInfo(FaceCodec::Lossless);
    const FaceChunk light = test::faceChunkOf(info, 0);
    auto packed = faces::packChunk(FaceCodec::Lossless, light, {}, 1).value();
    const auto unpack = [&](const Bytes& stored) {
        container::MemoryBudget budget(1 << 20);
        const auto chunk = faces::unpackChunk(FaceCodec::Lossless, 35, packed.entry, stored, budget);
        EXPECT_TRUE(budget.take(1 << 20)) << "all was given back";
        return chunk;
    };
    EXPECT_EQ(unpack(packed.stored).value(), light);
    std::size_t accepted = 0;
    for (std::size_t i = 0; i < packed.stored.size(); ++i) {
        for (int bit = 0; bit < 8; ++bit) {
            Bytes changed = packed.stored;
            changed[i] ^= std::byte{1} << bit;
            if (const auto chunk = unpack(changed)) {
                EXPECT_EQ(*chunk, light);
                ++accepted;
            }
        }
    }
    EXPECT_LT(accepted, packed.stored.size());
    container::MemoryBudget small(100);
    const auto refused = faces::unpackChunk(FaceCodec::Lossless, 35, packed.entry, packed.stored, small);
    EXPECT_EQ(refused.error().code, ErrorCode::LimitExceeded);
}

/// A few bytes that stand for a hundred million faces.
TEST(FaceHostile, ManyFacesNeedMemoryThatIsAllowed) {
    ProbeField field = test::probeField(test::noProbesInfo(), false);
    field.faces = FaceLight{};
    field.faces->info.instances = {{.index = {}, .faceCounts = {50000000, 50000000}}};
    field.faces->info.range = {0, 2};
    field.faces->info.chunks.resize(2);
    for (int i = 0; i < 2; ++i)
        field.faces->chunks.push_back(
            {.levels = std::vector<std::uint8_t>(50000000, kNoFaceValue), .values = {}});
    const Bytes file = encodePfProbe(field, {}).value();
    field = {};
    EXPECT_LT(file.size(), 2000u);
    const Limits limits{.maxMemoryBytes = 16u << 20};
    const auto decoded = decode(file, limits);
    ASSERT_FALSE(decoded);
    EXPECT_EQ(decoded.error().code, ErrorCode::LimitExceeded);
    DiagnosticList diagnostics;
    const auto reader = ProbeFileReader::overBytes(file, limits, diagnostics);
    ASSERT_TRUE(reader) << "what stands in it can be told";
    const auto chunk = reader->readFaceChunk(1);
    ASSERT_FALSE(chunk);
    EXPECT_EQ(chunk.error().code, ErrorCode::LimitExceeded);
    EXPECT_TRUE(chunk.error().offsetBytes);
}

class FaceJournal : public testing::Test {
  protected:
    /// A bake that was killed after it had written probes and chunks in this order: 0 to 2 are chunks, 10 and
    /// 11 probes. `starts` gets where each record begins.
    void bake(const std::vector<std::uint32_t>& order) {
        DiagnosticList diagnostics;
        auto writer = ProbeFileWriter::open(output_, info_, {.faces = faces_}, diagnostics).value();
        starts_.push_back(std::filesystem::file_size(journal_));
        for (const std::uint32_t i : order) {
            if (i < 10) {
                ASSERT_TRUE(writer.appendFaces(i, test::faceChunkOf(faces_, i), test::faceRecordOf(i)));
            } else {
                ASSERT_TRUE(writer.append(i - 10, test::probeOf(info_, i - 10)));
            }
            starts_.push_back(std::filesystem::file_size(journal_));
        }
    }

    /// Resumes and counts what need not be baked again; each must be right.
    std::size_t resume(DiagnosticList& diagnostics) {
        auto writer = ProbeFileWriter::open(output_, info_, {.resume = true, .faces = faces_}, diagnostics);
        EXPECT_TRUE(writer) << describe(writer.error());
        std::size_t kept = 0;
        for (std::uint32_t i = 0; i < 2; ++i)
            if (writer->reuse(i, test::probeOf(info_, i).inputHash)) ++kept;
        for (std::uint32_t i = 0; i < 3; ++i) {
            if (!writer->reuseFaces(i, test::faceRecordOf(i).inputHash)) continue;
            ++kept;
            EXPECT_EQ(writer->readFaceChunk(i).value(), test::faceChunkOf(faces_, i));
            EXPECT_EQ(writer->faceRecord(i).value(), test::faceLight(faces_).info.chunks[i]);
        }
        EXPECT_EQ(writer->missing().size() + writer->missingFaces().size(), 5 - kept);
        return kept;
    }

    std::size_t wholeRecords(std::size_t size) const {
        const auto begun = std::ranges::count_if(starts_, [&](std::uint64_t start) { return start <= size; });
        return static_cast<std::size_t>(std::max<std::ptrdiff_t>(begun - 1, 0));
    }

    test::TempFolder folder_;
    std::filesystem::path output_ = folder_ / "out.pf_probe";
    std::filesystem::path journal_ = folder_ / "out.pf_probe.journal";
    ProbeFieldInfo info_ = test::probeInfo({2, 1, 1}, {0, 2, 1, 0});
    FaceLightInfo faces_ = test::faceInfo();
    std::vector<std::uint64_t> starts_;
};

TEST_F(FaceJournal, EveryPrefixAndEveryDamagedByteGiveTheWholeRecordsBefore) {
    bake({11, 2, 0, 10, 1});
    const std::string whole = test::readText(journal_);
    for (std::size_t size = 0; size <= whole.size(); ++size) {
        test::writeText(journal_, whole.substr(0, size));
        DiagnosticList diagnostics;
        ASSERT_EQ(resume(diagnostics), wholeRecords(size)) << size;
        const bool isTorn = size > starts_[0] && std::ranges::find(starts_, size) == starts_.end();
        ASSERT_EQ(diagnostics.entries().size(), isTorn ? 1u : 0u) << size;
        if (size == whole.size()) continue;
        std::string damaged = whole;
        damaged[size] = static_cast<char>(damaged[size] ^ 0x41);
        test::writeText(journal_, damaged);
        DiagnosticList warned;
        ASSERT_EQ(resume(warned), wholeRecords(size)) << size;
        ASSERT_EQ(warned.entries().size(), 1u);
        ASSERT_EQ(warned.entries()[0].id, "probe-journal-damaged") << size;
    }
}

TEST_F(FaceJournal, ResumedBakesMakeTheBytesOfAnUninterruptedOne) {
    ProbeField field = test::probeField(info_, false);
    field.faces = test::faceLight(faces_);
    const auto bytes = encodePfProbe(field, {}).value();
    const std::string expected(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (std::size_t cut = 0; cut <= 5; ++cut) {
        starts_.clear();
        bake({11, 2, 0, 10, 1});
        std::filesystem::resize_file(journal_, starts_[cut] + (cut < 5 ? 20 : 0));
        DiagnosticList diagnostics;
        auto writer =
            ProbeFileWriter::open(output_, info_, {.resume = true, .faces = faces_}, diagnostics).value();
        for (std::uint32_t i = 0; i < 3; ++i)
            ASSERT_TRUE(writer.reuseFaces(i, test::faceRecordOf(i).inputHash) ||
                        writer.appendFaces(i, test::faceChunkOf(faces_, i), test::faceRecordOf(i)));
        for (std::uint32_t i = 0; i < 2; ++i)
            ASSERT_TRUE(writer.reuse(i, field.probes[i].inputHash) || writer.append(i, field.probes[i]));
        ASSERT_TRUE(writer.finish({}));
        EXPECT_EQ(test::readText(output_), expected);
        EXPECT_FALSE(std::filesystem::exists(journal_));
    }
}

TEST_F(FaceJournal, ChunksOfOtherInputsOrFacesAreNotUsed) {
    bake({0, 1, 0});
    {
        DiagnosticList diagnostics;
        faces_.settings.maxRays = 17;  // the input hash decides
        auto writer =
            ProbeFileWriter::open(output_, info_, {.resume = true, .faces = faces_}, diagnostics).value();
        EXPECT_TRUE(diagnostics.entries().empty());
        EXPECT_FALSE(writer.reuseFaces(1, {}));
        EXPECT_FALSE(writer.reuseFaces(1, test::faceRecordOf(0).inputHash));
        EXPECT_FALSE(writer.reuseFaces(2, test::faceRecordOf(2).inputHash));
        EXPECT_FALSE(writer.reuseFaces(3, test::faceRecordOf(3).inputHash));
        EXPECT_TRUE(writer.reuseFaces(0, test::faceRecordOf(0).inputHash));
        EXPECT_THAT(writer.missingFaces(), testing::ElementsAre(1, 2));
    }
    const auto isUsed = [&](const std::optional<FaceLightInfo>& faces) {
        starts_.clear();
        faces_ = test::faceInfo();
        bake({0, 1});
        DiagnosticList diagnostics;
        const auto writer =
            ProbeFileWriter::open(output_, info_, {.resume = true, .faces = faces}, diagnostics);
        EXPECT_TRUE(writer);
        return diagnostics.entries().empty();
    };
    FaceLightInfo other = test::faceInfo();
    EXPECT_TRUE(isUsed(other));
    other.instances[1].index = {};
    EXPECT_FALSE(isUsed(other));
    other = test::faceInfo();
    other.range.end = 2;
    EXPECT_FALSE(isUsed(other));
    EXPECT_FALSE(isUsed(test::faceInfo(FaceCodec::Lossless)));
    EXPECT_FALSE(isUsed({}));
}

TEST_F(FaceJournal, LiesBehindRepairedHashes) {
    using pl::JournalFaceRecord;
    const std::vector<std::pair<const char*, std::function<void(JournalFaceRecord&)>>> lies{
        {"chunk outside", [](JournalFaceRecord& r) { r.chunk = 3; }},
        {"four billion", [](JournalFaceRecord& r) { r.chunk = 0xffffffffu; }},
        {"of another chunk", [](JournalFaceRecord& r) { r.record.levelBytes = 36; }},
        {"noise is NaN", [](JournalFaceRecord& r) { r.record.noise = std::nanf(""); }},
        {"plane longer than its values", [](JournalFaceRecord& r) { r.record.storedBytes[1] = 0xffffffffu; }},
        {"plane that the codec does not have", [](JournalFaceRecord& r) { r.record.storedBytes[5] = 5; }},
    };
    bake({1, 0, 2});
    const std::string whole = test::readText(journal_);
    for (const auto& [name, tell] : lies) {
        SCOPED_TRACE(name);
        std::string text = whole;
        JournalFaceRecord record;
        std::memcpy(&record, text.data() + starts_[1], sizeof record);
        tell(record);
        const auto* bytes = reinterpret_cast<const std::byte*>(&record);
        record.recordHash = io::xxh3_64({bytes, offsetof(JournalFaceRecord, recordHash)});
        std::memcpy(text.data() + starts_[1], &record, sizeof record);
        test::writeText(journal_, text);
        DiagnosticList diagnostics;
        EXPECT_EQ(resume(diagnostics), 1u);
        ASSERT_EQ(diagnostics.entries().size(), 1u);
        EXPECT_EQ(diagnostics.entries()[0].id, "probe-journal-damaged");
    }
}

}  // namespace
}  // namespace pfvox

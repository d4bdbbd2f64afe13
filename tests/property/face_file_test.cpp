// Light on faces in probe files: what is written is read, in any order, through any interruption; the probes
// beside it are what they were.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <pfvox/probe_file.hpp>
#include <random>
#include <thread>

#include "support/lit_faces.hpp"
#include "support/pf_vox_surgery.hpp"
#include "support/temp_folder.hpp"

namespace pfvox {
namespace {

using testing::HasSubstr;

std::string asText(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

ProbeField litField(const ProbeFieldInfo& info, FaceLightInfo faces = test::faceInfo()) {
    ProbeField field = test::probeField(info, false);
    field.faces = test::faceLight(std::move(faces));
    return field;
}

FaceLightInfo faceShard(std::uint32_t first, std::uint32_t end) {
    FaceLightInfo info = test::faceInfo();
    info.range = {first, end};
    return info;
}

std::vector<ProbeField> fields() {
    std::vector<ProbeField> all{litField(test::probeInfo()),
                                litField(test::noProbesInfo()),
                                litField(test::noProbesInfo(), test::faceInfo(FaceCodec::Lossless)),
                                litField(test::noProbesInfo(), faceShard(1, 2)),
                                litField(test::probeInfo(), faceShard(3, 3)),
                                litField(test::noProbesInfo(), FaceLightInfo{})};
    all.front().proximity = test::proximityOf(all.front().info);
    ProbeFieldInfo none = test::probeInfo();  // a shard with chunks and no probes
    none.range = {5, 5};
    all.push_back(litField(none, faceShard(0, 2)));
    return all;
}

TEST(FaceFile, DecodeOfEncodeIsTheField) {
    for (const ProbeField& field : fields()) {
        DiagnosticList diagnostics;
        const auto bytes = encodePfProbe(field, {});
        ASSERT_TRUE(bytes) << describe(bytes.error());
        const auto decoded = decodePfProbe(*bytes, Limits{}, diagnostics);
        ASSERT_TRUE(decoded) << describe(decoded.error());
        EXPECT_EQ(*decoded, field);
        EXPECT_EQ(encodePfProbe(*decoded, {}).value(), *bytes);
        const auto findings = validatePfProbe(*bytes, Limits{});
        EXPECT_TRUE(findings.empty()) << findings[0].context << ": " << findings[0].message;
        EXPECT_TRUE(diagnostics.entries().empty());
    }
}

/// Values that the codec changes are written as what they become.
TEST(FaceFile, AnyValuesBecomeTheirStoredForm) {
    FaceLight light = test::faceLight();
    std::mt19937 random(1);
    for (FaceChunk& chunk : light.chunks)
        for (std::uint32_t& value : chunk.values) value = static_cast<std::uint32_t>(random()) % (31u << 27);
    ProbeField field = litField(test::noProbesInfo());
    field.faces = light;
    DiagnosticList diagnostics;
    const auto bytes = encodePfProbe(field, {}).value();
    const FaceLight read = *decodePfProbe(bytes, Limits{}, diagnostics)->faces;
    for (std::size_t c = 0; c < light.chunks.size(); ++c) {
        EXPECT_EQ(read.chunks[c].levels, light.chunks[c].levels);
        for (std::size_t i = 0; i < light.chunks[c].values.size(); ++i)
            EXPECT_EQ(read.chunks[c].values[i],
                      storedFaceValue(FaceCodec::Quantized, light.chunks[c].values[i]));
        EXPECT_EQ(read.info.chunks[c].hash, hashOf(read.chunks[c]));
    }
    field.faces = read;
    EXPECT_EQ(encodePfProbe(field, {}).value(), bytes);
}

/// What a reader of 1.1 does with it: both sections are unknown to it.
TEST(FaceFile, OlderReadersSkipTheFaces) {
    ProbeField field = litField(test::probeInfo());
    const auto bytes = encodePfProbe(field, {}).value();
    test::OpenFile open = test::openFile(bytes);
    EXPECT_EQ(open.header.versionMinor, 2u);
    for (const auto& [name, unknown] : {std::pair("FACE", "XACE"), std::pair("FDAT", "XDAT")}) {
        layout::Section& entry = open.part(name).entry;
        EXPECT_EQ(entry.flags & layout::kSectionMustUnderstand, 0u);
        std::memcpy(entry.fourcc.data(), unknown, 4);
    }
    DiagnosticList diagnostics;
    const auto decoded = decodePfProbe(test::closeFile(std::move(open)), Limits{}, diagnostics);
    ASSERT_TRUE(decoded) << describe(decoded.error());
    field.faces.reset();
    EXPECT_EQ(*decoded, field);
    ASSERT_EQ(diagnostics.entries().size(), 2u);
    EXPECT_EQ(diagnostics.entries()[0].id, "pfprobe-unknown-section");
}

TEST(FaceFile, ReaderTakesSingleChunksFromAnyThread) {
    const test::TempFolder folder;
    const ProbeField field = litField(test::probeInfo(), faceShard(1, 3));
    test::writeText(folder / "a", asText(encodePfProbe(field, {}).value()));
    DiagnosticList diagnostics;
    const auto reader = ProbeFileReader::open(folder / "a", Limits{}, diagnostics);
    ASSERT_TRUE(reader) << describe(reader.error());
    EXPECT_EQ(reader->versionMinor(), 2u);
    EXPECT_EQ(reader->faces(), field.faces->info);
    const auto readAll = [&] {
        for (int round = 0; round < 50; ++round)
            for (const std::uint32_t chunk : {2u, 1u})
                if (reader->readFaceChunk(chunk).value() != field.faces->chunks[chunk - 1]) std::abort();
    };
    std::thread other(readAll);
    readAll();
    other.join();
    const FaceFrames first = reader->faceFrames(1);
    EXPECT_EQ(reader->faceFrames(2).offsetBytes, first.offsetBytes + reader->faces()->chunks[0].storedBytes);
    EXPECT_EQ(reader->readStoredFaces(2)->size(), reader->faces()->chunks[1].storedBytes);
    EXPECT_EQ(reader->readProbe(7).value(), field.probes[7]);
}

TEST(FaceFile, DamageOfOneChunkLeavesTheOthersReadable) {
    auto bytes = encodePfProbe(litField(test::probeInfo()), {}).value();
    DiagnosticList diagnostics;
    const FaceFrames frames = ProbeFileReader::overBytes(bytes, Limits{}, diagnostics)->faceFrames(1);
    bytes[frames.offsetBytes + 12] ^= std::byte{0x5a};
    const auto reader = ProbeFileReader::overBytes(bytes, Limits{}, diagnostics);
    ASSERT_TRUE(reader);
    const auto read = reader->readFaceChunk(1);
    ASSERT_FALSE(read);
    EXPECT_THAT(describe(read.error()), HasSubstr("chunk 1 of light on faces"));
    EXPECT_EQ(read.error().offsetBytes, frames.offsetBytes);
    EXPECT_TRUE(reader->readFaceChunk(0));
    EXPECT_TRUE(reader->readFaceChunk(2));
    const auto findings = validatePfProbe(bytes, Limits{});
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].context, "chunk 1 of light on faces");
    EXPECT_FALSE(decodePfProbe(bytes, Limits{}, diagnostics));
}

TEST(FaceFile, WriterMakesTheBytesOfTheEncoderInAnyOrderFromAnyThread) {
    const test::TempFolder folder;
    std::mt19937 random(1);
    for (const ProbeField& field : fields()) {
        const std::string expected = asText(encodePfProbe(field, {.zstdLevel = 5}).value());
        DiagnosticList diagnostics;
        auto writer = ProbeFileWriter::open(
            folder / "a", field.info, {.encode = {.zstdLevel = 5}, .faces = field.faces->info}, diagnostics);
        ASSERT_TRUE(writer) << describe(writer.error());
        std::vector<std::uint32_t> chunks = writer->missingFaces();
        ASSERT_EQ(chunks.size(), field.faces->chunks.size());
        std::ranges::shuffle(chunks, random);
        std::thread other([&] {
            for (const std::uint32_t probe : writer->missing())
                if (!writer->append(probe, field.probes[probe - field.info.range.first])) std::abort();
        });
        for (const std::uint32_t chunk : chunks) {
            const std::size_t i = chunk - field.faces->info.range.first;
            ASSERT_TRUE(writer->appendFaces(chunk, field.faces->chunks[i], test::faceRecordOf(chunk)));
            EXPECT_EQ(writer->readFaceChunk(chunk).value(), field.faces->chunks[i]);
            EXPECT_EQ(writer->faceRecord(chunk).value(), field.faces->info.chunks[i]);
        }
        other.join();
        EXPECT_TRUE(writer->missingFaces().empty());
        const auto finished = writer->finish(field.proximity);
        ASSERT_TRUE(finished) << describe(finished.error());
        const auto files = test::readTree(folder.path());
        ASSERT_EQ(files.size(), 1u);  // the journal is gone
        EXPECT_EQ(files.at("a"), expected);
        EXPECT_TRUE(diagnostics.entries().empty());
    }
}

TEST(FaceFile, WriterNamesWhatIsMissingAndRefusesWhatDoesNotFit) {
    const test::TempFolder folder;
    const ProbeFieldInfo info = test::noProbesInfo();
    DiagnosticList diagnostics;
    const auto without = ProbeFileWriter::open(folder / "a", info, {}, diagnostics);
    ASSERT_FALSE(without);
    EXPECT_THAT(without.error().message, HasSubstr("no light on faces"));
    auto writer = ProbeFileWriter::open(folder / "a", info, {.faces = test::faceInfo()}, diagnostics).value();
    const FaceChunk light = test::faceChunkOf(test::faceInfo(), 1);
    ASSERT_TRUE(writer.appendFaces(1, light, {}));
    EXPECT_THAT(writer.finish({}).error().message,
                HasSubstr("2 of 3 chunks of light on faces are missing: 0, 2"));
    EXPECT_EQ(writer.appendFaces(3, light, {}).error().code, ErrorCode::BadReference);
    EXPECT_EQ(writer.appendFaces(0, light, {}).error().code, ErrorCode::BadStructure);
    EXPECT_EQ(writer.readFaceChunk(0).error().code, ErrorCode::BadReference);
    const auto refusal = [&](const std::function<void(FaceChunk&, FaceChunkRecord&)>& change) {
        FaceChunk changed = light;
        FaceChunkRecord record;
        change(changed, record);
        return writer.appendFaces(1, changed, record).error().code;
    };
    using enum ErrorCode;
    EXPECT_EQ(refusal([](FaceChunk& c, auto&) { c.values.pop_back(); }), BadStructure);
    EXPECT_EQ(refusal([](FaceChunk& c, auto&) { c.levels[0] = 4; }), BadValue);
    EXPECT_EQ(refusal([](FaceChunk& c, auto&) { c.values[2] = 31u << 27; }), BadValue);
    EXPECT_EQ(refusal([](auto&, FaceChunkRecord& r) { r.noise = -1.0f; }), BadValue);
    EXPECT_EQ(refusal([](auto&, FaceChunkRecord& r) { r.cappedFraction = 1.5f; }), BadValue);

    const auto opens = [&](const std::function<void(FaceLightInfo&)>& change) {
        FaceLightInfo changed = test::faceInfo();
        change(changed);
        const auto opened = ProbeFileWriter::open(folder / "b", info, {.faces = changed}, diagnostics);
        return opened ? NothingToConvert : opened.error().code;
    };
    EXPECT_EQ(opens([](FaceLightInfo& f) { f.range = {2, 4}; }), BadValue);
    EXPECT_EQ(opens([](FaceLightInfo& f) { f.range = {2, 1}; }), BadValue);
    EXPECT_EQ(opens([](FaceLightInfo& f) { f.facesPerChunk = 0; }), BadValue);
    EXPECT_EQ(opens([](FaceLightInfo& f) { f.settings.noiseTarget = -1; }), BadValue);
    EXPECT_EQ(opens([](FaceLightInfo& f) { f.instances[0].faceCounts[1] = 1u << 30; }), BadValue);
}

class FaceMerge : public testing::Test {
  protected:
    std::filesystem::path write(const ProbeFieldInfo& info, const FaceLightInfo& faces) {
        const auto file = folder_ / ("s" + std::to_string(written_++));
        test::writeText(file, asText(encodePfProbe(litField(info, faces), {}).value()));
        return file;
    }
    std::string merge(const std::vector<std::filesystem::path>& shards, bool allowPart = false) {
        DiagnosticList diagnostics;
        const auto merged =
            mergeProbeFields(shards, folder_ / "whole", {.allowPart = allowPart}, Limits{}, diagnostics);
        return merged ? "merged" : describe(merged.error());
    }
    static ProbeFieldInfo probes(std::uint32_t first, std::uint32_t end) {
        ProbeFieldInfo info = test::probeInfo();
        info.range = {first, end};
        return info;
    }

    test::TempFolder folder_;
    int written_ = 0;
};

TEST_F(FaceMerge, ShardsGiveTheBytesOfTheWhole) {
    const std::string whole = asText(encodePfProbe(litField(test::probeInfo()), {}).value());
    // Probes and chunks need not be cut alike, and shards come in any order.
    const std::vector<std::vector<std::filesystem::path>> cuts{
        {write(probes(0, 12), faceShard(0, 3))},
        {write(probes(6, 12), faceShard(2, 3)), write(probes(0, 6), faceShard(0, 2))},
        {write(probes(0, 3), faceShard(1, 3)), write(probes(3, 12), faceShard(0, 1))},
        {write(probes(0, 0), faceShard(0, 3)), write(probes(0, 12), faceShard(0, 0))},
        {write(probes(7, 7), faceShard(2, 3)), write(probes(0, 12), faceShard(1, 1)),
         write(probes(12, 12), faceShard(0, 2))}};
    for (const auto& cut : cuts) {
        EXPECT_EQ(merge(cut), "merged");
        EXPECT_EQ(test::readText(folder_ / "whole"), whole);
    }
    const ProbeFieldInfo none = test::noProbesInfo();
    EXPECT_EQ(merge({write(none, faceShard(1, 3)), write(none, faceShard(0, 1))}), "merged");
    EXPECT_EQ(test::readText(folder_ / "whole"), asText(encodePfProbe(litField(none), {}).value()));
    EXPECT_EQ(merge({write(none, faceShard(2, 3)), write(none, faceShard(1, 2))}, true), "merged");
    EXPECT_EQ(test::readText(folder_ / "whole"),
              asText(encodePfProbe(litField(none, faceShard(1, 3)), {}).value()));
}

TEST_F(FaceMerge, NamesMissingAndRepeatedChunks) {
    const ProbeFieldInfo none = test::noProbesInfo();
    EXPECT_THAT(merge({write(none, faceShard(1, 2))}),
                HasSubstr("2 of 3 chunks of light on faces are in no shard: 0, 2"));
    EXPECT_THAT(merge({write(none, faceShard(0, 1)), write(none, faceShard(2, 3))}, true),
                HasSubstr("1 of 3 chunks of light on faces are in no shard: 1"));
    EXPECT_THAT(merge({write(none, faceShard(0, 2)), write(none, faceShard(1, 3))}),
                HasSubstr("chunks of light on faces 1 are also in another shard"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "whole"));
}

TEST_F(FaceMerge, NamesEachDifference) {
    const ProbeFieldInfo none = test::noProbesInfo();
    const auto front = write(none, faceShard(0, 1));
    const auto refusal = [&](const std::function<void(FaceLightInfo&)>& change) {
        FaceLightInfo back = faceShard(1, 3);
        change(back);
        return merge({front, write(none, back)});
    };
    EXPECT_THAT(refusal([](FaceLightInfo& f) { f.instances[2].index = {}; }),
                testing::EndsWith("other faces"));
    EXPECT_THAT(refusal([](FaceLightInfo& f) { f.facesPerChunk = 17; }),
                testing::EndsWith("other chunks of faces"));
    EXPECT_THAT(refusal([](FaceLightInfo& f) { f.settings.sweeps = 3; }), testing::EndsWith("with sweeps 3"));
    EXPECT_THAT(refusal([](FaceLightInfo& f) { f.settings.codec = FaceCodec::Lossless; }),
                testing::EndsWith("with codec of faces lossless"));
    EXPECT_THAT(refusal([](FaceLightInfo& f) { f.settings.seed = 4; }), testing::EndsWith("with --seed 4"));
    const auto plain = folder_ / "plain";
    test::writeText(plain, asText(encodePfProbe(test::probeField(test::probeInfo(), false), {}).value()));
    EXPECT_THAT(merge({plain, write(test::probeInfo(), faceShard(0, 3))}), HasSubstr("(light on faces)"));
}

TEST_F(FaceMerge, DamagedChunk) {
    const auto file = write(test::noProbesInfo(), test::faceInfo());
    std::string text = test::readText(file);
    text[text.size() - 9] = static_cast<char>(text[text.size() - 9] ^ 0x10);
    test::writeText(file, text);
    EXPECT_THAT(merge({file}), HasSubstr("chunk 2 of light on faces"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "whole"));
}

TEST(FaceFile, SettingsTellWhatIsNotTheSame) {
    const FaceBakeSettings first = test::faceInfo().settings;
    FaceBakeSettings second = first;
    second.maxBounces = kUnlimitedBounces;
    second.divide = false;
    second.codec = FaceCodec::Lossless;
    std::vector<std::string> words;
    for (const ProbeSettingDifference& d : differencesOf(first, second))
        words.push_back(d.first + "|" + d.second);
    EXPECT_THAT(words,
                testing::ElementsAre("--bounces 16|--bounces unlimited", "divided faces on|divided faces off",
                                     "codec of faces quantized|codec of faces lossless"));
    std::size_t settings = 0;
    FaceBakeSettings changed = first;
    forEachFaceSetting(
        [&](const ProbeSetting&, auto& value) {
            ++settings;
            const auto kept = value;
            value = {};
            EXPECT_EQ(differencesOf(first, changed).size(), value == kept ? 0u : 1u);
            value = kept;
        },
        changed);
    EXPECT_EQ(settings, 10u);
}

}  // namespace
}  // namespace pfvox

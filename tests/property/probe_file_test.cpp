// Probe files: what is written is read; the bytes follow from the probes alone, whatever the order, the
// shards and the interruptions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pfvox/files.hpp>
#include <pfvox/probe_file.hpp>
#include <random>
#include <thread>

#include "support/probe_fields.hpp"
#include "support/temp_folder.hpp"

namespace pfvox {
namespace {

using testing::HasSubstr;

std::string asText(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

ProbeFieldInfo shardInfo(ProbeFieldInfo info, std::uint32_t first, std::uint32_t end) {
    info.range = {first, end};
    return info;
}

std::filesystem::path writeShard(const std::filesystem::path& file, const ProbeFieldInfo& info) {
    test::writeText(file, asText(encodePfProbe(test::probeField(info, false), {}).value()));
    return file;
}

TEST(ProbeFile, DecodeOfEncodeIsTheFieldForAnyShape) {
    std::mt19937 random(3);
    DiagnosticList diagnostics;
    for (int round = 0; round < 60; ++round) {
        const auto upTo = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % (n + 1)); };
        ProbeResolution resolution{16 * upTo(3), upTo(20), upTo(9), upTo(15)};
        if (resolution.bytesPerProbe() == 0) resolution.light = 1;
        ProbeFieldInfo info = test::probeInfo({1 + upTo(3), 1 + upTo(3), 1 + upTo(2)}, resolution);
        if (round % 3 == 0) {
            info.range.first = upTo(info.range.end - 1);
            info.range.end = info.range.first + 1 + upTo(info.range.end - info.range.first - 1);
        }
        const ProbeField field = test::probeField(info, round % 2 == 0);
        const auto bytes = encodePfProbe(field, {});
        ASSERT_TRUE(bytes) << describe(bytes.error());
        const auto decoded = decodePfProbe(*bytes, Limits{}, diagnostics);
        ASSERT_TRUE(decoded) << describe(decoded.error());
        EXPECT_EQ(*decoded, field);
        EXPECT_EQ(encodePfProbe(*decoded, {}).value(), *bytes);
        const auto findings = validatePfProbe(*bytes, Limits{});
        EXPECT_TRUE(findings.empty()) << findings[0].context << ": " << findings[0].message;
    }
    EXPECT_TRUE(diagnostics.entries().empty());
}

TEST(ProbeFile, ManyProbesHaveWideIndices) {
    ProbeFieldInfo info = test::probeInfo({65535, 1, 1}, {0, 0, 1, 0});
    info.range = {65000, 65002};
    ProbeField field = test::probeField(info, false);
    field.proximity =
        ProximityGrid{.start = {},
                      .step = glm::vec3{1},
                      .counts = {2, 1, 1},
                      .probes = {65534, 7, kNoProbe, kNoProbe, kNoProbe, kNoProbe, kNoProbe, kNoProbe}};
    DiagnosticList diagnostics;
    const auto decoded = decodePfProbe(encodePfProbe(field, {}).value(), Limits{}, diagnostics);
    ASSERT_TRUE(decoded) << describe(decoded.error());
    EXPECT_EQ(*decoded, field);
    info.grid.counts.x = 65534;  // the last count for which 0xFFFF is free to mean none
    field.info = info;
    field.proximity->probes[0] = 65533;
    EXPECT_EQ(decodePfProbe(encodePfProbe(field, {}).value(), Limits{}, diagnostics).value(), field);
}

TEST(ProbeFile, ProfilesHaveTheSizesOfTheDocument) {
    const auto bytesOf = [](ProbeProfile profile, ProbeLayer layer) {
        return resolutionOf(profile).bytesOf(layer);
    };
    EXPECT_EQ(bytesOf(ProbeProfile::Thesis, ProbeLayer::DepthNormal) +
                  bytesOf(ProbeProfile::Thesis, ProbeLayer::Light),
              8388608u);
    EXPECT_EQ(bytesOf(ProbeProfile::Thesis, ProbeLayer::MinDepth), 8192u);
    EXPECT_EQ(bytesOf(ProbeProfile::Default, ProbeLayer::MinDepth), 2048u);
    EXPECT_EQ(resolutionOf(ProbeProfile::Default).bytesPerProbe(),
              512u * 512 * 4 + 256 * 256 * 4 + 2048 + 400 + 1024);
    EXPECT_EQ(resolutionOf(ProbeProfile::Compact).bytesPerProbe() + 32, 1456u);
    for (const auto profile : {ProbeProfile::Thesis, ProbeProfile::Default, ProbeProfile::Compact})
        EXPECT_EQ(profileOf(resolutionOf(profile)), profile);
    EXPECT_EQ(profileOf({64, 64, 8, 14}), ProbeProfile::Custom);
}

TEST(ProbeFile, ReaderTakesSingleLayersInAnyOrder) {
    const test::TempFolder folder;
    const ProbeField field = test::probeField(test::probeInfo());
    test::writeText(folder / "a.pf_probe", asText(encodePfProbe(field, {.contentKey = {{5}}}).value()));
    DiagnosticList diagnostics;
    const auto reader = ProbeFileReader::open(folder / "a.pf_probe", Limits{}, diagnostics);
    ASSERT_TRUE(reader) << describe(reader.error());
    EXPECT_EQ(reader->info(), field.info);
    EXPECT_EQ(reader->contentKey(), (ContentKey{{5}}));
    EXPECT_EQ(reader->proximity(), field.proximity);
    EXPECT_EQ(reader->positionOf(4), field.info.grid.pointOf(4) + glm::vec3(0.25f, -0.125f, 0));
    for (const std::uint32_t probe : {11u, 0u, 4u, 7u}) {
        for (int l = kProbeLayerCount - 1; l >= 0; --l) {
            const auto layer = static_cast<ProbeLayer>(l);
            ASSERT_TRUE(reader->has(probe, layer));
            std::vector<std::byte> words(field.info.resolution.bytesOf(layer));
            ASSERT_TRUE(reader->readLayer(probe, layer, words));
            const auto expected = field.probes[probe].bytesOf(layer);
            EXPECT_TRUE(std::ranges::equal(words, expected)) << toString(layer);
        }
        EXPECT_EQ(reader->readProbe(probe).value(), field.probes[probe]);
    }
    EXPECT_FALSE(reader->has(3, ProbeLayer::Light));  // inactive
    EXPECT_EQ(reader->readProbe(3).value(), field.probes[3]);
}

TEST(ProbeFile, DamageOfOneMapLeavesTheOthersReadable) {
    const test::TempFolder folder;
    const ProbeField field = test::probeField(test::probeInfo());
    std::vector<std::byte> bytes = encodePfProbe(field, {}).value();
    DiagnosticList diagnostics;
    const ProbeFrame frame =
        ProbeFileReader::overBytes(bytes, Limits{}, diagnostics)->frame(7, ProbeLayer::Light);
    bytes[frame.offsetBytes + frame.storedBytes / 2] ^= std::byte{0x5a};
    test::writeText(folder / "a.pf_probe", asText(bytes));
    const auto reader = ProbeFileReader::open(folder / "a.pf_probe", Limits{}, diagnostics);
    ASSERT_TRUE(reader);
    std::vector<std::byte> words(field.info.resolution.bytesOf(ProbeLayer::Light));
    const auto read = reader->readLayer(7, ProbeLayer::Light, words);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::ChecksumMismatch);
    EXPECT_THAT(describe(read.error()), HasSubstr("a.pf_probe: light of probe 7"));
    EXPECT_EQ(read.error().offsetBytes, frame.offsetBytes);
    EXPECT_TRUE(reader->readProbe(6));
    EXPECT_TRUE(reader->readProbe(8));
    const auto findings = validatePfProbeFile(folder / "a.pf_probe", Limits{});
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].context, "light of probe 7");
}

TEST(ProbeFile, WriterMakesTheBytesOfTheEncoderInAnyOrderFromAnyThread) {
    const test::TempFolder folder;
    const ProbeField field = test::probeField(test::probeInfo({5, 4, 3}));
    const std::string expected = asText(encodePfProbe(field, {.zstdLevel = 5, .contentKey = {{8}}}).value());
    std::mt19937 random(1);
    for (int round = 0; round < 5; ++round) {
        std::vector<std::uint32_t> order(field.probes.size());
        for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
        std::ranges::shuffle(order, random);
        DiagnosticList diagnostics;
        auto writer = ProbeFileWriter::open(folder / "a.pf_probe", field.info,
                                            {.encode = {.zstdLevel = 5, .contentKey = {{8}}}}, diagnostics);
        ASSERT_TRUE(writer) << describe(writer.error());
        const auto half = order.size() / 2;
        const auto appendAll = [&](std::size_t from, std::size_t to) {
            for (std::size_t i = from; i < to; ++i)
                if (!writer->append(order[i], field.probes[order[i]])) std::abort();
        };
        std::thread other([&] { appendAll(0, half); });
        appendAll(half, order.size());
        other.join();
        EXPECT_EQ(writer->readProbe(17).value(), field.probes[17]);
        const auto finished = writer->finish(field.proximity);
        ASSERT_TRUE(finished) << describe(finished.error());
        const auto files = test::readTree(folder.path());
        ASSERT_EQ(files.size(), 1u);  // the journal is gone
        EXPECT_EQ(files.at("a.pf_probe"), expected);
        EXPECT_TRUE(diagnostics.entries().empty());
    }
}

TEST(ProbeFile, WriterNamesWhatIsMissingAndRefusesWhatDoesNotFit) {
    const test::TempFolder folder;
    const ProbeField field = test::probeField(test::probeInfo());
    DiagnosticList diagnostics;
    auto writer = ProbeFileWriter::open(folder / "a.pf_probe", field.info, {}, diagnostics).value();
    for (const std::uint32_t i : {0u, 1u, 5u, 9u}) ASSERT_TRUE(writer.append(i, field.probes[i]));
    const auto finished = writer.finish({});
    ASSERT_FALSE(finished);
    EXPECT_THAT(finished.error().message, HasSubstr("8 of 12 probes are missing: 2:5, 6:9, 10:12"));
    EXPECT_EQ(test::readTree(folder.path()).count("a.pf_probe"), 0u);

    EXPECT_EQ(writer.append(12, field.probes[0]).error().code, ErrorCode::BadReference);
    ProbeData broken = field.probes[0];
    broken.moments.pop_back();
    EXPECT_THAT(writer.append(0, broken).error().message, HasSubstr("probe 0: moments"));
    broken = field.probes[0];
    broken.light[5] = 0x7c0;  // infinity
    EXPECT_EQ(writer.append(0, broken).error().code, ErrorCode::BadValue);
    broken = field.probes[0];
    broken.record.offset = {1, 0, 0};
    EXPECT_EQ(writer.append(0, broken).error().code, ErrorCode::BadValue);
    EXPECT_EQ(writer.readProbe(2).error().code, ErrorCode::BadReference);

    const auto second = ProbeFileWriter::open(folder / "a.pf_probe", field.info, {}, diagnostics);
    ASSERT_FALSE(second);
    EXPECT_THAT(describe(second.error()), HasSubstr("a.pf_probe.journal: another process"));
}

TEST(ProbeFile, ShardsMergeToTheBytesOfTheWhole) {
    const test::TempFolder folder;
    const ProbeFieldInfo info = test::probeInfo({5, 2, 2});
    const ProximityGrid proximity = test::proximityOf(info);
    ProbeField whole = test::probeField(info, false);
    whole.proximity = proximity;
    const std::string expected = asText(encodePfProbe(whole, {.contentKey = {{3}}}).value());
    const std::vector<std::vector<std::uint32_t>> cuts{{0, 20}, {0, 7, 20}, {0, 1, 2, 19, 20}};
    for (const auto& cut : cuts) {
        std::vector<std::filesystem::path> shards;
        for (std::size_t i = 0; i + 1 < cut.size(); ++i) {
            shards.insert(shards.begin(), writeShard(folder / ("s" + std::to_string(i)),
                                                     shardInfo(info, cut[i], cut[i + 1])));
        }
        DiagnosticList diagnostics;
        const auto merged =
            mergeProbeFields(shards, folder / "whole.pf_probe", {.contentKey = {{3}}, .proximity = proximity},
                             Limits{}, diagnostics);
        ASSERT_TRUE(merged) << describe(merged.error());
        EXPECT_EQ(test::readText(folder / "whole.pf_probe"), expected);
        EXPECT_TRUE(diagnostics.entries().empty());
    }
}

TEST(ProbeFile, MergeKeepsTheGridOfASingleFileAndTakesANewOne) {
    const test::TempFolder folder;
    const ProbeField field = test::probeField(test::probeInfo());
    test::writeText(folder / "a", asText(encodePfProbe(field, {}).value()));
    DiagnosticList diagnostics;
    const std::vector<std::filesystem::path> one{folder / "a"};
    ASSERT_TRUE(mergeProbeFields(one, folder / "a", {}, Limits{}, diagnostics));
    EXPECT_EQ(loadPfProbe(folder / "a", Limits{}, diagnostics).value(), field);
    const ProximityGrid other = test::proximityOf(field.info, {1, 1, 7});
    ASSERT_TRUE(mergeProbeFields(one, folder / "a", {.proximity = other}, Limits{}, diagnostics));
    EXPECT_EQ(loadPfProbe(folder / "a", Limits{}, diagnostics)->proximity, other);
}

class ProbeMergeRefusal : public testing::Test {
  protected:
    /// The message with which a merge of these is refused.
    std::string refusal(const std::vector<ProbeFieldInfo>& infos, bool allowPart = false) {
        std::vector<std::filesystem::path> shards;
        for (const auto& info : infos)
            shards.push_back(writeShard(folder_ / ("s" + std::to_string(shards.size())), info));
        DiagnosticList diagnostics;
        const auto merged =
            mergeProbeFields(shards, folder_ / "whole", {.allowPart = allowPart}, Limits{}, diagnostics);
        EXPECT_EQ(test::readTree(folder_.path()).count("whole"), merged ? 1u : 0u);
        return merged ? "merged" : describe(merged.error());
    }

    test::TempFolder folder_;
    ProbeFieldInfo info_ = test::probeInfo();
    ProbeFieldInfo front_ = shardInfo(info_, 0, 6);
    ProbeFieldInfo back_ = shardInfo(info_, 6, 12);
};

TEST_F(ProbeMergeRefusal, NamesMissingAndRepeatedProbes) {
    EXPECT_EQ(refusal({front_, back_}), "merged");
    std::filesystem::remove(folder_ / "whole");
    EXPECT_THAT(refusal({front_}), HasSubstr("6 of 12 probes are in no shard: 6:12"));
    EXPECT_THAT(refusal({back_}), HasSubstr("0:6"));
    EXPECT_THAT(refusal({shardInfo(info_, 1, 3), shardInfo(info_, 4, 9)}),
                HasSubstr("5 of 12 probes are in no shard: 0, 3, 9:12"));
    EXPECT_THAT(refusal({shardInfo(info_, 0, 8), back_}), HasSubstr("probes 6:8 are also in another shard"));
    EXPECT_THAT(refusal({info_, shardInfo(info_, 3, 4)}), HasSubstr("probes 3 are also in another shard"));
    EXPECT_THAT(refusal({shardInfo(info_, 1, 3), shardInfo(info_, 4, 9)}, true),
                HasSubstr("1 of 12 probes are in no shard: 3"));
    EXPECT_EQ(refusal({shardInfo(info_, 1, 3), shardInfo(info_, 3, 9)}, true), "merged");
}

TEST_F(ProbeMergeRefusal, NamesEachDifference) {
    back_.settings.seed = 1;
    EXPECT_THAT(refusal({front_, back_}), HasSubstr("does not belong to"));
    EXPECT_THAT(refusal({front_, back_}), HasSubstr("s0 was baked with --seed 77, "));
    EXPECT_THAT(refusal({front_, back_}), testing::EndsWith("s1 with --seed 1"));
    back_.settings.maxSamples = 8;
    back_.sceneHash.bytes[3] = 1;
    back_.depth.scale = 9;
    EXPECT_THAT(refusal({front_, back_}), HasSubstr(": other depth encoding, scene; "));
    EXPECT_THAT(refusal({front_, back_}), testing::EndsWith("s1 with --seed 1, most samples 8"));
    back_ = shardInfo(test::probeInfo({3, 2, 2}, {16, 16, 4, 6}), 6, 12);
    EXPECT_THAT(refusal({front_, back_}), testing::EndsWith("other resolution"));
}

/// Shards baked with other --bounces, --relocate, samples or filter were merged with exit code 0.
TEST_F(ProbeMergeRefusal, EverySettingCounts) {
    const auto refuses = [&](auto change, const std::string& first, const std::string& second) {
        ProbeFieldInfo changed = back_;
        change(changed.settings);
        const std::string message = refusal({front_, changed});
        EXPECT_THAT(message, HasSubstr("was baked with " + first + ", "));
        EXPECT_THAT(message, testing::EndsWith("s1 with " + second));
    };
    refuses([](auto& s) { s.maxBounces = 0; }, "--bounces 16", "--bounces 0");
    refuses([](auto& s) { s.maxBounces = kUnlimitedBounces; }, "--bounces 16", "--bounces unlimited");
    refuses([](auto& s) { s.relocate = false; }, "--relocate", "--no-relocate");
    refuses([](auto& s) { s.filter = 0; }, "--filter (revision 1)", "--no-filter");
    refuses([](auto& s) { s.filter = 2; }, "--filter (revision 1)", "--filter (revision 2)");
    refuses([](auto& s) { s.filter.reset(); }, "--filter (revision 1)", "--filter unknown");
    refuses([](auto& s) { s.minSamples = 16; }, "least samples 32", "least samples 16");
    refuses([](auto& s) { s.noiseTarget = 0.25f; }, "--noise 0.125", "--noise 0.25");
    refuses([](auto& s) { s.noiseFloor = 0.5f; }, "noise floor 0.25", "noise floor 0.5");
    refuses([](auto& s) { s.stratified = false; }, "stratified points on", "stratified points off");
    std::size_t settings = 0;
    forEachProbeSetting(
        [&](const ProbeSetting&, const auto& value, auto& changed) {
            ++settings;
            const auto kept = changed;
            changed = {};
            EXPECT_NE(refusal({front_, back_}), "merged") << settings;
            changed = kept;
            EXPECT_EQ(value, changed);
        },
        std::as_const(front_.settings), back_.settings);
    EXPECT_EQ(settings, 11u);
}

/// What files do not keep is in their content keys.
TEST_F(ProbeMergeRefusal, OtherContentKeysOfOneDeviceAreOfTwoBakes) {
    const auto merged = [&](const ProbeFieldInfo& back, std::uint8_t key) {
        const std::vector<std::filesystem::path> shards{folder_ / "a", folder_ / "b"};
        const auto write = [&](const auto& file, const ProbeFieldInfo& info, std::uint8_t byte) {
            const auto bytes = encodePfProbe(test::probeField(info, false), {.contentKey = {{byte}}}).value();
            ASSERT_TRUE(io::writeFileAtomically(file, bytes));
        };
        write(shards[0], front_, 1);
        write(shards[1], back, key);
        DiagnosticList diagnostics;
        const auto result = mergeProbeFields(shards, folder_ / "whole", {}, Limits{}, diagnostics);
        return result ? "merged" : describe(result.error());
    };
    EXPECT_EQ(merged(back_, 1), "merged");
    EXPECT_EQ(merged(back_, 0), "merged") << "it is not known";
    EXPECT_THAT(merged(back_, 2), HasSubstr("other content key"));
    back_.deviceName = "another device";
    EXPECT_EQ(merged(back_, 2), "merged") << "the key names the device";
}

TEST_F(ProbeMergeRefusal, OtherDevicesAreReported) {
    back_.deviceName = "another device";
    const std::vector<std::filesystem::path> shards{writeShard(folder_ / "a", back_),
                                                    writeShard(folder_ / "b", front_)};
    DiagnosticList diagnostics;
    ASSERT_TRUE(mergeProbeFields(shards, folder_ / "whole", {}, Limits{}, diagnostics));
    ASSERT_EQ(diagnostics.entries().size(), 1u);
    EXPECT_EQ(diagnostics.entries()[0].id, "probe-merge-devices");
    EXPECT_EQ(loadPfProbe(folder_ / "whole", Limits{}, diagnostics)->info.deviceName,
              "test device, driver 1; another device");
}

TEST_F(ProbeMergeRefusal, DamagedShard) {
    const auto file = writeShard(folder_ / "a", info_);
    std::string text = test::readText(file);
    text[text.size() - 40] = static_cast<char>(text[text.size() - 40] ^ 0x10);
    test::writeText(file, text);
    DiagnosticList diagnostics;
    const std::vector<std::filesystem::path> shards{file};
    const auto merged = mergeProbeFields(shards, folder_ / "whole", {}, Limits{}, diagnostics);
    ASSERT_FALSE(merged);
    EXPECT_EQ(merged.error().code, ErrorCode::ChecksumMismatch);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "whole"));
}

}  // namespace
}  // namespace pfvox

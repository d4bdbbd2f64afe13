// The journal of a bake: killed at any byte, and damaged anywhere. What it then gives must be probes that
// were written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pfvox/probe_file.hpp>

#include <cmath>
#include <functional>

#include "io/hash.hpp"
#include "pf_probe/layout.hpp"
#include "support/probe_fields.hpp"
#include "support/temp_folder.hpp"

namespace pfvox {
namespace {

using testing::HasSubstr;

class ProbeJournal : public testing::Test {
  protected:
    static constexpr std::uint32_t kProbes = 6;

    /// A bake that was killed after it had written all probes; `starts` gets where each record begins.
    void bake(const std::vector<std::uint32_t>& order) {
        DiagnosticList diagnostics;
        auto writer = ProbeFileWriter::open(output_, info_, {}, diagnostics).value();
        starts_.push_back(std::filesystem::file_size(journal_));
        for (const std::uint32_t probe : order) {
            ASSERT_TRUE(writer.append(probe, test::probeOf(info_, probe)));
            starts_.push_back(std::filesystem::file_size(journal_));
        }
    }

    /// Resumes and counts the probes that need not be baked again; each must be right.
    std::size_t resume(DiagnosticList& diagnostics) {
        auto writer = ProbeFileWriter::open(output_, info_, {.resume = true}, diagnostics);
        EXPECT_TRUE(writer) << describe(writer.error());
        std::size_t kept = 0;
        for (std::uint32_t probe = 0; probe < kProbes; ++probe) {
            ProbeData expected = test::probeOf(info_, probe);
            if (!writer->reuse(probe, expected.inputHash)) continue;
            ++kept;
            expected.record.hash = hashOf(expected);
            EXPECT_EQ(writer->readProbe(probe).value(), expected);
        }
        EXPECT_EQ(writer->missing().size(), kProbes - kept);
        return kept;
    }

    test::TempFolder folder_;
    std::filesystem::path output_ = folder_ / "out.pf_probe";
    std::filesystem::path journal_ = folder_ / "out.pf_probe.journal";
    ProbeFieldInfo info_ = test::probeInfo({kProbes, 1, 1}, {0, 2, 1, 0});
    std::vector<std::uint64_t> starts_;
};

TEST_F(ProbeJournal, EveryPrefixGivesTheWholeRecordsInIt) {
    bake({4, 0, 3, 5, 1, 2});
    const std::string whole = test::readText(journal_);
    ASSERT_EQ(whole.size(), starts_.back());
    for (std::size_t size = 0; size <= whole.size(); ++size) {
        test::writeText(journal_, whole.substr(0, size));
        DiagnosticList diagnostics;
        const auto records =
            std::ranges::count_if(starts_, [&](std::uint64_t start) { return start <= size; }) - 1;
        ASSERT_EQ(resume(diagnostics), static_cast<std::size_t>(std::max<std::ptrdiff_t>(records, 0)))
            << size;
        const bool isTorn = size > starts_[0] && std::ranges::find(starts_, size) == starts_.end();
        ASSERT_EQ(diagnostics.entries().size(), isTorn ? 1u : 0u) << size;
        if (isTorn) {
            ASSERT_EQ(diagnostics.entries()[0].id, "probe-journal-torn");
        }
    }
}

TEST_F(ProbeJournal, EveryDamagedByteEndsItThere) {
    bake({4, 0, 3, 5, 1, 2});
    const std::string whole = test::readText(journal_);
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x41);
        test::writeText(journal_, damaged);
        DiagnosticList diagnostics;
        const auto records =
            std::ranges::count_if(starts_, [&](std::uint64_t start) { return start <= at; }) - 1;
        ASSERT_EQ(resume(diagnostics), static_cast<std::size_t>(std::max<std::ptrdiff_t>(records, 0))) << at;
        ASSERT_EQ(diagnostics.entries().size(), 1u);
        ASSERT_EQ(diagnostics.entries()[0].id, "probe-journal-damaged") << at;
    }
}

TEST_F(ProbeJournal, ResumedBakesMakeTheBytesOfAnUninterruptedOne) {
    DiagnosticList diagnostics;
    const ProbeField field = test::probeField(info_, false);
    const auto bytes = encodePfProbe(field, {}).value();
    const std::string expected(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (const std::size_t cut : {0u, 1u, 3u, 5u, 6u}) {
        starts_.clear();
        bake({4, 0, 3, 5, 1, 2});
        std::filesystem::resize_file(journal_, starts_[cut] + (cut < 6 ? 20 : 0));
        auto writer = ProbeFileWriter::open(output_, info_, {.resume = true}, diagnostics).value();
        std::size_t baked = 0;
        for (std::uint32_t probe = 0; probe < kProbes; ++probe) {
            if (writer.reuse(probe, field.probes[probe].inputHash)) continue;
            ASSERT_TRUE(writer.append(probe, field.probes[probe]));
            ++baked;
        }
        EXPECT_EQ(baked, kProbes - cut);
        ASSERT_TRUE(writer.finish({}));
        EXPECT_EQ(test::readText(output_), expected);
        EXPECT_FALSE(std::filesystem::exists(journal_));
    }
}

TEST_F(ProbeJournal, ProbesOfOtherInputsAreNotUsed) {
    bake({0, 1, 2});
    DiagnosticList diagnostics;
    auto writer = ProbeFileWriter::open(output_, info_, {.resume = true}, diagnostics).value();
    EXPECT_FALSE(writer.reuse(1, ContentKey{{1, 2, 3}}));
    EXPECT_FALSE(writer.reuse(1, ContentKey{}));
    EXPECT_FALSE(writer.reuse(5, test::probeOf(info_, 5).inputHash));
    EXPECT_TRUE(writer.reuse(1, test::probeOf(info_, 1).inputHash));
    EXPECT_THAT(writer.missing(), testing::ElementsAre(0, 2, 3, 4, 5));
}

TEST_F(ProbeJournal, OfTwoRecordsOfAProbeTheLastCounts) {
    bake({0, 1, 0});
    const ProbeData other = test::probeOf(info_, 0, 9);
    DiagnosticList diagnostics;
    {
        auto writer = ProbeFileWriter::open(output_, info_, {.resume = true}, diagnostics).value();
        ASSERT_TRUE(writer.append(0, other));
        EXPECT_EQ(writer.readProbe(0)->light, other.light);
    }
    auto writer = ProbeFileWriter::open(output_, info_, {.resume = true}, diagnostics).value();
    EXPECT_FALSE(writer.reuse(0, test::probeOf(info_, 0).inputHash));
    EXPECT_TRUE(writer.reuse(0, other.inputHash));
}

TEST_F(ProbeJournal, OfAnotherBakeIsReportedAndBegunAnew) {
    bake({0, 1, 2});
    info_.depth.farMetres = 17;
    DiagnosticList diagnostics;
    EXPECT_EQ(resume(diagnostics), 0u);
    ASSERT_EQ(diagnostics.entries().size(), 1u);
    EXPECT_EQ(diagnostics.entries()[0].id, "probe-journal-other");
    EXPECT_THAT(diagnostics.entries()[0].message, HasSubstr("out.pf_probe.journal"));
}

TEST_F(ProbeJournal, WithoutResumeItIsBegunAnewAndSaid) {
    bake({0, 1, 2});
    DiagnosticList diagnostics;
    auto writer = ProbeFileWriter::open(output_, info_, {}, diagnostics).value();
    EXPECT_EQ(writer.missing().size(), kProbes);
    ASSERT_EQ(diagnostics.entries().size(), 1u);
    EXPECT_EQ(diagnostics.entries()[0].id, "probe-journal-discarded");
}

/// A record of the journal behind repaired hashes.
TEST_F(ProbeJournal, LiesBehindRepairedHashes) {
    using probe_layout::JournalRecord;
    const std::vector<std::pair<const char*, std::function<void(JournalRecord&)>>> lies{
        {"probe outside", [](JournalRecord& r) { r.probe = 6; }},
        {"four billion", [](JournalRecord& r) { r.probe = 0xffffffffu; }},
        {"unknown state", [](JournalRecord& r) { r.record.state = 7; }},
        {"inactive with maps", [](JournalRecord& r) { r.record.state = 1; }},
        {"offset of an active probe", [](JournalRecord& r) { r.record.offset[1] = 1; }},
        {"error is NaN", [](JournalRecord& r) { r.record.error = std::nanf(""); }},
        {"codec 9", [](JournalRecord& r) { r.frames[1].codec = static_cast<probe_layout::FrameCodec>(9); }},
        {"frame longer than its map", [](JournalRecord& r) { r.frames[1].storedBytes = 0xffffffffu; }},
        {"frame of no bytes", [](JournalRecord& r) { r.frames[1].storedBytes = 0; }},
        {"layer that the bake does not have", [](JournalRecord& r) { r.frames[0] = r.frames[1]; }},
    };
    bake({0, 1, 2});
    const std::string whole = test::readText(journal_);
    for (const auto& [name, tell] : lies) {
        SCOPED_TRACE(name);
        std::string text = whole;
        JournalRecord record;
        std::memcpy(&record, text.data() + starts_[1], sizeof record);
        tell(record);
        const auto* bytes = reinterpret_cast<const std::byte*>(&record);
        record.recordHash = io::xxh3_64({bytes, offsetof(JournalRecord, recordHash)});
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

// What PF_VOX and PF_PROBE files have in common, when it lies: every prefix, every flipped bit, headers and
// tables that say wrong things with right hashes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "support/container_formats.hpp"

namespace pfvox {
namespace {

using layout::Section;
using test::Bytes;
using test::ContainerFormat;
using test::OpenFile;

class ContainerHostile : public testing::TestWithParam<const ContainerFormat*> {
  protected:
    const ContainerFormat& format() const { return *GetParam(); }
    const Bytes& sample() const { return format().sample(); }

    Result<Bytes> decode(const Bytes& file, const Limits& limits = {}) const {
        DiagnosticList diagnostics;
        return format().decode(file, limits, diagnostics);
    }

    /// Decoding must fail with this code, and validate must have a finding with the same.
    void expectRefused(const Bytes& file, ErrorCode code, const std::string& words = "") const {
        const auto decoded = decode(file);
        ASSERT_FALSE(decoded) << "accepted, expected " << toString(code);
        EXPECT_EQ(decoded.error().code, code) << describe(decoded.error());
        EXPECT_THAT(describe(decoded.error()), testing::HasSubstr(words));
        const std::vector<Finding> findings = format().validate(file, Limits{});
        ASSERT_FALSE(findings.empty());
        EXPECT_EQ(findings[0].id, toString(code)) << findings[0].message;
    }

    /// The sample with another table entry of its first compressed section.
    Bytes withTableEntry(const std::function<void(Section&)>& change) const {
        Bytes file = sample();
        OpenFile open = test::openFile(file);
        for (std::size_t i = 0; i < open.parts.size(); ++i) {
            Section& entry = open.parts[i].entry;
            if (entry.codec != layout::Codec::Zstd) continue;
            change(entry);
            std::memcpy(file.data() + sizeof(layout::Header) + i * sizeof entry, &entry, sizeof entry);
            test::repairHead(file);
            return file;
        }
        ADD_FAILURE() << "no section is compressed";
        return file;
    }
};

TEST_P(ContainerHostile, EveryPrefixIsRefused) {
    const Bytes& file = sample();
    for (std::size_t size = 0; size < file.size(); ++size) {
        const Bytes prefix(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
        const auto decoded = decode(prefix);
        ASSERT_FALSE(decoded) << "prefix of " << size << " bytes";
        ASSERT_TRUE(decoded.error().code == ErrorCode::Truncated ||
                    decoded.error().code == ErrorCode::BadMagic)
            << describe(decoded.error());
    }
}

TEST_P(ContainerHostile, AByteTooManyIsRefused) {
    Bytes file = sample();
    file.push_back(std::byte{0});
    expectRefused(file, ErrorCode::BadStructure, "1 bytes follow the end");
}

TEST_P(ContainerHostile, EveryFlippedBitIsNoticedOrChangesNothing) {
    const Bytes original = sample();
    Bytes file = original;
    std::size_t harmless = 0;
    for (std::size_t i = 0; i < file.size(); ++i) {
        for (int bit = 0; bit < 8; ++bit) {
            file[i] ^= std::byte{1} << bit;
            // zstd frames have bits without meaning: what it decodes to must be what was encoded.
            if (const auto decoded = decode(file)) {
                ASSERT_EQ(*decoded, original) << "byte " << i << " bit " << bit;
                ++harmless;
            }
            file[i] = original[i];
        }
    }
    EXPECT_LT(harmless, original.size() * 8 / 50);
}

TEST_P(ContainerHostile, RandomDamageBehindTheHashesNeverCrashes) {
    std::mt19937 random(5);
    std::size_t accepted = 0;
    for (int round = 0; round < 4000; ++round) {
        OpenFile open = test::openFile(sample());
        OpenFile::Part& part = open.parts[random() % open.parts.size()];
        if (part.raw.empty()) continue;
        for (std::uint64_t n = 1 + random() % 3; n > 0; --n)
            part.raw[random() % part.raw.size()] = static_cast<std::uint8_t>(random());
        const Bytes file = format().close(std::move(open));
        static_cast<void>(format().validate(file, Limits{}));
        if (decode(file)) ++accepted;
    }
    EXPECT_GT(accepted, 0u);  // colors, positions and seeds may be anything: it reached behind the hashes
}

TEST_P(ContainerHostile, SampleSurvivesSurgery) {
    EXPECT_EQ(decode(format().close(test::openFile(sample()))).value(), sample());
    EXPECT_THAT(format().validate(sample(), Limits{}), testing::IsEmpty());
}

TEST_P(ContainerHostile, ForeignFiles) {
    const std::string text = "hello world, this is a text";
    const auto bytes = std::as_bytes(std::span(text));
    expectRefused(Bytes(bytes.begin(), bytes.end()), ErrorCode::BadMagic, format().magicWords);
    expectRefused({}, ErrorCode::BadMagic);
    const bool isVox = &format() == &test::kVoxFormat;
    const ContainerFormat& other = isVox ? test::kProbeFormat : test::kVoxFormat;
    expectRefused(other.sample(), ErrorCode::BadMagic, isVox ? "probe-bake reads" : "vox2pf reads");
}

TEST_P(ContainerHostile, OtherVersionsAndFeaturesAreNamed) {
    Bytes file = sample();
    file[offsetof(layout::Header, versionMajor)] = std::byte{9};
    test::repairHead(file);
    expectRefused(file, ErrorCode::UnsupportedVersion, format().versionWords);

    file = sample();
    file[offsetof(layout::Header, requiredFeatures)] = std::byte{0x10};
    test::repairHead(file);
    expectRefused(file, ErrorCode::UnsupportedFeature, "0x10");

    file = sample();
    file[offsetof(layout::Header, endianTag)] = std::byte{1};
    test::repairHead(file);
    expectRefused(file, ErrorCode::BadValue, "byte order");
}

TEST_P(ContainerHostile, UnknownSections) {
    OpenFile open = test::openFile(sample());
    open.parts.push_back(
        {.entry = {.fourcc = {'X', 'T', 'R', 'A'}, .region = layout::kNoRegion}, .raw = {1, 2, 3}});
    DiagnosticList diagnostics;
    EXPECT_TRUE(format().decode(format().close(open), Limits{}, diagnostics));
    ASSERT_EQ(diagnostics.entries().size(), 1u);
    EXPECT_EQ(diagnostics.entries()[0].id, format().unknownSection);

    open.parts.back().entry.flags = layout::kSectionMustUnderstand;
    expectRefused(format().close(open), ErrorCode::UnsupportedFeature, "XTRA");
}

TEST_P(ContainerHostile, SectionsMissingOrTwice) {
    const std::size_t count = test::openFile(sample()).parts.size();
    for (std::size_t i = 0; i < count; ++i) {
        OpenFile open = test::openFile(sample());
        const Section entry = open.parts[i].entry;
        SCOPED_TRACE(std::string(entry.fourcc.data(), 4));
        open.parts.push_back(open.parts[i]);
        expectRefused(format().close(open), ErrorCode::BadStructure, "twice");
        open.parts.pop_back();
        open.parts.erase(open.parts.begin() + static_cast<std::ptrdiff_t>(i));
        // What need not be understood, cameras and the proximity grid may be absent; nothing refers to them.
        const std::string name(entry.fourcc.data(), 4);
        const bool isOptional = (entry.flags & layout::kSectionMustUnderstand) == 0;
        const bool isHalf = name == "FACE" || name == "FDAT";  // both or none
        EXPECT_EQ(decode(format().close(open)).has_value(),
                  (isOptional && !isHalf) || name == "CAMR" || name == "PROX");
    }
}

TEST_P(ContainerHostile, SectionTableThatLies) {
    using enum ErrorCode;
    expectRefused(withTableEntry([](Section& s) { s.offset = 1ull << 62; }), BadStructure);
    expectRefused(withTableEntry([](Section& s) { s.storedBytes = ~0ull; }), BadStructure);
    expectRefused(withTableEntry([](Section& s) { s.offset = 64; }), BadStructure, "overlaps");
    expectRefused(withTableEntry([](Section& s) { s.offset += 1; }), BadStructure, "aligned");
    expectRefused(withTableEntry([](Section& s) { s.rawBytes = 1ull << 40; }), BadStructure);
    expectRefused(withTableEntry([](Section& s) { s.codec = layout::Codec{7}; }), UnsupportedFeature);
    expectRefused(withTableEntry([](Section& s) { s.rawHash ^= 1; }), ChecksumMismatch);
    Bytes many = sample();
    const std::uint32_t count = 0xffffffffu;
    std::memcpy(many.data() + offsetof(layout::Header, sectionCount), &count, sizeof count);
    expectRefused(many, BadStructure, "4294967295 sections");
}

TEST_P(ContainerHostile, ForeignBytesBetweenSections) {
    const OpenFile open = test::openFile(sample());
    Bytes file = sample();
    for (std::size_t i = 0; i + 1 < open.parts.size(); ++i) {
        const Section& entry = open.parts[i].entry;
        if (entry.offset + entry.storedBytes == open.parts[i + 1].entry.offset) continue;
        file[entry.offset + entry.storedBytes] = std::byte{1};
        return expectRefused(file, ErrorCode::BadStructure, "foreign bytes");
    }
    FAIL() << "no gap between sections";
}

INSTANTIATE_TEST_SUITE_P(AllFormats, ContainerHostile,
                         testing::Values(&test::kVoxFormat, &test::kProbeFormat, &test::kFaceFormat),
                         [](const auto& tested) { return std::string(tested.param->name); });

}  // namespace
}  // namespace pfvox

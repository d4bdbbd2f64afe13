// The bytes of PF_PROBE 1.0 to 1.2. A reader must always take the file of every version; the writer of this
// version must make the same bytes again. Where the writer changes on purpose, run with PFVOX_UPDATE_GOLDEN=1
// and say why in CHANGELOG.md.
#include <gtest/gtest.h>

#include <cstdlib>
#include <pfvox/probe_file.hpp>

#include "support/lit_faces.hpp"
#include "support/probe_fields.hpp"
#include "support/temp_folder.hpp"

namespace pfvox {
namespace {

struct Golden {
    const char* name;
    ProbeFieldInfo info;
    bool withProximity;
    std::optional<FaceLightInfo> faces = {};

    std::filesystem::path file() const {
        return std::filesystem::path(PFVOX_TESTS_DIR) / "golden/data" / name;
    }
    ProbeField field() const {
        ProbeField field = test::probeField(info, withProximity);
        if (faces) field.faces = test::faceLight(*faces);
        return field;
    }
};

void PrintTo(const Golden& golden, std::ostream* out) {
    *out << golden.name;
}

ProbeFieldInfo shardInfo() {
    ProbeFieldInfo info = test::probeInfo({70000, 1, 1}, {0, 0, 3, 0});
    info.range = {69996, 70000};
    return info;
}

/// Chunks of a shard, lossless.
FaceLightInfo faceShard() {
    FaceLightInfo info = test::faceInfo(FaceCodec::Lossless);
    info.range = {1, 3};
    return info;
}

class PfProbeGolden : public testing::TestWithParam<Golden> {};

/// What a file of 1.0 tells of the settings.
ProbeFieldInfo ofVersion1_0(ProbeFieldInfo info) {
    const ProbeBakeSettings& s = info.settings;
    info.settings = {.seed = s.seed,
                     .tracedResolution = s.tracedResolution,
                     .minSamples = s.minSamples,
                     .maxSamples = s.maxSamples,
                     .maxBounces = s.maxBounces,
                     .noiseTarget = s.noiseTarget,
                     .noiseFloor = {},
                     .sampling = {},
                     .stratified = {},
                     .relocate = {},
                     .filter = {}};
    return info;
}

class PfProbeWritten : public PfProbeGolden {};

INSTANTIATE_TEST_SUITE_P(Files, PfProbeGolden,
                         testing::Values(Golden{"v1_0.pf_probe", ofVersion1_0(test::probeInfo()), true},
                                         Golden{"v1_0_shard.pf_probe", ofVersion1_0(shardInfo()), false},
                                         Golden{"v1_0_wide.pf_probe", ofVersion1_0(shardInfo()), true},
                                         Golden{"v1_1.pf_probe", test::probeInfo(), true},
                                         Golden{"v1_1_shard.pf_probe", shardInfo(), false},
                                         Golden{"v1_1_wide.pf_probe", shardInfo(), true},
                                         Golden{"v1_2.pf_probe", test::probeInfo(), true, test::faceInfo()},
                                         Golden{"v1_2_faces.pf_probe", test::noProbesInfo(), false,
                                                faceShard()}));
INSTANTIATE_TEST_SUITE_P(Files, PfProbeWritten,
                         testing::Values(Golden{"v1_1.pf_probe", test::probeInfo(), true},
                                         Golden{"v1_1_shard.pf_probe", shardInfo(), false},
                                         Golden{"v1_1_wide.pf_probe", shardInfo(), true},
                                         Golden{"v1_2.pf_probe", test::probeInfo(), true, test::faceInfo()},
                                         Golden{"v1_2_faces.pf_probe", test::noProbesInfo(), false,
                                                faceShard()}));

TEST_P(PfProbeWritten, WriterMakesTheSameBytes) {
    const ContentKey key{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}};
    const auto bytes = encodePfProbe(GetParam().field(), {.contentKey = key}).value();
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (std::getenv("PFVOX_UPDATE_GOLDEN") != nullptr) test::writeText(GetParam().file(), text);
    EXPECT_TRUE(text == test::readText(GetParam().file()));
}

TEST_P(PfProbeGolden, ReaderTakesIt) {
    DiagnosticList diagnostics;
    const auto field = loadPfProbe(GetParam().file(), Limits{}, diagnostics);
    ASSERT_TRUE(field) << describe(field.error());
    EXPECT_EQ(*field, GetParam().field());
    EXPECT_EQ(ProbeFileReader::open(GetParam().file(), Limits{}, diagnostics)->contentKey().hex(),
              "0102030405060708090a0b0c0d0e0f10");
    EXPECT_TRUE(validatePfProbeFile(GetParam().file(), Limits{}).empty());
}

}  // namespace
}  // namespace pfvox

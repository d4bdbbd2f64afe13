// What the probes window tells of a probe, and what file dialogs list.
#include "probe_detail.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <pfvox/files.hpp>
#include <pfvox/probe_layers.hpp>

#include "compose/file_list.hpp"
#include "pick.hpp"
#include "support/probe_fields.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

using namespace viewer;
using ::testing::ElementsAre;

/// A field of one light everywhere, surfaces 2.5 m away in half of the directions.
ProbeField knownField(const TempFolder& folder) {
    ProbeField field{.info = probeInfo(), .probes = {}, .proximity = {}};
    const DepthCoder coder(field.info.depth);
    for (std::uint32_t i = 0; i < field.info.grid.probeCount(); ++i)
        field.probes.push_back(probeOf(field.info, i));
    ProbeData& probe = field.probes[0];
    std::ranges::fill(probe.light, packLight({0.5f, 1.0f, 2.0f}));
    const std::uint32_t edge = field.info.resolution.depth;
    for (std::uint32_t t = 0; t < edge * edge; ++t) {
        const bool upper = directionOfTexel(t % edge, t / edge, edge).y > 0.0f;
        probe.depthNormal[t] = packDepthNormal(upper ? kDepthMissCode : coder.encode(2.5f), {0, 1, 0});
    }
    probe.minDepth = minDepthLayer(probe.depthNormal, edge);
    const auto bytes = encodePfProbe(field, {});
    EXPECT_TRUE(bytes) << describe(bytes.error());
    EXPECT_TRUE(io::writeFileAtomically(folder / "f.pf_probe", *bytes));
    return field;
}

TEST(ProbeDetail, FiguresAndMapsOfAKnownProbe) {
    TempFolder folder;
    const ProbeField field = knownField(folder);
    DiagnosticList diagnostics;
    const Result<ProbeDetail> detail = readProbeDetail(folder / "f.pf_probe", 0, diagnostics);
    ASSERT_TRUE(detail) << describe(detail.error());
    EXPECT_EQ(detail->position, field.info.grid.pointOf(0));
    EXPECT_NEAR(detail->meanLight.g, 1.0f, 1e-5f);
    EXPECT_EQ(detail->maxLight, glm::vec3(0.5f, 1.0f, 2.0f));
    ASSERT_TRUE(detail->minDepthMetres);
    EXPECT_NEAR(*detail->minDepthMetres, 2.5f, 0.01f);
    EXPECT_NEAR(detail->surfaceFraction.value_or(0.0f), 0.5f, 0.05f);
    EXPECT_EQ(detail->light.resolution, 16u);
    EXPECT_EQ(detail->depth.resolution, 32u);
    EXPECT_EQ(detail->normals.pixels.size(), 32u * 32u);
    EXPECT_EQ(detail->light.pixels[0] >> 16 & 0xffu, 255u) << "the brightest channel is white";
    EXPECT_GT(std::ranges::count(detail->depth.pixels, 0xff000000u), 400) << "misses are black";
}

TEST(ProbeDetail, AnInactiveProbeHasNoMapsAndOthersDoNotExist) {
    TempFolder folder;
    knownField(folder);
    DiagnosticList diagnostics;
    const Result<ProbeDetail> detail = readProbeDetail(folder / "f.pf_probe", 3, diagnostics);
    ASSERT_TRUE(detail) << describe(detail.error());
    EXPECT_EQ(detail->record.state, ProbeState::Inactive);
    EXPECT_EQ(detail->light.resolution, 0u);
    EXPECT_FALSE(readProbeDetail(folder / "f.pf_probe", 12, diagnostics));
    EXPECT_FALSE(readProbeDetail(folder / "none.pf_probe", 0, diagnostics));
}

TEST(FileList, FoldersThenFilesOfTheKindsAskedFor) {
    TempFolder folder;
    for (const char* name : {"b.pf_vox", "a.pf_vox", "a.vox", ".hidden.pf_vox", "sub/c.pf_vox", ".git/x"})
        writeText(folder / name, "x");
    const std::string_view kinds[] = {".pf_vox"};
    const Result<FileList> list = listFiles(folder / "sub" / "..", kinds);
    ASSERT_TRUE(list);
    EXPECT_EQ(list->folder, folder.path());
    EXPECT_THAT(list->folders, ElementsAre("sub"));
    EXPECT_THAT(list->files, ElementsAre("a.pf_vox", "b.pf_vox"));
    const Result<FileList> none = listFiles(folder / "none", kinds);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::FileNotReadable);
}

TEST(NearestProbe, IsTheGridPointNextToAPoint) {
    const ProbeGrid grid{.start = {1, 0, -1}, .step = {0.5f, 1, 2}, .counts = {3, 2, 4}};
    EXPECT_EQ(nearestProbe(grid, {1.7, 0.4, 2.9}), grid.indexOf({1, 0, 2}));
    EXPECT_EQ(nearestProbe(grid, {-90, 90, 90}), grid.indexOf({0, 1, 3}));
    for (std::uint32_t i = 0; i < grid.probeCount(); ++i) EXPECT_EQ(nearestProbe(grid, grid.pointOf(i)), i);
}

}  // namespace
}  // namespace pfvox::test

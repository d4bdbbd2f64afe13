// The revision in the content key of a conversion rises whenever the same source and settings give other
// bytes: else what users converted before would count as up to date.
#include <gtest/gtest.h>

#include <pfvox/convert.hpp>
#include <pfvox/files.hpp>

#include "support/legacy_writer.hpp"
#include "support/revision_table.hpp"
#include "support/svx_writer.hpp"

namespace pfvox::test {
namespace {

struct Source {
    std::string name;
    Bytes bytes;
};

Source fileBelowTests(const std::filesystem::path& name) {
    const auto contents = io::readFile(std::filesystem::path(PFVOX_TESTS_DIR) / name, 1 << 24);
    EXPECT_TRUE(contents) << name;
    const auto bytes = contents ? contents->bytes() : std::span<const std::byte>();
    return {name.filename().string(), {bytes.begin(), bytes.end()}};
}

Source svxBall() {
    SvxWriter writer({12, 12, 12});
    writer.addScalarChannel(
        R"(type="DENSITY" bits="8" slices="density/slice%04d.png")", "density", 8, [](glm::ivec3 v) {
            const glm::ivec3 d = 2 * v - 11;
            return static_cast<std::uint16_t>(std::max(0, 255 - (d.x * d.x + d.y * d.y + d.z * d.z)));
        });
    return {"ball.svx", writer.finish()};
}

Source thesisFile() {
    LegacyWriter writer;
    writer.materials = {{}, {.type = 1, .roughness = 0.3f, .color = glm::vec4(0.2f, 0.4f, 0.6f, 1.0f)}};
    writer.extent = glm::vec3(1.0f);
    writer.nodes = {{.leafMask = 0b10010110, .validMask = 0b10010110}};
    writer.leafMaterials = {0, 1, 1, 0};
    return {"thesis.pf_vox", writer.bytes()};
}

/// Everything but the key itself and the hash over it, which stand in the last 24 bytes of the header.
std::string hashOfOutput(const Source& source, const ConvertSettings& settings) {
    DiagnosticList diagnostics;
    ConvertReport report;
    auto bytes = convertBytes(source.bytes, source.name, settings, Limits{}, diagnostics, report);
    EXPECT_TRUE(bytes) << source.name << ": " << describe(bytes.error());
    if (!bytes || bytes->size() < 64) return "failed";
    std::fill(bytes->begin() + 40, bytes->begin() + 64, std::byte{0});
    return hashText(*bytes);
}

TEST(ConverterRevision, RisesWithTheBytes) {
    RevisionTable table("converter_revisions.txt");
    const std::string key =
        fmt::format("pf_vox-{}.{}-revision-{}", kPfVoxVersionMajor, kPfVoxVersionMinor, kConverterRevision);
    const auto expect = [&](const Source& source, const std::string& variant,
                            const ConvertSettings& settings) {
        table.expect(key, source.name + variant, hashOfOutput(source, settings),
                     "raise kConverterRevision in pfvox/convert.hpp, then run with PFVOX_UPDATE_GOLDEN=1");
    };
    const Source tree = fileBelowTests("../data/tree.vox");
    for (const Source& source : {fileBelowTests("../data/lamp.vox"), tree,
                                 fileBelowTests("golden/data/bench.vdb"), svxBall(), thesisFile()})
        expect(source, "", {});
    expect(tree, "/lod", {.build = {.lod = true}});
    expect(tree, "/hollow", {.hollow = true});
    expect(tree, "/resident", {.profile = Profile::Resident});
    expect(fileBelowTests("../data/courtyard.vox"), "/merge", {.import = {.merge = true}});
    expect(tree, "/zstd-9", {.zstdLevel = 9});
}

}  // namespace
}  // namespace pfvox::test

// What the tests of probe-bake share: a folder of their own, the program, and small probe files.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <pfvox/files.hpp>
#include <pfvox/probe_file.hpp>

#include "support/json_schema.hpp"
#include "support/probe_fields.hpp"
#include "support/process.hpp"
#include "support/scene_assets.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {

class ProbeBake : public ::testing::Test {
  protected:
    ProcessResult run(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), PFVOX_PROBE_BAKE);
        return runProcess(std::move(arguments), {.environment = {}, .input = {}, .folder = folder.path()});
    }

    void write(const std::string& name, const ProbeField& field) const {
        const auto bytes = encodePfProbe(field, {});
        ASSERT_TRUE(bytes) << describe(bytes.error());
        ASSERT_TRUE(io::writeFileAtomically(folder / name, *bytes));
    }

    /// The probes of a range of the field, as a file of their own.
    void writeShard(const std::string& name, const ProbeField& field, ProbeRange range) const {
        ProbeField shard{.info = field.info, .probes = {}, .proximity = {}};
        shard.info.range = range;
        shard.probes.assign(field.probes.begin() + range.first, field.probes.begin() + range.end);
        write(name, shard);
    }

    static void expectSchema(const std::string& name, const nlohmann::json& value) {
        const auto schema = nlohmann::json::parse(
            readText(std::filesystem::path(PFVOX_DOCS_DIR) / "schema" / (name + ".schema.json")));
        EXPECT_THAT(SchemaChecker::check(schema, value), ::testing::IsEmpty());
    }

    TempFolder folder;
};

/// With a box to bake.
class ProbeBakeScene : public ProbeBake {
  protected:
    void SetUp() override { writePfVox(folder / "box.pf_vox", boxAsset({{0, 0, 0}, {12, 6, 12}}, 0.1)); }

    void writeScene(const std::string& name, const std::string& model, const std::string& grid) const {
        writeText(folder / name, grid + "\n[[models]]\nname = \"box\"\npath = \"" + model + "\"\n");
    }
    static std::vector<std::string> tiny(std::vector<std::string> arguments) {
        for (const char* word : {"--resolution", "16,8,4,6", "--samples", "32"}) arguments.emplace_back(word);
        return arguments;
    }

    static constexpr const char* kGrid =
        "probeGridPos = [-0.5, 0.3, -0.5]\nprobeGridStep = 1.1\nprobeGridCount = [3, 2, "
        "3]\nproximityGridSize = [8, 8, 8]\n";
};

}  // namespace pfvox::test

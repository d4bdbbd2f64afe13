// The error of small bakes against path tracing, held against the figures of the last version
// (tests/golden/data/verify_trend.json): no worse by 2 %. Where the figures get better, or worse on purpose,
// run with PFVOX_UPDATE_GOLDEN=1 and say why in CHANGELOG.md.
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <pfvox/convert.hpp>
#include <pfvox/probe_file.hpp>
#include <pfvox/verify.hpp>

#include "bake/bake_fixture.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

using nlohmann::json;

constexpr double kWorse = 1.02;
/// Of a fraction: what another driver's rounding does.
constexpr double kSlack = 0.002;

/// A few probes of a scene of data/, around one of its cameras.
struct TrendScene {
    std::string name;
    std::string file;  ///< below data/
    std::vector<std::string> models;
    std::string camera;
    ProbeGrid grid;
};

std::vector<TrendScene> trendScenes() {
    return {{.name = "interior",
             .file = "verify/interior.scene.toml",
             .models = {"verify/interior"},
             .camera = "living",
             .grid = {.start = {1.6f, 0.9f, 6.0f}, .step = {1.6f, 1.6f, 2.0f}, .counts = {3, 2, 2}}},
            {.name = "foundry",
             .file = "verify/foundry.scene.toml",
             .models = {"verify/foundry"},
             .camera = "tubs",
             .grid = {.start = {1.5f, 0.8f, 8.0f}, .step = {2.0f, 1.8f, 2.2f}, .counts = {4, 2, 2}}},
            {.name = "courts",
             .file = "scene.toml",
             .models = {"courtyard", "tree", "lamp", "statue"},
             .camera = "room",
             .grid = {.start = {-1.5f, 1.2f, -6.0f}, .step = {1.5f, 1.5f, 1.5f}, .counts = {3, 2, 4}}}};
}

class VerifyTrend : public BakeTest {
  protected:
    static std::filesystem::path goldenFile() {
        return std::filesystem::path(PFVOX_TESTS_DIR) / "golden/data/verify_trend.json";
    }

    Result<LoadedScene> load(const TrendScene& trend) {
        const std::filesystem::path data = PFVOX_DATA_DIR;
        for (const std::string& model : trend.models)
            PFVOX_CHECK(convertFile(data / (model + ".vox"), folder / (model + ".pf_vox"), {}, Limits{},
                                    diagnostics));
        PFVOX_TRY(const std::string, text,
                  withModelPaths(
                      readText(data / trend.file), trend.file, Limits{}, diagnostics,
                      [](const ModelPathUse& use) -> std::optional<std::string> {
                          return std::filesystem::path(use.model.path).replace_extension(".pf_vox").string();
                      }));
        writeText(folder / trend.file, text);
        PFVOX_TRY(LoadedScene, scene, loadScene(folder / trend.file, Limits{}, diagnostics));
        scene.probes = trend.grid;
        scene.scene.probes.proximityCells = glm::uvec3(24, 12, 24);
        return scene;
    }

    Result<json> measure(const TrendScene& trend) {
        PFVOX_TRY(const LoadedScene, scene, load(trend));
        BakeSettings settings = plain(64, 32);
        settings.resolution = {.depth = 64, .light = 32, .irradiance = 8, .moments = 14};
        BakeObserver observer;
        const std::filesystem::path file = folder / (trend.name + ".pf_probe");
        PFVOX_CHECK(bakeProbes(device(), scene, settings, file, observer, diagnostics));
        PFVOX_TRY(const ProbeFileReader, reader, ProbeFileReader::open(file, Limits{}, diagnostics));
        PFVOX_TRY(const gpu::Scene, gpuScene, gpu::Scene::build(device(), gpu::partsOf(scene), diagnostics));
        const auto camera = std::ranges::find(scene.scene.cameras, trend.camera, &Camera::name);
        if (camera == scene.scene.cameras.end())
            return fail(ErrorCode::BadReference, "no camera " + trend.camera);
        PFVOX_TRY(const ProbeVerifier, verifier, ProbeVerifier::create(device()));
        json figures;
        std::optional<ReferencePicture> reference;
        for (const bool compact : {false, true}) {
            PFVOX_TRY(
                const gpu::GpuProbes, probes,
                gpu::GpuProbes::upload(device(), reader, {.voxelMetres = 0.1f, .compactOnly = compact}));
            const VerifyInput input{scene, gpuScene, *camera, &probes};
            if (!reference) {
                PFVOX_TRY(ReferencePicture, traced,
                          verifier.trace(device(), input, {.width = 48, .height = 32, .samples = 128}));
                reference = std::move(traced);
            }
            PFVOX_TRY(const VerifiedPicture, picture, verifier.lookUp(device(), input, *reference));
            const VerifyScore score = scoreOf(picture);
            EXPECT_EQ(score.withoutValue, 0u) << trend.name;
            figures[compact ? "compact" : "all"] = {{"relativeRmse", score.all.relativeRmse},
                                                    {"meanFlip", score.meanFlip},
                                                    {"trimmed", score.all.relativeTrimmedRmse}};
        }
        return figures;
    }

    TempFolder folder;
};

TEST_F(VerifyTrend, NoWorseThanLast) {
    const bool update = std::getenv("PFVOX_UPDATE_GOLDEN") != nullptr;
    const json last = update ? json::object() : json::parse(readText(goldenFile()));
    json now;
    for (const TrendScene& trend : trendScenes()) {
        const auto figures = measure(trend);
        ASSERT_TRUE(figures) << trend.name << ": " << describe(figures.error());
        now[trend.name] = *figures;
        if (update) continue;
        for (const char* part : {"all", "compact"}) {
            for (const char* figure : {"relativeRmse", "meanFlip"}) {
                const double before = last.at(trend.name).at(part).at(figure);
                EXPECT_LE(figures->at(part).at(figure).get<double>(), kWorse * before + kSlack)
                    << trend.name << ", " << part << ", " << figure << ": worse than the last version";
            }
        }
    }
    std::cout << now.dump(2) << '\n';
    if (update) writeText(goldenFile(), now.dump(2) + "\n");
}

}  // namespace
}  // namespace pfvox::test

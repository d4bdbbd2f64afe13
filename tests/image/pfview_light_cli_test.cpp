// pfview as a program, with probes: which are taken, what happens when they do not fit, and what its
// statistics say.
#include <nlohmann/json.hpp>

#include "png.hpp"
#include "support/json_schema.hpp"
#include "support/lit_hall.hpp"
#include "support/pfview_run.hpp"

namespace pfvox::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class PfviewLight : public PfviewCli {
  protected:
    void SetUp() override {
        PfviewCli::SetUp();
        writeLitHall(folder_);
    }
    void addProbes(const std::string& name = "hall.pf_probe") const {
        fs::copy_file(fs::path(PFVOX_TESTS_DIR) / "image/golden/hall.pf_probe", folder_ / name);
    }
    /// Statistics, checked against the schema.
    json statistics(const std::string& arguments) const {
        const Outcome r = run("hall.toml --size 64x40 --validate --stats-json - " + arguments);
        EXPECT_EQ(r.exitCode, 0) << r.err;
        const json schema =
            json::parse(contentOf(fs::path(PFVOX_TESTS_DIR) / "../docs/schema/view.schema.json"));
        json value = json::parse(r.out, nullptr, false);
        for (const std::string& complaint : SchemaChecker::check(schema, value)) ADD_FAILURE() << complaint;
        return value;
    }
};

TEST_F(PfviewLight, TakesTheProbesBesideTheScene) {
    const json without = statistics("--screenshot a.png");
    EXPECT_TRUE(without["probes"].is_null());
    EXPECT_TRUE(without["light"].is_null());
    addProbes();
    const json with = statistics("--screenshot b.png");
    EXPECT_EQ(with["probes"]["file"], "hall.pf_probe");
    EXPECT_EQ(with["probes"]["count"], 24);
    EXPECT_EQ(with["probes"]["ofThisScene"], true);
    EXPECT_EQ(with["light"]["withoutValue"], 0);
    EXPECT_GT(with["frames"]["passMs"]["light"]["mean"], 0.0);
    const json refused = statistics("--screenshot c.png --no-probes");
    EXPECT_TRUE(refused["probes"].is_null());
    EXPECT_EQ(contentOf(folder_ / "a.png"), contentOf(folder_ / "c.png"));
    EXPECT_NE(contentOf(folder_ / "a.png"), contentOf(folder_ / "b.png"));
}

TEST_F(PfviewLight, SaysThatLightWithoutProbesIsAnApproximation) {
    EXPECT_EQ(statistics("--screenshot a.png")["indirect"], "approximation");
    EXPECT_THAT(
        run("hall.toml --size 8x8 --screenshot a.png").err,
        HasSubstr("approximation from what is near by; bake it: probe-bake 'hall.toml' -o 'hall.pf_probe'"));
    EXPECT_TRUE(statistics("--screenshot a.png --view normals")["indirect"].is_null());
    EXPECT_THAT(run("hall.toml --size 8x8 --screenshot a.png --view normals").err, IsEmpty());
    addProbes();
    const json lit = statistics("--screenshot a.png");
    EXPECT_EQ(lit["indirect"], "probes");
    EXPECT_EQ(lit["picture"]["ambientRays"], 0);
}

TEST_F(PfviewLight, APictureHasSoManyRaysForAPixelHoweverItIsMade) {
    const auto raysOf = [&](const std::string& how) {
        return statistics("--screenshot a.png " + how)["picture"]["ambientRays"].get<double>();
    };
    const double rays = raysOf("");
    EXPECT_NEAR(raysOf("--samples 1"), rays, 0.02 * rays);
    EXPECT_NEAR(raysOf("--samples 2 --frames 8"), rays, 0.02 * rays);
}

TEST_F(PfviewLight, AModelAloneStandsOnAGroundAndASceneDoesNot) {
    EXPECT_EQ(statistics("--screenshot scene.png")["picture"]["ground"], false);
    EXPECT_EQ(statistics("--screenshot stands.png --ground")["picture"]["ground"], true);
    EXPECT_NE(contentOf(folder_ / "scene.png"), contentOf(folder_ / "stands.png"));
    const std::string model = "hall.pf_vox --size 64x40 --camera 9,4,9,2.7,1,1 --screenshot ";
    for (const char* const how : {"model.png", "off.png --no-ground", "on.png --ground"})
        EXPECT_EQ(run(model + how).exitCode, 0);
    EXPECT_EQ(contentOf(folder_ / "model.png"), contentOf(folder_ / "on.png"));
    EXPECT_NE(contentOf(folder_ / "model.png"), contentOf(folder_ / "off.png"));
}

TEST_F(PfviewLight, TakesNamedProbesAndTheSceneOfAProbeFile) {
    addProbes("other.pf_probe");
    EXPECT_EQ(statistics("--screenshot a.png --probes other.pf_probe")["probes"]["file"], "other.pf_probe");
    fs::rename(folder_ / "other.pf_probe", folder_ / "hall.pf_probe");
    const Outcome r = run("hall.pf_probe --size 32x20 --screenshot b.png --view tiers");
    EXPECT_EQ(r.exitCode, 0) << r.err;
}

TEST_F(PfviewLight, SaysWhichProbesItTakes) {
    addProbes();
    EXPECT_THAT(run("hall.toml --size 8x8 --screenshot a.png").err, HasSubstr("hall.pf_probe"));
    EXPECT_THAT(run("hall.toml --size 8x8 --screenshot a.png --quiet").err, IsEmpty());
}

TEST_F(PfviewLight, ProbesOfAnotherStateAreUsedWithAWarning) {
    addProbes();
    write("hall.toml", std::string(kLitHallScene) + "rotateVec = [0, 0.1, 0]\n");
    const Outcome r = run("hall.toml --size 32x20 --screenshot a.png --stats-json s.json");
    EXPECT_EQ(r.exitCode, 0);
    EXPECT_THAT(r.err, HasSubstr("probe-bake 'hall.toml' -o 'hall.pf_probe'"));
    EXPECT_THAT(contentOf(folder_ / "s.json"), HasSubstr("\"ofThisScene\": false"));
}

TEST_F(PfviewLight, ProbesThatCannotBeReadAreErrors) {
    const std::string picture = "hall.toml --size 8x8 --screenshot a.png --probes ";
    const Outcome missing = run(picture + "none.pf_probe");
    EXPECT_EQ(missing.exitCode, 3);
    EXPECT_THAT(missing.err, HasSubstr("probe-bake 'hall.toml' -o"));
    const Outcome foreign = run(picture + "hall.pf_vox");
    EXPECT_EQ(foreign.exitCode, 4);
    EXPECT_THAT(foreign.err, HasSubstr("probe-bake 'hall.toml' -o"));
    addProbes();
    const std::string good = contentOf(folder_ / "hall.pf_probe");
    write("cut.pf_probe", good.substr(0, good.size() / 2));
    EXPECT_EQ(run(picture + "cut.pf_probe").exitCode, 4);
    std::string older = good;
    older[8] = 9;  // the major version
    write("older.pf_probe", older);
    const Outcome version = run(picture + "older.pf_probe");
    EXPECT_EQ(version.exitCode, 5) << version.err;
    EXPECT_THAT(version.err, HasSubstr("bake again: probe-bake 'hall.toml' -o 'older.pf_probe'"))
        << "where it was asked for";
    EXPECT_FALSE(fs::exists(folder_ / "a.png"));
}

TEST_F(PfviewLight, ViewsOfProbesNeedProbes) {
    const Outcome r = run("hall.toml --size 8x8 --screenshot a.png --view tiers");
    EXPECT_EQ(r.exitCode, 3);
    EXPECT_THAT(
        r.err,
        HasSubstr("the view 'tiers' shows probes, and there are none; bake them: probe-bake 'hall.toml'"));
    addProbes();
    const Outcome beyond = run("hall.toml --size 8x8 --screenshot a.png --view atlas-light --probe 24");
    EXPECT_EQ(beyond.exitCode, 4);
    EXPECT_THAT(beyond.err, HasSubstr("24 probes"));
    EXPECT_FALSE(fs::exists(folder_ / "a.png"));
    const Outcome page = run("hall.toml --size 160x120 --screenshot a.png --view atlas-light --probe-page 2");
    EXPECT_EQ(page.exitCode, 4);
    EXPECT_THAT(page.err, HasSubstr("24 probes are on 2 pages"));
    EXPECT_FALSE(fs::exists(folder_ / "a.png"));
    EXPECT_GT(statistics("--screenshot a.png --view field-difference")["field"]["hits"], 100);
}

TEST_F(PfviewLight, MeasuresFramesWithoutAPicture) {
    addProbes();
    const json measured = statistics("--frames 5");
    EXPECT_EQ(measured["frames"]["count"], 5);
    EXPECT_EQ(measured["picture"]["samplesPerPixel"], 1);
    EXPECT_EQ(measured["picture"]["cameraRays"], 5 * 64 * 40);
    EXPECT_GT(measured["frames"]["framesPerSecond"], 0.0);
    EXPECT_LE(measured["frames"]["gpuMs"]["median"], measured["frames"]["gpuMs"]["p95"]);
    EXPECT_GT(measured["picture"]["sunRays"], 0);
    for (const auto& entry : fs::directory_iterator(folder_)) EXPECT_NE(entry.path().extension(), ".png");
}

TEST_F(PfviewLight, ACameraPathIsLitToo) {
    addProbes();
    write(
        "path.json",
        R"({"cameras": [{"position": [2.4, 1.5, 6], "target": [2.7, 1, 0]}, {"position": [1, 1.2, 5], "target": [2.7, 1, 0]}]})");
    const json flown =
        statistics("--screenshot f.png --frames 3 --camera-path path.json --exposure 1 --tonemap aces");
    EXPECT_EQ(flown["frames"]["count"], 3);
    EXPECT_EQ(flown["picture"]["toneMap"], "aces");
    EXPECT_EQ(flown["picture"]["exposureStops"], 1.0);
    EXPECT_GT(flown["light"]["lookups"], 100);
    EXPECT_TRUE(viewer::readPng(folder_ / "f-0003.png"));
}

}  // namespace
}  // namespace pfvox::test

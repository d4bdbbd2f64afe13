// The same bake on two devices: a file made on an NVIDIA H200 (tests/golden/data/two_devices) against one
// made here. Equal numbers go into both, so what differs is rounding: rays that pass an edge on its other
// side, and the paths behind them.
#include <cmath>
#include <iostream>
#include <pfvox/convert.hpp>
#include <pfvox/probe_file.hpp>
#include <pfvox/probe_maths.hpp>

#include "bake_fixture.hpp"
#include "shared/probe_maths.glsl.h"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

constexpr double kMinWithinOneCode = 0.999;
constexpr double kMinPsnr = 45.0;
constexpr double kMaxSigmas = 3.0;

/// Of texels that see the same surface in both files.
struct Agreement {
    std::size_t texels = 0;
    std::size_t withinOneCode = 0;
    std::size_t sameSurface = 0;
    std::size_t equalLight = 0;
    double squaredError = 0.0;
    double brightest = 0.0;
    double sumHere = 0.0;
    double sumThere = 0.0;

    void add(const ProbeData& here, const ProbeData& there) {
        for (std::size_t i = 0; i < here.depthNormal.size(); ++i) {
            const std::uint32_t a = here.depthNormal[i];
            const std::uint32_t b = there.depthNormal[i];
            const auto apart =
                std::abs(static_cast<int>(shared::depthCodeOf(a)) - static_cast<int>(shared::depthCodeOf(b)));
            ++texels;
            if (apart > 1) continue;
            ++withinOneCode;
            if (shared::isMiss(a) || a >> 16 != b >> 16) continue;
            addLight(here.light[i], there.light[i]);
        }
    }
    double psnr() const {
        const double mean = squaredError / (3.0 * static_cast<double>(sameSurface));
        return 10.0 * std::log10(brightest * brightest / mean);
    }

  private:
    void addLight(std::uint32_t hereWord, std::uint32_t thereWord) {
        ++sameSurface;
        equalLight += hereWord == thereWord ? 1u : 0u;
        const glm::dvec3 here = shared::unpackLight(hereWord);
        const glm::dvec3 there = shared::unpackLight(thereWord);
        squaredError += glm::dot(here - there, here - there);
        brightest = std::max({brightest, there.x, there.y, there.z});
        sumHere += here.x + here.y + here.z;
        sumThere += there.x + there.y + there.z;
    }
};

class TwoDevices : public BakeTest {
  protected:
    Result<LoadedScene> load() {
        for (const char* const name : {"interior", "foundry"}) {
            const std::filesystem::path source =
                std::filesystem::path(PFVOX_DATA_DIR) / "verify" / (std::string(name) + ".vox");
            PFVOX_CHECK(
                convertFile(source, folder / (std::string(name) + ".pf_vox"), {}, Limits{}, diagnostics));
        }
        std::filesystem::copy_file(golden() / "scene.toml", folder / "scene.toml");
        return loadScene(folder / "scene.toml", Limits{}, diagnostics);
    }
    static std::filesystem::path golden() {
        return std::filesystem::path(PFVOX_TESTS_DIR) / "golden/data/two_devices";
    }

    TempFolder folder;
};

TEST_F(TwoDevices, AgreeWithinRounding) {
    PFVOX_ASSERT_VALUE(const ProbeFileReader, there,
                       ProbeFileReader::open(golden() / "h200.pf_probe", Limits{}, diagnostics));
    PFVOX_ASSERT_VALUE(const LoadedScene, scene, load());
    ASSERT_EQ(sceneContentHash(scene), there.info().sceneHash)
        << "bake it again: scene.toml beside it says how";
    BakeSettings settings = plain(32, 256);
    settings.resolution = there.info().resolution;
    settings.filter = false;
    BakeObserver observer;
    PFVOX_ASSERT_VALUE(
        const BakeReport, report,
        bakeProbes(device(), scene, settings, folder / "here.pf_probe", observer, diagnostics));
    PFVOX_ASSERT_VALUE(const ProbeFileReader, here,
                       ProbeFileReader::open(folder / "here.pf_probe", Limits{}, diagnostics));
    ASSERT_EQ(here.info().settings, there.info().settings);

    ASSERT_EQ(report.stepLimitRays, 0u);

    Agreement all;
    double noise = 0.0;
    for (std::uint32_t probe = 0; probe < here.info().range.end; ++probe) {
        PFVOX_ASSERT_VALUE(const ProbeData, a, here.readProbe(probe));
        PFVOX_ASSERT_VALUE(const ProbeData, b, there.readProbe(probe));
        ASSERT_EQ(a.record.offset, b.record.offset);
        all.add(a, b);
        noise += static_cast<double>(b.record.error.value()) / static_cast<double>(here.info().range.end);
    }
    // The record's error is that of tiles of 64 texels; that of the mean of all is so much smaller.
    const double tiles = static_cast<double>(all.sameSurface) / 64.0;
    const double sigmas = std::abs(all.sumHere / all.sumThere - 1.0) / (noise / std::sqrt(tiles));
    std::cout << "  " << there.info().deviceName << " and " << here.info().deviceName << ": "
              << all.withinOneCode << " of " << all.texels << " codes within one; of " << all.sameSurface
              << " texels with the same surface " << all.equalLight << " of equal light, PSNR " << all.psnr()
              << " dB, means " << sigmas << " sigma apart\n";
    EXPECT_GE(static_cast<double>(all.withinOneCode), kMinWithinOneCode * static_cast<double>(all.texels));
    EXPECT_GE(static_cast<double>(all.sameSurface), 0.98 * static_cast<double>(all.texels));
    EXPECT_GE(all.psnr(), kMinPsnr);
    EXPECT_LE(sigmas, kMaxSigmas);
}

}  // namespace
}  // namespace pfvox::test

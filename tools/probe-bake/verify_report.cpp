#include "probe-bake/verify_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "common/paths.hpp"
#include "common/text.hpp"
#include "probe-bake/picture_file.hpp"

namespace pfvox::tools {

namespace {

std::string percent(double fraction) {
    return fmt::format("{:.2f} %", 100.0 * fraction);
}

Json partJson(const VerifyPart& part) {
    return {{"pixels", part.pixels},
            {"meanReference", part.meanReference},
            {"rmse", part.rmse},
            {"relativeRmse", part.relativeRmse},
            {"relativeTrimmedRmse", part.relativeTrimmedRmse},
            {"relativeNoise", part.relativeNoise},
            {"relativeError", part.relativeError},
            {"relativeBias", part.relativeBias}};
}

Json referenceJson(const CameraVerdict& verdict) {
    const std::string message = uncertaintyOf(verdict);
    Json json{{"samples", verdict.samples},
              {"maxSamples", verdict.target.maxSamples},
              {"wantedNoiseOfError", verdict.target.noiseOfError},
              {"isCertain", message.empty()}};
    if (!message.empty()) json["message"] = message;
    return json;
}

}  // namespace

std::vector<NamedCamera> namedCameras(std::span<const Camera> cameras) {
    std::vector<std::string> names;
    for (const Camera& camera : cameras) names.push_back(camera.name.empty() ? "camera" : camera.name);
    const std::vector<std::string> fileNames = safeFileNames(names);
    std::vector<NamedCamera> named;
    for (std::size_t i = 0; i < cameras.size(); ++i) named.push_back({cameras[i], fileNames[i]});
    return named;
}

Table verdictTable() {
    return Table({{"camera"},
                  {"pixels", Align::Right},
                  {"no value", Align::Right},
                  {"texels", Align::Right},
                  {"compact", Align::Right},
                  {"nearest", Align::Right},
                  {"RMSE/mean", Align::Right},
                  {"trimmed", Align::Right},
                  {"paths", Align::Right},
                  {"noise", Align::Right},
                  {"without it", Align::Right},
                  {"of texels", Align::Right},
                  {"PSNR, dB", Align::Right},
                  {"FLIP", Align::Right},
                  {"noise's", Align::Right}});
}

void addRow(Table& table, const CameraVerdict& verdict) {
    const VerifyScore& score = verdict.score;
    const auto tier = [&](gpu::ProbeTier t) {
        return percent(score.tierFractions[static_cast<std::size_t>(t)]);
    };
    table.addRow(
        {verdict.named.camera.name, formatCount(score.surfacePixels), formatCount(score.withoutValue),
         tier(gpu::ProbeTier::Texels), tier(gpu::ProbeTier::Compact), tier(gpu::ProbeTier::Nearest),
         percent(score.all.relativeRmse), percent(score.all.relativeTrimmedRmse),
         formatCount(verdict.samples), percent(score.all.relativeNoise), percent(score.all.relativeError),
         percent(score.texels().relativeError), fmt::format("{:.2f}", score.psnrDecibel),
         fmt::format("{:.4f}", score.meanFlip), fmt::format("{:.4f}", score.noiseFlip)});
}

std::string uncertaintyOf(const CameraVerdict& verdict) {
    const VerifyPart& all = verdict.score.all;
    if (verdict.target.isReached(all)) return {};
    return fmt::format(
        "reference noise {:.1f} % is more than {:.0f} % of the error {:.1f} %: figures are uncertain; raise "
        "--max-samples",
        100.0 * all.relativeNoise, 100.0 * verdict.target.noiseOfError, 100.0 * all.relativeError);
}

Json verdictJson(const CameraVerdict& verdict) {
    const VerifyScore& score = verdict.score;
    Json fractions;
    Json tiers = Json::object();
    for (std::size_t i = 0; i < gpu::kProbeTierCount; ++i) {
        const std::string name(toString(static_cast<gpu::ProbeTier>(i)));
        fractions[name] = score.tierFractions[i];
        if (score.byTier[i].pixels != 0) tiers[name] = partJson(score.byTier[i]);
    }
    Json materials = Json::object();
    for (std::size_t i = 0; i < kMaterialTypeCount; ++i) {
        if (score.byMaterial[i].pixels != 0)
            materials[toString(static_cast<MaterialType>(i))] = partJson(score.byMaterial[i]);
    }
    return {{"camera", verdict.named.camera.name},
            {"width", verdict.picture.width},
            {"height", verdict.picture.height},
            {"surfacePixels", score.surfacePixels},
            {"withoutValue", score.withoutValue},
            {"tierFractions", fractions},
            {"reference", referenceJson(verdict)},
            {"all", partJson(score.all)},
            {"byTier", tiers},
            {"byMaterial", materials},
            {"psnrDecibel", score.psnrDecibel},
            {"meanFlip", score.meanFlip},
            {"noiseFlip", score.noiseFlip},
            {"gpuMs", verdict.picture.gpuMs}};
}

Result<void> writePictures(const std::filesystem::path& folder, const CameraVerdict& verdict) {
    constexpr std::array<glm::vec3, gpu::kProbeTierCount> kTierColors{{{1.0f, 0.0f, 1.0f},
                                                                       {0.20f, 0.62f, 0.24f},
                                                                       {0.85f, 0.75f, 0.15f},
                                                                       {0.16f, 0.36f, 0.78f},
                                                                       {0.80f, 0.18f, 0.12f},
                                                                       {0.10f, 0.62f, 0.62f}}};
    const VerifiedPicture& picture = verdict.picture;
    std::array<std::vector<glm::vec3>, 4> images;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const VerifiedPixel& pixel = picture.pixels[i];
        const auto exposure = static_cast<float>(verdict.score.exposure);
        images[0].push_back(exposure * pixel.lookup);
        images[1].push_back(exposure * pixel.reference);
        images[2].push_back(pixel.surface ? heatColor(verdict.score.flip[i]) : glm::vec3{0.0f});
        images[3].push_back(pixel.surface ? kTierColors[static_cast<std::size_t>(pixel.tier)]
                                          : glm::vec3{0.0f});
    }
    constexpr std::array<const char*, 4> kNames{"probes", "reference", "flip", "tiers"};
    for (std::size_t i = 0; i < images.size(); ++i) {
        const std::filesystem::path file =
            folder / fmt::format("{}-{}.png", verdict.named.fileName, kNames[i]);
        PFVOX_CHECK(writePicture(file, {picture.width, picture.height}, images[i]));
    }
    return {};
}

}  // namespace pfvox::tools

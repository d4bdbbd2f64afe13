#include "probe-bake/verify_report.hpp"

namespace pfvox::tools {

namespace {

Json partJson(const VerifyPart& part) {
    return {{"pixels", part.pixels},
            {"meanReference", part.meanReference},
            {"rmse", part.rmse},
            {"relativeRmse", part.relativeRmse},
            {"relativeNoise", part.relativeNoise},
            {"relativeError", part.relativeError},
            {"relativeBias", part.relativeBias}};
}

}  // namespace

Json scoreJson(const Camera& camera, const VerifiedPicture& picture, const VerifyScore& score) {
    Json shares;
    Json tiers = Json::object();
    for (std::size_t i = 0; i < gpu::kProbeTierCount; ++i) {
        const std::string name(toString(static_cast<gpu::ProbeTier>(i)));
        shares[name] = score.tierShares[i];
        if (score.byTier[i].pixels != 0) tiers[name] = partJson(score.byTier[i]);
    }
    Json materials = Json::object();
    for (std::size_t i = 0; i < kMaterialTypeCount; ++i) {
        if (score.byMaterial[i].pixels != 0)
            materials[toString(static_cast<MaterialType>(i))] = partJson(score.byMaterial[i]);
    }
    return {{"camera", camera.name},
            {"width", picture.width},
            {"height", picture.height},
            {"surfacePixels", score.surfacePixels},
            {"withoutValue", score.withoutValue},
            {"tierShares", shares},
            {"all", partJson(score.all)},
            {"byTier", tiers},
            {"byMaterial", materials},
            {"psnrDecibel", score.psnrDecibel},
            {"meanFlip", score.meanFlip},
            {"noiseFlip", score.noiseFlip},
            {"gpuMs", picture.gpuMs}};
}

}  // namespace pfvox::tools

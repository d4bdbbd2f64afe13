#include <algorithm>
#include <cmath>
#include <numeric>
#include <pfvox/flip.hpp>
#include <pfvox/verify.hpp>

namespace pfvox {

namespace {

// Of the paths of a reference, from one round to the next.
constexpr double kMinGrowth = 2.0;
constexpr double kMaxGrowth = 8.0;

double squared(const glm::vec3& v) {
    return static_cast<double>(glm::dot(v, v)) / 3.0;
}
double mean(const glm::vec3& v) {
    return static_cast<double>(v.x + v.y + v.z) / 3.0;
}
bool isFinite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Sums over pixels with a value.
struct Sums {
    std::uint64_t pixels = 0;
    double reference = 0.0;
    double error = 0.0;
    double noise = 0.0;
    double apart = 0.0;
    std::vector<double> errors;  ///< squared, one a pixel

    void add(const VerifiedPixel& pixel) {
        ++pixels;
        reference += mean(pixel.reference);
        errors.push_back(squared(pixel.lookup - pixel.reference));
        error += errors.back();
        noise += squared(pixel.noise);
        apart += mean(pixel.lookup - pixel.reference);
    }
    VerifyPart part() const {
        VerifyPart part{.pixels = pixels};
        if (pixels == 0) return part;
        const auto count = static_cast<double>(pixels);
        part.meanReference = reference / count;
        part.rmse = std::sqrt(error / count);
        if (reference <= 0.0) return part;
        part.relativeRmse = part.rmse / part.meanReference;
        part.relativeNoise = std::sqrt(noise / count) / part.meanReference;
        part.relativeError = std::sqrt(std::max(error - noise, 0.0) / count) / part.meanReference;
        part.relativeBias = apart / reference;
        part.relativeTrimmedRmse = trimmedRmse() / part.meanReference;
        return part;
    }
    double trimmedRmse() const {
        std::vector<double> rest = errors;
        const auto dropped = static_cast<std::size_t>(kTrimmedFraction * static_cast<double>(rest.size()));
        const auto end = rest.end() - static_cast<std::ptrdiff_t>(dropped);
        if (end != rest.end()) std::ranges::nth_element(rest, end);
        return std::sqrt(std::accumulate(rest.begin(), end, 0.0) / static_cast<double>(end - rest.begin()));
    }
};

bool hasValue(const VerifiedPixel& pixel) {
    return pixel.tier != gpu::ProbeTier::None && isFinite(pixel.lookup) && isFinite(pixel.reference);
}

glm::vec3 exposed(const glm::vec3& light, double exposure) {
    const glm::vec3 value = isFinite(light) ? light : glm::vec3{0.0f};
    return glm::clamp(static_cast<float>(exposure) * value, 0.0f, 1.0f);
}

double meanOverSurface(const VerifiedPicture& picture, const std::vector<float>& values) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!picture.pixels[i].surface) continue;
        sum += static_cast<double>(values[i]);
        count += 1.0;
    }
    return count > 0.0 ? sum / count : 0.0;
}

/// What PSNR and FLIP look at: all pictures, exposed alike.
void compareExposed(const VerifiedPicture& picture, VerifyScore& score) {
    std::vector<glm::vec3> reference;
    std::vector<glm::vec3> test;
    std::vector<glm::vec3> noisy;
    double error = 0.0;
    for (const VerifiedPixel& pixel : picture.pixels) {
        reference.push_back(exposed(pixel.reference, score.exposure));
        test.push_back(exposed(pixel.lookup, score.exposure));
        noisy.push_back(exposed(pixel.reference + pixel.noise, score.exposure));
        if (pixel.surface) error += squared(reference.back() - test.back());
    }
    const auto surfaces = static_cast<double>(std::max<std::uint64_t>(score.surfacePixels, 1));
    score.psnrDecibel = error > 0.0 ? -10.0 * std::log10(error / surfaces) : 999.0;
    FlipInput input{.width = picture.width, .height = picture.height, .reference = reference, .test = test};
    score.flip = flipOf(input);
    score.meanFlip = meanOverSurface(picture, score.flip);
    input.test = noisy;
    score.noiseFlip = meanOverSurface(picture, flipOf(input));
}

}  // namespace

std::uint64_t VerifyScore::tierPixels(gpu::ProbeTier tier) const {
    return static_cast<std::uint64_t>(
        std::llround(tierFractions[static_cast<std::size_t>(tier)] * static_cast<double>(surfacePixels)));
}

VerifyScore scoreOf(const VerifiedPicture& picture) {
    VerifyScore score;
    Sums all;
    std::array<Sums, gpu::kProbeTierCount> tiers;
    std::array<Sums, kMaterialTypeCount> materials;
    for (const VerifiedPixel& pixel : picture.pixels) {
        if (!pixel.surface) continue;
        ++score.surfacePixels;
        score.tierFractions[static_cast<std::size_t>(pixel.tier)] += 1.0;
        if (!hasValue(pixel)) {
            ++score.withoutValue;
            continue;
        }
        all.add(pixel);
        tiers[static_cast<std::size_t>(pixel.tier)].add(pixel);
        materials[static_cast<std::size_t>(pixel.material)].add(pixel);
    }
    if (score.surfacePixels == 0) return score;
    for (double& fraction : score.tierFractions) fraction /= static_cast<double>(score.surfacePixels);
    score.all = all.part();
    std::ranges::transform(tiers, score.byTier.begin(), &Sums::part);
    std::ranges::transform(materials, score.byMaterial.begin(), &Sums::part);
    score.exposure = score.all.meanReference > 0.0 ? 0.5 / score.all.meanReference : 1.0;
    compareExposed(picture, score);
    return score;
}

VerifyPart partOfAll(const VerifiedPicture& picture) {
    Sums all;
    for (const VerifiedPixel& pixel : picture.pixels) {
        if (pixel.surface && hasValue(pixel)) all.add(pixel);
    }
    return all.part();
}

bool ReferenceTarget::isReached(const VerifyPart& part) const {
    return part.relativeNoise <= noiseOfError * part.relativeError;
}

std::uint32_t ReferenceTarget::nextSamples(const VerifyPart& part, std::uint32_t samples) const {
    if (isReached(part) || samples >= maxSamples) return samples;
    // Noise falls with the root of the paths; a tenth more, since both figures are estimates.
    const double wanted = noiseOfError * part.relativeError;
    const double times = wanted > 0.0 ? 1.1 * std::pow(part.relativeNoise / wanted, 2.0) : kMaxGrowth;
    const double next = std::clamp(times, kMinGrowth, kMaxGrowth) * samples;
    const double even = 2.0 * std::ceil(next / 2.0);  // halves of equal size
    return static_cast<std::uint32_t>(std::min(even, static_cast<double>(maxSamples)));
}

}  // namespace pfvox

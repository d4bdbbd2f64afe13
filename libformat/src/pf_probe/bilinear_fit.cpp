#include "pf_probe/bilinear_fit.hpp"

#include <cmath>

namespace pfvox::probe {

namespace {

/// The matrix couples neighbors only and its diagonal leads: some twenty steps reach the last digit that is
/// stored.
constexpr int kMaxSteps = 64;
constexpr double kRelativeResidual = 1e-9;
constexpr int kMaxRefits = 32;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

}  // namespace

BilinearFit::BilinearFit(std::uint32_t interior, std::uint32_t sampleResolution)
    : texelCount_(std::size_t{interior} * interior) {
    for (std::uint32_t y = 0; y < sampleResolution; ++y)
        for (std::uint32_t x = 0; x < sampleResolution; ++x) {
            footprints_.push_back(footprintOf(directionOf(x + 0.5, y + 0.5, sampleResolution), interior));
            weights_.push_back(solidAngleOf(x, y, sampleResolution));
        }
}

BilinearFit::Vector BilinearFit::applyNormalMatrix(const Vector& texels,
                                                   const std::vector<bool>& isFree) const {
    Vector result(texelCount_, 0.0);
    for (std::size_t s = 0; s < footprints_.size(); ++s) {
        const Footprint& f = footprints_[s];
        double looked = 0;
        for (std::size_t k = 0; k < 4; ++k) looked += f.weight[k] * texels[f.texel[k]];
        looked *= weights_[s];
        for (std::size_t k = 0; k < 4; ++k) result[f.texel[k]] += f.weight[k] * looked;
    }
    for (std::size_t i = 0; i < texelCount_; ++i)
        if (!isFree[i]) result[i] = 0;
    return result;
}

void BilinearFit::solve(const Vector& rightSide, const std::vector<bool>& isFree, Vector& texels) const {
    const Vector applied = applyNormalMatrix(texels, isFree);
    Vector residual(texelCount_, 0.0);
    for (std::size_t i = 0; i < texelCount_; ++i)
        if (isFree[i]) residual[i] = rightSide[i] - applied[i];
    Vector direction = residual;
    double squared = dot(residual, residual);
    const double enough = kRelativeResidual * kRelativeResidual * dot(rightSide, rightSide);
    for (int step = 0; step < kMaxSteps && squared > enough; ++step) {
        const Vector image = applyNormalMatrix(direction, isFree);
        const double length = squared / dot(direction, image);
        for (std::size_t i = 0; i < texelCount_; ++i) {
            texels[i] += length * direction[i];
            residual[i] -= length * image[i];
        }
        const double next = dot(residual, residual);
        for (std::size_t i = 0; i < texelCount_; ++i)
            direction[i] = residual[i] + next / squared * direction[i];
        squared = next;
    }
}

std::vector<double> BilinearFit::fitNonNegative(std::span<const double> values) const {
    Vector rightSide(texelCount_, 0.0);
    for (std::size_t s = 0; s < footprints_.size(); ++s)
        for (std::size_t k = 0; k < 4; ++k)
            rightSide[footprints_[s].texel[k]] += footprints_[s].weight[k] * weights_[s] * values[s];
    std::vector<bool> isFree(texelCount_, true);
    Vector texels(texelCount_, 0.0);
    for (int refit = 0; refit < kMaxRefits; ++refit) {
        solve(rightSide, isFree, texels);
        bool isDone = true;
        for (std::size_t i = 0; i < texelCount_; ++i) {
            if (texels[i] >= 0) continue;
            texels[i] = 0;
            isFree[i] = false;
            isDone = false;
        }
        if (isDone) break;
    }
    return texels;
}

}  // namespace pfvox::probe

// BilinearFit: the texels for which a bilinear lookup comes nearest to given values over the sphere.
#pragma once

#include <span>
#include <vector>

#include "pf_probe/layer_maths.hpp"

namespace pfvox::probe {

class BilinearFit {
  public:
    /// `sampleResolution`: the values are given at the texels of an octahedral map of this edge.
    BilinearFit(std::uint32_t interior, std::uint32_t sampleResolution);

    /// Weighted least squares over all texels >= 0: texels that come out negative are set to 0 and the rest
    /// is fitted again, until none is. `values`: sampleResolution^2.
    std::vector<double> fitNonNegative(std::span<const double> values) const;

  private:
    using Vector = std::vector<double>;
    /// Conjugate gradients on the normal equations of the texels that are free; the others are 0.
    void solve(const Vector& rightSide, const std::vector<bool>& isFree, Vector& texels) const;
    Vector applyNormalMatrix(const Vector& texels, const std::vector<bool>& isFree) const;

    std::size_t texelCount_;
    std::vector<Footprint> footprints_;  ///< a row of the lookup matrix for each sample
    std::vector<double> weights_;        ///< solid angles
};

}  // namespace pfvox::probe

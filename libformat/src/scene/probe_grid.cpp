#include <fmt/format.h>

#include <cmath>
#include <pfvox/scene.hpp>

namespace pfvox {

namespace {

constexpr double kFittedSteps = 8.0;  ///< along the longest edge: nine probes
constexpr double kSmallestStep = 1e-6;
constexpr double kRounding = 1e-9;  ///< of a step: what does not ask for another probe

double longestOf(const glm::dvec3& v) {
    return std::max(v.x, std::max(v.y, v.z));
}

/// The step along one axis when only the count is known.
double stepFor(double length, std::uint32_t count, double otherwise) {
    const double step = count > 1 ? length / (count - 1) : otherwise;
    return step > kSmallestStep ? step : otherwise;
}

}  // namespace

glm::dvec3 frameOrigin(const WorldBounds& bounds) {
    constexpr double kNear = 1024.0;  // metres: a float tells 0.06 mm apart there
    constexpr double kRaster = 256.0;
    if (bounds.empty()) return glm::dvec3(0.0);
    const glm::dvec3 middle = 0.5 * (bounds.min + bounds.max);
    const double away = longestOf(glm::abs(middle));
    // A scene that is as large as it is far away gains nothing.
    if (away <= kNear || away <= 4.0 * longestOf(bounds.max - bounds.min)) return glm::dvec3(0.0);
    return kRaster * glm::round(middle / kRaster);
}

Result<ProbeGrid> fitProbeGrid(const ProbeGridRequest& request, const WorldBounds& bounds,
                               Diagnostics& diagnostics) {
    const glm::dvec3 low = bounds.empty() ? glm::dvec3(0.0) : bounds.min;
    const glm::dvec3 high = bounds.empty() ? glm::dvec3(0.0) : bounds.max;
    const glm::dvec3 length = high - request.position.value_or(low);
    const double longest = longestOf(high - low);
    const double fittedStep = longest > kSmallestStep * kFittedSteps ? longest / kFittedSteps : 1.0;

    glm::dvec3 step{0.0};
    glm::dvec3 wanted{0.0};
    for (int axis = 0; axis < 3; ++axis) {
        step[axis] = request.stepMetres ? (*request.stepMetres)[axis]
                     : request.count    ? stepFor(length[axis], (*request.count)[axis], fittedStep)
                                        : fittedStep;
        const double steps = std::ceil(length[axis] / step[axis] - kRounding);
        wanted[axis] = request.count ? (*request.count)[axis] : std::max(steps, 0.0) + 1.0;
    }
    if (longestOf(wanted) > kMaxProbesPerAxis || wanted.x * wanted.y * wanted.z > kMaxProbes) {
        return fail(
            ErrorCode::LimitExceeded,
            fmt::format("the probe grid would have {:.0f} x {:.0f} x {:.0f} probes, more than {} along "
                        "an axis or {} in all: raise probeGridStep",
                        wanted.x, wanted.y, wanted.z, kMaxProbesPerAxis, kMaxProbes));
    }
    const glm::dvec3 extent = step * (wanted - 1.0);
    const glm::dvec3 start = request.position.value_or(0.5 * (low + high - extent));
    const glm::dvec3 slack = 1e-6 * step;
    const bool encloses = glm::all(glm::lessThanEqual(start - slack, low)) &&
                          glm::all(glm::greaterThanEqual(start + extent + slack, high));
    const bool asGiven = request.position && request.stepMetres && request.count;
    if (!encloses && !asGiven)
        diagnostics.note("scene-grid-smaller", "the probe grid does not enclose all models");
    const glm::dvec3 origin = frameOrigin(bounds);
    return ProbeGrid{.start = start - origin, .step = step, .counts = glm::uvec3(wanted), .origin = origin};
}

}  // namespace pfvox

#include <algorithm>
#include <array>
#include <cmath>
#include <pfvox/flip.hpp>

namespace pfvox {

namespace {

using Image = std::vector<glm::dvec3>;

constexpr double kPi = 3.14159265358979323846;
// Exponents and break points of the paper (sections 4.1.2 and 4.3).
constexpr double kColorExponent = 0.7;
constexpr double kBreakFraction = 0.4;
constexpr double kBreakValue = 0.95;
constexpr double kFeatureDegrees = 0.082;
constexpr double kFeatureExponent = 0.5;

// ---- Color spaces, D65 ----

const glm::dmat3 kXyzFromRgb{{0.4124564, 0.2126729, 0.0193339},  // columns
                             {0.3575761, 0.7151522, 0.1191920},
                             {0.1804375, 0.0721750, 0.9503041}};

glm::dvec3 white() {
    return kXyzFromRgb * glm::dvec3{1.0};
}

/// Opponent colors in which the eye's acuity is known: Y, red-green, blue-yellow.
glm::dvec3 opponentFromRgb(const glm::dvec3& rgb) {
    const glm::dvec3 xyz = kXyzFromRgb * rgb / white();
    return {116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)};
}
glm::dvec3 rgbFromOpponent(const glm::dvec3& c) {
    const double y = (c.x + 16.0) / 116.0;
    return glm::inverse(kXyzFromRgb) * (glm::dvec3{y + c.y / 500.0, y, y - c.z / 200.0} * white());
}

/// CIE L*a*b*, its colors weaker where it is dark (the Hunt effect).
glm::dvec3 huntLabFromRgb(const glm::dvec3& rgb) {
    const glm::dvec3 xyz = kXyzFromRgb * rgb / white();
    const auto f = [](double t) {
        const double delta = 6.0 / 29.0;
        return t > delta * delta * delta ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
    };
    const double y = f(xyz.y);
    const double lightness = 116.0 * y - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (f(xyz.x) - y), 0.01 * lightness * 200.0 * (y - f(xyz.z))};
}

double hyab(const glm::dvec3& a, const glm::dvec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// ---- Filters ----

struct Filter {
    int radius = 0;
    std::vector<double> weights;  ///< (2 radius + 1)^2
    double at(int x, int y) const {
        return weights[static_cast<std::size_t>((y + radius) * (2 * radius + 1) + x + radius)];
    }
};

template <class Value>
Filter makeFilter(int radius, Value value) {
    Filter filter{.radius = radius, .weights = {}};
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x) filter.weights.push_back(value(x, y));
    return filter;
}

/// Contrast sensitivity of one channel as the sum of two Gaussians over degrees: factors and widths of the
/// paper.
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kSensitivities{
    {{1.0, 0.0047, 0.0, 1e-5}, {1.0, 0.0053, 0.0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};

Filter sensitivityFilter(const Sensitivity& s, double pixelsPerDegree) {
    const int radius =
        static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * kPi * kPi)) * pixelsPerDegree));
    Filter filter = makeFilter(radius, [&](int x, int y) {
        const double squared = (x * x + y * y) / (pixelsPerDegree * pixelsPerDegree);
        const auto gaussian = [&](double a, double b) {
            return a * std::sqrt(kPi / b) * std::exp(-kPi * kPi * squared / b);
        };
        return gaussian(s.a1, s.b1) + gaussian(s.a2, s.b2);
    });
    double sum = 0.0;
    for (const double weight : filter.weights) sum += weight;
    for (double& weight : filter.weights) weight /= sum;
    return filter;
}

/// First or second derivative of a Gaussian along x; what is positive sums to 1, what is negative to -1.
Filter featureFilter(bool points, double pixelsPerDegree) {
    const double sigma = 0.5 * kFeatureDegrees * pixelsPerDegree;
    Filter filter = makeFilter(static_cast<int>(std::ceil(3.0 * sigma)), [&](int x, int y) {
        const double gaussian = std::exp(-(x * x + y * y) / (2.0 * sigma * sigma));
        return points ? (x * x / (sigma * sigma) - 1.0) * gaussian : -x * gaussian;
    });
    double positive = 0.0;
    double negative = 0.0;
    for (const double weight : filter.weights) (weight > 0.0 ? positive : negative) += weight;
    for (double& weight : filter.weights) weight /= weight > 0.0 ? positive : -negative;
    return filter;
}

struct Size {
    int width;
    int height;
    std::size_t clamped(int x, int y) const {
        return static_cast<std::size_t>(std::clamp(y, 0, height - 1) * width + std::clamp(x, 0, width - 1));
    }
};

template <class Weight>
double filtered(const Image& image, const Size& size, glm::ivec2 at, int channel, int radius, Weight weight) {
    double sum = 0.0;
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x)
            sum += weight(x, y) * image[size.clamped(at.x + x, at.y + y)][channel];
    return sum;
}

// ---- The two parts ----

Image opponentImage(std::span<const glm::vec3> rgb) {
    Image image;
    for (const glm::vec3& pixel : rgb)
        image.push_back(opponentFromRgb(glm::clamp(glm::dvec3{pixel}, 0.0, 1.0)));
    return image;
}

/// What the eye sees of the colors from its distance.
Image seenColors(const Image& opponent, const Size& size, double pixelsPerDegree) {
    std::array<Filter, 3> filters;
    for (std::size_t i = 0; i < 3; ++i) filters[i] = sensitivityFilter(kSensitivities[i], pixelsPerDegree);
    Image seen;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            glm::dvec3 c;
            for (int channel = 0; channel < 3; ++channel) {
                const Filter& filter = filters[static_cast<std::size_t>(channel)];
                c[channel] = filtered(opponent, size, {x, y}, channel, filter.radius,
                                      [&](int i, int j) { return filter.at(i, j); });
            }
            seen.push_back(huntLabFromRgb(glm::clamp(rgbFromOpponent(c), 0.0, 1.0)));
        }
    }
    return seen;
}

double colorDifference(const glm::dvec3& a, const glm::dvec3& b) {
    static const double largest =
        std::pow(hyab(huntLabFromRgb({0, 1, 0}), huntLabFromRgb({0, 0, 1})), kColorExponent);
    const double difference = std::pow(hyab(a, b), kColorExponent);
    const double breakPoint = kBreakFraction * largest;
    if (difference < breakPoint) return kBreakValue / breakPoint * difference;
    return kBreakValue + (difference - breakPoint) / (largest - breakPoint) * (1.0 - kBreakValue);
}

/// Strength of edges (x) and points (y) at each pixel.
std::vector<glm::dvec2> featuresOf(const Image& opponent, const Size& size, double pixelsPerDegree) {
    Image luminance = opponent;
    for (glm::dvec3& pixel : luminance) pixel.x = (pixel.x + 16.0) / 116.0;
    const std::array<Filter, 2> filters{featureFilter(false, pixelsPerDegree),
                                        featureFilter(true, pixelsPerDegree)};
    std::vector<glm::dvec2> features;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            glm::dvec2 strength;
            for (int k = 0; k < 2; ++k) {
                const Filter& filter = filters[static_cast<std::size_t>(k)];
                const auto along = [&](int i, int j) { return filter.at(i, j); };
                const auto across = [&](int i, int j) { return filter.at(j, i); };
                strength[k] = std::hypot(filtered(luminance, size, {x, y}, 0, filter.radius, along),
                                         filtered(luminance, size, {x, y}, 0, filter.radius, across));
            }
            features.push_back(strength);
        }
    }
    return features;
}

}  // namespace

std::vector<float> flipOf(const FlipInput& input) {
    const Size size{static_cast<int>(input.width), static_cast<int>(input.height)};
    const Image reference = opponentImage(input.reference);
    const Image test = opponentImage(input.test);
    const Image seenReference = seenColors(reference, size, input.pixelsPerDegree);
    const Image seenTest = seenColors(test, size, input.pixelsPerDegree);
    const auto featuresReference = featuresOf(reference, size, input.pixelsPerDegree);
    const auto featuresTest = featuresOf(test, size, input.pixelsPerDegree);
    std::vector<float> flip;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        const double color = std::min(colorDifference(seenReference[i], seenTest[i]), 1.0);
        const glm::dvec2 apart = glm::abs(featuresReference[i] - featuresTest[i]);
        const double feature =
            std::pow(std::min(std::max(apart.x, apart.y) / std::sqrt(2.0), 1.0), kFeatureExponent);
        flip.push_back(static_cast<float>(std::pow(color, 1.0 - feature)));
    }
    return flip;
}

}  // namespace pfvox

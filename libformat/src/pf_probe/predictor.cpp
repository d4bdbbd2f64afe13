#include "pf_probe/predictor.hpp"

#include <cstring>

#include "pf_probe/frame_codec.hpp"

namespace pfvox::probe {

namespace {

enum class Rule : std::uint8_t { Plane, Left };

struct Field {
    std::uint32_t shift;
    std::uint32_t bits;
    Rule rule = Rule::Left;

    std::uint32_t mask() const { return (1u << bits) - 1; }
    std::size_t planes() const { return bits > 8 ? 2 : 1; }
};

constexpr std::array<Field, 3> kDepthNormalFields{Field{0, 16, Rule::Plane}, Field{16, 8}, Field{24, 8}};
constexpr std::array<Field, 3> kLightFields{Field{0, 11}, Field{11, 11}, Field{22, 10}};
constexpr std::array<Field, 1> kMinDepthFields{Field{0, 16, Rule::Plane}};
constexpr std::array<Field, 2> kMomentsFields{Field{0, 16}, Field{16, 16}};

std::span<const Field> fieldsOf(ProbeLayer layer) {
    switch (layer) {
        case ProbeLayer::DepthNormal:
            return kDepthNormalFields;
        case ProbeLayer::MinDepth:
            return kMinDepthFields;
        case ProbeLayer::Moments:
            return kMomentsFields;
        case ProbeLayer::Light:
        case ProbeLayer::Irradiance:
            break;
    }
    return kLightFields;
}

/// What neighbors foretell, row by row: only the values of the row above and of the left neighbor are kept.
class Foreteller {
  public:
    Foreteller(const Field& field, std::uint32_t edge) : rule_(field.rule), above_(edge, 0) {}

    /// Calls step(x, foretold) for each texel of the next row; step returns the value.
    template <class Step>
    void row(Step&& step) {
        std::uint32_t upLeft = above_[0];
        std::uint32_t left = above_[0] = step(std::size_t{0}, above_[0]);
        if (rule_ == Rule::Left || isFirst_) {
            for (std::size_t x = 1; x < above_.size(); ++x) left = above_[x] = step(x, left);
        } else {
            for (std::size_t x = 1; x < above_.size(); ++x) {
                const std::uint32_t up = above_[x];
                left = above_[x] = step(x, left + up - upLeft);
                upLeft = up;
            }
        }
        isFirst_ = false;
    }

  private:
    Rule rule_;
    bool isFirst_ = true;
    std::vector<std::uint32_t> above_;
};

std::uint32_t zigzag(std::uint32_t difference, const Field& field) {
    const bool isNegative = (difference >> (field.bits - 1) & 1u) != 0;
    return (difference << 1 ^ (isNegative ? field.mask() : 0u)) & field.mask();
}

std::uint32_t unzigzag(std::uint32_t code, const Field& field) {
    return code >> 1 ^ ((code & 1u) != 0 ? field.mask() : 0u);
}

std::vector<std::uint32_t> wideWords(ProbeLayer layer, std::span<const std::byte> bytes, std::size_t count) {
    std::vector<std::uint32_t> words(count);
    if (wordBytesOf(layer) == 4) {
        std::memcpy(words.data(), bytes.data(), bytes.size());
        return words;
    }
    std::vector<std::uint16_t> narrow(count);
    std::memcpy(narrow.data(), bytes.data(), bytes.size());
    words.assign(narrow.begin(), narrow.end());
    return words;
}

}  // namespace

std::uint64_t planeBytes(ProbeLayer layer, std::uint32_t edge) {
    std::uint64_t planes = 0;
    for (const Field& field : fieldsOf(layer)) planes += field.planes();
    return planes * edge * edge;
}

std::vector<std::byte> toPlanes(ProbeLayer layer, std::span<const std::byte> words, std::uint32_t edge) {
    const std::size_t count = std::size_t{edge} * edge;
    const std::vector<std::uint32_t> wide = wideWords(layer, words, count);
    std::vector<std::byte> planes(planeBytes(layer, edge));
    std::byte* plane = planes.data();
    for (const Field& field : fieldsOf(layer)) {
        Foreteller foreteller(field, edge);
        for (std::size_t first = 0; first < count; first += edge) {
            foreteller.row([&](std::size_t x, std::uint32_t foretold) {
                const std::uint32_t value = wide[first + x] >> field.shift & field.mask();
                const std::uint32_t code = zigzag(value - foretold, field);
                plane[first + x] = static_cast<std::byte>(code & 0xffu);
                if (field.planes() == 2) plane[count + first + x] = static_cast<std::byte>(code >> 8);
                return value;
            });
        }
        plane += field.planes() * count;
    }
    return planes;
}

void fromPlanes(ProbeLayer layer, std::span<const std::byte> planes, std::uint32_t edge,
                std::span<std::byte> words) {
    const std::size_t count = std::size_t{edge} * edge;
    std::vector<std::uint32_t> wide(count);
    const std::byte* plane = planes.data();
    for (const Field& field : fieldsOf(layer)) {
        Foreteller foreteller(field, edge);
        for (std::size_t first = 0; first < count; first += edge) {
            foreteller.row([&](std::size_t x, std::uint32_t foretold) {
                std::uint32_t code = std::to_integer<std::uint32_t>(plane[first + x]);
                if (field.planes() == 2)
                    code |= std::to_integer<std::uint32_t>(plane[count + first + x]) << 8;
                const std::uint32_t value = (foretold + unzigzag(code & field.mask(), field)) & field.mask();
                wide[first + x] |= value << field.shift;
                return value;
            });
        }
        plane += field.planes() * count;
    }
    if (wordBytesOf(layer) == 4) {
        std::memcpy(words.data(), wide.data(), words.size());
        return;
    }
    std::vector<std::uint16_t> narrow(count);
    for (std::size_t i = 0; i < count; ++i) narrow[i] = static_cast<std::uint16_t>(wide[i]);
    std::memcpy(words.data(), narrow.data(), words.size());
}

}  // namespace pfvox::probe

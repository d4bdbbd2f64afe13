// A second reader of light on faces, written from docs/format-pf_probe.md alone: what the page says is what
// the files have.
#include <gtest/gtest.h>
#include <xxhash.h>
#include <zstd.h>

#include <cmath>
#include <cstring>
#include <map>

#include "support/lit_faces.hpp"
#include "support/temp_folder.hpp"

namespace pfvox {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Little endian numbers, one after the other.
class Cursor {
  public:
    explicit Cursor(const Bytes& bytes, std::size_t at = 0) : bytes_(bytes), at_(at) {}
    template <class T>
    T next() {
        T value;
        std::memcpy(&value, &bytes_.at(at_ + sizeof value - 1) - (sizeof value - 1), sizeof value);
        at_ += sizeof value;
        return value;
    }
    std::uint32_t word() { return next<std::uint32_t>(); }
    std::uint64_t number() { return next<std::uint64_t>(); }
    Bytes take(std::size_t count) {
        at_ += count;
        return {bytes_.begin() + static_cast<std::ptrdiff_t>(at_ - count),
                bytes_.begin() + static_cast<std::ptrdiff_t>(at_)};
    }
    bool atEnd() const { return at_ == bytes_.size(); }

  private:
    const Bytes& bytes_;
    std::size_t at_;
};

Bytes unpacked(const Bytes& stored, std::size_t rawBytes) {
    if (stored.size() == rawBytes) return stored;
    Bytes raw(rawBytes);
    EXPECT_EQ(ZSTD_decompress(raw.data(), raw.size(), stored.data(), stored.size()), rawBytes);
    return raw;
}

std::map<std::string, Bytes> sectionsOf(const Bytes& file) {
    std::map<std::string, Bytes> sections;
    Cursor table(file, 64);
    for (std::uint32_t i = Cursor(file, 28).word(); i > 0; --i) {
        const Bytes name = table.take(4);
        table.word();
        const bool isPacked = table.word() == 1;
        table.word();
        const std::uint64_t offset = table.number();
        const Bytes stored = Cursor(file, offset).take(table.number());
        const std::uint64_t rawBytes = table.number();
        sections[std::string(name.begin(), name.end())] = isPacked ? unpacked(stored, rawBytes) : stored;
        table.take(24);
    }
    return sections;
}

std::int64_t unfold(std::uint32_t folded) {
    return folded % 2 == 0 ? folded / 2 : -static_cast<std::int64_t>(folded / 2) - 1;
}

std::uint32_t quantizedWord(std::int64_t light, std::int64_t r, std::int64_t b) {
    if (light == 0) return 0;
    const auto power =
        static_cast<std::int64_t>(std::llround(std::exp2(12 + static_cast<double>((light - 1) % 64) / 64)))
        << ((light - 1) / 64);
    const auto mantissa = [&](std::int64_t part, int e) {
        const std::int64_t unit = std::int64_t{255} << (12 + e);
        return static_cast<std::uint32_t>((2 * power * part + unit) / (2 * unit));
    };
    const std::int64_t g = 255 - r - b;
    int e = 0;
    while (std::max({mantissa(r, e), mantissa(g, e), mantissa(b, e)}) > 511) ++e;
    return mantissa(r, e) | mantissa(g, e) << 9 | mantissa(b, e) << 18 | static_cast<std::uint32_t>(e) << 27;
}

std::vector<std::uint32_t> quantizedValues(const std::array<Bytes, 6>& streams, std::size_t count) {
    std::vector<std::uint32_t> values;
    std::int64_t light = 0;
    std::int64_t r = 0;
    std::int64_t b = 0;
    for (std::size_t i = 0; i < count; ++i) {
        light += unfold(streams[1][i] + 256u * streams[2][i]);
        r = (r + unfold(streams[3][i])) & 255;
        b = (b + unfold(streams[4][i])) & 255;
        values.push_back(quantizedWord(light, r, b));
    }
    return values;
}

std::vector<std::uint32_t> losslessValues(const std::array<Bytes, 6>& streams, std::size_t count) {
    std::vector<std::uint32_t> values;
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const int exponent = static_cast<int>((before >> 27) + streams[1][i]) % 32;
        const int up = exponent - static_cast<int>(before >> 27);
        const auto foretold = [&](int at) {
            const double m = before >> at & 511;
            return static_cast<std::int64_t>(std::min(511.0, std::floor(m * std::exp2(-up))));
        };
        const auto difference = [&](int k) {
            return unfold(streams[static_cast<std::size_t>(k) + 2][i] + 256u * (streams[5][i] >> k & 1u));
        };
        const std::int64_t g = difference(0);
        const auto color = [](std::int64_t v, int at) {
            return (static_cast<std::uint32_t>(v) & 511u) << at;
        };
        const std::uint32_t word = color(foretold(0) + g + difference(1), 0) | color(foretold(9) + g, 9) |
                                   color(foretold(18) + g + difference(2), 18) |
                                   static_cast<std::uint32_t>(exponent) << 27;
        values.push_back(word);
        before = word;
    }
    return values;
}

Bytes levelsOf(const Bytes& runs) {
    Bytes levels;
    for (std::size_t at = 0; at < runs.size();) {
        std::uint64_t number = 0;
        for (int shift = 0;; shift += 7) {
            number |= std::uint64_t{runs[at] & 127u} << shift;
            if (runs[at++] < 128) break;
        }
        levels.resize(levels.size() + number / 8,
                      number % 8 == 4 ? std::uint8_t{255} : static_cast<std::uint8_t>(number % 8));
    }
    return levels;
}

/// Faces of each chunk of the scene.
std::vector<std::uint32_t> chunksOf(const std::vector<std::uint32_t>& regions, std::uint32_t least) {
    std::vector<std::uint32_t> chunks;
    for (const std::uint32_t faces : regions) {
        if (faces != 0 && (chunks.empty() || chunks.back() >= least)) chunks.push_back(0);
        if (faces != 0) chunks.back() += faces;
    }
    return chunks;
}

void expectRead(const std::string& file, const FaceLight& expected) {
    SCOPED_TRACE(file);
    const std::string text = test::readText(std::filesystem::path(PFVOX_TESTS_DIR) / "golden/data" / file);
    const auto sections = sectionsOf(Bytes(text.begin(), text.end()));
    Cursor head(sections.at("FACE"));
    Cursor data(sections.at("FDAT"));
    const std::uint32_t least = head.word();
    const std::uint32_t first = head.word();
    const std::uint32_t end = head.word();
    const std::uint32_t settingCount = head.word();
    const std::uint32_t instanceCount = head.word();
    const std::uint32_t regionCount = head.word();
    ASSERT_EQ(first, expected.info.range.first);
    ASSERT_EQ(end, expected.info.range.end);
    std::map<std::uint32_t, std::uint64_t> settings;
    for (std::uint32_t i = 0; i < settingCount; ++i) {
        const std::uint32_t id = head.word();
        EXPECT_EQ(head.word(), 0u);
        settings[id] = head.number();
    }
    EXPECT_EQ(settings.at(16), expected.info.settings.seed);
    EXPECT_EQ(settings.at(20), expected.info.settings.maxRays);
    std::uint32_t sum = 0;
    for (std::uint32_t i = 0; i < instanceCount; ++i) {
        head.take(16);
        sum += head.word();
    }
    EXPECT_EQ(sum, regionCount);
    std::vector<std::uint32_t> regions(regionCount);
    for (std::uint32_t& faces : regions) faces = head.word();
    const auto chunks = chunksOf(regions, least);
    for (std::uint32_t chunk = first; chunk < end; ++chunk) {
        const std::uint64_t hash = head.number();
        head.take(16 + 4 + 4);
        const std::uint32_t count = head.word();
        const std::uint32_t levelBytes = head.word();
        std::array<Bytes, 6> streams;
        for (std::size_t i = 0; i < 6; ++i) {
            const Bytes stored = data.take(head.word());
            if (!stored.empty()) streams[i] = unpacked(stored, i == 0 ? levelBytes : count);
        }
        const FaceChunk read{.levels = levelsOf(streams[0]),
                             .values = settings.at(23) == 0 ? quantizedValues(streams, count)
                                                            : losslessValues(streams, count)};
        EXPECT_EQ(read.levels.size(), chunks.at(chunk));
        EXPECT_TRUE(read == expected.chunks[chunk - first]) << chunk;
        const std::array<std::uint64_t, 2> hashes{XXH3_64bits(read.levels.data(), read.levels.size()),
                                                  XXH3_64bits(read.values.data(), 4 * read.values.size())};
        EXPECT_EQ(XXH3_64bits(hashes.data(), sizeof hashes), hash);
    }
    EXPECT_TRUE(head.atEnd());
    EXPECT_TRUE(data.atEnd());
}

TEST(FacePage, IsEnoughToReadTheFiles) {
    expectRead("v1_2.pf_probe", test::faceLight());
    FaceLightInfo shard = test::faceInfo(FaceCodec::Lossless);
    shard.range = {1, 3};
    expectRead("v1_2_faces.pf_probe", test::faceLight(shard));
}

}  // namespace
}  // namespace pfvox

// The codec of maps: lossless for any words, and worth its place on maps of real rooms.
#include <gtest/gtest.h>

#include <random>

#include "pf_probe/frame_codec.hpp"
#include "pf_probe/predictor.hpp"
#include "pf_probe/records.hpp"
#include "support/box_room.hpp"

namespace pfvox {
namespace {

TEST(ProbePredictor, IsLosslessForAnyWords) {
    std::mt19937 random(8);
    for (const ProbeLayer layer : probe::kAllLayers) {
        for (const std::uint32_t edge : {1u, 2u, 3u, 16u, 31u}) {
            for (int round = 0; round < 20; ++round) {
                std::vector<std::byte> words(std::size_t{edge} * edge * probe::wordBytesOf(layer));
                // All bits, few bits, and jumps between the ends of the range.
                for (std::byte& b : words)
                    b = round % 3 == 0
                            ? static_cast<std::byte>(random())
                            : static_cast<std::byte>(round % 3 == 1 ? random() % 2 : 0xffu * (random() % 2));
                const auto planes = probe::toPlanes(layer, words, edge);
                ASSERT_EQ(planes.size(), probe::planeBytes(layer, edge));
                std::vector<std::byte> back(words.size());
                probe::fromPlanes(layer, planes, edge, back);
                ASSERT_EQ(back, words) << toString(layer) << " " << edge;
            }
        }
    }
}

/// By hand: a plane of depth codes is foretold but for its first row and column.
TEST(ProbePredictor, PlanesOfDepthLeaveNothing) {
    std::vector<std::uint16_t> codes;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) codes.push_back(static_cast<std::uint16_t>(1000 + 3 * x - 7 * y));
    const auto planes = probe::toPlanes(ProbeLayer::MinDepth, std::as_bytes(std::span(codes)), 4);
    const std::vector<int> low{0xd0, 6, 6, 6, 13, 0, 0, 0,
                               13,   0, 0, 0, 13, 0, 0, 0};  // 2000 = 0x7d0; 3 -> 6; -7 -> 13
    for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_EQ(std::to_integer<int>(planes[i]), low[i]) << i;
        EXPECT_EQ(std::to_integer<int>(planes[16 + i]), i == 0 ? 7 : 0) << i;
    }
}

TEST(ProbePredictor, MapsOfARoomShrinkToATenth) {
    const test::BoxRoom room(24);
    const DepthCoder coder(depthEncodingFor({0, 0, 0}, room.size()));
    const auto words = test::traceDepthNormal(room, {4.8f, 2.1f, 5.3f}, 512, coder);
    std::vector<std::byte> stored;
    const auto bytes = std::as_bytes(std::span(words));
    const auto frame = probe::packFrame(ProbeLayer::DepthNormal, bytes, 1, stored);
    ASSERT_TRUE(frame);
    EXPECT_LT(stored.size(), bytes.size() / 10);
    RecordProperty("stored_bytes", static_cast<int>(stored.size()));
    std::vector<std::byte> back(bytes.size());
    container::MemoryBudget budget(8u << 20);
    ASSERT_TRUE(probe::unpackFrame(ProbeLayer::DepthNormal, *frame, stored, back, budget));
    EXPECT_TRUE(std::ranges::equal(back, bytes));
}

}  // namespace
}  // namespace pfvox

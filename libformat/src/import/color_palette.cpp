#include "import/color_palette.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <pfvox/assert.hpp>
#include <queue>
#include <span>

namespace pfvox::import {

namespace {

constexpr std::uint32_t channelOf(std::uint32_t code, int channel) {
    return (code >> (16 - 8 * channel)) & 0xffu;
}

glm::u8vec3 colorOf(std::uint32_t code) {
    return {static_cast<std::uint8_t>(channelOf(code, 0)), static_cast<std::uint8_t>(channelOf(code, 1)),
            static_cast<std::uint8_t>(channelOf(code, 2))};
}

/// A group of colors: a range of the array that medianCut() sorts.
struct Group {
    std::size_t begin = 0;
    std::size_t end = 0;
    int longestChannel = 0;
    std::uint32_t longestEdge = 0;

    std::size_t size() const { return end - begin; }
    /// The group to split next is the widest, then the fullest, then the first.
    bool operator<(const Group& other) const {
        if (longestEdge != other.longestEdge) return longestEdge < other.longestEdge;
        if (size() != other.size()) return size() < other.size();
        return begin > other.begin;
    }
};

Group makeGroup(std::span<const std::uint32_t> codes, std::size_t begin, std::size_t end) {
    Group group{.begin = begin, .end = end};
    for (int channel = 0; channel < 3; ++channel) {
        std::uint32_t low = 255;
        std::uint32_t high = 0;
        for (const std::uint32_t code : codes.subspan(begin, end - begin)) {
            low = std::min(low, channelOf(code, channel));
            high = std::max(high, channelOf(code, channel));
        }
        if (high - low > group.longestEdge) {
            group.longestEdge = high - low;
            group.longestChannel = channel;
        }
    }
    return group;
}

/// Rearranges `codes` into `count` consecutive groups of close colors.
std::vector<Group> medianCut(std::span<std::uint32_t> codes, std::size_t count) {
    std::priority_queue<Group> queue;
    queue.push(makeGroup(codes, 0, codes.size()));
    while (queue.size() < count) {
        const Group group = queue.top();
        queue.pop();
        const int channel = group.longestChannel;
        const std::size_t middle = group.begin + group.size() / 2;
        const auto at = [&](std::size_t i) { return codes.begin() + static_cast<std::ptrdiff_t>(i); };
        std::ranges::nth_element(at(group.begin), at(middle), at(group.end),
                                 [&](std::uint32_t a, std::uint32_t b) {
                                     const std::uint32_t ca = channelOf(a, channel);
                                     const std::uint32_t cb = channelOf(b, channel);
                                     return ca != cb ? ca < cb : a < b;
                                 });
        queue.push(makeGroup(codes, group.begin, middle));
        queue.push(makeGroup(codes, middle, group.end));
    }
    std::vector<Group> groups;
    for (; !queue.empty(); queue.pop()) groups.push_back(queue.top());
    std::ranges::sort(groups, {}, &Group::begin);
    return groups;
}

glm::u8vec3 meanOf(std::span<const std::uint32_t> codes) {
    std::array<std::uint64_t, 3> sums{};
    for (const std::uint32_t code : codes) {
        for (int channel = 0; channel < 3; ++channel)
            sums[static_cast<std::size_t>(channel)] += channelOf(code, channel);
    }
    glm::u8vec3 mean;
    for (int channel = 0; channel < 3; ++channel) {
        const std::uint64_t sum = sums[static_cast<std::size_t>(channel)];
        mean[channel] = static_cast<std::uint8_t>((sum + codes.size() / 2) / codes.size());
    }
    return mean;
}

}  // namespace

std::vector<std::uint32_t> ColorPalette::collect() const {
    std::vector<std::uint32_t> codes;
    codes.reserve(distinctColors_);
    for (std::size_t word = 0; word < kWords; ++word) {
        for (std::uint64_t bits = present_[word]; bits != 0; bits &= bits - 1) {
            codes.push_back(static_cast<std::uint32_t>(word * 64) +
                            static_cast<std::uint32_t>(std::countr_zero(bits)));
        }
    }
    return codes;
}

void ColorPalette::finish() {
    rankOfWord_.resize(kWords);
    std::uint32_t rank = 0;
    for (std::size_t word = 0; word < kWords; ++word) {
        rankOfWord_[word] = rank;
        rank += static_cast<std::uint32_t>(std::popcount(present_[word]));
    }
    distinctColors_ = rank;
    std::vector<std::uint32_t> codes = collect();
    if (!quantised()) {
        for (const std::uint32_t code : codes) colors_.push_back(colorOf(code));
        return;
    }
    indexOfRank_.resize(codes.size());
    const std::span<std::uint32_t> all(codes);
    for (const Group& group : medianCut(all, maxColors_)) {
        const auto members = all.subspan(group.begin, group.size());
        for (const std::uint32_t code : members)
            indexOfRank_[rankOf(code)] = static_cast<MaterialIndex>(colors_.size());
        colors_.push_back(meanOf(members));
    }
}

std::size_t ColorPalette::rankOf(std::uint32_t code) const {
    const std::uint64_t below = (std::uint64_t{1} << (code & 63u)) - 1;
    return rankOfWord_[code >> 6] + static_cast<std::size_t>(std::popcount(present_[code >> 6] & below));
}

MaterialIndex ColorPalette::indexOf(glm::u8vec3 color) const {
    const std::uint32_t code = codeOf(color);
    PFVOX_ASSERT(((present_[code >> 6] >> (code & 63u)) & 1u) != 0);
    const std::size_t rank = rankOf(code);
    return indexOfRank_.empty() ? static_cast<MaterialIndex>(rank) : indexOfRank_[rank];
}

}  // namespace pfvox::import

#include "octree/plane_linker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "octree/lanes.hpp"

namespace pfvox::octree {

namespace {

constexpr std::uint32_t kMaxTreeDepth = 32;

tl::unexpected<Error> badNode(std::size_t index, std::string message) {
    return failAt(ErrorCode::BadStructure, index, fmt::format("node {}", index), std::move(message));
}

/// Nodes with inner children, and all inner children.
struct Counts {
    std::size_t branches = 0;
    std::size_t innerChildren = 0;
};
Counts countIn(std::span<const std::uint8_t> inner) {
    Counts counts;
    for (std::size_t i = 0; i < inner.size(); i += 8) {
        const std::uint64_t word = eightBytes(inner.data(), i, inner.size());
        counts.branches += kBitCount[nonZeroBytes(word)];
        counts.innerChildren += sumsOfBytes(countInBytes(word)) >> 56;
    }
    return counts;
}

Result<void> checkSizes(const NodePlanes& planes, std::uint32_t depth) {
    const std::size_t n = planes.inner.size();
    if (n == 0) return fail(ErrorCode::BadStructure, "a tree needs at least its root");
    if (depth == 0 || depth > kMaxTreeDepth) {
        return fail(ErrorCode::BadStructure, fmt::format("a tree of {} levels", depth));
    }
    const Counts counts = countIn(planes.inner);
    if (counts.branches != planes.branchLeaves.size() || n - counts.branches != planes.tipLeaves.size()) {
        return fail(ErrorCode::BadStructure, "the announced number of nodes with inner children is wrong");
    }
    if (!planes.hoisted.empty() && planes.hoisted.size() != counts.branches) {
        return fail(ErrorCode::BadStructure, "the hoisted plane has another length than the branch plane");
    }
    if (counts.innerChildren + 1 != n) {
        return fail(ErrorCode::BadStructure,
                    fmt::format("{} nodes announce {} inner children; a tree has one less than nodes", n,
                                counts.innerChildren));
    }
    return {};
}

/// Says what joinMasks has found somewhere. Precondition: checkSizes found nothing.
Result<void> nameFault(const NodePlanes& planes) {
    std::size_t branch = 0;
    for (std::size_t i = 0; i < planes.inner.size(); ++i) {
        const unsigned inner = planes.inner[i];
        if (inner == 0) {
            if (planes.tipLeaves[i - branch] == 0) return badNode(i, "has no children");
            continue;
        }
        if ((planes.branchLeaves[branch] & inner) != 0)
            return badNode(i, "a child is leaf and inner node at once");
        if (!planes.hoisted.empty() && (planes.hoisted[branch] & ~inner) != 0)
            return badNode(i, "a hoisted value belongs to no inner child");
        ++branch;
    }
    return {};
}

/// The bits of `bits` at the places of `mask`, side by side. Precondition: a subset.
std::uint32_t gather(std::uint32_t bits, std::uint32_t mask) {
    if (bits == 0) return 0;
    std::uint32_t gathered = 0;
    for (std::uint32_t place = 1; mask != 0; mask &= mask - 1, place <<= 1) {
        if ((bits & mask & (~mask + 1)) != 0) gathered |= place;
    }
    return gathered;
}

/// Takes up to eight bytes at a time from a plane.
class EightOf {
  public:
    explicit EightOf(std::span<const std::uint8_t> plane) : plane_(plane) {}
    /// The next `count` bytes, as far as there are any; zeros behind them.
    std::uint64_t take(std::size_t count) {
        const std::uint64_t word = eightBytes(plane_.data(), next_, plane_.size());
        next_ = std::min(next_ + count, plane_.size());
        return count == 8 ? word : word & ((std::uint64_t{1} << (8 * count)) - 1);
    }

  private:
    std::span<const std::uint8_t> plane_;
    std::size_t next_ = 0;
};

/// For each mask of eight nodes and each of them: by how many bits the byte of that node lies up in the bytes
/// of all nodes in the mask and then of all others.
constexpr std::array<std::array<std::uint8_t, 8>, 256> kPlaces = [] {
    std::array<std::array<std::uint8_t, 8>, 256> places{};
    for (unsigned mask = 0; mask < 256; ++mask) {
        auto inside = 0;
        auto outside = std::popcount(mask);
        for (unsigned k = 0; k < 8; ++k)
            places[mask][k] = static_cast<std::uint8_t>(8 * ((mask >> k & 1u) != 0 ? inside++ : outside++));
    }
    return places;
}();

/// Spreads bytes that are side by side over eight nodes: those of nodes in the mask and those of the others.
std::uint64_t spread(std::uint32_t mask, std::uint64_t inMask, std::uint64_t others) {
    if (mask == 0) return others;
    if (mask == 0xff) return inMask;
    const std::uint64_t all = inMask | (others << (8 * kBitCount[mask]));
    if (all == 0) return 0;
    std::uint64_t bytes = 0;
    for (unsigned k = 0; k < 8; ++k) bytes |= (all >> kPlaces[mask][k] & 0xff) << (8 * k);
    return bytes;
}

#if defined(__SSE2__)
__m128i lowBytes(std::uint64_t bytes) {
    return _mm_cvtsi64_si128(static_cast<long long>(bytes));
}

/// Writes eight words: a byte, a byte above it, and `base` added.
void writeWords(std::uint64_t low, std::uint64_t high, std::uint32_t base, std::uint32_t* out) {
    const __m128i pairs = _mm_unpacklo_epi8(lowBytes(low), lowBytes(high));
    const __m128i bases = _mm_set1_epi32(static_cast<int>(base));
    const __m128i zero = _mm_setzero_si128();
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out), _mm_add_epi32(_mm_unpacklo_epi16(pairs, zero), bases));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out + 4),
                     _mm_add_epi32(_mm_unpackhi_epi16(pairs, zero), bases));
}
#else
void writeWords(std::uint64_t low, std::uint64_t high, std::uint32_t base, std::uint32_t* out) {
    for (unsigned k = 0; k < 8; ++k) {
        out[k] = static_cast<std::uint32_t>(low >> (8 * k) & 0xff) +
                 (static_cast<std::uint32_t>(high >> (8 * k) & 0xff) << 8) + base;
    }
}
#endif

/// The same for the first `count` of the eight words.
void writeSomeWords(std::uint64_t low, std::uint64_t high, std::uint32_t base, std::span<std::uint32_t> out) {
    if (out.size() == 8) return writeWords(low, high, base, out.data());
    std::array<std::uint32_t, 8> words;
    writeWords(low, high, base, words.data());
    std::copy_n(words.begin(), out.size(), out.begin());
}

/// Lookup words from masks, eight at a time; returns the number of values. The masks are padded with zeros to
/// eight.
std::uint64_t writeLookup(const std::uint8_t* masks, std::size_t size, std::uint32_t* out) {
    std::uint64_t values = 0;
    for (std::size_t i = 0; i < size; i += 8) {
        std::uint64_t mask;
        std::memcpy(&mask, masks + i, 8);
        const std::uint64_t sums = sumsOfBytes(countInBytes(mask));
        // A value pointer counts the values of all nodes before its own.
        writeSomeWords(mask, sums << 8, static_cast<std::uint32_t>(values) << 8,
                       {out + i, std::min<std::size_t>(8, size - i)});
        values += sums >> 56;
    }
    return values;
}

}  // namespace

Result<void> PlaneLinker::joinMasks(const NodePlanes& planes, std::uint32_t* nodes) {
    size_ = planes.inner.size();
    masks_ = buffer_.room(size_ + 8);
    std::uint8_t* const masks = masks_;
    EightOf branches(planes.branchLeaves);
    EightOf tips(planes.tipLeaves);
    EightOf hoisted(planes.hoisted);
    bool isFaulty = false;
    for (std::size_t i = 0; i < size_; i += 8) {
        const std::size_t count = std::min<std::size_t>(8, size_ - i);
        const std::uint64_t inner = eightBytes(planes.inner.data(), i, size_);
        const std::uint32_t isBranch = nonZeroBytes(inner);
        const std::size_t branchCount = kBitCount[isBranch];
        const std::uint64_t leaf =
            spread(isBranch, branches.take(branchCount), tips.take(count - branchCount));
        const std::uint64_t uniform = spread(isBranch, hoisted.take(branchCount), 0);
        const std::uint64_t valid = leaf | inner;
        isFaulty |= ((leaf & inner) | (uniform & ~inner)) != 0 || kBitCount[nonZeroBytes(valid)] != count;
        const std::uint64_t values = leaf | uniform;
        std::memcpy(masks + i, &values, 8);
        writeSomeWords(leaf, valid, 0, {nodes + i, count});
    }
    std::memset(masks + size_, 0, 8);
    if (isFaulty) return nameFault(planes);
    return {};
}

/// The values of covered nodes belong to an ancestor. False if one of them has a hoisted value all the same.
bool PlaneLinker::coverBlock(std::uint64_t innerMasks, std::uint32_t first, std::uint32_t count,
                             std::uint32_t covered) {
    std::uint8_t* const place = masks_ + first;
    std::uint64_t masks;
    std::memcpy(&masks, place, 8);  // eight bytes follow the last mask
    const std::uint64_t below = kBytesOfBits[covered & ((1u << count) - 1)];
    if ((masks & innerMasks & below) != 0) return false;
    masks &= ~below;
    std::memcpy(place, &masks, 8);
    return true;
}

/// Gives every branch its pointer and clears the masks below hoisted values. Nodes lie in depth-first order
/// of sibling blocks, so the next block of children is always the first place not given out yet.
Result<void> PlaneLinker::walk(std::span<const std::uint8_t> inner, NodeTree& tree) {
    struct Level {
        std::uint32_t first;     ///< node of the block
        std::uint32_t branches;  ///< bit k: node first + k has inner children that were not visited
        std::uint32_t covered;   ///< bit k: node first + k lies below a hoisted value
    };
    std::array<Level, kMaxTreeDepth + 1> stack;
    std::uint32_t level = 0;
    stack[0] = {.first = 0, .branches = inner[0] != 0, .covered = 0};
    std::uint32_t places = 1;
    far_.clear();
    while (true) {
        Level& block = stack[level];
        if (block.branches == 0) {
            if (level-- == 0) break;
            continue;
        }
        const auto k = static_cast<std::uint32_t>(std::countr_zero(block.branches));
        block.branches &= block.branches - 1;
        const std::uint32_t index = block.first + k;
        const std::uint32_t children = inner[index];
        if (level + 1 >= tree.depth) return badNode(index, "has inner children at the last level");
        const std::uint32_t count = kBitCount[children];
        const std::uint32_t first = places;
        // checkSizes: all inner children are as many as nodes, so places never runs past the end.
        places += count;
        const std::uint32_t distance = first - index;
        if (distance <= node::kMaxNearPointer) {
            tree.nodes[index] |= distance << node::kPointerShift;
        } else {
            far_.push_back({index, distance});
        }
        const std::uint64_t innerMasks =
            eightBytes(inner.data(), first, inner.size()) & kBytesOfBits[(1u << count) - 1];
        const bool isCovered = (block.covered >> k & 1u) != 0;
        const std::uint32_t covered = isCovered ? 0xffu : gather(masks_[index] & children, children);
        if (covered != 0 && !coverBlock(innerMasks, first, count, covered))
            return badNode(index, "a hoisted value lies below another");
        stack[++level] = {.first = first, .branches = nonZeroBytes(innerMasks), .covered = covered};
    }
    if (places != inner.size()) return badNode(places, "is not reached from the root");
    return {};
}

Result<void> PlaneLinker::writeFarTable(NodeTree& tree) {
    tree.farTable.clear();
    if (far_.empty()) return {};
    std::ranges::sort(far_, {}, &FarPointer::node);
    if (far_.size() > node::kMaxNearPointer + 1)
        return badNode(far_[node::kMaxNearPointer + 1].node, "more than 32768 far pointers");
    tree.farTable.reserve(far_.size());
    for (const FarPointer& far : far_) {
        tree.nodes[far.node] |=
            node::kFarBit | (static_cast<std::uint32_t>(tree.farTable.size()) << node::kPointerShift);
        tree.farTable.push_back(far.distance);
    }
    return {};
}

Result<void> PlaneLinker::linkTree(const NodePlanes& planes, NodeTree& tree) {
    PFVOX_CHECK(checkSizes(planes, tree.depth));
    tree.nodes.resize(planes.inner.size());
    PFVOX_CHECK(joinMasks(planes, tree.nodes.data()));
    PFVOX_CHECK(walk(planes.inner, tree));
    return writeFarTable(tree);
}

Result<std::uint64_t> PlaneLinker::linkRegion(const NodePlanes& planes, NodeTree& tree,
                                              PooledVector<std::uint32_t>& lookup) {
    PFVOX_CHECK(linkTree(planes, tree));
    lookup.resize(size_);
    return writeLookup(masks_, size_, lookup.data());
}

}  // namespace pfvox::octree

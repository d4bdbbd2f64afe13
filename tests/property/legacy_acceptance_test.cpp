// The acceptance against the thesis program: for every pair of its .pf_vox and the .vox that it was made
// from, our octree of the .vox has the same voxels as its octree, the colors of the source (its own changed
// some), and all octrees together have fewer nodes and leaves.
//
// Both the thesis's file and the source are read here by readers that share no line with the importers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iostream>
#include <map>
#include <pfvox/convert.hpp>

#include "support/corpus.hpp"
#include "support/independent_vox_reader.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

using Rgba = std::array<int, 4>;
using Colors = std::map<Cell, Rgba>;  ///< by cell in MagicaVoxel's axes, z up

template <class T>
T valueAt(const std::string& bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

/// What the octree of the thesis says: see "Legacy PF_VOX" in docs/import.md for the field table.
struct ThesisFile {
    std::uint64_t nodes = 0;
    std::uint64_t leaves = 0;
    Colors colors;
};

ThesisFile readThesis(const std::string& bytes) {
    constexpr std::size_t kMaterial = 60, kColorInMaterial = 44;
    ThesisFile file;
    const std::size_t materials = valueAt<std::uint32_t>(bytes, 0) / kMaterial;
    const std::size_t info = 4 + kMaterial * materials;
    file.leaves = valueAt<std::uint32_t>(bytes, info);
    const std::uint32_t depth = valueAt<std::uint32_t>(bytes, info + 4);
    const std::size_t attachments = info + 44 + 24;
    file.nodes = valueAt<std::uint64_t>(bytes, attachments + 4 * file.leaves) / 4;
    const std::size_t lookups = attachments + 4 * file.leaves + 8;
    const std::size_t descriptors = lookups + 4 * file.nodes + 24;

    const auto colorOf = [&](std::size_t attachment) {
        const std::size_t m = valueAt<std::uint32_t>(bytes, attachments + 4 * attachment);
        Rgba rgba;
        for (std::size_t c = 0; c < 4; ++c) {
            const float value = valueAt<float>(bytes, 4 + kMaterial * m + kColorInMaterial + 4 * c);
            rgba[c] = static_cast<int>(std::lround(value * 255.0f));
        }
        return rgba;
    };
    const auto fill = [&](Cell corner, int edge, const Rgba& rgba) {
        for (int z = 0; z < edge; ++z)
            for (int y = 0; y < edge; ++y)
                for (int x = 0; x < edge; ++x) {
                    // The file has x, z, y of its source.
                    file.colors[{corner[0] + x, corner[2] + z, corner[1] + y}] = rgba;
                }
    };
    const auto walk = [&](const auto& self, std::size_t node, std::uint32_t level, Cell corner) -> void {
        const std::size_t at = descriptors + 8 * node;
        const unsigned leaf = valueAt<std::uint8_t>(bytes, at);
        const unsigned valid = valueAt<std::uint8_t>(bytes, at + 1);
        std::size_t child = node + valueAt<std::uint32_t>(bytes, at + 4);
        std::size_t attachment = valueAt<std::uint32_t>(bytes, lookups + 4 * node) >> 8;
        const int edge = 1 << (depth - level);
        for (unsigned slot = 0; slot < 8; ++slot) {
            if (((valid >> slot) & 1u) == 0) continue;
            const int k = static_cast<int>(slot);
            const Cell p{corner[0] + (k & 1) * edge, corner[1] + (k >> 1 & 1) * edge,
                         corner[2] + (k >> 2) * edge};
            if (((leaf >> slot) & 1u) != 0) {
                fill(p, edge, colorOf(attachment++));
            } else {
                self(self, child++, level + 1, p);
            }
        }
    };
    walk(walk, 0, 1, {0, 0, 0});
    return file;
}

Colors readSource(const std::filesystem::path& vox) {
    Colors colors;
    for (const auto& instance : IndependentVoxReader(readText(vox)).instances()) {
        for (const auto& [cell, look] : instance.worldCells) colors[cell] = look.rgba;
    }
    return colors;
}

/// The same cells with the lower corner of their box in the origin.
Colors movedToOrigin(const Colors& colors) {
    Cell low{INT32_MAX, INT32_MAX, INT32_MAX};
    for (const auto& [cell, rgba] : colors)
        for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], cell[a]);
    Colors moved;
    for (const auto& [cell, rgba] : colors) {
        moved.emplace(Cell{cell[0] - low[0], cell[1] - low[1], cell[2] - low[2]}, rgba);
    }
    return moved;
}

/// Our octree of a source, after a round trip through a .pf_vox file.
OctreeAsset convert(const std::filesystem::path& vox) {
    DiagnosticList diagnostics;
    VoxelAsset asset = importFile(vox, {.merge = true}, Limits{}, diagnostics).value();
    compactMaterials(asset);
    const OctreeAsset octrees = buildOctrees(asset, Limits{}).value();
    return decodePfVox(encodePfVox(octrees, {}).value(), Limits{}, diagnostics).value();
}

/// Every voxel by descending from the root.
Colors readOctree(const OctreeAsset& asset) {
    Colors colors;
    const OctreeModel& model = asset.models.at(0);
    for (int z = model.bounds.min.z; z < model.bounds.max.z; ++z)
        for (int y = model.bounds.min.y; y < model.bounds.max.y; ++y)
            for (int x = model.bounds.min.x; x < model.bounds.max.x; ++x) {
                const auto material = model.at({x, y, z});
                if (!material) continue;
                const glm::ivec4 c{asset.materials.at(*material).baseColor};
                colors[{x, -z - 1, y}] = {c.r, c.g, c.b, c.a};
            }
    return colors;
}

struct Sums {
    std::uint64_t pairs = 0, voxels = 0, changedByThesis = 0;
    std::uint64_t thesisNodes = 0, thesisLeaves = 0, nodes = 0, leaves = 0;
};

void comparePair(const std::filesystem::path& legacy, const std::filesystem::path& vox, Sums& sums) {
    const ThesisFile thesis = readThesis(readText(legacy));
    const Colors expected = movedToOrigin(readSource(vox));
    const OctreeAsset asset = convert(vox);
    const Colors ours = movedToOrigin(readOctree(asset));
    const Colors theirs = movedToOrigin(thesis.colors);

    ASSERT_FALSE(expected.empty());
    EXPECT_TRUE(std::ranges::equal(ours, theirs, {}, &Colors::value_type::first, &Colors::value_type::first))
        << ours.size() << " voxels, the thesis has " << theirs.size();
    EXPECT_TRUE(ours == expected) << "a voxel has another color than in the source";
    for (const auto& [cell, rgba] : theirs) {
        const auto source = expected.find(cell);
        if (source != expected.end() && source->second != rgba) ++sums.changedByThesis;
    }
    const OctreeStatistics s = statistics(asset.models[0], asset.materials.size());
    ++sums.pairs;
    sums.voxels += ours.size();
    sums.thesisNodes += thesis.nodes;
    sums.thesisLeaves += thesis.leaves;
    sums.nodes += s.nodes;
    sums.leaves += s.leaves;
}

TEST(LegacyAcceptance, SameVoxelsTrueColorsFewerNodesAndLeaves) {
    const auto files = corpusFiles("legacy", ".pf_vox");
    if (files.empty()) {
        GTEST_SKIP()
            << "corpus/legacy is absent: no pairs to compare (set PFVOX_CORPUS_DIR to the corpus folder)";
    }
    Sums sums;
    for (const auto& file : files) {
        const auto vox =
            std::filesystem::path(PFVOX_CORPUS_DIR) / "vox" / "mmmm" / file.stem().concat(".vox");
        SCOPED_TRACE(file.filename());
        ASSERT_TRUE(std::filesystem::exists(vox)) << "the source of this file is missing";
        ASSERT_NO_FATAL_FAILURE(comparePair(file, vox, sums));
    }
    EXPECT_LT(sums.leaves, sums.thesisLeaves);
    EXPECT_LT(sums.nodes, sums.thesisNodes);
    const auto show = [](const char* name, std::uint64_t value) {
        testing::Test::RecordProperty(name, std::to_string(value));
        std::cout << "    " << name << " = " << value << '\n';
    };
    show("pairs", sums.pairs);
    show("voxels", sums.voxels);
    show("voxels_that_the_thesis_recolored", sums.changedByThesis);
    show("leaves_of_the_thesis", sums.thesisLeaves);
    show("leaves", sums.leaves);
    show("nodes_of_the_thesis", sums.thesisNodes);
    show("nodes", sums.nodes);
}

}  // namespace
}  // namespace pfvox::test

#include "import/vdb/grid_colors.hpp"

#include <pfvox/assert.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "import/color_palette.hpp"
#include "shared/color.glsl.h"

namespace pfvox::import::vdb {

namespace {

/// Linear values at which the sRGB byte steps up: a search in them is exact and faster than a power.
std::array<float, 255> makeSteps() {
    std::array<float, 255> steps{};
    for (std::size_t i = 0; i < steps.size(); ++i) {
        steps[i] = static_cast<float>(shared::linearFromSrgb((static_cast<double>(i) + 0.5) / 255.0));
    }
    return steps;
}

template <class Vec3>
glm::u8vec3 colorOf(const Vec3& value) {
    return {srgbByteOf(static_cast<float>(value[0])), srgbByteOf(static_cast<float>(value[1])),
            srgbByteOf(static_cast<float>(value[2]))};
}

template <class Vec3>
bool isClamped(const Vec3& value) {
    const auto isInside = [](double c) { return c >= 0.0 && c <= 1.0; };
    return !(isInside(static_cast<double>(value[0])) && isInside(static_cast<double>(value[1])) &&
             isInside(static_cast<double>(value[2])));
}

/// What a tree holds, tiles and inactive values included; only active ones count as clamped.
template <class TreeT>
ColorPalette collect(const TreeT& tree, std::uint64_t& clamped) {
    ColorPalette palette(kMaxGridColors);
    palette.add(colorOf(tree.background()));
    auto tiles = tree.cbeginValueAll();
    tiles.setMaxDepth(tiles.getLeafDepth() - 1);
    for (; tiles; ++tiles) {
        palette.add(colorOf(*tiles));
        if (tiles.isValueOn() && isClamped(*tiles)) ++clamped;
    }
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
        for (std::uint32_t i = 0; i < kBrickVoxels; ++i) {
            palette.add(colorOf(leaf->getValue(i)));
            if (leaf->isValueOn(i) && isClamped(leaf->getValue(i))) ++clamped;
        }
    }
    palette.finish();
    return palette;
}

template <class GridT>
class GridShader final : public Shader {
  public:
    using Tree = typename GridT::TreeType;
    using Leaf = typename Tree::LeafNodeType;
    using Lower = typename Tree::RootNodeType::ChildNodeType::ChildNodeType;
    using Upper = typename Tree::RootNodeType::ChildNodeType;

    GridShader(typename GridT::ConstPtr grid, ColorPalette palette, MaterialIndex firstMaterial)
        : grid_(std::move(grid)), palette_(std::move(palette)), first_(firstMaterial) {}

    void shadeLeaf(const openvdb::Coord& origin, LeafMaterials& out) const override {
        const Leaf* leaf = grid_->tree().probeConstLeaf(origin);
        if (leaf == nullptr) {
            out.fill(materialOf(grid_->tree().getValue(origin)));
            return;
        }
        for (std::uint32_t i = 0; i < kBrickVoxels; ++i) out[i] = materialOf(leaf->getValue(i));
    }

    std::optional<MaterialIndex> shadeTile(const openvdb::Coord& corner, int edgeLog2) const override {
        const Tree& tree = grid_->tree();
        const bool divided = edgeLog2 == Leaf::TOTAL ? tree.template probeConstNode<Leaf>(corner) != nullptr
                             : edgeLog2 == Lower::TOTAL
                                 ? tree.template probeConstNode<Lower>(corner) != nullptr
                                 : tree.template probeConstNode<Upper>(corner) != nullptr;
        if (divided) return std::nullopt;
        return materialOf(tree.getValue(corner));
    }

  private:
    MaterialIndex materialOf(const typename GridT::ValueType& value) const {
        return static_cast<MaterialIndex>(first_ + palette_.indexOf(colorOf(value)));
    }

    typename GridT::ConstPtr grid_;
    ColorPalette palette_;
    MaterialIndex first_;
};

template <class GridT>
GridColors makeColors(const openvdb::GridBase::ConstPtr& base, MaterialIndex firstMaterial) {
    auto grid = openvdb::gridConstPtrCast<GridT>(base);
    GridColors colors;
    ColorPalette palette = collect(grid->tree(), colors.clampedValues);
    colors.distinctColors = palette.distinctColors();
    for (const glm::u8vec3 color : palette.colors()) {
        Material material;
        material.baseColor = glm::u8vec4{color, 255};
        colors.materials.push_back(std::move(material));
    }
    colors.shader = std::make_unique<GridShader<GridT>>(std::move(grid), std::move(palette), firstMaterial);
    return colors;
}

}  // namespace

std::uint8_t srgbByteOf(float linear) {
    static const std::array<float, 255> kSteps = makeSteps();
    if (!(linear > 0.0f)) return 0;
    return static_cast<std::uint8_t>(std::ranges::upper_bound(kSteps, linear) - kSteps.begin());
}

openvdb::GridBase::Ptr joinChannels(const openvdb::FloatGrid& red, const openvdb::FloatGrid& green,
                                    const openvdb::FloatGrid& blue) {
    const openvdb::Vec3s background(red.background(), green.background(), blue.background());
    auto tree = std::make_shared<openvdb::Vec3STree>(red.tree(), background, openvdb::TopologyCopy());
    // The union is as fine as the finest of the three, so that one value holds for a whole tile.
    tree->topologyUnion(green.tree());
    tree->topologyUnion(blue.tree());
    const auto r = red.getConstAccessor();
    const auto g = green.getConstAccessor();
    const auto b = blue.getConstAccessor();
    for (auto value = tree->beginValueOn(); value; ++value) {
        const openvdb::Coord at = value.getCoord();
        value.setValue(openvdb::Vec3s(r.getValue(at), g.getValue(at), b.getValue(at)));
    }
    auto grid = openvdb::Vec3SGrid::create(tree);
    grid->setTransform(red.transform().copy());
    grid->setName(red.getName());
    return grid;
}

GridColors makeGridColors(const openvdb::GridBase::ConstPtr& grid, MaterialIndex firstMaterial) {
    if (grid->isType<openvdb::Vec3SGrid>()) return makeColors<openvdb::Vec3SGrid>(grid, firstMaterial);
    PFVOX_ASSERT(grid->isType<openvdb::Vec3DGrid>());
    return makeColors<openvdb::Vec3DGrid>(grid, firstMaterial);
}

}  // namespace pfvox::import::vdb

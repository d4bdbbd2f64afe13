#include "vox_writer.hpp"

#include <array>
#include <limits>

#include "export/vox_writer.hpp"

namespace pfvox::demo {

int Rotation::code() const {
    int bits = column.x | (column.y << 2);
    for (int row = 0; row < 3; ++row) bits |= (sign[row] < 0 ? 1 : 0) << (4 + row);
    return bits;
}

Rotation turned(int quarters) {
    switch (((quarters % 4) + 4) % 4) {
        case 1:
            return {.column = {1, 0, 2}, .sign = {-1, 1, 1}};
        case 2:
            return {.column = {0, 1, 2}, .sign = {-1, -1, 1}};
        case 3:
            return {.column = {1, 0, 2}, .sign = {1, -1, 1}};
        default:
            return {};
    }
}

Rotation mirroredX() {
    return {.column = {0, 1, 2}, .sign = {-1, 1, 1}};
}

Node placeAtCorner(const std::string& name, int model, glm::ivec3 modelSize, glm::ivec3 corner,
                   Rotation rotation) {
    // Voxel p lands at floor(R * (p + 1/2 - size/2) + t); doubled to stay with whole numbers.
    const glm::ivec3 middle = modelSize / 2;
    glm::ivec3 lowest{std::numeric_limits<int>::max()};
    for (const glm::ivec3 p : {glm::ivec3{0}, modelSize - 1}) {
        const glm::ivec3 doubled = rotation * (2 * (p - middle) + 1);
        for (int axis = 0; axis < 3; ++axis) lowest[axis] = std::min(lowest[axis], (doubled[axis] - 1) / 2);
    }
    return {
        .name = name, .model = model, .children = {}, .rotation = rotation, .translation = corner - lowest};
}

namespace {

using vox_file::VoxDict;
using vox_file::VoxVoxel;
using vox_file::VoxWriter;

void writeModel(VoxWriter& out, const Canvas& model) {
    std::vector<VoxVoxel> voxels;
    for (int z = 0; z < model.size().z; ++z) {
        for (int y = 0; y < model.size().y; ++y) {
            for (int x = 0; x < model.size().x; ++x) {
                const auto byte = [](int v) { return static_cast<std::uint8_t>(v); };
                if (const std::uint8_t index = model.at({x, y, z}))
                    voxels.push_back({byte(x), byte(y), byte(z), index});
            }
        }
    }
    out.model({model.size().x, model.size().y, model.size().z}, voxels);
}

/// Numbers the nodes in the order in which MagicaVoxel does: parents first.
class GraphWriter {
  public:
    explicit GraphWriter(VoxWriter& out) : out_(out) {}

    void write(const std::vector<Node>& nodes) { transform(Node{.name = "", .children = nodes}, true); }

  private:
    void transform(const Node& node, bool isRoot) {
        const int id = nextId_++;
        out_.transform({.id = id,
                        .child = nextId_,  // it is written next
                        .frames = {isRoot ? VoxDict{} : placement(node)},
                        .attributes = node.name.empty() ? VoxDict{} : VoxDict{{"_name", node.name}},
                        .layer = isRoot ? -1 : node.layer});
        if (node.model >= 0) {
            out_.shape({.id = nextId_++, .models = {{node.model, {}}}});
        } else {
            group(node.children);
        }
    }

    void group(const std::vector<Node>& nodes) {
        // Ids of the children depend on the size of the subtrees before them, so these are written aside
        // first.
        const int id = nextId_++;
        VoxWriter subtrees;
        GraphWriter writer(subtrees);
        writer.nextId_ = nextId_;
        std::vector<std::int32_t> children;
        for (const Node& node : nodes) {
            children.push_back(writer.nextId_);
            writer.transform(node, false);
        }
        nextId_ = writer.nextId_;
        out_.group(id, children).append(subtrees);
    }

    static VoxDict placement(const Node& node) {
        VoxDict attributes;
        constexpr int kIdentity = 4;
        if (const int code = node.rotation.code(); code != kIdentity) {
            attributes.emplace_back("_r", std::to_string(code));
        }
        const glm::ivec3 t = node.translation;
        attributes.emplace_back("_t",
                                std::to_string(t.x) + " " + std::to_string(t.y) + " " + std::to_string(t.z));
        return attributes;
    }

    VoxWriter& out_;
    int nextId_ = 0;
};

void writePalette(VoxWriter& out, const Palette& palette) {
    std::array<std::array<std::uint8_t, 4>, 256> colors;
    for (int index = 1; index <= 256; ++index) {
        const Color color = palette.color(index);
        colors[static_cast<std::size_t>(index - 1)] = {color.r, color.g, color.b, 255};
    }
    out.palette(colors);
    for (const auto& [index, attributes] : palette.materials()) out.material(index, attributes);
}

}  // namespace

std::string writeVox(const VoxScene& scene, const Palette& palette) {
    VoxWriter file;
    for (const Canvas& model : scene.models) writeModel(file, model);
    if (!scene.nodes.empty()) GraphWriter(file).write(scene.nodes);
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        VoxDict attributes{{"_name", scene.layers[i].name}};
        if (scene.layers[i].hidden) attributes.emplace_back("_hidden", "1");
        file.layer(static_cast<int>(i), attributes);
    }
    writePalette(file, palette);
    return file.finish();
}

}  // namespace pfvox::demo

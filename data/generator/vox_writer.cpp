#include "vox_writer.hpp"

#include <limits>

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

constexpr std::int32_t kVersion = 150;

class Bytes {
  public:
    void int32(std::int32_t value) {
        const auto bits = static_cast<std::uint32_t>(value);
        for (unsigned shift = 0; shift < 32; shift += 8)
            data.push_back(static_cast<std::uint8_t>(bits >> shift));
    }
    void text(const std::string& s) { data.insert(data.end(), s.begin(), s.end()); }
    void string(const std::string& s) {
        int32(static_cast<std::int32_t>(s.size()));
        text(s);
    }
    void dict(const std::vector<std::pair<std::string, std::string>>& entries) {
        int32(static_cast<std::int32_t>(entries.size()));
        for (const auto& [key, value] : entries) {
            string(key);
            string(value);
        }
    }
    void chunk(const std::string& id, const Bytes& content) {
        text(id);
        int32(static_cast<std::int32_t>(content.data.size()));
        int32(0);
        data.insert(data.end(), content.data.begin(), content.data.end());
    }

    std::vector<std::uint8_t> data;
};

void writeModel(Bytes& out, const Canvas& model) {
    Bytes size;
    for (int axis = 0; axis < 3; ++axis) size.int32(model.size()[axis]);
    out.chunk("SIZE", size);

    Bytes voxels;
    std::int32_t count = 0;
    for (int z = 0; z < model.size().z; ++z) {
        for (int y = 0; y < model.size().y; ++y) {
            for (int x = 0; x < model.size().x; ++x) {
                const std::uint8_t index = model.at({x, y, z});
                if (index == 0) continue;
                for (const int v : {x, y, z}) voxels.data.push_back(static_cast<std::uint8_t>(v));
                voxels.data.push_back(index);
                ++count;
            }
        }
    }
    Bytes content;
    content.int32(count);
    content.data.insert(content.data.end(), voxels.data.begin(), voxels.data.end());
    out.chunk("XYZI", content);
}

/// Numbers the nodes in the order in which MagicaVoxel does: parents first.
class GraphWriter {
  public:
    explicit GraphWriter(Bytes& out) : out_(out) {}

    void write(const std::vector<Node>& nodes) { transform(Node{.name = "", .children = nodes}, true); }

  private:
    void transform(const Node& node, bool isRoot) {
        const int id = nextId_++;
        Bytes content;
        content.int32(id);
        content.dict(node.name.empty() ? Attributes{} : Attributes{{"_name", node.name}});
        content.int32(nextId_);  // the child is written next
        content.int32(-1);
        content.int32(isRoot ? -1 : node.layer);
        content.int32(1);
        content.dict(isRoot ? Attributes{} : placement(node));
        out_.chunk("nTRN", content);
        if (node.model >= 0) {
            shape(node.model);
        } else {
            group(node.children);
        }
    }

    void group(const std::vector<Node>& children) {
        // Ids of the children depend on the size of the subtrees before them, so these are written aside
        // first.
        const int id = nextId_++;
        Bytes subtrees;
        GraphWriter writer(subtrees);
        writer.nextId_ = nextId_;
        Bytes content;
        content.int32(id);
        content.dict({});
        content.int32(static_cast<std::int32_t>(children.size()));
        for (const Node& child : children) {
            content.int32(writer.nextId_);
            writer.transform(child, false);
        }
        nextId_ = writer.nextId_;
        out_.chunk("nGRP", content);
        out_.data.insert(out_.data.end(), subtrees.data.begin(), subtrees.data.end());
    }

    void shape(int model) {
        Bytes content;
        content.int32(nextId_++);
        content.dict({});
        content.int32(1);
        content.int32(model);
        content.dict({});
        out_.chunk("nSHP", content);
    }

    using Attributes = std::vector<std::pair<std::string, std::string>>;

    static Attributes placement(const Node& node) {
        Attributes attributes;
        constexpr int kIdentity = 4;
        if (const int code = node.rotation.code(); code != kIdentity) {
            attributes.emplace_back("_r", std::to_string(code));
        }
        const glm::ivec3 t = node.translation;
        attributes.emplace_back("_t",
                                std::to_string(t.x) + " " + std::to_string(t.y) + " " + std::to_string(t.z));
        return attributes;
    }

    Bytes& out_;
    int nextId_ = 0;
};

void writeLayers(Bytes& out, const std::vector<LayerText>& layers) {
    for (std::size_t i = 0; i < layers.size(); ++i) {
        Bytes content;
        content.int32(static_cast<std::int32_t>(i));
        if (layers[i].hidden) {
            content.dict({{"_name", layers[i].name}, {"_hidden", "1"}});
        } else {
            content.dict({{"_name", layers[i].name}});
        }
        content.int32(-1);
        out.chunk("LAYR", content);
    }
}

void writePalette(Bytes& out, const Palette& palette) {
    Bytes colors;
    for (int index = 1; index <= 256; ++index) {
        const Color color = palette.color(index);
        for (const std::uint8_t v : {color.r, color.g, color.b, std::uint8_t{255}}) colors.data.push_back(v);
    }
    out.chunk("RGBA", colors);
    for (const auto& [index, attributes] : palette.materials()) {
        Bytes content;
        content.int32(index);
        content.dict(attributes);
        out.chunk("MATL", content);
    }
}

}  // namespace

std::vector<std::uint8_t> writeVox(const VoxScene& scene, const Palette& palette) {
    Bytes children;
    for (const Canvas& model : scene.models) writeModel(children, model);
    if (!scene.nodes.empty()) GraphWriter(children).write(scene.nodes);
    writeLayers(children, scene.layers);
    writePalette(children, palette);

    Bytes file;
    file.text("VOX ");
    file.int32(kVersion);
    file.text("MAIN");
    file.int32(0);
    file.int32(static_cast<std::int32_t>(children.data.size()));
    file.data.insert(file.data.end(), children.data.begin(), children.data.end());
    return std::move(file.data);
}

}  // namespace pfvox::demo

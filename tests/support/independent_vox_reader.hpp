// A second reader of MagicaVoxel files, for tests only: slow, obvious, and without a line in common with the
// importer. It trusts the file (only well-formed ones are given to it), multiplies rotations as plain 3 x 3
// matrices and places voxels by the integer formula of docs/import.md.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace pfvox::test {

using Cell = std::array<int, 3>;

/// Color and material type of a voxel, as one value that can be compared and counted.
struct VoxelLook {
    std::array<int, 4> rgba{};
    std::string type;
    auto operator<=>(const VoxelLook&) const = default;
};

class IndependentVoxReader {
  public:
    struct Model {
        Cell size{};
        std::map<Cell, int> indexAt;  // the last of equal places, without index 0
    };
    struct Instance {
        int model = 0;
        std::vector<std::pair<Cell, VoxelLook>> worldCells;  // VOX axes, z up
    };

    explicit IndependentVoxReader(std::string bytes) : bytes_(std::move(bytes)) {
        if (bytes_.substr(0, 4) != "VOX " || bytes_.substr(8, 4) != "MAIN")
            throw std::runtime_error("not a .vox");
        std::size_t at = 20 + number(12);
        const std::size_t end = at + number(16);
        Cell size{};
        while (at < end) {
            const std::string id = bytes_.substr(at, 4);
            const std::size_t content = at + 12;
            at_ = content;
            if (id == "SIZE") {
                for (int& edge : size) edge = nextInt();
            } else if (id == "XYZI") {
                readModel(size);
            } else if (id == "RGBA") {
                hasPalette_ = true;
                for (unsigned i = 0; i < 255; ++i) {
                    for (unsigned c = 0; c < 4; ++c) {
                        palette_[static_cast<int>(i + 1)][c] = static_cast<int>(byteAt(content + 4 * i + c));
                    }
                }
            } else if (id == "MATL") {
                const int slot = nextInt() % 256;
                const auto properties = nextDict();
                types_[slot] = properties.count("_type") != 0 ? properties.at("_type") : "_diffuse";
            } else if (id == "LAYR") {
                const int layer = nextInt();
                const auto attributes = nextDict();
                layerHidden_[layer] = is(attributes, "_hidden", "1") || is(attributes, "_visible", "0");
            } else if (id == "nTRN" || id == "nGRP" || id == "nSHP") {
                readNode(id);
            }
            at = content + number(content - 8) + number(content - 4);
        }
    }

    const std::vector<Model>& models() const { return models_; }

    /// Visible instances at frame 0, in depth-first order.
    std::vector<Instance> instances() const {
        std::vector<Instance> result;
        bool anyShape = false;
        for (const auto& [id, node] : nodes_) anyShape = anyShape || node.kind == "nSHP";
        if (anyShape) {
            follow(0, kUnit, {0, 0, 0}, false, result);
        } else {
            const std::size_t count = nodes_.empty() ? 1 : models_.size();
            for (std::size_t m = 0; m < count && m < models_.size(); ++m) {
                Instance instance{int(m), {}};
                const auto& size = models_[m].size;
                for (const auto& [p, index] : models_[m].indexAt) {
                    // The middle voxel comes to lie in the origin.
                    const Cell cell{p[0] - size[0] / 2, p[1] - size[1] / 2, p[2] - size[2] / 2};
                    instance.worldCells.push_back({cell, look(index)});
                }
                result.push_back(instance);
            }
        }
        return result;
    }

    VoxelLook look(int index) const {
        const auto type = types_.find(index);
        VoxelLook result{{}, type == types_.end() ? "_diffuse" : type->second};
        result.rgba = hasPalette_ ? palette_.at(index) : defaultColor(index);
        return result;
    }

    /// Written out from the sentence that describes it, to compare the importer's rule with.
    static std::array<int, 4> defaultColor(int index) {
        static const int levels[6] = {0xff, 0xcc, 0x99, 0x66, 0x33, 0x00};
        static const int ramp[10] = {0xee, 0xdd, 0xbb, 0xaa, 0x88, 0x77, 0x55, 0x44, 0x22, 0x11};
        const int n = index - 1;
        if (n < 215) return {levels[n / 36], levels[n / 6 % 6], levels[n % 6], 255};
        const int hue = (n - 215) / 10;
        const int level = ramp[(n - 215) % 10];
        return {hue == 0 || hue == 3 ? level : 0, hue == 1 || hue == 3 ? level : 0, hue >= 2 ? level : 0,
                255};
    }

  private:
    using Matrix = std::array<std::array<int, 3>, 3>;
    static constexpr Matrix kUnit{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    struct Node {
        std::string kind;
        bool hidden = false;
        int layer = -1;
        Matrix rotation = kUnit;
        Cell translation{};
        std::vector<int> children;
        int model = -1;
    };

    unsigned byteAt(std::size_t at) const { return static_cast<unsigned char>(bytes_.at(at)); }
    std::size_t number(std::size_t at) const {
        return byteAt(at) + 256u * byteAt(at + 1) + 65536u * byteAt(at + 2) + 16777216u * byteAt(at + 3);
    }
    int nextInt() {
        at_ += 4;
        return static_cast<int>(static_cast<std::uint32_t>(number(at_ - 4)));
    }
    std::string nextString() {
        const auto length = static_cast<std::size_t>(nextInt());
        at_ += length;
        return bytes_.substr(at_ - length, length);
    }
    std::map<std::string, std::string> nextDict() {
        std::map<std::string, std::string> dict;
        for (int left = nextInt(); left > 0; --left) {
            const std::string key = nextString();
            dict[key] = nextString();
        }
        return dict;
    }
    static bool is(const std::map<std::string, std::string>& dict, const std::string& key,
                   const std::string& value) {
        return dict.count(key) != 0 && dict.at(key) == value;
    }

    void readModel(Cell size) {
        Model model{size, {}};
        for (int left = nextInt(); left > 0; --left, at_ += 4) {
            const Cell p{int(byteAt(at_)), int(byteAt(at_ + 1)), int(byteAt(at_ + 2))};
            const int index = int(byteAt(at_ + 3));
            if (index != 0 && p[0] < size[0] && p[1] < size[1] && p[2] < size[2]) model.indexAt[p] = index;
        }
        models_.push_back(model);
    }

    void readNode(const std::string& kind) {
        const int id = nextInt();
        Node node;
        node.kind = kind;
        node.hidden = is(nextDict(), "_hidden", "1");
        if (kind == "nTRN") {
            node.children = {nextInt()};
            nextInt();
            node.layer = nextInt();
            if (nextInt() > 0) {
                const auto frame = nextDict();
                if (frame.count("_r") != 0) node.rotation = matrixOf(std::stoi(frame.at("_r")));
                if (frame.count("_t") != 0) {
                    std::sscanf(frame.at("_t").c_str(), "%d %d %d", &node.translation[0],
                                &node.translation[1], &node.translation[2]);
                }
            }
        } else if (kind == "nGRP") {
            for (int left = nextInt(); left > 0; --left) node.children.push_back(nextInt());
        } else if (nextInt() > 0) {
            node.model = nextInt();
        }
        nodes_[id] = node;
    }

    static Matrix matrixOf(int byte) {
        Matrix m{};
        const int a = byte & 3;
        const int b = byte / 4 & 3;
        m[0][std::size_t(a)] = byte & 16 ? -1 : 1;
        m[1][std::size_t(b)] = byte & 32 ? -1 : 1;
        m[2][std::size_t(3 - a - b)] = byte & 64 ? -1 : 1;
        return m;
    }

    static Cell times(const Matrix& m, const Cell& v) {
        Cell result{};
        for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t c = 0; c < 3; ++c) result[r] += m[r][c] * v[c];
        }
        return result;
    }

    void follow(int id, const Matrix& rotation, const Cell& t, bool hidden,
                std::vector<Instance>& result) const {
        const Node& node = nodes_.at(id);
        hidden =
            hidden || node.hidden || (layerHidden_.count(node.layer) != 0 && layerHidden_.at(node.layer));
        if (node.kind == "nSHP") {
            if (!hidden && node.model >= 0) result.push_back(place(node.model, rotation, t));
            return;
        }
        Matrix turned{};
        for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t c = 0; c < 3; ++c) {
                for (std::size_t k = 0; k < 3; ++k) turned[r][c] += rotation[r][k] * node.rotation[k][c];
            }
        }
        Cell moved = times(rotation, node.translation);
        for (std::size_t k = 0; k < 3; ++k) moved[k] += t[k];
        for (const int child : node.children) follow(child, turned, moved, hidden, result);
    }

    Instance place(int modelId, const Matrix& rotation, const Cell& t) const {
        Instance instance{modelId, {}};
        const Model& model = models_.at(std::size_t(modelId));
        for (const auto& [p, index] : model.indexAt) {
            Cell q{};
            for (std::size_t k = 0; k < 3; ++k) q[k] = 2 * (p[k] - model.size[k] / 2) + 1;
            const Cell turned = times(rotation, q);
            Cell w{};
            for (std::size_t k = 0; k < 3; ++k) w[k] = int(std::floor((turned[k] + 2 * t[k]) / 2.0));
            instance.worldCells.push_back({w, look(index)});
        }
        return instance;
    }

    std::string bytes_;
    std::size_t at_ = 0;
    std::vector<Model> models_;
    std::map<int, Node> nodes_;
    std::map<int, std::string> types_;
    std::map<int, bool> layerHidden_;
    std::map<int, std::array<int, 4>> palette_;
    bool hasPalette_ = false;
};

}  // namespace pfvox::test

// VoxWriter: makes the bytes of .vox files for tests, right or wrong ones: it checks nothing.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace pfvox::test {

using VoxDict = std::vector<std::pair<std::string, std::string>>;
/// x, y, z and palette index.
using VoxVoxel = std::array<std::uint8_t, 4>;

template <class Number>
std::string voxBytes(Number number) {
    std::string bytes(sizeof(Number), '\0');
    std::memcpy(bytes.data(), &number, sizeof(Number));
    return bytes;
}

inline std::string voxInts(const std::vector<std::int32_t>& numbers) {
    std::string bytes;
    for (const std::int32_t number : numbers) bytes += voxBytes(number);
    return bytes;
}

inline std::string voxString(const std::string& text) {
    return voxBytes(static_cast<std::int32_t>(text.size())) + text;
}

inline std::string voxDict(const VoxDict& dict) {
    std::string bytes = voxBytes(static_cast<std::int32_t>(dict.size()));
    for (const auto& [key, value] : dict) bytes += voxString(key) + voxString(value);
    return bytes;
}

inline std::string voxChunk(const std::string& id, const std::string& content,
                            const std::string& children = {}) {
    return id + voxBytes(static_cast<std::int32_t>(content.size())) +
           voxBytes(static_cast<std::int32_t>(children.size())) + content + children;
}

class VoxWriter {
  public:
    struct Transform {
        int id = 0;
        int child = 1;
        std::vector<VoxDict> frames{{}};
        VoxDict attributes{};
        int layer = -1;
    };
    struct Shape {
        int id = 1;
        std::vector<std::pair<int, VoxDict>> models{{0, {}}};
        VoxDict attributes{};
    };

    VoxWriter& chunk(const std::string& id, const std::string& content) {
        chunks_ += voxChunk(id, content);
        return *this;
    }
    VoxWriter& model(const std::array<std::int32_t, 3>& size, const std::vector<VoxVoxel>& voxels) {
        chunk("SIZE", voxInts({size[0], size[1], size[2]}));
        std::string list = voxBytes(static_cast<std::int32_t>(voxels.size()));
        for (const VoxVoxel& voxel : voxels) list += voxBytes(voxel);
        return chunk("XYZI", list);
    }
    VoxWriter& transform(const Transform& t) {
        std::string content = voxBytes(t.id) + voxDict(t.attributes) +
                              voxInts({t.child, -1, t.layer, static_cast<std::int32_t>(t.frames.size())});
        for (const VoxDict& frame : t.frames) content += voxDict(frame);
        return chunk("nTRN", content);
    }
    VoxWriter& group(int id, const std::vector<std::int32_t>& children, const VoxDict& attributes = {}) {
        return chunk("nGRP", voxBytes(id) + voxDict(attributes) +
                                 voxBytes(static_cast<std::int32_t>(children.size())) + voxInts(children));
    }
    VoxWriter& shape(const Shape& s) {
        std::string content =
            voxBytes(s.id) + voxDict(s.attributes) + voxBytes(static_cast<std::int32_t>(s.models.size()));
        for (const auto& [model, attributes] : s.models) content += voxBytes(model) + voxDict(attributes);
        return chunk("nSHP", content);
    }
    VoxWriter& material(int id, const VoxDict& properties) {
        return chunk("MATL", voxBytes(id) + voxDict(properties));
    }
    VoxWriter& layer(int id, const VoxDict& attributes) {
        return chunk("LAYR", voxBytes(id) + voxDict(attributes) + voxBytes(-1));
    }

    std::string finish(std::int32_t version = 150) const {
        return "VOX " + voxBytes(version) + voxChunk("MAIN", {}, chunks_);
    }

  private:
    std::string chunks_;
};

}  // namespace pfvox::test

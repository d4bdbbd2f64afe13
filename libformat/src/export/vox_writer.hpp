// VoxWriter: the bytes of .vox files, chunk by chunk. The exporter, the demo sources, the benchmarks and the
// tests write with it; it checks nothing, so that tests can write what no program should. z is up, as in
// MagicaVoxel.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pfvox::vox_file {

using VoxDict = std::vector<std::pair<std::string, std::string>>;
/// x, y, z and palette index, from 1 on.
using VoxVoxel = std::array<std::uint8_t, 4>;

template <class Number>
std::string voxBytes(Number number) {
    static_assert(std::endian::native == std::endian::little);
    std::string bytes(sizeof(Number), '\0');
    std::memcpy(bytes.data(), &number, sizeof(Number));
    return bytes;
}

inline std::string voxInts(std::span<const std::int32_t> numbers) {
    std::string bytes;
    for (const std::int32_t number : numbers) bytes += voxBytes(number);
    return bytes;
}
inline std::string voxInts(std::initializer_list<std::int32_t> numbers) {
    return voxInts(std::span(numbers.begin(), numbers.size()));
}

inline std::string voxString(std::string_view text) {
    return voxBytes(static_cast<std::int32_t>(text.size())).append(text);
}

inline std::string voxDict(const VoxDict& dict) {
    std::string bytes = voxBytes(static_cast<std::int32_t>(dict.size()));
    for (const auto& [key, value] : dict) bytes += voxString(key) + voxString(value);
    return bytes;
}

inline std::string voxChunk(std::string_view id, std::string_view content, std::string_view children = {}) {
    std::string bytes(id);
    bytes += voxInts({static_cast<std::int32_t>(content.size()), static_cast<std::int32_t>(children.size())});
    return bytes.append(content).append(children);
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

    VoxWriter& chunk(std::string_view id, std::string_view content) {
        chunks_ += voxChunk(id, content);
        return *this;
    }
    VoxWriter& model(const std::array<std::int32_t, 3>& size, const std::vector<VoxVoxel>& voxels) {
        chunk("SIZE", voxInts(size));
        std::string list = voxBytes(static_cast<std::int32_t>(voxels.size()));
        list.append(reinterpret_cast<const char*>(voxels.data()), sizeof(VoxVoxel) * voxels.size());
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
    /// 256 colors: R, G, B, A. The first is that of palette index 1.
    VoxWriter& palette(std::span<const std::array<std::uint8_t, 4>, 256> colors) {
        return chunk("RGBA", {reinterpret_cast<const char*>(colors.data()), colors.size_bytes()});
    }
    VoxWriter& material(int id, const VoxDict& properties) {
        return chunk("MATL", voxBytes(id) + voxDict(properties));
    }
    VoxWriter& layer(int id, const VoxDict& attributes) {
        return chunk("LAYR", voxBytes(id) + voxDict(attributes) + voxBytes(-1));
    }
    /// Everything that `other` holds.
    VoxWriter& append(const VoxWriter& other) {
        chunks_ += other.chunks_;
        return *this;
    }

    std::string finish(std::int32_t version = 150) const {
        return "VOX " + voxBytes(version) + voxChunk("MAIN", {}, chunks_);
    }

  private:
    std::string chunks_;
};

}  // namespace pfvox::vox_file

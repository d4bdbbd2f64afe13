// LegacyWriter: bytes of the thesis program's .pf_vox, for tests. Sizes and pointers follow from the content,
// so that a test damages one thing at a time.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <vector>

#include "support/import_helpers.hpp"

namespace pfvox::test {

struct LegacyWriter {
    struct Material {
        std::uint32_t type = 0;
        float metalness = 0.0f, roughness = 0.0f, specular = 0.0f, indexOfRefraction = 1.0f, flux = 0.0f,
              emission = 0.0f, lowDynamicRange = 0.0f, transparency = 0.0f, alpha = 0.0f, density = 0.0f;
        glm::vec4 color{1.0f};
    };
    struct Node {
        std::uint8_t leafMask = 0;
        std::uint8_t validMask = 0;
    };

    std::vector<Material> materials{Material{}};
    std::uint32_t depth = 1;
    glm::vec3 extent{0.5f};
    glm::vec3 origin{0.0f};
    std::vector<Node> nodes;
    std::vector<std::uint32_t> leafMaterials;

    /// One voxel at the origin of a 2^3 cube.
    static LegacyWriter solidVoxel() {
        LegacyWriter writer;
        writer.nodes = {{.leafMask = 1, .validMask = 1}};
        writer.leafMaterials = {0};
        return writer;
    }

    Bytes bytes() const {
        Bytes out;
        const std::uint64_t n = nodes.size();
        const std::uint64_t l = leafMaterials.size();
        put(out, static_cast<std::uint32_t>(sizeof(Material) * materials.size()));
        for (const Material& m : materials) put(out, m);
        put(out, static_cast<std::uint32_t>(l));
        put(out, depth);
        put(out, glm::vec3{0.0f});
        put(out, extent);
        put(out, origin);
        put(out, 56 + 12 * n + 4 * l);
        put(out, 48 + 12 * n + 4 * l);
        put(out, 4 * l);
        for (const std::uint32_t m : leafMaterials) put(out, m);
        put(out, 4 * n);
        std::uint32_t leaves = 0;
        for (const Node& node : nodes) {
            put(out, std::uint32_t{node.leafMask} | (node.leafMask != 0 ? leaves << 8 : 0u));
            leaves += static_cast<std::uint32_t>(std::popcount(node.leafMask));
        }
        put(out, 24 + 8 * n);
        put(out, static_cast<std::uint32_t>(2 * n));
        put(out, static_cast<std::uint32_t>(3 * n));
        put(out, 8 * n);
        std::uint32_t firstChild = 1;
        for (std::uint32_t i = 0; i < n; ++i) {
            put(out, nodes[i].leafMask);
            put(out, nodes[i].validMask);
            put(out, std::uint16_t{0});
            put(out, firstChild - i);
            firstChild += static_cast<std::uint32_t>(
                std::popcount(static_cast<std::uint8_t>(nodes[i].validMask & ~nodes[i].leafMask)));
        }
        put(out, std::uint64_t{0});
        return out;
    }

  private:
    template <class T>
    static void put(Bytes& out, const T& value) {
        const std::size_t at = out.size();
        out.resize(at + sizeof(T));
        std::memcpy(out.data() + at, &value, sizeof(T));
    }
};

}  // namespace pfvox::test

#include "large_sources.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "export/vox_writer.hpp"
#include "noise.hpp"

namespace pfvox::bench {

namespace {

constexpr int kModelEdge = 256;
constexpr int kTerrainEdge = 2048;
constexpr float kTerrainAmplitude = 120.0f;

using vox_file::VoxVoxel;

/// A scene of models that are only moved.
class VoxScene {
  public:
    /// Returns the number of the model. Edges are at most 256.
    int addModel(glm::ivec3 size, const std::vector<VoxVoxel>& voxels) {
        file_.model({size.x, size.y, size.z}, voxels);
        return models_++;
    }
    /// Places a model with its middle voxel at `translation`.
    void addInstance(int model, glm::ivec3 t) {
        const auto id = static_cast<int>(2 + 2 * children_.size());
        children_.push_back(id);
        const std::string place = std::to_string(t.x) + ' ' + std::to_string(t.y) + ' ' + std::to_string(t.z);
        nodes_.transform({.id = id, .child = id + 1, .frames = {{{"_t", place}}}, .layer = 0});
        nodes_.shape({.id = id + 1, .models = {{model, {}}}});
    }
    void write(const std::filesystem::path& path) {
        if (!children_.empty()) file_.transform({.id = 0, .child = 1}).group(1, children_).append(nodes_);
        finish(path);
    }
    /// With a graph that is one transform node, which is its own child: real files have such.
    void writeWithSelfCycle(const std::filesystem::path& path) {
        file_.transform({.id = 0, .child = 0});
        finish(path);
    }

  private:
    void finish(const std::filesystem::path& path) {
        std::array<std::array<std::uint8_t, 4>, 256> palette;
        for (std::uint32_t i = 0; i < 256; ++i)
            palette[i] =
                std::bit_cast<std::array<std::uint8_t, 4>>(0xff000000u | (i * 0x010306u + 0x102030u));
        const std::string bytes = file_.palette(palette).finish();
        std::ofstream out;
        out.exceptions(std::ios::failbit | std::ios::badbit);
        out.open(path, std::ios::binary | std::ios::trunc);
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }

    vox_file::VoxWriter file_, nodes_;
    int models_ = 0;
    std::vector<std::int32_t> children_;
};

std::uint8_t colorAt(int x, int y, int z) {
    return static_cast<std::uint8_t>(1 + 4 * (hashOf(x >> 6, y >> 6, 0) % 16) + hashOf(x, y, z) % 4);
}

/// Heights [bottom, top) that are filled in the column at (x, y).
struct Column {
    int bottom;
    int top;
};

/// A landscape as a grid of models of 256^3, those without voxels left out.
template <class ColumnAt>
void writeLandscape(const std::filesystem::path& file, int edge, int height, const ColumnAt& columnAt) {
    VoxScene scene;
    std::vector<VoxVoxel> voxels;
    const auto modelAt = [&](glm::ivec3 corner) {
        voxels.clear();
        for (int y = 0; y < kModelEdge; ++y) {
            for (int x = 0; x < kModelEdge; ++x) {
                const Column column = columnAt(corner.x + x, corner.y + y);
                const int end = std::min(column.top - corner.z, kModelEdge);
                for (int z = std::max(column.bottom - corner.z, 0); z < end; ++z) {
                    voxels.push_back({static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                                      static_cast<std::uint8_t>(z),
                                      colorAt(corner.x + x, corner.y + y, corner.z + z)});
                }
            }
        }
        if (voxels.empty()) return;
        const int model = scene.addModel(glm::ivec3{kModelEdge}, voxels);
        scene.addInstance(model, corner + kModelEdge / 2);
    };
    for (int z = 0; z < height; z += kModelEdge)
        for (int y = 0; y < edge; y += kModelEdge)
            for (int x = 0; x < edge; x += kModelEdge) modelAt({x, y, z});
    scene.write(file);
}

/// Heights of all columns of a landscape, made once.
class HeightMap {
  public:
    HeightMap(int edge, float amplitude) : edge_(edge), heights_(index(0, edge)) {
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x)
                heights_[index(x, y)] = static_cast<int>(fractalNoise(x, y, amplitude, 512.0f));
    }
    int at(int x, int y) const { return heights_[index(x, y)]; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(edge_) + static_cast<std::size_t>(x);
    }
    int edge_;
    std::vector<int> heights_;
};

/// A hollow house of this size with windows: a building of the city.
std::vector<VoxVoxel> building(glm::ivec3 size, int kind) {
    std::vector<VoxVoxel> voxels;
    for (int z = 0; z < size.z; ++z) {
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                const bool wall = x == 0 || y == 0 || x == size.x - 1 || y == size.y - 1;
                const bool floor = z % 8 == 0 || z == size.z - 1;
                if (!wall && !floor) continue;
                const bool window = wall && z % 8 > 2 && z % 8 < 6 && (x + y) % 6 < 3;
                if (window) continue;
                voxels.push_back({static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                                  static_cast<std::uint8_t>(z),
                                  static_cast<std::uint8_t>(1 + 16 * kind + (wall ? 0 : 8))});
            }
        }
    }
    return voxels;
}

/// One model of up to 32^3 voxels with a fraction of them set.
void writeSmallFile(const std::filesystem::path& file, int seed) {
    const auto chance = [&](int what) { return static_cast<int>(hashOf(seed, what, 77) >> 1); };
    const glm::ivec3 size{8 + chance(0) % 25, 8 + chance(1) % 25, 8 + chance(2) % 25};
    const std::uint32_t percent = 10 + hashOf(seed, 3, 0) % 60;
    std::vector<VoxVoxel> voxels;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                if (hashOf(x + 64 * seed, y, z) % 100 >= percent) continue;
                voxels.push_back({static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                                  static_cast<std::uint8_t>(z), colorAt(8 * x, 8 * y, z)});
            }
    VoxScene scene;
    scene.addInstance(scene.addModel(size, voxels), size / 2);
    scene.write(file);
}

std::string numbered(const std::string& name, int i) {
    std::string digits = std::to_string(i);
    return name + std::string(4 - std::min<std::size_t>(4, digits.size()), '0') + digits + ".vox";
}

}  // namespace

void writeTerrainShell(const std::filesystem::path& file) {
    constexpr int kThickness = 6;
    const HeightMap heights(kTerrainEdge, kTerrainAmplitude);
    writeLandscape(file, kTerrainEdge, kModelEdge, [&](int x, int y) {
        const int top = std::min(heights.at(x, y) + kThickness, kModelEdge);
        return Column{top - kThickness, top};
    });
}

void writeValley(const std::filesystem::path& file) {
    constexpr float kMetres = 0.1f;
    constexpr int kModels = 35;
    constexpr int kRow = 7;
    constexpr float kStep = 9.0f;
    const HeightMap heights(kTerrainEdge, kTerrainAmplitude);
    const auto groundAt = [&](float x, float z) {
        const auto cell = [](float metres) {
            return std::clamp(static_cast<int>(metres / kMetres), 0, kTerrainEdge - 1);
        };
        return kMetres * static_cast<float>(heights.at(cell(x), cell(-z)) + 6);
    };
    const float middle = 0.5f * kMetres * kTerrainEdge;
    const float ground = groundAt(middle, -middle);
    std::ofstream out(file);
    out << "probeGridPos = [" << middle - 28.0f << ", " << ground - 6.0f << ", " << -middle - 28.0f << "]\n"
        << "probeGridStep = [8.0, 2.5, 8.0]\nprobeGridCount = [8, 8, 8]\nproximityGridSize = [64, 32, 64]\n\n"
        << "[sun]\ndirection = [0.5, -0.8, -0.45]\nirradiance = [3.0, 2.8, 2.4]\n\n"
        << "[sky]\nzenith = [0.35, 0.55, 0.95]\nhorizon = [0.85, 0.92, 1.0]\nground = [0.30, 0.27, 0.24]\n\n"
        << "[[cameras]]\nname = \"valley\"\nposition = [" << middle - 30.0f << ", " << ground + 16.0f << ", "
        << -middle + 42.0f << "]\ntarget = [" << middle << ", " << ground + 2.0f << ", " << -middle
        << "]\nfovYDegrees = 55.0\n\n"
        << "[[cameras]]\nname = \"among\"\nposition = [" << middle - 12.0f << ", "
        << groundAt(middle - 12.0f, -middle + 13.0f) + 4.0f << ", " << -middle + 13.0f << "]\ntarget = ["
        << middle << ", " << ground + 2.5f << ", " << -middle - 4.0f << "]\nfovYDegrees = 65.0\n\n"
        << "[[models]]\nname = \"terrain\"\npath = \"terrain_shell.vox\"\n";
    const char* const names[] = {"courtyard", "tree", "statue", "tree", "lamp", "tree", "tree"};
    for (int i = 0; i < kModels; ++i) {
        const float x = middle + kStep * static_cast<float>(i % kRow - kRow / 2);
        const float z = -middle + kStep * static_cast<float>(i / kRow - 2);
        const char* const name = names[(i + i / kRow) % 7];
        out << "\n[[models]]\nname = \"" << name << ' ' << i << "\"\npath = \"" << name
            << ".vox\"\ntranslateVec = [" << x << ", " << groundAt(x, z) << ", " << z
            << "]\nrotateVec = [0.0, " << 0.37f * static_cast<float>(i) << ", 0.0]\n";
    }
}

void writeSolidTerrain(const std::filesystem::path& file) {
    constexpr int kEdge = 1024;
    const HeightMap heights(kEdge, 98.0f);
    writeLandscape(file, kEdge, kEdge, [&](int x, int y) { return Column{0, heights.at(x, y)}; });
}

void writeInstances(const std::filesystem::path& file, int count) {
    constexpr int kModels = 12;
    constexpr int kStep = 40;
    VoxScene scene;
    for (int kind = 0; kind < kModels; ++kind) {
        const glm::ivec3 size{16 + kind, 20 + (kind % 3) * 6, 24 + kind * 6};
        scene.addModel(size, building(size, kind));
    }
    const int row = static_cast<int>(std::ceil(std::sqrt(count)));
    for (int i = 0; i < count; ++i) {
        const int kind = static_cast<int>(hashOf(i, 5, 5) % kModels);
        scene.addInstance(kind, {i % row * kStep, i / row * kStep, (24 + kind * 6) / 2});
    }
    scene.write(file);
}

void writeSmallFiles(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    for (int i = 0; i < 527; ++i) writeSmallFile(folder / numbered("small", i), i);
}

void writeCutFiles(const std::filesystem::path& folder) {
    constexpr int kCuts = 100;
    std::filesystem::create_directories(folder);
    const std::filesystem::path whole = folder / "whole.tmp";
    writeSmallFile(whole, 9);
    const auto bytes = std::filesystem::file_size(whole);
    for (unsigned i = 0; i < kCuts; ++i) {
        const std::filesystem::path cut = folder / numbered("cut", static_cast<int>(i));
        std::filesystem::copy_file(whole, cut, std::filesystem::copy_options::overwrite_existing);
        std::filesystem::resize_file(cut, bytes * i / kCuts);
    }
    std::filesystem::remove(whole);
}

void writeSelfCycles(const std::filesystem::path& folder) {
    constexpr int kFiles = 81;
    std::filesystem::create_directories(folder);
    for (int i = 0; i < kFiles; ++i) {
        VoxScene scene;
        scene.addModel({20, 21, 22}, building({20, 21, 22}, i % 12));
        scene.writeWithSelfCycle(folder / numbered("cycle", i));
    }
}

void writeHalfPlanet(const std::filesystem::path& file) {
    constexpr int kRadius = 128;
    constexpr int kInnerSquared = 14'090;  // a crust of 9.3 voxels
    std::vector<VoxVoxel> voxels;
    for (int z = 0; z < kRadius; ++z)
        for (int y = 0; y < kModelEdge; ++y)
            for (int x = 0; x < kModelEdge; ++x) {
                const glm::ivec3 p{x - kRadius, y - kRadius, z};
                const int distance = p.x * p.x + p.y * p.y + p.z * p.z;
                if (distance >= kRadius * kRadius || distance < kInnerSquared) continue;
                voxels.push_back({static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                                  static_cast<std::uint8_t>(z), colorAt(x, y, z)});
            }
    VoxScene scene;
    scene.addInstance(scene.addModel(glm::ivec3{kModelEdge}, voxels), {0, 0, 0});
    scene.write(file);
}

void writeMonument(const std::filesystem::path& file) {
    constexpr int kBase = 118;
    constexpr int kHeight = 126;
    std::vector<VoxVoxel> voxels;
    for (int z = 0; z < kHeight; ++z) {
        const int inset = z / 6 * 2;
        for (int y = inset; y < kBase - inset; ++y)
            for (int x = inset; x < kBase - inset; ++x)
                voxels.push_back({static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                                  static_cast<std::uint8_t>(z), colorAt(4 * x, 4 * y, z)});
    }
    VoxScene scene;
    scene.addInstance(scene.addModel({kBase, kBase, kHeight}, voxels), {0, 0, 0});
    scene.write(file);
}

void writeLiar(const std::filesystem::path& file) {
    // The size is a lie, the rest is in order: one voxel in a model.
    const VoxVoxel voxel{1, 2, 3, 4};
    VoxScene scene;
    scene.addModel({65536, 65536, 1}, {voxel});
    scene.write(file);
    std::filesystem::resize_file(file,
                                 64);  // within the palette, as such a file comes: the end is missing, too
}

}  // namespace pfvox::bench

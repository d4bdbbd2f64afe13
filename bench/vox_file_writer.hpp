// VoxFileWriter: writes MagicaVoxel scenes model by model, so that half a gigabyte of them needs no memory.
//
// The writer of data/generator makes small files with every feature; this one makes large files with few.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace pfvox::bench {

/// A voxel as it is in the file; z is up, `color` is a palette index from 1.
struct VoxVoxel {
    std::uint8_t x, y, z, color;
};
static_assert(sizeof(VoxVoxel) == 4);

class VoxFileWriter {
  public:
    /// Throws std::ios_base::failure where the file cannot be written, as all functions here do.
    explicit VoxFileWriter(const std::filesystem::path& path);

    /// Returns the number of the model. Edges are at most 256.
    int addModel(glm::ivec3 size, std::span<const VoxVoxel> voxels);
    /// Places a model with its middle voxel at `translation`.
    void addInstance(int model, glm::ivec3 translation);
    /// Writes the scene graph and the sizes that were not known before.
    void finish();
    /// The same with a graph that is one transform node, which is its own child: real files have such.
    void finishWithSelfCycle();

  private:
    void int32(std::int32_t value);
    void chunk(const char* id, std::size_t contentBytes);
    void text(const std::string& s);
    void writeGraph();
    void writePalette();

    struct Instance {
        int model;
        glm::ivec3 translation;
    };

    std::ofstream file_;
    int modelCount_ = 0;
    std::vector<Instance> instances_;
};

}  // namespace pfvox::bench

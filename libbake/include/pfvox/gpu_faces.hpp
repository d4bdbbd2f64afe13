// GpuFaces: baked light of faces in device memory, ready for lookups.
//
//     FaceValues, gpu::Scene -> [GpuFaces::upload] -> device buffers -> shaders/face_lookup.glsl
//
// The layout is that of shaders/shared/faces.glsl.h.
#pragma once

#include <pfvox/face_light.hpp>
#include <pfvox/gpu_scene.hpp>
#include <vector>

namespace pfvox {

/// I = E / pi of indirect light of all faces of a scene, in the order of gpu::Scene::faces().
struct FaceValues {
    std::vector<std::uint8_t> levels;   ///< a face: 0 to 3 for 4^level values, or kNoFaceValue
    std::vector<std::uint32_t> values;  ///< RGB9E5; those of a face row by row
};

namespace gpu {

struct GpuFaceStatistics {
    std::uint64_t faces = 0;
    std::uint64_t divided = 0;  ///< of them, with several values
    std::uint64_t values = 0;
    std::uint64_t valueBytes = 0;
    std::uint64_t meanBytes = 0;  ///< of levels of detail
    std::uint64_t totalBytes() const { return valueBytes + meanBytes; }
};

/// Immutable once made. Keeps its device alive.
class GpuFaces {
  public:
    /// `scene` was built with faces. Errors: BadStructure (the values are not those of this scene),
    /// GpuOutOfMemory, GpuLost.
    static Result<GpuFaces> upload(Device& device, const Scene& scene, const FaceValues& values);

    /// Device address of the shared::FaceField.
    glm::uvec2 address() const { return table_.addressWords(); }
    const GpuFaceStatistics& statistics() const { return statistics_; }

  private:
    GpuFaces(Buffer table, Buffer values, Buffer parts, Buffer means)
        : table_(std::move(table)),
          values_(std::move(values)),
          parts_(std::move(parts)),
          means_(std::move(means)) {}

    Buffer table_;
    Buffer values_;
    Buffer parts_;
    Buffer means_;
    GpuFaceStatistics statistics_;
};

}  // namespace gpu

}  // namespace pfvox

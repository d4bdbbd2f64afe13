// Between the light of a scene's faces as the device numbers them and as files keep it.
//
//     baker: FaceValues -> [faceChunks] -> FaceChunk -> ProbeFileWriter
//     ProbeFileReader -> [readFaceValues] -> FaceValues -> gpu::GpuFaces
#pragma once

#include <pfvox/gpu_faces.hpp>
#include <pfvox/probe_file.hpp>

namespace pfvox {

/// The instances of a scene that was built with faces.
std::vector<FaceInstance> faceInstancesOf(const gpu::Scene& scene);

/// The light of all chunks of `info`, whose instances are the scene's.
std::vector<FaceChunk> faceChunks(const gpu::Scene& scene, const FaceLightInfo& info,
                                  const FaceValues& light);

/// Faces of each chunk, by number in the list of the scene: for what else is known by face.
std::vector<std::vector<std::uint32_t>> facesOfChunks(const gpu::Scene& scene, const FaceLightInfo& info);

/// The other way round, from all chunks.
FaceValues faceValues(const gpu::Scene& scene, const FaceLightInfo& info, std::span<const FaceChunk> chunks);

/// All of a file, read in parallel in the calling TBB arena. Errors: BadReference (the light is of other
/// models, or of models in other places of the scene's list; a shard), those of
/// ProbeFileReader::readFaceChunk. Precondition: the file has light on faces, the scene was built with faces.
Result<FaceValues> readFaceValues(const ProbeFileReader& reader, const gpu::Scene& scene);

}  // namespace pfvox

// Light on faces as a stage of a bake: traced, or taken from the journal; written chunk by chunk.
#pragma once

#include <pfvox/gpu_faces.hpp>
#include <pfvox/probe_file.hpp>

#include "faces/face_tracer.hpp"

namespace pfvox::bake {

/// What a file with light on the faces of this scene is begun with. A shard has the part of the chunks that
/// it has of the probes, all of whose light it needs, and so computes it. Precondition: settings.faces.
FaceLightInfo faceInfoFor(const gpu::Scene& scene, const BakeSettings& settings,
                          const ProbeFieldInfo& probes);

struct FaceStage {
    gpu::Device& device;
    const gpu::Scene& gpuScene;  ///< built with faces
    const Scene& scene;
    const EmitterList& emitters;
    const BakeSettings& settings;
    const FaceLightInfo& info;
    ContentKey field;  ///< fieldHash()
};

/// The light, as readers of the file will have it. Errors: those of FaceTracer, of the writer and of `done`.
Result<FaceValues> bakeFaceLight(const FaceStage& stage, ProbeFileWriter& writer, FaceReport& report,
                                 const WorkDone& done);

}  // namespace pfvox::bake

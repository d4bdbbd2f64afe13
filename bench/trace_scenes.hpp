// Scenes and cameras of bench_trace.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/octree.hpp>
#include <string>
#include <vector>

namespace pfvox::bench {

struct TraceCamera {
    std::string name;
    glm::dvec3 eye{0.0};
    glm::dvec3 target{0.0};
    double fovYDegrees = 60.0;
};

struct TraceScene {
    std::string name;
    OctreeAsset asset;
    std::vector<TraceCamera> cameras;
    bool singleModel =
        false;  ///< one instance in voxel units: can be traced without BVH and materials as well
};

/// `what`: a measured model ("sphere", "shell", "terrain", "tiny"), "landscape" (the terrain over 6144^2
/// columns: 113 million voxels) or a PF_VOX file. The measured models have the cameras of the ray casting
/// anchors; the others are seen from near, from far and from just above the ground. Errors: those of
/// loadPfVox and buildOctree.
Result<TraceScene> makeTraceScene(const std::string& what);

}  // namespace pfvox::bench

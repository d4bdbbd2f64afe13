#include <cmath>
#include <pfvox/scene.hpp>

namespace pfvox {

namespace {

/// A content that is wider than a power of two by no more than this is taken to have its width: transforms in
/// files are float32.
constexpr double kSlackVoxels = 0.01;

Affine rotationOf(const glm::dvec3& radians) {
    const glm::dvec3 c = glm::cos(radians);
    const glm::dvec3 s = glm::sin(radians);
    const glm::dmat3 x{{1.0, 0.0, 0.0}, {0.0, c.x, s.x}, {0.0, -s.x, c.x}};
    const glm::dmat3 y{{c.y, 0.0, -s.y}, {0.0, 1.0, 0.0}, {s.y, 0.0, c.y}};
    const glm::dmat3 z{{c.z, s.z, 0.0}, {-s.z, c.z, 0.0}, {0.0, 0.0, 1.0}};
    const glm::dmat3 r = z * y * x;
    return Affine{r[0], r[1], r[2], glm::dvec3{0.0}};
}

Affine scaleOf(const glm::dvec3& scale) {
    Affine m = identityAffine();
    for (int axis = 0; axis < 3; ++axis) m[axis][axis] = scale[axis];
    return m;
}

Affine translationOf(const glm::dvec3& offset) {
    Affine m = identityAffine();
    m[3] = offset;
    return m;
}

}  // namespace

void WorldBounds::include(const glm::dvec3& point) {
    min = glm::min(min, point);
    max = glm::max(max, point);
}

WorldBounds boundsOf(const OctreeAsset& asset, const Affine& worldFromAsset) {
    WorldBounds bounds;
    for (const Instance& instance : asset.instances) {
        if (isHidden(asset, instance) || instance.model >= asset.models.size()) continue;
        const VoxelBox& box = asset.models[instance.model].bounds;
        if (box.empty()) continue;
        const Affine worldFromModel = compose(worldFromAsset, instance.worldFromModel);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 p((corner & 1) != 0 ? box.max.x : box.min.x,
                               (corner & 2) != 0 ? box.max.y : box.min.y,
                               (corner & 4) != 0 ? box.max.z : box.min.z);
            bounds.include(worldFromModel * glm::dvec4(p, 1.0));
        }
    }
    return bounds;
}

double SourceCube::edgeVoxels() const {
    return std::ldexp(1.0, static_cast<int>(depth));
}

SourceCube sourceCube(const OctreeAsset& asset) {
    const WorldBounds bounds = boundsOf(asset);
    SourceCube cube;
    if (bounds.empty()) return cube;
    const double voxel = asset.source.voxelSizeMetres;
    const glm::dvec3 size = (bounds.max - bounds.min) / voxel;
    const double longest = std::max(size.x, std::max(size.y, size.z));
    cube.minVoxels = bounds.min / voxel;
    while (cube.edgeVoxels() + kSlackVoxels < longest && cube.depth < 1000) ++cube.depth;
    return cube;
}

Affine worldFromCube(const SceneModel& model, const OctreeAsset& asset) {
    const SourceCube cube = sourceCube(asset);
    const double metresPerVoxel = model.metresPerVoxel.value_or(asset.source.voxelSizeMetres);
    const glm::dvec3 edges = model.cubeEdgeMetres.value_or(glm::dvec3(metresPerVoxel * cube.edgeVoxels()));
    return compose(
        compose(translationOf(model.translateMetres), scaleOf(edges)),
        compose(rotationOf(model.rotateRadians), translationOf(cube.minVoxels / cube.edgeVoxels())));
}

Affine worldFromAsset(const SceneModel& model, const OctreeAsset& asset) {
    // Without scaleVec the cube falls out, and with it what rounding its edge would cost.
    const double voxel = asset.source.voxelSizeMetres;
    const double metresPerVoxel = model.metresPerVoxel.value_or(voxel);
    const glm::dvec3 scale = model.cubeEdgeMetres
                                 ? *model.cubeEdgeMetres / (voxel * sourceCube(asset).edgeVoxels())
                                 : glm::dvec3(metresPerVoxel / voxel);
    return compose(compose(translationOf(model.translateMetres), scaleOf(scale)),
                   rotationOf(model.rotateRadians));
}

}  // namespace pfvox

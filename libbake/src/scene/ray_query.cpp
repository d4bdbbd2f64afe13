#include <algorithm>
#include <pfvox/ray_query.hpp>
#include <pfvox_shaders/shaders.hpp>

#include "shared/rays.glsl.h"
#include "shared/scene.glsl.h"

namespace pfvox::gpu {

namespace {

shared::RayRecord recordOf(const GpuRay& ray, const Scene& scene) {
    return {
        .origin = scene.onDevice(ray.origin), .tMax = ray.tMax, .direction = ray.direction, .cone = ray.cone};
}

GpuHit hitOf(const shared::HitRecord& record) {
    return {.hit = record.instance != shared::kNoInstance,
            .t = record.t,
            .instance = record.instance,
            .voxel = record.voxel,
            .normal = record.normal,
            .material = record.material,
            .face = static_cast<std::uint8_t>(record.face),
            .steps = record.steps,
            .stepLimitReached = record.stepLimitReached != 0,
            .lodColor = record.lodColor,
            .cellLog2 = record.cellLog2};
}

}  // namespace

Result<RayQuery> RayQuery::create(Device& device) {
    PFVOX_TRY(Program, program,
              device.createProgram(shaders::kTraceRays, sizeof(shared::TraceRaysParameters), "trace rays"));
    return RayQuery(std::move(program));
}

Result<RayBatch> RayQuery::cast(Device& device, const Scene& scene, std::span<const GpuRay> rays,
                                RayMode mode) const {
    if (rays.empty()) return RayBatch{};
    std::vector<shared::RayRecord> records(rays.size());
    std::ranges::transform(rays, records.begin(), [&](const GpuRay& ray) { return recordOf(ray, scene); });
    PFVOX_TRY(const Buffer, rayBuffer,
              device.createBuffer(records.size() * sizeof(shared::RayRecord), "rays"));
    PFVOX_TRY(const Buffer, hitBuffer,
              device.createBuffer(records.size() * sizeof(shared::HitRecord), "hits"));
    PFVOX_CHECK(device.upload(rayBuffer, 0, std::as_bytes(std::span(records))));

    const auto rayCount = static_cast<std::uint32_t>(rays.size());
    const shared::TraceRaysParameters parameters{
        .scene = scene.address(),
        .rays = rayBuffer.addressWords(),
        .hits = hitBuffer.addressWords(),
        .rayCount = rayCount,
        .mode = mode == RayMode::AnyHit ? shared::kTraceAnyHit : shared::kTraceClosestHit};
    const Dispatch dispatch{
        .program = &program_,
        .pushConstants = bytesOf(parameters),
        .groups = {(rayCount + shared::kTraceRaysGroupSize - 1) / shared::kTraceRaysGroupSize, 1, 1}};
    PFVOX_TRY(const double, gpuMs, device.run({&dispatch, 1}));

    std::vector<shared::HitRecord> found(rays.size());
    PFVOX_CHECK(device.download(hitBuffer, 0, std::as_writable_bytes(std::span(found))));
    RayBatch batch{.hits = std::vector<GpuHit>(rays.size()), .gpuMs = gpuMs};
    std::ranges::transform(found, batch.hits.begin(), hitOf);
    return batch;
}

}  // namespace pfvox::gpu

#include "support/probe_query.hpp"

#include <algorithm>
#include <pfvox_check_shaders/shaders.hpp>

#include "shared/probes.glsl.h"

namespace pfvox::gpu {

namespace {

Result<std::vector<shared::ProbeAnswerRecord>> runQueries(Device& device, const Program& program,
                                                          const GpuProbes& probes,
                                                          std::span<const shared::ProbeQueryRecord> queries,
                                                          std::uint32_t mode) {
    std::vector<shared::ProbeAnswerRecord> answers(queries.size());
    if (queries.empty()) return answers;
    PFVOX_TRY(const Buffer, in, device.createBuffer(queries.size_bytes(), "probe queries"));
    PFVOX_TRY(const Buffer, out, device.createBuffer(std::span(answers).size_bytes(), "probe answers"));
    PFVOX_CHECK(device.upload(in, 0, std::as_bytes(queries)));
    const auto count = static_cast<std::uint32_t>(queries.size());
    const shared::ProbeQueryParameters parameters{.field = probes.address(),
                                                  .queries = in.addressWords(),
                                                  .answers = out.addressWords(),
                                                  .count = count,
                                                  .mode = mode};
    const Dispatch dispatch{
        .program = &program,
        .pushConstants = bytesOf(parameters),
        .groups = {(count + shared::kProbeQueryGroupSize - 1) / shared::kProbeQueryGroupSize, 1, 1}};
    PFVOX_CHECK(device.run({&dispatch, 1}));
    PFVOX_CHECK(device.download(out, 0, std::as_writable_bytes(std::span(answers))));
    return answers;
}

std::uint32_t modeOf(FieldTracing tracing) {
    if (tracing == FieldTracing::Full) return shared::kQueryTrace;
    return tracing == FieldTracing::HighOnly ? shared::kQueryTraceHighOnly : shared::kQueryTraceFilled;
}

}  // namespace

Result<ProbeQuery> ProbeQuery::create(Device& device) {
    PFVOX_TRY(
        Program, program,
        device.createProgram(shaders::kProbeQuery, sizeof(shared::ProbeQueryParameters), "probe query"));
    return ProbeQuery(std::move(program));
}

Result<std::vector<ProbeLookup>> ProbeQuery::lookUp(Device& device, const GpuProbes& probes,
                                                    std::span<const ProbePoint> points) const {
    std::vector<shared::ProbeQueryRecord> queries(points.size());
    std::ranges::transform(points, queries.begin(), [](const ProbePoint& point) {
        return shared::ProbeQueryRecord{
            .position = point.position, .tMax = 0, .direction = point.normal, .reserved0 = 0};
    });
    PFVOX_TRY(const std::vector<shared::ProbeAnswerRecord>, answers,
              runQueries(device, program_, probes, queries, shared::kQueryLookup));
    std::vector<ProbeLookup> results(answers.size());
    std::ranges::transform(answers, results.begin(), [](const shared::ProbeAnswerRecord& answer) {
        return ProbeLookup{.indirect = answer.light,
                           .tier = static_cast<ProbeTier>(answer.state),
                           .weights = glm::vec3{answer.weights}};
    });
    return results;
}

Result<std::vector<FieldTrace>> ProbeQuery::trace(Device& device, const GpuProbes& probes,
                                                  std::span<const FieldRay> rays,
                                                  FieldTracing tracing) const {
    std::vector<shared::ProbeQueryRecord> queries(rays.size());
    std::ranges::transform(rays, queries.begin(), [](const FieldRay& ray) {
        return shared::ProbeQueryRecord{
            .position = ray.origin, .tMax = ray.tMax, .direction = ray.direction, .reserved0 = 0};
    });
    PFVOX_TRY(const std::vector<shared::ProbeAnswerRecord>, answers,
              runQueries(device, program_, probes, queries, modeOf(tracing)));
    std::vector<FieldTrace> results(answers.size());
    std::ranges::transform(answers, results.begin(), [](const shared::ProbeAnswerRecord& answer) {
        return FieldTrace{.answer = static_cast<FieldAnswer>(answer.state),
                          .t = answer.t,
                          .normal = answer.normal,
                          .light = answer.light,
                          .probe = answer.probe,
                          .lowSteps = answer.lowSteps,
                          .highSteps = answer.highSteps,
                          .probesAsked = answer.probesAndCaps & 0xffffu,
                          .stepLimitReached = answer.probesAndCaps >> 16};
    });
    return results;
}

}  // namespace pfvox::gpu

// encodePfProbe: a field that fits into memory.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "guarded.hpp"
#include "pf_probe/composer.hpp"

namespace pfvox {

namespace {

/// All chunks, in order.
Result<std::vector<faces::PackedChunk>> packFaces(const FaceLight& light, int zstdLevel) {
    PFVOX_CHECK(checkFaceLightInfo(light.info));
    const FaceChunkRange range = light.info.range;
    if (light.chunks.size() != range.size() || light.info.chunks.size() != range.size()) {
        return fail(ErrorCode::BadStructure,
                    fmt::format("{} chunks of light on faces and {} records for the range {}:{}",
                                light.chunks.size(), light.info.chunks.size(), range.first, range.end));
    }
    const auto places = faceChunkPlaces(light.info);
    std::vector<Result<faces::PackedChunk>> packed(light.chunks.size());
    tbb::parallel_for(std::size_t{0}, packed.size(), [&](std::size_t i) {
        const FaceChunkRecord& record = light.info.chunks[i];
        const auto checked = checkFaceChunk(places[range.first + i].faceCount, light.chunks[i], record);
        if (checked) {
            packed[i] = faces::packChunk(light.info.settings.codec, light.chunks[i], record, zstdLevel);
        } else {
            packed[i] = tl::make_unexpected(checked.error());
        }
    });
    std::vector<faces::PackedChunk> chunks;
    for (auto& chunk : packed) {
        if (!chunk) return tl::make_unexpected(chunk.error());
        chunks.push_back(*std::move(chunk));
    }
    return chunks;
}

Result<std::vector<std::byte>> encode(const ProbeField& field, const ProbeEncodeSettings& settings) {
    PFVOX_CHECK(checkProbeInfo(field.info));
    PFVOX_CHECK(probe::checkHasContent(field.info, field.faces.has_value()));
    if (field.probes.size() != field.info.range.size()) {
        return fail(ErrorCode::BadStructure, fmt::format("{} probes for the range {}:{}", field.probes.size(),
                                                         field.info.range.first, field.info.range.end));
    }
    std::vector<Result<probe::PackedProbe>> packed(field.probes.size());
    tbb::parallel_for(std::size_t{0}, field.probes.size(), [&](std::size_t i) {
        const auto index = field.info.range.first + static_cast<std::uint32_t>(i);
        const auto checked = checkProbeData(field.info, index, field.probes[i]);
        if (checked) {
            packed[i] = probe::packProbe(field.probes[i], settings.zstdLevel);
        } else {
            packed[i] = tl::make_unexpected(checked.error());
        }
    });
    probe::FilePlan plan{.info = field.info,
                         .contentKey = settings.contentKey,
                         .probes = {},
                         .proximity = field.proximity ? &*field.proximity : nullptr};
    for (const auto& probe : packed) {
        if (!probe) return tl::make_unexpected(probe.error());
        plan.probes.push_back(probe->entry);
    }
    std::vector<faces::PackedChunk> chunks;
    if (field.faces) {
        PFVOX_TRY(auto, all, packFaces(*field.faces, settings.zstdLevel));
        chunks = std::move(all);
        plan.faces = &field.faces->info;
        for (const auto& chunk : chunks) plan.chunks.push_back(chunk.entry);
    }
    PFVOX_TRY(auto, file, probe::composeHead(plan));
    const auto append = [&file](std::span<const std::byte> bytes) {
        file.insert(file.end(), bytes.begin(), bytes.end());
    };
    const auto gap = plan.gapBeforeFaces(file);
    for (const auto& probe : packed) append(probe->stored);
    append(gap);
    for (const auto& chunk : chunks) append(chunk.stored);
    return file;
}

}  // namespace

Result<std::vector<std::byte>> encodePfProbe(const ProbeField& field, const ProbeEncodeSettings& settings) {
    return guarded([&] { return encode(field, settings); });
}

}  // namespace pfvox

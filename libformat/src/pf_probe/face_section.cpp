#include "pf_probe/face_section.hpp"

#include <fmt/format.h>

#include <numeric>

#include "container/section_writer.hpp"
#include "io/byte_cursor.hpp"
#include "pf_probe/setting_values.hpp"

namespace pfvox::probe {

namespace {

using container::appendBytes;
using faces::StoredChunk;

/// More than later versions will have.
constexpr std::uint32_t kMaxSettings = 1024;

constexpr auto kWalk = [](const auto& visit, auto&... settings) { forEachFaceSetting(visit, settings...); };

/// The next `count` records; the section has them or it ends too early. Errors: BadStructure, LimitExceeded.
template <class T>
Result<container::Array<T>> take(io::ByteCursor& cursor, std::uint64_t count,
                                 container::MemoryBudget& budget) {
    const auto bytes = cursor.take(count * sizeof(T));
    if (!bytes) return fail(ErrorCode::BadStructure, fmt::format("ends before its {} entries", count));
    PFVOX_TRY(auto, records, container::Array<T>::make(budget, count));
    if (count != 0) std::memcpy(records.data(), bytes->data(), bytes->size());
    return records;
}

Result<void> readInstances(io::ByteCursor& cursor, const probe_layout::Faces& fixed, FaceLightInfo& info,
                           container::MemoryBudget& budget) {
    PFVOX_TRY(const auto, instances, take<probe_layout::FaceInstance>(cursor, fixed.instanceCount, budget));
    PFVOX_TRY(const auto, counts, take<std::uint32_t>(cursor, fixed.regionCount, budget));
    PFVOX_CHECK(budget.resize(info.instances, instances.size()));
    std::size_t next = 0;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const std::uint32_t regions = instances[i].regionCount;
        if (regions > counts.size() - next)
            return fail(ErrorCode::BadStructure, fmt::format("instance {} has {} regions where {} are left",
                                                             i, regions, counts.size() - next));
        FaceInstance& instance = info.instances[i];
        instance.index = {instances[i].index};
        PFVOX_CHECK(budget.resize(instance.faceCounts, regions));
        std::copy_n(counts.begin() + next, regions, instance.faceCounts.begin());
        next += regions;
    }
    if (next != counts.size())
        return fail(ErrorCode::BadStructure,
                    fmt::format("{} regions are of no instance", counts.size() - next));
    return {};
}

}  // namespace

probe_layout::FaceChunk toFaceChunk(const StoredChunk& chunk) {
    return {.hash = chunk.record.hash,
            .inputHash = chunk.record.inputHash.bytes,
            // -0 and 0 are equal and must be written alike.
            .noise = chunk.record.noise.value_or(probe_layout::kUnknownError) + 0.0f,
            .cappedFraction = chunk.record.cappedFraction + 0.0f,
            .valueCount = static_cast<std::uint32_t>(chunk.record.valueCount),
            .levelBytes = chunk.frames.levelBytes,
            .storedBytes = chunk.frames.storedBytes};
}

Result<StoredChunk> fromFaceChunk(FaceCodec codec, std::uint32_t faceCount,
                                  const probe_layout::FaceChunk& chunk) {
    StoredChunk stored{.record = {.valueCount = chunk.valueCount,
                                  .noise = chunk.noise,
                                  .cappedFraction = chunk.cappedFraction,
                                  .inputHash = {chunk.inputHash},
                                  .hash = chunk.hash,
                                  .storedBytes = std::accumulate(chunk.storedBytes.begin(),
                                                                 chunk.storedBytes.end(), std::uint64_t{0})},
                       .frames = {.levelBytes = chunk.levelBytes, .storedBytes = chunk.storedBytes}};
    PFVOX_CHECK(faces::checkChunkRecord(stored.record));
    if (chunk.noise == probe_layout::kUnknownError) stored.record.noise.reset();
    PFVOX_CHECK(faces::checkStoredChunk(codec, faceCount, stored));
    return stored;
}

std::uint64_t bytesOf(const FaceLightInfo& info) {
    std::uint64_t bytes =
        info.instances.size() * sizeof(FaceInstance) + info.chunks.size() * sizeof(FaceChunkRecord);
    for (const FaceInstance& instance : info.instances)
        bytes += instance.faceCounts.size() * sizeof(std::uint32_t);
    return bytes;
}

std::vector<std::uint8_t> faceSectionBytes(const FaceLightInfo& info, std::span<const StoredChunk> chunks) {
    const auto settings = settingEntries(kWalk, info.settings);
    probe_layout::Faces fixed{.facesPerChunk = info.facesPerChunk,
                              .rangeFirst = info.range.first,
                              .rangeEnd = info.range.end,
                              .settingCount = static_cast<std::uint32_t>(settings.size()),
                              .instanceCount = static_cast<std::uint32_t>(info.instances.size()),
                              .regionCount = 0};
    std::vector<probe_layout::FaceInstance> instances;
    std::vector<std::uint32_t> counts;
    for (const FaceInstance& instance : info.instances) {
        instances.push_back({instance.index.bytes, static_cast<std::uint32_t>(instance.faceCounts.size())});
        counts.insert(counts.end(), instance.faceCounts.begin(), instance.faceCounts.end());
    }
    fixed.regionCount = static_cast<std::uint32_t>(counts.size());
    std::vector<probe_layout::FaceChunk> records;
    for (const StoredChunk& chunk : chunks) records.push_back(toFaceChunk(chunk));
    std::vector<std::uint8_t> bytes;
    appendBytes(bytes, std::span<const probe_layout::Faces>(&fixed, 1));
    appendBytes(bytes, std::span<const probe_layout::Setting>(settings));
    appendBytes(bytes, std::span<const probe_layout::FaceInstance>(instances));
    appendBytes(bytes, std::span<const std::uint32_t>(counts));
    appendBytes(bytes, std::span<const probe_layout::FaceChunk>(records));
    return bytes;
}

Result<FaceHead> readFaceSection(std::span<const std::byte> bytes, container::MemoryBudget& budget) {
    io::ByteCursor cursor(bytes);
    const auto fixed = cursor.read<probe_layout::Faces>();
    if (!fixed) return fail(ErrorCode::BadStructure, "is too short");
    if (fixed->settingCount > kMaxSettings)
        return fail(ErrorCode::BadStructure, fmt::format("{} settings", fixed->settingCount));
    FaceHead head;
    head.info.facesPerChunk = fixed->facesPerChunk;
    head.info.range = {fixed->rangeFirst, fixed->rangeEnd};
    PFVOX_TRY(const auto, settings, take<probe_layout::Setting>(cursor, fixed->settingCount, budget));
    PFVOX_CHECK(readSettingEntries(kWalk, std::span(settings), head.info.settings));
    PFVOX_CHECK(readInstances(cursor, *fixed, head.info, budget));
    // One chunk a region at most: what places of chunks can take.
    PFVOX_CHECK(budget.take(fixed->regionCount, 2 * sizeof(FaceChunkPlace)));
    PFVOX_CHECK(checkFaceLightInfo(head.info));
    head.places = faceChunkPlaces(head.info);
    PFVOX_TRY(const auto, chunks, take<probe_layout::FaceChunk>(cursor, head.info.range.size(), budget));
    if (cursor.remaining() != 0) return fail(ErrorCode::BadStructure, "is too long");
    PFVOX_CHECK(budget.resize(head.chunks, chunks.size()));
    PFVOX_CHECK(budget.resize(head.info.chunks, chunks.size()));
    for (std::uint32_t i = 0; i < chunks.size(); ++i) {
        const std::uint32_t index = head.info.range.first + i;
        auto chunk = fromFaceChunk(head.info.settings.codec, head.places[index].faceCount, chunks[i]);
        if (!chunk)
            return fail(chunk.error().code, fmt::format("chunk {}: {}", index, chunk.error().message));
        head.chunks[i] = *std::move(chunk);
        head.info.chunks[i] = head.chunks[i].record;
    }
    return head;
}

}  // namespace pfvox::probe

// ProbeFileReader.
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>
#include <pfvox/assert.hpp>
#include <pfvox/probe_file.hpp>

#include "guarded.hpp"
#include "pf_probe/frame_codec.hpp"
#include "pf_probe/head_reader.hpp"

namespace pfvox {

namespace {

/// What is read in parallel, and the first of those that cannot be read.
struct FirstFault {
    std::mutex mutex{};
    std::size_t index = ~std::size_t{0};
    std::optional<Error> error{};

    template <class T>
    void store(std::size_t i, T& into, Result<T> read) {
        if (read) {
            into = *std::move(read);
            return;
        }
        const std::scoped_lock lock(mutex);
        if (i > index) return;
        index = i;
        error = std::move(read).error();
    }
};

}  // namespace

struct ProbeFileReader::State {
    std::unique_ptr<container::ByteSource> source;
    mutable container::MemoryBudget budget;
    probe::FileHead head{};
    std::filesystem::path file{};

    State(std::unique_ptr<container::ByteSource> from, const Limits& limits)
        : source(std::move(from)), budget(limits.maxMemoryBytes) {}

    const probe::StoredProbe& probeAt(std::uint32_t index) const {
        PFVOX_ASSERT(head.info.range.contains(index));
        return head.probes[index - head.info.range.first];
    }

    std::uint64_t offsetOf(std::uint32_t index, ProbeLayer layer) const {
        std::uint64_t offset = head.frameOffsets[index - head.info.range.first];
        for (std::size_t i = 0; i < static_cast<std::size_t>(layer); ++i)
            offset += probeAt(index).frames[i].storedBytes;
        return offset;
    }

    /// Names file and frame in an error.
    template <class T>
    Result<T> placed(Result<T> result, std::uint32_t index, ProbeLayer layer) const {
        if (!result) {
            Error& error = result.error();
            error.file = file;
            error.context = probe::frameName(index, layer);
            error.offsetBytes = offsetOf(index, layer);
        }
        return result;
    }

    const probe_layout::Frame& frameAt(std::uint32_t index, ProbeLayer layer) const {
        return probeAt(index).frames[static_cast<std::size_t>(layer)];
    }

    Result<void> readStored(std::uint32_t index, ProbeLayer layer, std::span<std::byte> stored) const {
        return placed(source->readAt(offsetOf(index, layer), stored), index, layer);
    }

    Result<void> readLayer(std::uint32_t index, ProbeLayer layer, std::span<std::byte> words,
                           container::MemoryBudget& scratch) const {
        const probe_layout::Frame& frame = frameAt(index, layer);
        auto stored = container::Array<std::byte>::make(scratch, frame.storedBytes);
        if (!stored) return placed(Result<void>(tl::make_unexpected(stored.error())), index, layer);
        PFVOX_CHECK(readStored(index, layer, *stored));
        return placed(probe::unpackFrame(layer, frame, *stored, words, scratch), index, layer);
    }

    Result<ProbeData> readProbe(std::uint32_t index, container::MemoryBudget& scratch) const {
        const probe::StoredProbe& probe = probeAt(index);
        ProbeData data{.record = probe.record, .inputHash = probe.inputHash};
        for (const ProbeLayer layer : probe::kAllLayers) {
            if (frameAt(index, layer).storedBytes == 0) continue;
            const auto words = data.resizeLayer(layer, head.info.resolution.bytesOf(layer));
            PFVOX_CHECK(readLayer(index, layer, words, scratch));
        }
        return data;
    }

    /// Names file and place in an error.
    template <class T>
    Result<T> placedInFaces(Result<T> result, std::uint32_t chunk) const {
        if (!result) {
            result.error().file = file;
            result.error().context = probe::chunkName(chunk);
            result.error().offsetBytes = chunkAt(chunk).frames.offsetBytes;
        }
        return result;
    }

    const faces::StoredChunk& chunkAt(std::uint32_t chunk) const {
        PFVOX_ASSERT(head.faces && head.faces->range.contains(chunk));
        return head.faceChunks[chunk - head.faces->range.first];
    }

    Result<FaceChunk> readFaceChunk(std::uint32_t index, container::MemoryBudget& scratch) const {
        const faces::StoredChunk& chunk = chunkAt(index);
        const auto read = [&]() -> Result<FaceChunk> {
            PFVOX_TRY(auto, stored, container::Array<std::byte>::make(scratch, chunk.record.storedBytes));
            PFVOX_CHECK(source->readAt(chunk.frames.offsetBytes, std::span(stored)));
            return faces::unpackChunk(head.faces->settings.codec, head.facePlaces[index].faceCount, chunk,
                                      std::span(stored), scratch);
        };
        return placedInFaces(read(), index);
    }

    Result<ProbeField> readField() const;
    Result<FaceLight> readFaces() const;

    static Result<std::unique_ptr<State>> make(std::unique_ptr<container::ByteSource> source,
                                               const Limits& limits, Diagnostics& diagnostics) {
        auto state = std::make_unique<State>(std::move(source), limits);
        PFVOX_TRY(auto, head, probe::readHead(*state->source, state->budget, diagnostics));
        state->head = std::move(head);
        return state;
    }
};

/// All memory is taken from the budget before, so that the outcome does not depend on threads that meet.
Result<ProbeField> ProbeFileReader::State::readField() const {
    const ProbeRange range = head.info.range;
    std::uint64_t largest = 0;
    for (const ProbeLayer layer : probe::kAllLayers)
        largest = std::max(largest, head.info.resolution.bytesOf(layer));
    const auto threads = static_cast<std::uint64_t>(tbb::this_task_arena::max_concurrency());
    const auto busy = std::min<std::uint64_t>(threads, range.size());
    PFVOX_TRY(const auto, frames, container::Charge::take(budget, busy, 2 * largest));
    PFVOX_TRY(const auto, probes,
              container::Charge::take(budget, range.size(),
                                      head.info.resolution.bytesPerProbe() + sizeof(ProbeData)));
    const std::uint64_t indices = head.proximity ? head.proximity->probes.size() : 0;
    PFVOX_TRY(const auto, cells, container::Charge::take(budget, indices, sizeof(std::uint32_t)));
    ProbeField field{.info = head.info, .probes = {}, .proximity = head.proximity};
    field.probes.resize(range.size());
    container::MemoryBudget scratch(~std::uint64_t{0});
    FirstFault fault;
    tbb::parallel_for(std::size_t{0}, field.probes.size(), [&](std::size_t i) {
        fault.store(i, field.probes[i], readProbe(range.first + static_cast<std::uint32_t>(i), scratch));
    });
    if (fault.error) return tl::make_unexpected(*std::move(fault.error));
    if (head.faces) {
        PFVOX_TRY(auto, light, readFaces());
        field.faces = std::move(light);
    }
    return field;
}

/// As readField().
Result<FaceLight> ProbeFileReader::State::readFaces() const {
    const FaceChunkRange range = head.faces->range;
    std::uint64_t largest = 0;
    std::uint64_t all = probe::bytesOf(*head.faces);
    for (std::uint32_t chunk = range.first; chunk < range.end; ++chunk) {
        const faces::StoredChunk& stored = chunkAt(chunk);
        largest = std::max(largest, faces::unpackBytes(head.faces->settings.codec, stored));
        all += faces::chunkBytes(head.facePlaces[chunk].faceCount, stored.record) + sizeof(FaceChunk);
    }
    const auto threads = static_cast<std::uint64_t>(tbb::this_task_arena::max_concurrency());
    const auto busy = std::min<std::uint64_t>(threads, range.size());
    PFVOX_TRY(const auto, frames, container::Charge::take(budget, busy, largest));
    PFVOX_TRY(const auto, chunks, container::Charge::take(budget, 1, all));
    FaceLight light{.info = *head.faces, .chunks = {}};
    light.chunks.resize(range.size());
    container::MemoryBudget scratch(~std::uint64_t{0});
    FirstFault fault;
    tbb::parallel_for(std::size_t{0}, light.chunks.size(), [&](std::size_t i) {
        fault.store(i, light.chunks[i], readFaceChunk(range.first + static_cast<std::uint32_t>(i), scratch));
    });
    if (fault.error) return tl::make_unexpected(*std::move(fault.error));
    return light;
}

ProbeFileReader::ProbeFileReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
ProbeFileReader::ProbeFileReader(ProbeFileReader&&) noexcept = default;
ProbeFileReader& ProbeFileReader::operator=(ProbeFileReader&&) noexcept = default;
ProbeFileReader::~ProbeFileReader() = default;

Result<ProbeFileReader> ProbeFileReader::open(const std::filesystem::path& file, const Limits& limits,
                                              Diagnostics& diagnostics) {
    return guarded([&]() -> Result<ProbeFileReader> {
        PFVOX_TRY(auto, opened, io::RandomFile::openForReading(file, limits.maxFileBytes));
        auto state =
            State::make(std::make_unique<container::FileSource>(std::move(opened)), limits, diagnostics);
        if (!state) {
            state.error().file = file;
            return tl::make_unexpected(std::move(state).error());
        }
        (*state)->file = file;
        return ProbeFileReader(*std::move(state));
    });
}

Result<ProbeFileReader> ProbeFileReader::overBytes(std::span<const std::byte> bytes, const Limits& limits,
                                                   Diagnostics& diagnostics) {
    return guarded([&]() -> Result<ProbeFileReader> {
        PFVOX_TRY(auto, state,
                  State::make(std::make_unique<container::MemorySource>(bytes), limits, diagnostics));
        return ProbeFileReader(std::move(state));
    });
}

const ProbeFieldInfo& ProbeFileReader::info() const {
    return state_->head.info;
}
std::uint16_t ProbeFileReader::versionMinor() const {
    return state_->head.header.versionMinor;
}
ContentKey ProbeFileReader::contentKey() const {
    return {state_->head.header.contentKey};
}
std::uint64_t ProbeFileReader::fileBytes() const {
    return state_->head.header.fileBytes;
}
const std::optional<ProximityGrid>& ProbeFileReader::proximity() const {
    return state_->head.proximity;
}
const std::optional<FaceLightInfo>& ProbeFileReader::faces() const {
    return state_->head.faces;
}

Result<FaceChunk> ProbeFileReader::readFaceChunk(std::uint32_t chunk) const {
    return guarded([&] { return state_->readFaceChunk(chunk, state_->budget); });
}

FaceFrames ProbeFileReader::faceFrames(std::uint32_t chunk) const {
    return state_->chunkAt(chunk).frames;
}

Result<std::vector<std::byte>> ProbeFileReader::readStoredFaces(std::uint32_t chunk) const {
    return guarded([&]() -> Result<std::vector<std::byte>> {
        const faces::StoredChunk& entry = state_->chunkAt(chunk);
        std::vector<std::byte> stored(entry.record.storedBytes);
        PFVOX_CHECK(state_->placedInFaces(state_->source->readAt(entry.frames.offsetBytes, stored), chunk));
        return stored;
    });
}

const ProbeRecord& ProbeFileReader::record(std::uint32_t probe) const {
    return state_->probeAt(probe).record;
}
const ContentKey& ProbeFileReader::inputHash(std::uint32_t probe) const {
    return state_->probeAt(probe).inputHash;
}
glm::vec3 ProbeFileReader::positionOf(std::uint32_t probe) const {
    return info().grid.pointOf(probe) + record(probe).offset;
}
bool ProbeFileReader::has(std::uint32_t probe, ProbeLayer layer) const {
    return state_->frameAt(probe, layer).storedBytes != 0;
}

ProbeFrame ProbeFileReader::frame(std::uint32_t probe, ProbeLayer layer) const {
    const probe_layout::Frame& frame = state_->frameAt(probe, layer);
    return {.offsetBytes = state_->offsetOf(probe, layer),
            .storedBytes = frame.storedBytes,
            .codec = probe::toString(frame.codec),
            .rawHash = frame.rawHash};
}

Result<std::vector<std::byte>> ProbeFileReader::readStored(std::uint32_t probe, ProbeLayer layer) const {
    return guarded([&]() -> Result<std::vector<std::byte>> {
        std::vector<std::byte> stored(state_->frameAt(probe, layer).storedBytes);
        PFVOX_CHECK(state_->readStored(probe, layer, stored));
        return stored;
    });
}

Result<void> ProbeFileReader::readLayer(std::uint32_t probe, ProbeLayer layer,
                                        std::span<std::byte> words) const {
    PFVOX_ASSERT(words.size() == info().resolution.bytesOf(layer));
    return guarded([&] { return state_->readLayer(probe, layer, words, state_->budget); });
}

Result<ProbeData> ProbeFileReader::readProbe(std::uint32_t probe) const {
    return guarded([&] { return state_->readProbe(probe, state_->budget); });
}

Result<ProbeField> ProbeFileReader::readField() const {
    return guarded([&] { return state_->readField(); });
}

}  // namespace pfvox

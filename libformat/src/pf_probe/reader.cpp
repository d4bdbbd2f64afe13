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

    Result<ProbeField> readField() const;

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
    std::mutex mutex;
    std::optional<Error> fault;
    std::size_t faulty = range.size();  // the first of those that cannot be read
    tbb::parallel_for(std::size_t{0}, field.probes.size(), [&](std::size_t i) {
        auto probe = readProbe(range.first + static_cast<std::uint32_t>(i), scratch);
        if (probe) {
            field.probes[i] = *std::move(probe);
            return;
        }
        const std::scoped_lock lock(mutex);
        if (i > faulty) return;
        faulty = i;
        fault = std::move(probe).error();
    });
    if (fault) return tl::make_unexpected(*std::move(fault));
    return field;
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

// ProbeFileReader.
#include <fmt/format.h>

#include <pfvox/assert.hpp>
#include <pfvox/probe_file.hpp>

#include "pf_probe/frame_codec.hpp"
#include "pf_probe/head_reader.hpp"

namespace pfvox {

struct ProbeFileReader::State {
    std::unique_ptr<probe::ByteSource> source;
    probe::FileHead head;
    std::filesystem::path file;

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

    static Result<std::unique_ptr<State>> make(std::unique_ptr<probe::ByteSource> source,
                                               const Limits& limits, Diagnostics& diagnostics) {
        PFVOX_TRY(auto, head, probe::readHead(*source, limits, diagnostics));
        auto state = std::make_unique<State>();
        state->source = std::move(source);
        state->head = std::move(head);
        return state;
    }
};

ProbeFileReader::ProbeFileReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
ProbeFileReader::ProbeFileReader(ProbeFileReader&&) noexcept = default;
ProbeFileReader& ProbeFileReader::operator=(ProbeFileReader&&) noexcept = default;
ProbeFileReader::~ProbeFileReader() = default;

Result<ProbeFileReader> ProbeFileReader::open(const std::filesystem::path& file, const Limits& limits,
                                              Diagnostics& diagnostics) {
    PFVOX_TRY(auto, opened, io::RandomFile::openForReading(file, limits.maxFileBytes));
    auto state = State::make(std::make_unique<probe::FileSource>(std::move(opened)), limits, diagnostics);
    if (!state) {
        state.error().file = file;
        return tl::make_unexpected(std::move(state).error());
    }
    (*state)->file = file;
    return ProbeFileReader(*std::move(state));
}

Result<ProbeFileReader> ProbeFileReader::overBytes(std::span<const std::byte> bytes, const Limits& limits,
                                                   Diagnostics& diagnostics) {
    PFVOX_TRY(auto, state, State::make(std::make_unique<probe::MemorySource>(bytes), limits, diagnostics));
    return ProbeFileReader(std::move(state));
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
    return state_->probeAt(probe).frames[static_cast<std::size_t>(layer)].storedBytes != 0;
}

ProbeFrame ProbeFileReader::frame(std::uint32_t probe, ProbeLayer layer) const {
    const probe_layout::Frame& frame = state_->probeAt(probe).frames[static_cast<std::size_t>(layer)];
    return {.offsetBytes = state_->offsetOf(probe, layer),
            .storedBytes = frame.storedBytes,
            .codec = probe::toString(frame.codec),
            .rawHash = frame.rawHash};
}

Result<std::vector<std::byte>> ProbeFileReader::readStored(std::uint32_t probe, ProbeLayer layer) const {
    std::vector<std::byte> stored(frame(probe, layer).storedBytes);
    PFVOX_CHECK(state_->placed(state_->source->readAt(state_->offsetOf(probe, layer), stored), probe, layer));
    return stored;
}

Result<void> ProbeFileReader::readLayer(std::uint32_t probe, ProbeLayer layer,
                                        std::span<std::byte> words) const {
    PFVOX_ASSERT(words.size() == info().resolution.bytesOf(layer));
    PFVOX_TRY(const auto, stored, readStored(probe, layer));
    const probe_layout::Frame& frame = state_->probeAt(probe).frames[static_cast<std::size_t>(layer)];
    return state_->placed(probe::unpackFrame(layer, frame, stored, words), probe, layer);
}

Result<ProbeData> ProbeFileReader::readProbe(std::uint32_t probe) const {
    ProbeData data{.record = record(probe), .inputHash = inputHash(probe)};
    for (const ProbeLayer layer : probe::kAllLayers) {
        if (!has(probe, layer)) continue;
        PFVOX_CHECK(readLayer(probe, layer, data.resizeLayer(layer, info().resolution.bytesOf(layer))));
    }
    return data;
}

}  // namespace pfvox

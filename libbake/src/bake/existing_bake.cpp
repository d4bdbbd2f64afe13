#include <tbb/parallel_for.h>

#include <mutex>
#include <pfvox/bake.hpp>
#include <pfvox/probe_file.hpp>
#include <vector>

namespace pfvox {

namespace {

/// What is wrong with the first probe whose maps are not what their hashes say.
std::string damageIn(const ProbeFileReader& reader) {
    const ProbeRange range = reader.info().range;
    std::mutex mutex;
    std::uint32_t first = range.end;
    std::string damage;
    tbb::parallel_for(range.first, range.end, [&](std::uint32_t probe) {
        std::vector<std::byte> words;
        for (std::size_t i = 0; i < kProbeLayerCount; ++i) {
            const auto layer = static_cast<ProbeLayer>(i);
            if (!reader.has(probe, layer)) continue;
            words.resize(reader.info().resolution.bytesOf(layer));
            const auto read = reader.readLayer(probe, layer, words);
            if (read) continue;
            const std::scoped_lock lock(mutex);
            if (probe >= first) return;
            first = probe;
            damage = describe(read.error());
            return;
        }
    });
    if (!damage.empty() || !reader.faces()) return damage;
    const FaceChunkRange chunks = reader.faces()->range;
    tbb::parallel_for(chunks.first, chunks.end, [&](std::uint32_t chunk) {
        const auto read = reader.readFaceChunk(chunk);
        if (read) return;
        const std::scoped_lock lock(mutex);
        if (damage.empty()) damage = describe(read.error());
    });
    return damage;
}

ProbeCounts countsIn(const ProbeFileReader& reader) {
    std::vector<ProbeRecord> records;
    const ProbeRange range = reader.info().range;
    for (std::uint32_t probe = range.first; probe < range.end; ++probe)
        records.push_back(reader.record(probe));
    return countProbes(records);
}

}  // namespace

ExistingBake inspectBake(const std::filesystem::path& output, const ContentKey& key,
                         const ProbeRange& range) {
    using State = ExistingBake::State;
    std::error_code ignored;
    if (!std::filesystem::exists(output, ignored)) return {};
    DiagnosticList unused;
    const auto reader = ProbeFileReader::open(output, Limits{}, unused);
    if (!reader) {
        const ErrorCode code = reader.error().code;
        const bool damaged = code == ErrorCode::ChecksumMismatch || code == ErrorCode::BadStructure;
        return {.state = damaged ? State::Damaged : State::Unreadable,
                .damage = damaged ? describe(reader.error()) : std::string()};
    }
    ExistingBake existing{.state = State::UpToDate, .fileBytes = reader->fileBytes()};
    if (reader->info().range != range) {
        existing.state = State::OtherProbes;
    } else if (reader->contentKey() != key) {
        existing.state = State::OtherContent;
    } else if (existing.damage = damageIn(*reader); !existing.damage.empty()) {
        existing.state = State::Damaged;
    } else {
        existing.counts = countsIn(*reader);
    }
    return existing;
}

}  // namespace pfvox

// ProbeFileWriter: a journal that becomes a file.
#include <fmt/format.h>

#include <mutex>
#include <pfvox/files.hpp>
#include <pfvox/probe_file.hpp>

#include "guarded.hpp"
#include "io/hash.hpp"
#include "pf_probe/frame_codec.hpp"
#include "pf_probe/journal.hpp"
#include "pf_probe/probe_list.hpp"

namespace pfvox {

struct ProbeFileWriter::State {
    std::filesystem::path output;
    probe::WritePlan plan;
    ProbeEncodeSettings encode;
    probe::Journal journal;
    io::WriteOptions write;
    probe::Journal::Entries found{};    ///< what a resumed journal had
    probe::Journal::Entries written{};  ///< what counts
    mutable std::mutex mutex{};         ///< of the end of the journal and of `written`

    const ProbeFieldInfo& info() const { return plan.info; }
    std::size_t slotOf(std::uint32_t probe) const { return probe - plan.info.range.first; }
    std::size_t faceSlotOf(std::uint32_t chunk) const { return chunk - plan.faces->range.first; }

    /// A chunk that counts. Errors: BadReference.
    Result<probe::Journal::FaceEntry> faceEntry(std::uint32_t chunk) const;
    static Result<void> checkComplete(std::span<const std::uint32_t> absent, std::uint32_t count,
                                      std::string_view what);
    Result<void> writeFile(const std::optional<ProximityGrid>& proximity) const;
};

std::filesystem::path probeJournalPath(const std::filesystem::path& output) {
    constexpr std::string_view kSuffix = ".journal";
    constexpr std::size_t kMaxNameBytes = 255;  // of most file systems
    constexpr std::size_t kKeptBytes = 200;
    std::string name = output.filename().string();
    if (name.size() + kSuffix.size() > kMaxNameBytes) {
        const std::uint64_t hash = io::xxh3_64(std::as_bytes(std::span(name)));
        std::size_t kept = kKeptBytes;
        while (kept > 0 && (static_cast<unsigned char>(name[kept]) & 0xc0u) == 0x80u)
            --kept;  // between two characters
        name = fmt::format("{}-{:016x}", name.substr(0, kept), hash);
    }
    return output.parent_path() / name.append(kSuffix);
}

ProbeFileWriter::ProbeFileWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
ProbeFileWriter::ProbeFileWriter(ProbeFileWriter&&) noexcept = default;
ProbeFileWriter& ProbeFileWriter::operator=(ProbeFileWriter&&) noexcept = default;
ProbeFileWriter::~ProbeFileWriter() = default;

Result<ProbeFileWriter> ProbeFileWriter::open(const std::filesystem::path& output, const ProbeFieldInfo& info,
                                              const ProbeWriteSettings& settings, Diagnostics& diagnostics) {
    return guarded([&]() -> Result<ProbeFileWriter> {
        PFVOX_CHECK(checkProbeInfo(info));
        PFVOX_CHECK(probe::checkHasContent(info, settings.faces.has_value()));
        probe::WritePlan plan{.info = info, .faces = settings.faces, .places = {}};
        if (plan.faces) {
            plan.faces->chunks.clear();
            PFVOX_CHECK(checkFaceLightInfo(*plan.faces));
            plan.places = faceChunkPlaces(*plan.faces);
        }
        const io::WriteOptions write{.replaceReadOnly = settings.replaceReadOnly};
        PFVOX_CHECK(io::checkReplaceable(output, write));
        probe::Journal::Entries found;
        PFVOX_TRY(auto, journal,
                  probe::Journal::open(probeJournalPath(output), plan, settings.resume, found, diagnostics));
        auto state = std::unique_ptr<State>(new State{.output = output,
                                                      .plan = std::move(plan),
                                                      .encode = settings.encode,
                                                      .journal = std::move(journal),
                                                      .write = write,
                                                      .found = std::move(found)});
        state->written = probe::Journal::Entries(state->plan);
        return ProbeFileWriter(std::move(state));
    });
}

bool ProbeFileWriter::reuse(std::uint32_t probe, const ContentKey& inputHash) {
    if (!state_->info().range.contains(probe) || inputHash == ContentKey{}) return false;
    const std::scoped_lock lock(state_->mutex);
    const auto& found = state_->found.probes[state_->slotOf(probe)];
    if (!found || found->probe.inputHash != inputHash) return false;
    state_->written.probes[state_->slotOf(probe)] = found;
    return true;
}

Result<void> ProbeFileWriter::append(std::uint32_t probe, const ProbeData& data) {
    return guarded([&]() -> Result<void> {
        PFVOX_CHECK(checkProbeData(state_->info(), probe, data));
        PFVOX_TRY(const probe::PackedProbe, packed, probe::packProbe(data, state_->encode.zstdLevel));
        const std::scoped_lock lock(state_->mutex);
        PFVOX_TRY(auto, entry, state_->journal.append(probe, packed));
        state_->written.probes[state_->slotOf(probe)] = std::move(entry);
        return {};
    });
}

std::vector<std::uint32_t> ProbeFileWriter::missing() const {
    const std::scoped_lock lock(state_->mutex);
    std::vector<std::uint32_t> probes;
    for (std::uint32_t i = 0; i < state_->info().range.size(); ++i)
        if (!state_->written.probes[i]) probes.push_back(state_->info().range.first + i);
    return probes;
}

Result<ProbeData> ProbeFileWriter::readProbe(std::uint32_t probe) const {
    return guarded([&]() -> Result<ProbeData> {
        std::optional<probe::Journal::Entry> entry;
        if (state_->info().range.contains(probe)) {
            const std::scoped_lock lock(state_->mutex);
            entry = state_->written.probes[state_->slotOf(probe)];
        }
        if (!entry) return fail(ErrorCode::BadReference, fmt::format("probe {} was not written yet", probe));
        PFVOX_TRY(const auto, stored, state_->journal.readStored(*entry));
        ProbeData data{.record = entry->probe.record, .inputHash = entry->probe.inputHash};
        data.record.hash = probe::hashOf(entry->probe.record, entry->probe.frames);
        container::MemoryBudget unlimited(~std::uint64_t{0});
        std::size_t next = 0;
        for (const ProbeLayer layer : probe::kAllLayers) {
            const probe_layout::Frame& frame = entry->probe.frames[static_cast<std::size_t>(layer)];
            if (frame.storedBytes == 0) continue;
            const auto words = data.resizeLayer(layer, state_->info().resolution.bytesOf(layer));
            const auto bytes = std::span(stored).subspan(next, frame.storedBytes);
            PFVOX_CHECK(probe::unpackFrame(layer, frame, bytes, words, unlimited));
            next += frame.storedBytes;
        }
        return data;
    });
}

bool ProbeFileWriter::reuseFaces(std::uint32_t chunk, const ContentKey& inputHash) {
    if (!state_->plan.chunkRange().contains(chunk) || inputHash == ContentKey{}) return false;
    const std::scoped_lock lock(state_->mutex);
    const auto& found = state_->found.faces[state_->faceSlotOf(chunk)];
    if (!found || found->chunk.record.inputHash != inputHash) return false;
    state_->written.faces[state_->faceSlotOf(chunk)] = found;
    return true;
}

Result<void> ProbeFileWriter::appendFaces(std::uint32_t chunk, const FaceChunk& light,
                                          const FaceChunkRecord& record) {
    return guarded([&]() -> Result<void> {
        const FaceChunkRange range = state_->plan.chunkRange();
        if (!range.contains(chunk))
            return fail(ErrorCode::BadReference,
                        fmt::format("chunk {} is outside the chunks {}:{}", chunk, range.first, range.end));
        PFVOX_CHECK(checkFaceChunk(state_->plan.faceCount(chunk), light, record));
        PFVOX_TRY(
            const faces::PackedChunk, packed,
            faces::packChunk(state_->plan.faces->settings.codec, light, record, state_->encode.zstdLevel));
        const std::scoped_lock lock(state_->mutex);
        PFVOX_TRY(auto, entry, state_->journal.append(chunk, packed));
        state_->written.faces[state_->faceSlotOf(chunk)] = std::move(entry);
        return {};
    });
}

std::vector<std::uint32_t> ProbeFileWriter::missingFaces() const {
    const std::scoped_lock lock(state_->mutex);
    std::vector<std::uint32_t> chunks;
    for (std::uint32_t i = 0; i < state_->written.faces.size(); ++i)
        if (!state_->written.faces[i]) chunks.push_back(state_->plan.faces->range.first + i);
    return chunks;
}

Result<probe::Journal::FaceEntry> ProbeFileWriter::State::faceEntry(std::uint32_t chunk) const {
    if (plan.chunkRange().contains(chunk)) {
        const std::scoped_lock lock(mutex);
        if (const auto& entry = written.faces[faceSlotOf(chunk)]) return *entry;
    }
    return fail(ErrorCode::BadReference, fmt::format("chunk {} was not written yet", chunk));
}

Result<FaceChunk> ProbeFileWriter::readFaceChunk(std::uint32_t chunk) const {
    return guarded([&]() -> Result<FaceChunk> {
        PFVOX_TRY(const auto, entry, state_->faceEntry(chunk));
        PFVOX_TRY(const auto, stored, state_->journal.readStored(entry));
        container::MemoryBudget unlimited(~std::uint64_t{0});
        return faces::unpackChunk(state_->plan.faces->settings.codec, state_->plan.faceCount(chunk),
                                  entry.chunk, stored, unlimited);
    });
}

Result<FaceChunkRecord> ProbeFileWriter::faceRecord(std::uint32_t chunk) const {
    return guarded([&]() -> Result<FaceChunkRecord> {
        PFVOX_TRY(const auto, entry, state_->faceEntry(chunk));
        return entry.chunk.record;
    });
}

Result<void> ProbeFileWriter::State::checkComplete(std::span<const std::uint32_t> absent, std::uint32_t count,
                                                   std::string_view what) {
    if (absent.empty()) return {};
    return fail(ErrorCode::BadStructure, fmt::format("{} of {} {} are missing: {}", absent.size(), count,
                                                     what, probe::listProbes(probe::rangesOf(absent))));
}

Result<void> ProbeFileWriter::State::writeFile(const std::optional<ProximityGrid>& proximity) const {
    probe::FilePlan file{.info = plan.info,
                         .contentKey = encode.contentKey,
                         .probes = {},
                         .proximity = proximity ? &*proximity : nullptr,
                         .faces = plan.faces ? &*plan.faces : nullptr,
                         .chunks = {}};
    for (const auto& entry : written.probes) file.probes.push_back(entry->probe);
    for (const auto& entry : written.faces) file.chunks.push_back(entry->chunk);
    PFVOX_TRY(const auto, head, probe::composeHead(file));
    PFVOX_TRY(io::AtomicFile, out, io::AtomicFile::create(output, write));
    PFVOX_CHECK(out.write(head));
    for (const auto& entry : written.probes) {
        PFVOX_TRY(const auto, stored, journal.readStored(*entry));
        PFVOX_CHECK(out.write(stored));
    }
    PFVOX_CHECK(out.write(file.gapBeforeFaces(head)));
    for (const auto& entry : written.faces) {
        PFVOX_TRY(const auto, stored, journal.readStored(*entry));
        PFVOX_CHECK(out.write(stored));
    }
    return out.commit();
}

Result<void> ProbeFileWriter::finish(const std::optional<ProximityGrid>& proximity) {
    return guarded([&]() -> Result<void> {
        PFVOX_CHECK(state_->checkComplete(missing(), state_->info().range.size(), "probes"));
        PFVOX_CHECK(state_->checkComplete(missingFaces(), state_->plan.chunkRange().size(),
                                          "chunks of light on faces"));
        PFVOX_CHECK(state_->writeFile(proximity));
        return state_->journal.remove();
    });
}

}  // namespace pfvox

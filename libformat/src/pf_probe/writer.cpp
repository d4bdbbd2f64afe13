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
    ProbeFieldInfo info;
    ProbeEncodeSettings encode;
    probe::Journal journal;
    io::WriteOptions write;
    probe::Journal::Entries found{};    ///< what a resumed journal had
    probe::Journal::Entries written{};  ///< what counts
    mutable std::mutex mutex{};         ///< of the end of the journal and of `written`

    probe::Journal::Entries::size_type slotOf(std::uint32_t index) const { return index - info.range.first; }
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
        const io::WriteOptions write{.replaceReadOnly = settings.replaceReadOnly};
        PFVOX_CHECK(io::checkReplaceable(output, write));
        probe::Journal::Entries found;
        PFVOX_TRY(auto, journal,
                  probe::Journal::open(probeJournalPath(output), info, settings.resume, found, diagnostics));
        auto state = std::unique_ptr<State>(new State{.output = output,
                                                      .info = info,
                                                      .encode = settings.encode,
                                                      .journal = std::move(journal),
                                                      .write = write,
                                                      .found = std::move(found)});
        state->written.resize(info.range.size());
        return ProbeFileWriter(std::move(state));
    });
}

bool ProbeFileWriter::reuse(std::uint32_t probe, const ContentKey& inputHash) {
    if (!state_->info.range.contains(probe) || inputHash == ContentKey{}) return false;
    const std::scoped_lock lock(state_->mutex);
    const auto& found = state_->found[state_->slotOf(probe)];
    if (!found || found->probe.inputHash != inputHash) return false;
    state_->written[state_->slotOf(probe)] = found;
    return true;
}

Result<void> ProbeFileWriter::append(std::uint32_t probe, const ProbeData& data) {
    return guarded([&]() -> Result<void> {
        PFVOX_CHECK(checkProbeData(state_->info, probe, data));
        PFVOX_TRY(const probe::PackedProbe, packed, probe::packProbe(data, state_->encode.zstdLevel));
        const std::scoped_lock lock(state_->mutex);
        PFVOX_TRY(auto, entry, state_->journal.append(probe, packed));
        state_->written[state_->slotOf(probe)] = std::move(entry);
        return {};
    });
}

std::vector<std::uint32_t> ProbeFileWriter::missing() const {
    const std::scoped_lock lock(state_->mutex);
    std::vector<std::uint32_t> probes;
    for (std::uint32_t i = 0; i < state_->info.range.size(); ++i)
        if (!state_->written[i]) probes.push_back(state_->info.range.first + i);
    return probes;
}

Result<ProbeData> ProbeFileWriter::readProbe(std::uint32_t probe) const {
    return guarded([&]() -> Result<ProbeData> {
        std::optional<probe::Journal::Entry> entry;
        if (state_->info.range.contains(probe)) {
            const std::scoped_lock lock(state_->mutex);
            entry = state_->written[state_->slotOf(probe)];
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
            const auto words = data.resizeLayer(layer, state_->info.resolution.bytesOf(layer));
            const auto bytes = std::span(stored).subspan(next, frame.storedBytes);
            PFVOX_CHECK(probe::unpackFrame(layer, frame, bytes, words, unlimited));
            next += frame.storedBytes;
        }
        return data;
    });
}

Result<void> ProbeFileWriter::finish(const std::optional<ProximityGrid>& proximity) {
    return guarded([&]() -> Result<void> {
        if (const auto absent = missing(); !absent.empty()) {
            return fail(ErrorCode::BadStructure,
                        fmt::format("{} of {} probes are missing: {}", absent.size(),
                                    state_->info.range.size(), probe::listProbes(probe::rangesOf(absent))));
        }
        probe::FilePlan plan{.info = state_->info,
                             .contentKey = state_->encode.contentKey,
                             .probes = {},
                             .proximity = proximity ? &*proximity : nullptr};
        for (const auto& entry : state_->written) plan.probes.push_back(entry->probe);
        PFVOX_TRY(const auto, head, probe::composeHead(plan));
        PFVOX_TRY(io::AtomicFile, file, io::AtomicFile::create(state_->output, state_->write));
        PFVOX_CHECK(file.write(head));
        for (const auto& entry : state_->written) {
            PFVOX_TRY(const auto, stored, state_->journal.readStored(*entry));
            PFVOX_CHECK(file.write(stored));
        }
        PFVOX_CHECK(file.commit());
        return state_->journal.remove();
    });
}

}  // namespace pfvox

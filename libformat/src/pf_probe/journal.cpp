#include "pf_probe/journal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "io/hash.hpp"

namespace pfvox::probe {

namespace {

using probe_layout::JournalHeader;
using probe_layout::JournalRecord;

constexpr std::array<char, 4> kDone{'D', 'O', 'N', 'E'};

template <class T>
std::span<const std::byte> bytesOf(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

std::uint64_t hashBefore(const JournalHeader& header) {
    return io::xxh3_64(bytesOf(header).first(offsetof(JournalHeader, headerHash)));
}
std::uint64_t hashBefore(const JournalRecord& record) {
    return io::xxh3_64(bytesOf(record).first(offsetof(JournalRecord, recordHash)));
}

/// All that decides whether frames fit together. What decides their content is in the input hash of each
/// probe.
JournalHeader headerOf(const ProbeFieldInfo& info) {
    JournalHeader header{
        .magic = probe_layout::kJournalMagic,
        .versionMajor = kPfProbeVersionMajor,
        .versionMinor = kPfProbeVersionMinor,
        .endianTag = layout::kEndianTag,
        .gridStart = {info.grid.start.x, info.grid.start.y, info.grid.start.z},
        .gridStep = {info.grid.step.x, info.grid.step.y, info.grid.step.z},
        .gridCounts = {info.grid.counts.x, info.grid.counts.y, info.grid.counts.z},
        .rangeFirst = info.range.first,
        .rangeEnd = info.range.end,
        .depthResolution = info.resolution.depth,
        .lightResolution = info.resolution.light,
        .irradianceResolution = info.resolution.irradiance,
        .momentsResolution = info.resolution.moments,
        .depthScale = info.depth.scale,
        .depthFarMetres = info.depth.farMetres,
        .lightContent = info.lightContent,
        .headerHash = 0,
    };
    header.headerHash = hashBefore(header);
    return header;
}

}  // namespace

Result<void> Journal::begin(const JournalHeader& header) {
    PFVOX_CHECK(file_.truncate(0));
    PFVOX_CHECK(file_.writeAt(0, bytesOf(header)));
    end_ = sizeof header;
    return {};
}

/// Whether the journal begins with this header; says why when it does not.
Result<bool> Journal::isOf(const JournalHeader& header, Diagnostics& diagnostics) const {
    JournalHeader found{};
    const std::uint64_t present = std::min<std::uint64_t>(file_.sizeBytes(), sizeof found);
    PFVOX_CHECK(file_.readAt(0, std::as_writable_bytes(std::span(&found, 1)).first(present)));
    if (std::memcmp(&found, &header, present) == 0) return present == sizeof header;
    const std::string name = file_.path().string();
    const bool isWhole = present == sizeof found && found.magic == header.magic;
    if (isWhole && found.headerHash == hashBefore(found)) {
        diagnostics.warn("probe-journal-other",
                         name +
                             ": is of a bake with another grid, range, resolution, depth encoding or kind of "
                             "light; nothing of it is used");
    } else {
        diagnostics.warn("probe-journal-damaged", name + ": its header is damaged; nothing of it is used");
    }
    return false;
}

Result<Journal::Entry> Journal::readRecord(const ProbeFieldInfo& info, std::uint32_t& index) const {
    JournalRecord record;
    const std::uint64_t left = file_.sizeBytes() - end_;
    if (left < sizeof record) return fail(ErrorCode::Truncated, "the journal ends inside a record");
    PFVOX_CHECK(file_.readAt(end_, std::as_writable_bytes(std::span(&record, 1))));
    if (record.fourcc != kDone || record.recordHash != hashBefore(record))
        return fail(ErrorCode::ChecksumMismatch, "a record is damaged");
    if (!info.range.contains(record.probe))
        return fail(ErrorCode::BadReference, fmt::format("a record of probe {}", record.probe));
    PFVOX_TRY(const ProbeRecord, probeRecord, fromRecord(record.record));
    PFVOX_CHECK(checkFrames(info.resolution, probeRecord, record.frames));
    Entry entry{.probe = {.record = probeRecord, .inputHash = {record.inputHash}, .frames = record.frames},
                .offsetBytes = end_ + sizeof record,
                .payloadHash = record.payloadHash};
    if (entry.probe.storedBytes() > left - sizeof record)
        return fail(ErrorCode::Truncated, fmt::format("the journal ends inside probe {}", record.probe));
    PFVOX_CHECK(readStored(entry));
    index = record.probe;
    return entry;
}

Result<void> Journal::scan(const ProbeFieldInfo& info, Entries& found, Diagnostics& diagnostics) {
    end_ = sizeof(JournalHeader);
    while (end_ < file_.sizeBytes()) {
        std::uint32_t index = 0;
        auto entry = readRecord(info, index);
        if (!entry) {
            const bool isTorn = entry.error().code == ErrorCode::Truncated;
            diagnostics.report(
                {.severity = isTorn ? Severity::Note : Severity::Warning,
                 .id = isTorn ? "probe-journal-torn" : "probe-journal-damaged",
                 .message = fmt::format("{}: @0x{:x}: {}; the {} bytes from there on are not used",
                                        file_.path().string(), end_, entry.error().message,
                                        file_.sizeBytes() - end_),
                 .offsetBytes = end_});
            break;
        }
        end_ = entry->offsetBytes + entry->probe.storedBytes();
        found[index - info.range.first] = *std::move(entry);
    }
    return file_.truncate(end_);
}

Result<Journal> Journal::open(const std::filesystem::path& file, const ProbeFieldInfo& info, bool resume,
                              Entries& found, Diagnostics& diagnostics) {
    PFVOX_TRY(auto, opened, io::RandomFile::openForWriting(file));
    Journal journal(std::move(opened));
    found.assign(info.range.size(), std::nullopt);
    const JournalHeader header = headerOf(info);
    bool isUsable = false;
    if (journal.file_.sizeBytes() != 0 && resume) {
        PFVOX_TRY(const bool, matches, journal.isOf(header, diagnostics));
        isUsable = matches;
    } else if (journal.file_.sizeBytes() > sizeof header) {
        diagnostics.note(
            "probe-journal-discarded",
            file.string() + ": the probes of an unfinished bake are not used, as nothing asked to resume");
    }
    PFVOX_CHECK(isUsable ? journal.scan(info, found, diagnostics) : journal.begin(header));
    return journal;
}

Result<Journal::Entry> Journal::append(std::uint32_t index, const PackedProbe& packed) {
    JournalRecord record{.fourcc = kDone,
                         .probe = index,
                         .inputHash = packed.entry.inputHash.bytes,
                         .record = toRecord(packed.entry.record),
                         .frames = packed.entry.frames,
                         .payloadHash = io::xxh3_64(packed.stored),
                         .recordHash = 0};
    record.recordHash = hashBefore(record);
    Result<void> written = file_.writeAt(end_, bytesOf(record));
    if (written) written = file_.writeAt(end_ + sizeof record, packed.stored);
    if (!written) {
        // A disk that is full: half a record must not stand before the next one.
        static_cast<void>(file_.truncate(end_));
        return tl::make_unexpected(std::move(written).error());
    }
    const Entry entry{
        .probe = packed.entry, .offsetBytes = end_ + sizeof record, .payloadHash = record.payloadHash};
    end_ = entry.offsetBytes + packed.stored.size();
    return entry;
}

Result<std::vector<std::byte>> Journal::readStored(const Entry& entry) const {
    std::vector<std::byte> stored(entry.probe.storedBytes());
    PFVOX_CHECK(file_.readAt(entry.offsetBytes, stored));
    if (io::xxh3_64(stored) != entry.payloadHash) {
        return tl::make_unexpected(Error{.code = ErrorCode::ChecksumMismatch,
                                         .message = "the maps of a probe are damaged",
                                         .file = file_.path(),
                                         .offsetBytes = entry.offsetBytes});
    }
    return stored;
}

}  // namespace pfvox::probe

#include "pf_probe/journal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "io/hash.hpp"
#include "pf_probe/face_section.hpp"

namespace pfvox::probe {

namespace {

using probe_layout::JournalFaceRecord;
using probe_layout::JournalHeader;
using probe_layout::JournalRecord;

constexpr std::array<char, 4> kDone{'D', 'O', 'N', 'E'};
constexpr std::array<char, 4> kFace{'F', 'A', 'C', 'E'};

template <class T>
std::span<const std::byte> bytesOf(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

std::uint64_t hashBefore(const JournalHeader& header) {
    return io::xxh3_64(bytesOf(header).first(offsetof(JournalHeader, headerHash)));
}
template <class Record>
std::uint64_t hashBefore(const Record& record) {
    return io::xxh3_64(bytesOf(record).first(offsetof(Record, recordHash)));
}

/// Which faces the chunks are of, and how they are stored. 0 = none.
std::uint64_t layoutHash(const std::optional<FaceLightInfo>& faces) {
    if (!faces) return 0;
    FaceLightInfo layout = *faces;
    layout.settings = {.codec = faces->settings.codec};
    const std::vector<std::uint8_t> bytes = faceSectionBytes(layout, {});
    return io::xxh3_64(std::as_bytes(std::span(bytes)));
}

/// All that decides whether frames fit together. What decides their content is in the input hash of each
/// probe.
JournalHeader headerOf(const WritePlan& plan) {
    const ProbeFieldInfo& info = plan.info;
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
        .facesHash = layoutHash(plan.faces),
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
                             ": is of a bake with another grid, range, resolution, depth encoding, kind of "
                             "light or other faces; nothing of it is used");
    } else {
        diagnostics.warn("probe-journal-damaged", name + ": its header is damaged; nothing of it is used");
    }
    return false;
}

template <class Record>
Result<Record> Journal::readHead() const {
    Record record;
    if (file_.sizeBytes() - end_ < sizeof record)
        return fail(ErrorCode::Truncated, "the journal ends inside a record");
    PFVOX_CHECK(file_.readAt(end_, std::as_writable_bytes(std::span(&record, 1))));
    if (record.recordHash != hashBefore(record))
        return fail(ErrorCode::ChecksumMismatch, "a record is damaged");
    return record;
}

/// Where the frames of a record lie, which are read once: only hashes are trusted.
Result<Journal::Place> Journal::placeBehind(std::uint64_t headBytes, std::uint64_t payloadHash,
                                            std::uint64_t storedBytes) const {
    const Place place{.offsetBytes = end_ + headBytes, .payloadHash = payloadHash};
    if (storedBytes > file_.sizeBytes() - place.offsetBytes)
        return fail(ErrorCode::Truncated, "the journal ends inside the frames of a record");
    PFVOX_CHECK(readStored(place, storedBytes));
    return place;
}

Result<std::uint64_t> Journal::readProbe(const WritePlan& plan, Entries& found) const {
    const ProbeFieldInfo& info = plan.info;
    PFVOX_TRY(const JournalRecord, record, readHead<JournalRecord>());
    if (!info.range.contains(record.probe))
        return fail(ErrorCode::BadReference, fmt::format("a record of probe {}", record.probe));
    PFVOX_TRY(const ProbeRecord, probeRecord, fromRecord(record.record));
    PFVOX_CHECK(checkFrames(info.resolution, probeRecord, record.frames));
    Entry entry{.probe = {.record = probeRecord, .inputHash = {record.inputHash}, .frames = record.frames},
                .place = {}};
    const std::uint64_t stored = entry.probe.storedBytes();
    PFVOX_TRY(const Place, place, placeBehind(sizeof record, record.payloadHash, stored));
    entry.place = place;
    found.probes[record.probe - info.range.first] = entry;
    return entry.place.offsetBytes + stored;
}

Result<std::uint64_t> Journal::readFaces(const WritePlan& plan, Entries& found) const {
    PFVOX_TRY(const JournalFaceRecord, record, readHead<JournalFaceRecord>());
    if (!plan.chunkRange().contains(record.chunk))
        return fail(ErrorCode::BadReference, fmt::format("a record of chunk {}", record.chunk));
    PFVOX_TRY(auto, chunk,
              fromFaceChunk(plan.faces->settings.codec, plan.faceCount(record.chunk), record.record));
    const std::uint64_t stored = chunk.record.storedBytes;
    PFVOX_TRY(const Place, place, placeBehind(sizeof record, record.payloadHash, stored));
    found.faces[record.chunk - plan.faces->range.first] = FaceEntry{std::move(chunk), place};
    return place.offsetBytes + stored;
}

Result<std::uint64_t> Journal::readRecord(const WritePlan& plan, Entries& found) const {
    std::array<char, 4> fourcc{};
    if (file_.sizeBytes() - end_ < fourcc.size())
        return fail(ErrorCode::Truncated, "the journal ends inside a record");
    PFVOX_CHECK(file_.readAt(end_, std::as_writable_bytes(std::span(fourcc))));
    if (fourcc == kDone) return readProbe(plan, found);
    if (fourcc == kFace) return readFaces(plan, found);
    return fail(ErrorCode::ChecksumMismatch, "a record is damaged");
}

Result<void> Journal::scan(const WritePlan& plan, Entries& found, Diagnostics& diagnostics) {
    end_ = sizeof(JournalHeader);
    while (end_ < file_.sizeBytes()) {
        const auto next = readRecord(plan, found);
        if (!next) {
            const bool isTorn = next.error().code == ErrorCode::Truncated;
            diagnostics.report(
                {.severity = isTorn ? Severity::Note : Severity::Warning,
                 .id = isTorn ? "probe-journal-torn" : "probe-journal-damaged",
                 .message =
                     fmt::format("{}: @0x{:x}: {}; the {} bytes from there on are not used",
                                 file_.path().string(), end_, next.error().message, file_.sizeBytes() - end_),
                 .offsetBytes = end_});
            break;
        }
        end_ = *next;
    }
    return file_.truncate(end_);
}

Result<Journal> Journal::open(const std::filesystem::path& file, const WritePlan& plan, bool resume,
                              Entries& found, Diagnostics& diagnostics) {
    PFVOX_TRY(auto, opened, io::RandomFile::openForWriting(file));
    Journal journal(std::move(opened));
    found = Entries(plan);
    const JournalHeader header = headerOf(plan);
    bool isUsable = false;
    if (journal.file_.sizeBytes() != 0 && resume) {
        PFVOX_TRY(const bool, matches, journal.isOf(header, diagnostics));
        isUsable = matches;
    } else if (journal.file_.sizeBytes() > sizeof header) {
        diagnostics.note(
            "probe-journal-discarded",
            file.string() + ": the probes of an unfinished bake are not used, as nothing asked to resume");
    }
    PFVOX_CHECK(isUsable ? journal.scan(plan, found, diagnostics) : journal.begin(header));
    return journal;
}

/// Precondition: all but the two hashes is there.
template <class Record>
Result<Journal::Place> Journal::write(Record record, std::span<const std::byte> stored) {
    record.payloadHash = io::xxh3_64(stored);
    record.recordHash = hashBefore(record);
    Result<void> written = file_.writeAt(end_, bytesOf(record));
    if (written) written = file_.writeAt(end_ + sizeof record, stored);
    if (!written) {
        // A disk that is full: half a record must not stand before the next one.
        static_cast<void>(file_.truncate(end_));
        return tl::make_unexpected(std::move(written).error());
    }
    const Place place{.offsetBytes = end_ + sizeof record, .payloadHash = record.payloadHash};
    end_ = place.offsetBytes + stored.size();
    return place;
}

Result<Journal::Entry> Journal::append(std::uint32_t probe, const PackedProbe& packed) {
    PFVOX_TRY(const Place, place,
              write(JournalRecord{.fourcc = kDone,
                                  .probe = probe,
                                  .inputHash = packed.entry.inputHash.bytes,
                                  .record = toRecord(packed.entry.record),
                                  .frames = packed.entry.frames,
                                  .payloadHash = 0,
                                  .recordHash = 0},
                    packed.stored));
    return Entry{.probe = packed.entry, .place = place};
}

Result<Journal::FaceEntry> Journal::append(std::uint32_t chunk, const faces::PackedChunk& packed) {
    PFVOX_TRY(const Place, place,
              write(JournalFaceRecord{.fourcc = kFace,
                                      .chunk = chunk,
                                      .record = toFaceChunk(packed.entry),
                                      .payloadHash = 0,
                                      .recordHash = 0},
                    packed.stored));
    return FaceEntry{.chunk = packed.entry, .place = place};
}

Result<std::vector<std::byte>> Journal::readStored(const Place& place, std::uint64_t bytes) const {
    std::vector<std::byte> stored(bytes);
    PFVOX_CHECK(file_.readAt(place.offsetBytes, stored));
    if (io::xxh3_64(stored) != place.payloadHash) {
        return tl::make_unexpected(Error{.code = ErrorCode::ChecksumMismatch,
                                         .message = "the frames of a record are damaged",
                                         .file = file_.path(),
                                         .offsetBytes = place.offsetBytes});
    }
    return stored;
}

}  // namespace pfvox::probe

// Journal: finished probes and chunks of faces beside the output, so that a killed bake goes on where it was.
//
//     JournalHeader | JournalRecord or JournalFaceRecord, stored frames | the next one, stored frames | ...
//
// Records are written one at a time and never changed: a kill at any byte leaves whole records and the
// beginning of one. Only hashes are trusted; behind the first record that does not have them nothing is used.
#pragma once

#include <filesystem>
#include <optional>
#include <pfvox/error.hpp>
#include <vector>

#include "io/random_file.hpp"
#include "pf_probe/composer.hpp"
#include "pf_probe/layout.hpp"

namespace pfvox::probe {

/// What a file will be, as far as it is known before the first probe.
struct WritePlan {
    ProbeFieldInfo info;
    std::optional<FaceLightInfo> faces;
    std::vector<FaceChunkPlace> places;  ///< of all chunks of the scene

    std::uint32_t faceCount(std::uint32_t chunk) const { return places[chunk].faceCount; }
    FaceChunkRange chunkRange() const { return faces ? faces->range : FaceChunkRange{}; }
};

class Journal {
  public:
    /// Where stored frames lie.
    struct Place {
        std::uint64_t offsetBytes = 0;
        std::uint64_t payloadHash = 0;
    };
    /// A probe and its frames.
    struct Entry {
        StoredProbe probe;
        Place place;
    };
    /// A chunk of faces and its frames.
    struct FaceEntry {
        faces::StoredChunk chunk;
        Place place;
    };
    /// By probe, from info.range.first on, and by chunk, from faces->range.first on.
    struct Entries {
        std::vector<std::optional<Entry>> probes;
        std::vector<std::optional<FaceEntry>> faces;

        Entries() = default;
        explicit Entries(const WritePlan& plan)
            : probes(plan.info.range.size()), faces(plan.chunkRange().size()) {}
    };

    /// Opens the journal for this process alone. With `resume`, `found` gets what is in it, of several
    /// records of one thing the last; else it starts over. Errors: FileNotWritable, FileNotReadable.
    static Result<Journal> open(const std::filesystem::path& file, const WritePlan& plan, bool resume,
                                Entries& found, Diagnostics& diagnostics);

    /// Not thread-safe: a record that is whole must not stand behind one that is not. Errors:
    /// FileNotWritable.
    Result<Entry> append(std::uint32_t probe, const PackedProbe& packed);
    Result<FaceEntry> append(std::uint32_t chunk, const faces::PackedChunk& packed);

    /// The stored frames. Thread-safe. Errors: FileNotReadable, Truncated, ChecksumMismatch.
    Result<std::vector<std::byte>> readStored(const Entry& entry) const {
        return readStored(entry.place, entry.probe.storedBytes());
    }
    Result<std::vector<std::byte>> readStored(const FaceEntry& entry) const {
        return readStored(entry.place, entry.chunk.record.storedBytes);
    }

    Result<void> remove() { return file_.remove(); }

  private:
    explicit Journal(io::RandomFile file) : file_(std::move(file)) {}
    Result<void> begin(const probe_layout::JournalHeader& header);
    Result<bool> isOf(const probe_layout::JournalHeader& header, Diagnostics& diagnostics) const;
    Result<void> scan(const WritePlan& plan, Entries& found, Diagnostics& diagnostics);
    template <class Record>
    Result<Record> readHead() const;
    Result<Place> placeBehind(std::uint64_t headBytes, std::uint64_t payloadHash,
                              std::uint64_t storedBytes) const;
    /// Reads a record into `found`; where the next one begins.
    Result<std::uint64_t> readRecord(const WritePlan& plan, Entries& found) const;
    Result<std::uint64_t> readProbe(const WritePlan& plan, Entries& found) const;
    Result<std::uint64_t> readFaces(const WritePlan& plan, Entries& found) const;
    template <class Record>
    Result<Place> write(Record record, std::span<const std::byte> stored);
    Result<std::vector<std::byte>> readStored(const Place& place, std::uint64_t bytes) const;

    io::RandomFile file_;
    std::uint64_t end_ = 0;  ///< where the next record goes
};

}  // namespace pfvox::probe

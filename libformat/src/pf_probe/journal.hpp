// Journal: finished probes beside the output, so that a killed bake goes on where it was.
//
//     JournalHeader | JournalRecord, stored frames | JournalRecord, stored frames | ...
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

class Journal {
  public:
    /// A probe and where its frames lie.
    struct Entry {
        StoredProbe probe;
        std::uint64_t offsetBytes = 0;
        std::uint64_t payloadHash = 0;
    };
    /// By probe, from info.range.first on.
    using Entries = std::vector<std::optional<Entry>>;

    /// Opens the journal for this process alone. With `resume`, `found` gets what is in it, of several
    /// records of a probe the last; else it begins anew. Errors: FileNotWritable, FileNotReadable.
    static Result<Journal> open(const std::filesystem::path& file, const ProbeFieldInfo& info, bool resume,
                                Entries& found, Diagnostics& diagnostics);

    /// Not thread-safe: a record that is whole must not stand behind one that is not. Errors:
    /// FileNotWritable.
    Result<Entry> append(std::uint32_t index, const PackedProbe& packed);

    /// The stored frames. Thread-safe. Errors: FileNotReadable, Truncated, ChecksumMismatch.
    Result<std::vector<std::byte>> readStored(const Entry& entry) const;

    Result<void> remove() { return file_.remove(); }

  private:
    explicit Journal(io::RandomFile file) : file_(std::move(file)) {}
    Result<void> begin(const probe_layout::JournalHeader& header);
    Result<bool> isOf(const probe_layout::JournalHeader& header, Diagnostics& diagnostics) const;
    Result<void> scan(const ProbeFieldInfo& info, Entries& found, Diagnostics& diagnostics);
    Result<Entry> readRecord(const ProbeFieldInfo& info, std::uint32_t& index) const;

    io::RandomFile file_;
    std::uint64_t end_ = 0;  ///< where the next record goes
};

}  // namespace pfvox::probe

// Probe files read and written one probe, or one chunk of light on faces, at a time: a bake of 512 probes of
// 8 MB never is in memory as a whole.
//
//     ProbeFileWriter::open -> reuse / append (any order, any thread) -> finish -> out.pf_probe
//     ProbeFileReader::open -> readLayer / readProbe (any order, any thread)
//     mergeProbeFields: shards -> the whole
//
// The writer collects finished probes in a journal beside the output, "out.pf_probe.journal". finish() copies
// them from there, in the order of their indices, into the output, which appears complete or not at all, and
// removes the journal: the bytes do not depend on the order in which probes came, nor on how often the bake
// was killed and resumed. Why so: docs/decisions/011-probe-file.md.
#pragma once

#include <filesystem>
#include <memory>
#include <pfvox/pf_probe.hpp>

namespace pfvox {

/// Where a layer lies in its file.
struct ProbeFrame {
    std::uint64_t offsetBytes = 0;
    std::uint32_t storedBytes = 0;  ///< after compression
    std::string_view codec;         ///< "raw" or "predicted"
    std::uint64_t rawHash = 0;      ///< xxh3-64 of the words
};

/// How a chunk of light on faces lies in its file: levels, then planes of values, one behind the other.
struct FaceFrames {
    std::uint64_t offsetBytes = 0;
    std::uint32_t levelBytes = 0;                   ///< of the runs of levels, before compression
    std::array<std::uint32_t, 6> storedBytes = {};  ///< of the runs, then of each plane
    bool operator==(const FaceFrames&) const = default;
};

/// Random access to a file. Opening reads and checks everything but the maps; each map is checked when it is
/// read. All const functions may be called from several threads at once.
class ProbeFileReader {
  public:
    /// Errors: FileNotFound, FileNotReadable and those of decodePfProbe, each with `file`.
    static Result<ProbeFileReader> open(const std::filesystem::path& file, const Limits& limits,
                                        Diagnostics& diagnostics);
    /// `bytes` must outlive the reader.
    static Result<ProbeFileReader> overBytes(std::span<const std::byte> bytes, const Limits& limits,
                                             Diagnostics& diagnostics);
    ProbeFileReader(ProbeFileReader&&) noexcept;
    ProbeFileReader& operator=(ProbeFileReader&&) noexcept;
    ~ProbeFileReader();

    const ProbeFieldInfo& info() const;                     ///< all but the probes
    ContentKey contentKey() const;                          ///< of what it was made from
    std::uint16_t versionMinor() const;                     ///< of the format, as the file has it
    std::uint64_t fileBytes() const;                        ///< of the file
    const std::optional<ProximityGrid>& proximity() const;  ///< none in shards

    /// Light on faces but for the light, if the file has it.
    const std::optional<FaceLightInfo>& faces() const;

    /// Precondition of the two that follow: faces()->range.contains(chunk).
    /// The light of a chunk, checked. Memory is taken from the limit only while it is read. Errors: as
    /// readLayer; BadValue.
    Result<FaceChunk> readFaceChunk(std::uint32_t chunk) const;
    FaceFrames faceFrames(std::uint32_t chunk) const;  ///< where it lies
    /// The frames as they are stored, unchecked. Errors: FileNotReadable, Truncated.
    Result<std::vector<std::byte>> readStoredFaces(std::uint32_t chunk) const;

    /// Precondition of all that follow: info().range.contains(probe).
    const ProbeRecord& record(std::uint32_t probe) const;
    const ContentKey& inputHash(std::uint32_t probe) const;  ///< of what the probe was made from
    /// Where the probe stands, metres.
    glm::vec3 positionOf(std::uint32_t probe) const;  ///< counts from grid.origin
    /// Whether there is something to read: not for layers that the file does not have, nor for inactive
    /// probes.
    bool has(std::uint32_t probe, ProbeLayer layer) const;
    /// Precondition: has(probe, layer).
    ProbeFrame frame(std::uint32_t probe, ProbeLayer layer) const;

    /// Fills `words` (info().resolution.bytesOf(layer) bytes) with a map: straight into a mapped staging
    /// buffer, for example. Precondition: has(probe, layer). Errors: FileNotReadable, Truncated (the file
    /// became shorter), ChecksumMismatch, BadStructure, LimitExceeded (memory).
    Result<void> readLayer(std::uint32_t probe, ProbeLayer layer, std::span<std::byte> words) const;
    /// The probe with all its maps. Errors: as readLayer.
    Result<ProbeData> readProbe(std::uint32_t probe) const;
    /// All probes, read in parallel in the calling TBB arena. Errors: as readLayer; LimitExceeded.
    Result<ProbeField> readField() const;
    /// The frame as it is stored, unchecked: for copying into another file.
    Result<std::vector<std::byte>> readStored(std::uint32_t probe, ProbeLayer layer) const;

  private:
    struct State;
    explicit ProbeFileReader(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// decodePfProbe and validatePfProbe on a file; validation needs the memory of one probe only.
Result<ProbeField> loadPfProbe(const std::filesystem::path& file, const Limits& limits,
                               Diagnostics& diagnostics);
std::vector<Finding> validatePfProbeFile(const std::filesystem::path& file,
                                         const Limits& limits);  ///< all of them

/// "out.pf_probe" -> "out.pf_probe.journal". Where that is longer than file names may be: the beginning of
/// the name and a hash of it.
std::filesystem::path probeJournalPath(const std::filesystem::path& output);
/// How a file is begun.
struct ProbeWriteSettings {
    ProbeEncodeSettings encode;    ///< key and compression
    bool resume = false;           ///< take what a journal beside the output holds; else begin a new one
    bool replaceReadOnly = false;  ///< replace an output that is read-only, too
    /// The file has light on faces: of the chunks of this range. `chunks` is not used.
    std::optional<FaceLightInfo> faces = {};
};

/// Writes a file probe by probe.
class ProbeFileWriter {
  public:
    /// Begins or resumes. A journal of another grid, range, resolution, depth encoding or other faces is not
    /// used, and one that is damaged only up to the damage; both are reported ("probe-journal-other",
    /// "probe-journal-damaged"). Errors: those of checkProbeInfo; FileNotWritable (also while another process
    /// writes the same journal, and for an output that could not be replaced in the end).
    static Result<ProbeFileWriter> open(const std::filesystem::path& output, const ProbeFieldInfo& info,
                                        const ProbeWriteSettings& settings, Diagnostics& diagnostics);
    ProbeFileWriter(ProbeFileWriter&&) noexcept;
    ProbeFileWriter& operator=(ProbeFileWriter&&) noexcept;
    /// Without finish() the journal stays, for the next run.
    ~ProbeFileWriter();

    /// True when the resumed journal has this probe, made from inputs of this hash: it then counts as
    /// written, and need not be computed again. A zero hash is never equal.
    bool reuse(std::uint32_t probe, const ContentKey& inputHash);

    /// Compresses the maps on the calling thread and adds the probe; a second time replaces the first. When
    /// this returns, a killed process no longer loses the probe. Thread-safe. Errors: those of
    /// checkProbeData, FileNotWritable.
    Result<void> append(std::uint32_t probe, const ProbeData& data);

    /// The same three for chunks of light on faces. The record gets its counts and hash here. Errors of
    /// appendFaces: those of checkFaceChunk, BadReference, FileNotWritable.
    bool reuseFaces(std::uint32_t chunk, const ContentKey& inputHash);
    Result<void> appendFaces(std::uint32_t chunk, const FaceChunk& light, const FaceChunkRecord& record);
    std::vector<std::uint32_t> missingFaces() const;
    /// A chunk that was appended or reused, as a reader of the file will have it, and what is known about it.
    /// Thread-safe. Errors: as readProbe.
    Result<FaceChunk> readFaceChunk(std::uint32_t chunk) const;
    Result<FaceChunkRecord> faceRecord(std::uint32_t chunk) const;

    /// Probes of the range that are neither appended nor reused, ascending.
    std::vector<std::uint32_t> missing() const;
    /// A probe that was appended or reused, read back. Thread-safe. Errors: BadReference, FileNotReadable,
    /// ChecksumMismatch.
    Result<ProbeData> readProbe(std::uint32_t probe) const;

    /// Writes the output and removes the journal. Errors: BadStructure (probes or chunks are missing: they
    /// are named), those of checkProximityGrid, FileNotWritable. After an error the journal is still there.
    Result<void> finish(const std::optional<ProximityGrid>& proximity);

  private:
    struct State;
    explicit ProbeFileWriter(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};
/// What the joined file gets beside the probes.
struct ProbeMergeSettings {
    ContentKey contentKey;                   ///< zero: it is never up to date
    std::optional<ProximityGrid> proximity;  ///< for the output; those of the inputs are dropped, but a
                                             ///< single input's is kept when none is given here
    bool allowPart = false;                  ///< the output may be a shard again, as long as it has no holes
};

/// Joins shards, in any order, to one file. Maps and light on faces are copied as they are stored, so that
/// the bytes are those that an unsharded bake would have written. Different devices are allowed and reported
/// ("probe-merge-devices"). Errors: BadStructure when the shards disagree (each difference is named; where
/// only content keys of one device do, a setting that the files do not keep does), or probes are missing or
/// in two shards (they are named); those of ProbeFileReader::open; FileNotWritable.
Result<void> mergeProbeFields(std::span<const std::filesystem::path> shards,
                              const std::filesystem::path& output, const ProbeMergeSettings& settings,
                              const Limits& limits, Diagnostics& diagnostics);

}  // namespace pfvox

// Layout of a PF_PROBE 1.2 file, byte for byte. docs/format-pf_probe.md says the same in words; change both
// or none. Header and section table are those of container/layout.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <pfvox/pf_probe.hpp>

#include "container/layout.hpp"

namespace pfvox::probe_layout {

/// As the magic of files.
inline constexpr std::array<std::uint8_t, 8> kJournalMagic{'P', 'F', 'P', 'R', 'J', '\r', '\n', 0x1a};

/// INFO; the bytes of both names follow.
struct Info {
    std::array<float, 3> gridStart;
    std::array<float, 3> gridStep;
    std::array<std::uint32_t, 3> gridCounts;
    std::uint32_t rangeFirst;
    std::uint32_t rangeEnd;
    std::uint32_t depthResolution;
    std::uint32_t lightResolution;
    std::uint32_t irradianceResolution;
    std::uint32_t momentsResolution;
    float depthScale;
    float depthFarMetres;
    std::uint32_t lightContent;
    std::uint64_t seed;
    std::uint32_t tracedResolution;
    std::uint32_t minSamples;
    std::uint32_t maxSamples;
    std::uint32_t maxBounces;
    float noiseTarget;
    std::uint32_t reserved;
    std::array<std::uint8_t, 16> sceneHash;
    std::array<std::uint8_t, 16> shaderHash;
    std::uint32_t deviceNameBytes;
    std::uint32_t toolNameBytes;
};
static_assert(sizeof(Info) == 144 && offsetof(Info, seed) == 72 && offsetof(Info, sceneHash) == 104);

/// ORIG, of a field that does not count from the origin of the world. Since 1.1.
struct Origin {
    std::array<double, 3> origin;
};
static_assert(sizeof(Origin) == 24);

/// BAKE, one a setting that INFO does not have, ascending by id (ProbeSetting). Since 1.1.
struct Setting {
    std::uint32_t id;
    std::uint32_t reserved;
    std::uint64_t value;  ///< a number, 0 or 1, or the bits of a float
};
static_assert(sizeof(Setting) == 16 && offsetof(Setting, value) == 8);

/// Record::error where it is unknown, since 1.1: a number, so that readers of 1.0 take it.
inline constexpr float kUnknownError = std::numeric_limits<float>::max();

/// PROB, one a probe.
struct Record {
    std::array<float, 3> offset;
    std::uint8_t state;
    std::uint8_t reserved;
    std::uint16_t flags;
    std::uint64_t hash;
    float error;
    float noisyTileFraction;
};
static_assert(sizeof(Record) == 32 && offsetof(Record, hash) == 16);

/// FRAM, one a probe and layer. The frames lie in DATA, one behind the other, in this order.
enum class FrameCodec : std::uint32_t {
    Raw = 0,
    Predicted = 1,  ///< zstd of the planes that pf_probe/predictor.hpp makes
};
struct Frame {
    std::uint32_t storedBytes;  ///< 0 = the probe has no such layer
    FrameCodec codec;
    std::uint64_t rawHash;
};
static_assert(sizeof(Frame) == 16);

/// PROX; kProbesPerCell indices a cell of 16 or 32 bits follow, all ones = none.
struct Proximity {
    std::array<float, 3> start;
    std::array<float, 3> step;
    std::array<std::uint32_t, 3> counts;
    std::uint32_t indexBits;
};
static_assert(sizeof(Proximity) == 40);

/// FACE: this, then settings (Setting), instances (FaceInstance), for each region of each instance a u32
/// number of faces, and the chunks (FaceChunk) of the range. Since 1.2.
struct Faces {
    std::uint32_t facesPerChunk;
    std::uint32_t rangeFirst;
    std::uint32_t rangeEnd;
    std::uint32_t settingCount;
    std::uint32_t instanceCount;
    std::uint32_t regionCount;  ///< of all instances
};
static_assert(sizeof(Faces) == 24);

struct FaceInstance {
    std::array<std::uint8_t, 16> index;
    std::uint32_t regionCount;
};
static_assert(sizeof(FaceInstance) == 20);

/// The frames of chunks lie in FDAT, one behind the other.
struct FaceChunk {
    std::uint64_t hash;
    std::array<std::uint8_t, 16> inputHash;
    float noise;  ///< kUnknownError = unknown
    float cappedFraction;
    std::uint32_t valueCount;
    std::uint32_t levelBytes;                  ///< of the runs of levels, before compression
    std::array<std::uint32_t, 6> storedBytes;  ///< of the runs, then of each plane; 0 = there is none
};
static_assert(sizeof(FaceChunk) == 64 && offsetof(FaceChunk, storedBytes) == 40);

/// The journal begins with this; a journal is good for a bake that would begin with the same bytes.
struct JournalHeader {
    std::array<std::uint8_t, 8> magic;
    std::uint16_t versionMajor;
    std::uint16_t versionMinor;
    std::uint32_t endianTag;
    std::array<float, 3> gridStart;
    std::array<float, 3> gridStep;
    std::array<std::uint32_t, 3> gridCounts;
    std::uint32_t rangeFirst;
    std::uint32_t rangeEnd;
    std::uint32_t depthResolution;
    std::uint32_t lightResolution;
    std::uint32_t irradianceResolution;
    std::uint32_t momentsResolution;
    float depthScale;
    float depthFarMetres;
    std::uint32_t lightContent;
    std::uint64_t facesHash;   ///< xxh3-64 of FACE as it is before the first chunk; 0 = no light on faces
    std::uint64_t headerHash;  ///< xxh3-64 of all before
};
static_assert(sizeof(JournalHeader) == 104 && offsetof(JournalHeader, headerHash) == 96);

/// Before the frames of each finished probe.
struct JournalRecord {
    std::array<char, 4> fourcc;  ///< "DONE"
    std::uint32_t probe;
    std::array<std::uint8_t, 16> inputHash;
    Record record;
    std::array<Frame, kProbeLayerCount> frames;  ///< in the order of ProbeLayer; absent ones are zero
    std::uint64_t payloadHash;                   ///< xxh3-64 of the stored frames that follow
    std::uint64_t recordHash;                    ///< xxh3-64 of all before in this struct
};
static_assert(sizeof(JournalRecord) == 152 && offsetof(JournalRecord, recordHash) == 144);

/// Before the frames of each finished chunk of faces.
struct JournalFaceRecord {
    std::array<char, 4> fourcc;  ///< "FACE"
    std::uint32_t chunk;
    FaceChunk record;
    std::uint64_t payloadHash;  ///< as in JournalRecord
    std::uint64_t recordHash;
};
static_assert(sizeof(JournalFaceRecord) == 88 && offsetof(JournalFaceRecord, recordHash) == 80);

}  // namespace pfvox::probe_layout

// FaceLight: light on the faces of voxels, as a bake makes it and a PF_PROBE file keeps it. Where the bytes
// are described: docs/format-pf_probe.md.
//
//     baker -> FaceChunk, chunk by chunk -> [ProbeFileWriter] -> file -> [ProbeFileReader] -> viewer
//
// A face has I = E / pi of indirect irradiance E, as probes do (pfvox/pf_probe.hpp), as one value or as
// 2^level by 2^level of them. A value is a word RGB9E5: packRgb9e5() of shared/faces.glsl.h.
//
// The faces of a scene are one list: instances in the order of the scene's visible ones, of each the regions
// of its model, of each region the faces in the order of FaceIndex::fileOrder(). The list is cut into chunks;
// a chunk is what is compressed, hashed, kept in a journal and given to a shard as one.
#pragma once

#include <cstdint>
#include <optional>
#include <pfvox/error.hpp>
#include <pfvox/pf_vox.hpp>
#include <pfvox/probe_settings.hpp>
#include <string_view>
#include <vector>

namespace pfvox {

struct FaceIndex;

inline constexpr std::uint8_t kNoFaceValue = 255;          ///< level of a face that another instance covers
inline constexpr std::uint8_t kMaxStoredFaceLevel = 3;     ///< 8 x 8 values
inline constexpr std::uint32_t kFacesPerChunk = 1u << 16;  ///< FaceLightInfo::facesPerChunk of pfvox's files

/// Values of a face of this level. Precondition: it is one.
constexpr std::uint32_t faceValuesOf(std::uint8_t level) {
    return level == kNoFaceValue ? 0u : 1u << 2 * level;
}

/// How values are stored. Both are read as RGB9E5.
enum class FaceCodec : std::uint8_t {
    Quantized,  ///< steps of 1/64 octave and of 1/255 of the color: 0.5 % off, about a third of the bytes
    Lossless,
};
/// "quantized", "lossless".
std::string_view toString(FaceCodec codec);

/// What a value is after it was written and read: itself where the codec is lossless. The stored form of a
/// stored form is the same. Precondition: the exponent is not 31.
std::uint32_t storedFaceValue(FaceCodec codec, std::uint32_t value);

/// How the light was computed. forEachFaceSetting() is the one list of them.
struct FaceBakeSettings {
    std::uint64_t seed = 0;
    std::uint32_t baseRays = 0;  ///< linked rays of a face
    std::uint32_t sweeps = 0;    ///< of the light along the links
    std::uint32_t minRays = 0;   ///< of a value in the last gather
    std::uint32_t maxRays = 0;   ///< equal to minRays when not adaptive
    float noiseTarget = 0.0f;    ///< relative standard error at which a value stops; 0 = not adaptive
    std::uint32_t maxBounces = kUnlimitedBounces;  ///< reflections of a path
    std::uint32_t sampling = 0;                    ///< which light paths look for: a LightSampling
    bool divide = false;                           ///< faces with sharp light have more values than one
    FaceCodec codec = FaceCodec::Quantized;
    bool operator==(const FaceBakeSettings&) const = default;
};

/// Calls visit(ProbeSetting, value of the first settings, value of the second ...) for each setting. Ids are
/// those of the entries in a file; a setting that probes have, too, has their id.
template <class Visit, class... Settings>
void forEachFaceSetting(const Visit& visit, Settings&... of) {
    visit(ProbeSetting{kBouncesId, "maxBounces", "--bounces"}, of.maxBounces...);
    visit(ProbeSetting{3, "sampling", "light sampling"}, of.sampling...);
    visit(ProbeSetting{16, "seed", "--seed"}, of.seed...);
    visit(ProbeSetting{17, "baseRays", "linked rays"}, of.baseRays...);
    visit(ProbeSetting{18, "sweeps", "sweeps"}, of.sweeps...);
    visit(ProbeSetting{19, "minRays", "least rays"}, of.minRays...);
    visit(ProbeSetting{20, "maxRays", "most rays"}, of.maxRays...);
    visit(ProbeSetting{21, "noiseTarget", "--noise"}, of.noiseTarget...);
    visit(ProbeSetting{22, "divide", "divided faces"}, of.divide...);
    visit(ProbeSetting{23, "codec", "codec of faces"}, of.codec...);
}
/// In the order of forEachFaceSetting(); empty = the same settings.
std::vector<ProbeSettingDifference> differencesOf(const FaceBakeSettings& first,
                                                  const FaceBakeSettings& second);

/// Which faces a placed instance has.
struct FaceInstance {
    ContentKey index;                       ///< keyOf() the FaceIndex of its model
    std::vector<std::uint32_t> faceCounts;  ///< by region of the model
    bool operator==(const FaceInstance&) const = default;
};
/// Of regions, bricks and masks: equal keys = the same faces in the same order.
ContentKey keyOf(const FaceIndex& index);
/// The instance of a model with this index.
FaceInstance faceInstanceOf(const FaceIndex& index);

/// A half-open range of chunks.
struct FaceChunkRange {
    std::uint32_t first = 0;  ///< inclusive
    std::uint32_t end = 0;    ///< exclusive

    std::uint32_t size() const { return end - first; }  ///< Number of chunks.
    bool contains(std::uint32_t chunk) const {
        return chunk >= first && chunk < end;
    }  ///< Whether the chunk is in it.
    bool operator==(const FaceChunkRange&) const = default;
};

/// The faces of a chunk: those of this region, the next one of the instance, and so on to the next instance,
/// until there are `faceCount`.
struct FaceChunkPlace {
    std::uint32_t instance = 0;
    std::uint32_t region = 0;  ///< of the instance's model
    std::uint32_t faceCount = 0;
    bool operator==(const FaceChunkPlace&) const = default;
};

/// What is known about a chunk without its values.
struct FaceChunkRecord {
    std::uint64_t valueCount = 0;  ///< of all its faces; below 2^32
    std::optional<float> noise;    ///< relative standard error of the values; nothing = unknown
    float cappedFraction = 0.0f;   ///< fraction of the values that stopped at maxRays
    ContentKey inputHash;          ///< of all that decided the content; zero = unknown
    /// xxh3-64 of levels and values as they are read: equal hashes = equal light. Writers compute this and
    /// what follows, and take no notice of what stands here.
    std::uint64_t hash = 0;
    std::uint64_t storedBytes = 0;  ///< in the file, after compression
    /// Of all but storedBytes, which is not the light's but the compressor's.
    bool operator==(const FaceChunkRecord& other) const;
};

/// Everything about light on faces but the light.
struct FaceLightInfo {
    FaceBakeSettings settings;
    std::vector<FaceInstance> instances;  ///< visible ones, in the order of the scene
    /// Regions are joined until a chunk has so many faces or more, > 0; none is split.
    std::uint32_t facesPerChunk = kFacesPerChunk;
    FaceChunkRange range;                 ///< the chunks of this file: a shard has a part of them
    std::vector<FaceChunkRecord> chunks;  ///< of `range`; what begins a file has none yet
    bool operator==(const FaceLightInfo&) const = default;
};
/// All chunks of the scene: where each begins. Regions without faces begin none.
std::vector<FaceChunkPlace> faceChunkPlaces(const FaceLightInfo& info);

/// The light of one chunk.
struct FaceChunk {
    std::vector<std::uint8_t> levels;   ///< one a face: 0 to 3, or kNoFaceValue
    std::vector<std::uint32_t> values;  ///< of each face 4^level, rows along axis (a + 1) % 3 of its axis a
    bool operator==(const FaceChunk&) const = default;
};

/// What FaceChunkRecord::hash of this light must be. Precondition: its values are in their stored form.
std::uint64_t hashOf(const FaceChunk& chunk);

/// Light on faces in memory.
struct FaceLight {
    FaceLightInfo info;
    std::vector<FaceChunk> chunks;  ///< of info.range
    bool operator==(const FaceLight&) const = default;
};

/// Whether it can be written: counts, ranges, domains of settings. Errors: BadValue, BadStructure.
Result<void> checkFaceLightInfo(const FaceLightInfo& info);
/// The same of a chunk of `faceCount` faces. Errors: BadStructure (another number of levels or values),
/// BadValue (unknown levels, words with exponent 31, noise that is NaN).
Result<void> checkFaceChunk(std::uint32_t faceCount, const FaceChunk& chunk, const FaceChunkRecord& record);

}  // namespace pfvox

// mergeProbeFields.
#include <fmt/format.h>

#include <algorithm>
#include <pfvox/files.hpp>
#include <pfvox/probe_file.hpp>

#include "guarded.hpp"
#include "pf_probe/composer.hpp"
#include "pf_probe/frame_codec.hpp"
#include "pf_probe/probe_list.hpp"

namespace pfvox {

namespace {

struct Shard {
    std::filesystem::path file;
    ProbeFileReader reader;
};

ProbeRange probesOf(const Shard& shard) {
    return shard.reader.info().range;
}
ProbeRange chunksOf(const Shard& shard) {
    const auto& faces = shard.reader.faces();
    return faces ? ProbeRange{faces->range.first, faces->range.end} : ProbeRange{};
}

struct MergeTarget {
    const std::filesystem::path& output;
    bool allowPart = false;
};

/// What the light of shards must have in common, by name.
void compareFaces(const std::optional<FaceLightInfo>& a, const std::optional<FaceLightInfo>& b,
                  std::vector<std::string>& names) {
    if (!a || !b) {
        if (a.has_value() != b.has_value()) names.emplace_back("kinds of content (light on faces)");
        return;
    }
    if (a->instances != b->instances) names.emplace_back("faces");
    if (a->facesPerChunk != b->facesPerChunk) names.emplace_back("chunks of faces");
}

/// What two shards must have in common, by name.
std::vector<std::string> differences(const ProbeFieldInfo& a, const ProbeFieldInfo& b) {
    std::vector<std::string> names;
    const auto compare = [&](const char* name, bool isEqual) {
        if (!isEqual) names.emplace_back(name);
    };
    compare("grid", a.grid == b.grid);
    compare("resolution", a.resolution == b.resolution);
    compare("depth encoding", a.depth == b.depth);
    compare("kinds of light", a.lightContent == b.lightContent);
    compare("scene", a.sceneHash == b.sceneHash);
    compare("shaders", a.shaderHash == b.shaderHash);
    compare("tool", a.toolName == b.toolName);
    return names;
}

std::string join(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

/// "a was baked with --bounces 2, b with --bounces 4"; empty = with the same settings, as far as files know
/// them.
std::string otherSettings(const Shard& a, const Shard& b) {
    std::vector<std::string> first;
    std::vector<std::string> second;
    const auto add = [&](std::vector<ProbeSettingDifference> differences) {
        for (ProbeSettingDifference& difference : differences) {
            first.push_back(std::move(difference.first));
            second.push_back(std::move(difference.second));
        }
    };
    add(differencesOf(a.reader.info().settings, b.reader.info().settings));
    if (a.reader.faces() && b.reader.faces())
        add(differencesOf(a.reader.faces()->settings, b.reader.faces()->settings));
    if (first.empty()) return {};
    return fmt::format("{} was baked with {}, {} with {}", a.file.string(), join(first), b.file.string(),
                       join(second));
}

/// Why two shards are not of one bake; empty = they are.
std::string disagreement(const Shard& a, const Shard& b) {
    auto names = differences(a.reader.info(), b.reader.info());
    compareFaces(a.reader.faces(), b.reader.faces(), names);
    std::string why = names.empty() ? "" : "other " + join(names);
    if (const std::string settings = otherSettings(a, b); !settings.empty())
        why += (why.empty() ? "" : "; ") + settings;
    const ContentKey key = a.reader.contentKey();
    const ContentKey other = b.reader.contentKey();
    const bool bothKnown = key != ContentKey{} && other != ContentKey{};
    if (why.empty() && bothKnown && key != other && a.reader.info().deviceName == b.reader.info().deviceName)
        why =
            "other content key: a setting or version that the files do not keep is not the same; bake both "
            "again";
    return why;
}

tl::unexpected<Error> refuse(const std::filesystem::path& file, std::string message) {
    return tl::make_unexpected(
        Error{.code = ErrorCode::BadStructure, .message = std::move(message), .file = file});
}

Result<std::vector<Shard>> openShards(std::span<const std::filesystem::path> files, const Limits& limits,
                                      Diagnostics& diagnostics) {
    std::vector<Shard> shards;
    for (const std::filesystem::path& file : files) {
        PFVOX_TRY(auto, reader, ProbeFileReader::open(file, limits, diagnostics));
        shards.push_back({file, std::move(reader)});
    }
    for (const Shard& shard : shards) {
        if (const std::string why = disagreement(shards.front(), shard); !why.empty())
            return refuse(shard.file,
                          fmt::format("does not belong to {}: {}", shards.front().file.string(), why));
    }
    std::ranges::stable_sort(shards, {}, [](const Shard& shard) {
        return std::pair(probesOf(shard).first, chunksOf(shard).first);
    });
    return shards;
}

/// What a shard has of something that is counted; probes and chunks are joined alike.
struct Part {
    std::size_t shard = 0;
    ProbeRange range;
};

/// Those that have something, in its order.
std::vector<Part> partsOf(const std::vector<Shard>& shards, ProbeRange (*rangeOf)(const Shard&)) {
    std::vector<Part> parts;
    for (std::size_t i = 0; i < shards.size(); ++i)
        if (const ProbeRange range = rangeOf(shards[i]); range.size() != 0) parts.push_back({i, range});
    std::ranges::stable_sort(parts, {}, [](const Part& part) { return part.range.first; });
    return parts;
}

/// Of all parts, which have no holes; of no parts where the first of them begins.
ProbeRange coverOf(const std::vector<Part>& parts, ProbeRange whenEmpty) {
    if (parts.empty()) return {whenEmpty.first, whenEmpty.first};
    return {parts.front().range.first, parts.back().range.end};
}

/// Parts must follow each other without overlap and without holes.
Result<void> checkCover(const std::vector<Shard>& shards, const std::vector<Part>& parts, std::uint32_t count,
                        std::string_view what, const MergeTarget& target) {
    std::uint32_t end = target.allowPart && !parts.empty() ? parts.front().range.first : 0;
    std::vector<ProbeRange> absent;
    std::uint64_t absentCount = 0;
    const auto noteHole = [&](ProbeRange hole) {
        if (hole.size() == 0) return;
        absent.push_back(hole);
        absentCount += hole.size();
    };
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const ProbeRange range = parts[i].range;
        if (range.first < end) {
            const ProbeRange twice{range.first, std::min(end, range.end)};
            return refuse(shards[parts[i].shard].file,
                          fmt::format("{} {} are also in another shard ({})", what,
                                      probe::listProbes(std::span(&twice, 1)),
                                      shards[parts[i - 1].shard].file.string()));
        }
        noteHole({end, range.first});
        end = range.end;
    }
    if (!target.allowPart) noteHole({end, count});
    if (absent.empty()) return {};
    return refuse(target.output, fmt::format("{} of {} {} are in no shard: {}", absentCount, count, what,
                                             probe::listProbes(absent)));
}

ProbeFieldInfo mergedInfo(const std::vector<Shard>& shards, ProbeRange range, Diagnostics& diagnostics) {
    ProbeFieldInfo info = shards.front().reader.info();
    info.range = range;
    std::vector<std::string> devices;
    for (const Shard& shard : shards) {
        const std::string& device = shard.reader.info().deviceName;
        if (std::ranges::find(devices, device) == devices.end()) devices.push_back(device);
    }
    if (devices.size() == 1) return info;
    std::string all;
    for (const std::string& device : devices) all += (all.empty() ? "" : "; ") + device;
    diagnostics.warn(
        "probe-merge-devices",
        fmt::format("the shards were baked on different devices, which agree within tolerances only: {}",
                    all));
    info.deviceName = all.substr(0, probe::kMaxNameBytes);
    return info;
}

probe::StoredProbe storedProbe(const ProbeFileReader& reader, std::uint32_t index) {
    probe::StoredProbe stored{.record = reader.record(index), .inputHash = reader.inputHash(index)};
    for (const ProbeLayer layer : probe::kAllLayers) {
        if (!reader.has(index, layer)) continue;
        const ProbeFrame frame = reader.frame(index, layer);
        stored.frames[static_cast<std::size_t>(layer)] = {
            .storedBytes = frame.storedBytes, .codec = probe::codecOf(frame.codec), .rawHash = frame.rawHash};
    }
    return stored;
}

Result<void> copyProbe(const ProbeFileReader& reader, std::uint32_t index, io::AtomicFile& file) {
    // Read first as a viewer would: a damaged shard must not become a damaged whole.
    PFVOX_CHECK(reader.readProbe(index));
    for (const ProbeLayer layer : probe::kAllLayers) {
        if (!reader.has(index, layer)) continue;
        PFVOX_TRY(const auto, stored, reader.readStored(index, layer));
        PFVOX_CHECK(file.write(stored));
    }
    return {};
}

faces::StoredChunk storedChunk(const ProbeFileReader& reader, std::uint32_t index) {
    const FaceLightInfo& faces = *reader.faces();
    return {.record = faces.chunks[index - faces.range.first], .frames = reader.faceFrames(index)};
}

/// As copyProbe.
Result<void> copyChunk(const ProbeFileReader& reader, std::uint32_t index, io::AtomicFile& file) {
    PFVOX_CHECK(reader.readFaceChunk(index));
    PFVOX_TRY(const auto, stored, reader.readStoredFaces(index));
    return file.write(stored);
}

/// Calls visit(reader, index) for each thing of the parts.
template <class Visit>
Result<void> forEachIn(const std::vector<Shard>& shards, const std::vector<Part>& parts, const Visit& visit) {
    for (const Part& part : parts)
        for (std::uint32_t index = part.range.first; index < part.range.end; ++index)
            PFVOX_CHECK(visit(shards[part.shard].reader, index));
    return {};
}

Result<void> merge(std::span<const std::filesystem::path> shards, const std::filesystem::path& output,
                   const ProbeMergeSettings& settings, const Limits& limits, Diagnostics& diagnostics) {
    if (shards.empty()) return refuse(output, "there are no shards to merge");
    PFVOX_TRY(const auto, opened, openShards(shards, limits, diagnostics));
    const ProbeFileReader& first = opened.front().reader;
    const auto probes = partsOf(opened, probesOf);
    const auto chunks = partsOf(opened, chunksOf);
    const MergeTarget target{.output = output, .allowPart = settings.allowPart};
    const auto probeCount = static_cast<std::uint32_t>(first.info().grid.probeCount());
    PFVOX_CHECK(checkCover(opened, probes, probeCount, "probes", target));
    std::optional<FaceLightInfo> faces = first.faces();
    if (faces) {
        const auto chunkCount = static_cast<std::uint32_t>(faceChunkPlaces(*faces).size());
        PFVOX_CHECK(checkCover(opened, chunks, chunkCount, "chunks of light on faces", target));
        const ProbeRange range = coverOf(chunks, chunksOf(opened.front()));
        faces->range = {range.first, range.end};
    }
    probe::FilePlan plan{.info = mergedInfo(opened, coverOf(probes, first.info().range), diagnostics),
                         .contentKey = settings.contentKey,
                         .probes = {},
                         .faces = faces ? &*faces : nullptr,
                         .chunks = {}};
    if (opened.size() == 1 && first.proximity()) plan.proximity = &*first.proximity();
    if (settings.proximity) plan.proximity = &*settings.proximity;
    PFVOX_CHECK(forEachIn(opened, probes, [&](const ProbeFileReader& reader, std::uint32_t index) {
        plan.probes.push_back(storedProbe(reader, index));
        return Result<void>{};
    }));
    PFVOX_CHECK(forEachIn(opened, chunks, [&](const ProbeFileReader& reader, std::uint32_t index) {
        plan.chunks.push_back(storedChunk(reader, index));
        return Result<void>{};
    }));
    PFVOX_TRY(const auto, head, probe::composeHead(plan));
    PFVOX_TRY(io::AtomicFile, file, io::AtomicFile::create(output));
    PFVOX_CHECK(file.write(head));
    PFVOX_CHECK(forEachIn(opened, probes, [&](const ProbeFileReader& reader, std::uint32_t index) {
        return copyProbe(reader, index, file);
    }));
    PFVOX_CHECK(file.write(plan.gapBeforeFaces(head)));
    PFVOX_CHECK(forEachIn(opened, chunks, [&](const ProbeFileReader& reader, std::uint32_t index) {
        return copyChunk(reader, index, file);
    }));
    return file.commit();
}

}  // namespace

Result<void> mergeProbeFields(std::span<const std::filesystem::path> shards,
                              const std::filesystem::path& output, const ProbeMergeSettings& settings,
                              const Limits& limits, Diagnostics& diagnostics) {
    return guarded([&] { return merge(shards, output, settings, limits, diagnostics); });
}

}  // namespace pfvox

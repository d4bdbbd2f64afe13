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
    for (ProbeSettingDifference& difference :
         differencesOf(a.reader.info().settings, b.reader.info().settings)) {
        first.push_back(std::move(difference.first));
        second.push_back(std::move(difference.second));
    }
    if (first.empty()) return {};
    return fmt::format("{} was baked with {}, {} with {}", a.file.string(), join(first), b.file.string(),
                       join(second));
}

/// Why two shards are not of one bake; empty = they are.
std::string disagreement(const Shard& a, const Shard& b) {
    const auto names = differences(a.reader.info(), b.reader.info());
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
    std::ranges::stable_sort(shards, {}, [](const Shard& s) { return s.reader.info().range.first; });
    return shards;
}

/// Shards, which are sorted, must follow each other without overlap and without holes.
Result<void> checkCover(const std::vector<Shard>& shards, const std::filesystem::path& output,
                        bool allowPart) {
    const ProbeFieldInfo& first = shards.front().reader.info();
    std::uint32_t end = allowPart ? first.range.first : 0;
    std::vector<ProbeRange> absent;
    std::uint64_t absentCount = 0;
    const auto noteHole = [&](ProbeRange hole) {
        if (hole.size() == 0) return;
        absent.push_back(hole);
        absentCount += hole.size();
    };
    for (std::size_t i = 0; i < shards.size(); ++i) {
        const ProbeRange range = shards[i].reader.info().range;
        if (range.first < end) {
            const ProbeRange twice{range.first, std::min(end, range.end)};
            return refuse(shards[i].file,
                          fmt::format("probes {} are also in another shard ({})",
                                      probe::listProbes(std::span(&twice, 1)), shards[i - 1].file.string()));
        }
        noteHole({end, range.first});
        end = range.end;
    }
    if (!allowPart) noteHole({end, static_cast<std::uint32_t>(first.grid.probeCount())});
    if (absent.empty()) return {};
    return refuse(output, fmt::format("{} of {} probes are in no shard: {}", absentCount,
                                      first.grid.probeCount(), probe::listProbes(absent)));
}

ProbeFieldInfo mergedInfo(const std::vector<Shard>& shards, Diagnostics& diagnostics) {
    ProbeFieldInfo info = shards.front().reader.info();
    info.range.end = shards.back().reader.info().range.end;
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

Result<void> merge(std::span<const std::filesystem::path> shards, const std::filesystem::path& output,
                   const ProbeMergeSettings& settings, const Limits& limits, Diagnostics& diagnostics) {
    if (shards.empty()) return refuse(output, "there are no shards to merge");
    PFVOX_TRY(const auto, opened, openShards(shards, limits, diagnostics));
    PFVOX_CHECK(checkCover(opened, output, settings.allowPart));
    probe::FilePlan plan{
        .info = mergedInfo(opened, diagnostics), .contentKey = settings.contentKey, .probes = {}};
    if (opened.size() == 1 && opened[0].reader.proximity()) plan.proximity = &*opened[0].reader.proximity();
    if (settings.proximity) plan.proximity = &*settings.proximity;
    for (const Shard& shard : opened) {
        const ProbeRange range = shard.reader.info().range;
        for (std::uint32_t index = range.first; index < range.end; ++index)
            plan.probes.push_back(storedProbe(shard.reader, index));
    }
    PFVOX_TRY(const auto, head, probe::composeHead(plan));
    PFVOX_TRY(io::AtomicFile, file, io::AtomicFile::create(output));
    PFVOX_CHECK(file.write(head));
    for (const Shard& shard : opened) {
        const ProbeRange range = shard.reader.info().range;
        for (std::uint32_t index = range.first; index < range.end; ++index)
            PFVOX_CHECK(copyProbe(shard.reader, index, file));
    }
    return file.commit();
}

}  // namespace

Result<void> mergeProbeFields(std::span<const std::filesystem::path> shards,
                              const std::filesystem::path& output, const ProbeMergeSettings& settings,
                              const Limits& limits, Diagnostics& diagnostics) {
    return guarded([&] { return merge(shards, output, settings, limits, diagnostics); });
}

}  // namespace pfvox

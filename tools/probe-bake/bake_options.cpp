#include "probe-bake/bake_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include "probe-bake/commands.hpp"

namespace pfvox::tools {

namespace {

constexpr double kMaxSampleCount = 65536;
constexpr std::uint64_t kMaxBounceCount = 16;
constexpr const char* kUnlimited = "unlimited";
constexpr std::uint32_t kSampleBatch = 16;
constexpr std::uint32_t kFaceRayBatch = 128;
constexpr const char* kBaking = "Baking";

std::optional<std::uint64_t> parseCount(std::string_view text) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

/// The numbers between separators; nothing when one is no number.
std::optional<std::vector<std::uint64_t>> parseCounts(std::string_view text, char separator) {
    std::vector<std::uint64_t> values;
    for (;;) {
        const std::size_t end = text.find(separator);
        const auto value = parseCount(text.substr(0, end));
        if (!value) return std::nullopt;
        values.push_back(*value);
        if (end == std::string_view::npos) return values;
        text.remove_prefix(end + 1);
    }
}

/// A texel of thesis maps has its own paths only, as in the original.
bool filtersByDefault(const std::string& profile) {
    return BakeSettings{}.filter && profile != "thesis";
}

std::string filterDefaultText() {
    std::string text = BakeSettings{}.filter ? "--filter" : "--no-filter";
    for (const char* const profile : {"thesis", "compact"}) {
        if (filtersByDefault(profile) != BakeSettings{}.filter)
            text += fmt::format("; with --profile {} {}", profile,
                                filtersByDefault(profile) ? "--filter" : "--no-filter");
    }
    return text;
}

void addBounces(CLI::App& command, std::optional<std::uint32_t>& bounces) {
    const auto set = [&bounces](const std::string& text) {
        bounces.reset();
        if (text != kUnlimited) bounces = static_cast<std::uint32_t>(std::stoul(text));
    };
    const auto check = [](const std::string& text) -> std::string {
        const auto count = parseCount(text);
        if (text == kUnlimited || (count && *count <= kMaxBounceCount)) return {};
        return fmt::format("{} is neither a whole number from 0 to {} nor {}", text, kMaxBounceCount,
                           kUnlimited);
    };
    command
        .add_option_function<std::string>("--bounces", set,
                                          "reflections of a path, 0 to 16; unlimited: until it has no weight")
        ->option_text("N")
        ->check(check)
        ->check(showDefault(bounces ? std::to_string(*bounces) : kUnlimited))
        ->group(kBaking);
}

void addLightOptions(CLI::App& command, BakeOptions& options) {
    auto* profile =
        command
            .add_option(
                "--profile", options.profile,
                "faces: light on faces and small probes; probes, thesis, compact: light-field probes alone, "
                "with more maps or fewer")
            ->option_text("NAME")
            ->check(CLI::IsMember({"faces", "probes", "thesis", "compact"}))
            ->check(showDefault(options.profile))
            ->group(kBaking);
    command
        .add_option("--resolution", options.resolution,
                    "probes alone, of this resolution: depth,light,irradiance,moments in texels, 0 = none")
        ->option_text("D,L,I,M")
        ->excludes(profile)
        ->group(kBaking);
    auto* samples = command
                        .add_option("--samples", options.samples,
                                    "as many paths for every texel, or rays for every face, a multiple of 16 "
                                    "(of faces: 128) up to "
                                    "65536")
                        ->option_text("N")
                        ->check(numberFrom(kSampleBatch, kMaxSampleCount))
                        ->group(kBaking);
    command
        .add_option("--noise", options.noise,
                    "relative standard error at which faces or a tile of texels are done, 0.0001 to 1")
        ->option_text("FRACTION")
        ->check(showDefault("of faces 0.005, without a GPU 0.03; of probes 0.02"))
        ->excludes(samples)
        ->check(numberFrom(1e-4, 1))
        ->group(kBaking);
    command
        .add_option("--max-samples", options.maxSamples,
                    "paths a texel, or rays a face, at most, 32 to 65536")
        ->option_text("N")
        ->check(showDefault("of faces 16384, without a GPU 512; of probes 4096"))
        ->excludes(samples)
        ->check(numberFrom(32, kMaxSampleCount))
        ->group(kBaking);
    addBounces(command, options.bounces);
    command.add_option("--seed", options.seed, "of the random numbers")
        ->option_text("N")
        ->check(showDefault(options.seed))
        ->group(kBaking);
    addSwitch(command, "filter", options.filter,
              "take noise out of the light maps, or leave each texel its own paths only", filterDefaultText())
        ->group(kBaking);
    addSwitch(command, "relocate", options.relocate, "move probes out of solids, or make them inactive")
        ->group(kBaking);
}

void addRunOptions(CLI::App& command, BakeOptions& options) {
    addDeviceOption(command, options.device);
    command.add_option("--device-memory", options.deviceMemoryMiB, "device memory to take at most")
        ->option_text("MIB")
        ->check(showDefault("what there is"))
        ->check(numberFrom(1, 1 << 24))
        ->group(kBaking);
    command.add_flag("--list-devices", options.listDevices, "print the devices and do nothing")
        ->group(kBaking);
    command
        .add_option("--probes", options.probes,
                    "bake probes A to B - 1 only, or part K of N, from 0: a shard for merge")
        ->option_text("A:B|K/N")
        ->check(showDefault("0/1"))
        ->group(kBaking);
    command.add_flag("--resume", options.resume, "take finished probes of a stopped bake from the journal")
        ->group(kBaking);
    command
        .add_option("--depfile", options.depfile, "write what the output was made from, for make and ninja")
        ->option_text("FILE")
        ->check(outputPath())
        ->check(suggestFiles({".d"}))
        ->group(group::kBuild);
    command
        .add_option("--depfile-known", options.depfileKnown,
                    "list of files, one a line, that the build knows: the depfile names the list instead")
        ->option_text("LIST")
        ->group(group::kBuild);
    command
        .add_flag("--if-changed", options.ifChanged,
                  "keep the time stamp of an output that stays the same (ninja)")
        ->group(group::kBuild);
    command.add_flag("--no-summary", options.noSummary, "print nothing but warnings and errors, for builds")
        ->group(group::kBuild);
    command
        .add_flag("--warnings-as-errors", options.warningsAsErrors,
                  "a scene with warnings fails, nothing is baked")
        ->group(group::kBuild);
}

}  // namespace

void addDeviceOption(CLI::App& command, std::string& device) {
    command.add_option("--device", device, "number in --list-devices, else part of the name")
        ->option_text("DEVICE")
        ->check(showDefault("the first real GPU, else the first device"))
        ->group(kBaking);
}

void addBakeOptions(CLI::App& command, BakeOptions& options) {
    command.add_option("input", options.input)
        ->check(suggestFiles({".toml", ".pf_vox"}))
        ->group(group::kInputOutput);
    command.add_option("-o,--output", options.output, "the probe file (.pf_probe); required")
        ->option_text("FILE")
        ->check(outputPath())
        ->check(suggestFiles({kPfProbeExtension}))
        ->group(group::kInputOutput);
    command.add_flag("--force", options.force, "bake what is up to date, too; replace a read-only output")
        ->group(group::kInputOutput);
    command.add_flag("--dry-run", options.dryRun, "write nothing, say what would be baked")
        ->group(group::kInputOutput);
    command.add_flag("--explain", options.explain, "say why it is baked or not")->group(group::kInputOutput);
    addLightOptions(command, options);
    addRunOptions(command, options);
    addCommonOptions(command, options.common);
}

namespace {

/// Part K of N; the parts differ by one probe at most.
tl::expected<ProbeRange, std::string> parseProbePart(const std::string& text, std::uint64_t probeCount) {
    const auto part = parseCounts(text, '/');
    if (!part || part->size() != 2 || part->at(0) >= part->at(1))
        return tl::make_unexpected(fmt::format("--probes {}: not part K of N, K from 0 to N - 1", text));
    const std::uint64_t parts = part->at(1);
    if (parts > probeCount)
        return tl::make_unexpected(
            fmt::format("--probes {}: {} probes do not make {} parts", text, probeCount, parts));
    const auto end = [&](std::uint64_t k) { return static_cast<std::uint32_t>(probeCount * k / parts); };
    return ProbeRange{end(part->at(0)), end(part->at(0) + 1)};
}

}  // namespace

tl::expected<ProbeRange, std::string> parseProbeRange(const std::string& text, std::uint64_t probeCount) {
    if (text.find('/') != std::string::npos) return parseProbePart(text, probeCount);
    const auto ends = parseCounts(text, ':');
    if (!ends || ends->size() != 2)
        return tl::make_unexpected(
            fmt::format("--probes {}: not two numbers with a colon between them", text));
    if (ends->at(0) >= ends->at(1) || ends->at(1) > probeCount)
        return tl::make_unexpected(fmt::format("--probes {}: not a range of the {} probes, which are 0:{}",
                                               text, probeCount, probeCount));
    return ProbeRange{static_cast<std::uint32_t>(ends->at(0)), static_cast<std::uint32_t>(ends->at(1))};
}

tl::expected<ProbeResolution, std::string> parseResolution(const std::string& text) {
    const auto maps = parseCounts(text, ',');
    if (!maps || maps->size() != 4)
        return tl::make_unexpected(
            fmt::format("--resolution {}: not four numbers with commas between them", text));
    std::array<std::uint32_t, 4> checked{};
    for (std::size_t i = 0; i < checked.size(); ++i) {
        if (maps->at(i) > kMaxProbeResolution)
            return tl::make_unexpected(
                fmt::format("--resolution {}: resolutions are 0 to {}", text, kMaxProbeResolution));
        checked[i] = static_cast<std::uint32_t>(maps->at(i));
    }
    if (checked[0] % 16 != 0)
        return tl::make_unexpected(fmt::format("--resolution {}: the first must be a multiple of 16", text));
    return ProbeResolution{
        .depth = checked[0], .light = checked[1], .irradiance = checked[2], .moments = checked[3]};
}

tl::expected<BakeSettings, std::string> settingsOf(const BakeOptions& options, std::uint64_t probeCount) {
    BakeSettings settings;
    if (!options.resolution.empty()) {
        const auto resolution = parseResolution(options.resolution);
        if (!resolution) return tl::make_unexpected(resolution.error());
        settings.resolution = *resolution;
    } else {
        settings.resolution = resolutionOf(options.profile == "thesis"   ? ProbeProfile::Thesis
                                           : options.profile == "probes" ? ProbeProfile::Default
                                                                         : ProbeProfile::Compact);
        if (options.profile == "faces") settings.faces = FaceSettings{};
    }
    if (!options.probes.empty()) {
        const auto range = parseProbeRange(options.probes, probeCount);
        if (!range) return tl::make_unexpected(range.error());
        settings.range = *range;
    }
    const std::uint32_t batch = settings.faces ? kFaceRayBatch : kSampleBatch;
    for (const std::uint32_t count : {options.samples.value_or(batch), options.maxSamples.value_or(batch)}) {
        if (count % batch != 0)
            return tl::make_unexpected(fmt::format("{} samples: must be a multiple of {}", count, batch));
    }
    if (!settings.faces) {  // those of faces are adaptTo()'s
        settings.maxSamples = options.samples.value_or(options.maxSamples.value_or(settings.maxSamples));
        settings.minSamples = std::min(options.samples.value_or(settings.minSamples), settings.maxSamples);
        if (options.samples) settings.noiseTarget = 0.0f;
        if (options.noise) settings.noiseTarget = static_cast<float>(*options.noise);
    }
    settings.maxBounces = options.bounces;
    settings.seed = options.seed;
    settings.filter = options.filter.value_or(filtersByDefault(options.profile));
    settings.relocate = options.relocate;
    settings.resume = options.resume;
    settings.force = options.force;
    settings.toolName = "probe-bake " PFVOX_VERSION;
    return settings;
}

void adaptTo(const gpu::DeviceInfo& device, const BakeOptions& options, BakeSettings& settings) {
    if (!settings.faces) return;
    FaceSettings& faces = *settings.faces;
    faces = faceSettingsFor(device);
    if (options.samples) faces.minRays = faces.maxRays = *options.samples;
    if (options.maxSamples) {
        faces.maxRays = *options.maxSamples;
        // Rounds have four times the rays of the one before, up to the largest number.
        faces.minRays = faces.maxRays;
        while (faces.minRays > faceSettingsFor(device).minRays && faces.minRays % (4 * kFaceRayBatch) == 0)
            faces.minRays /= 4;
    }
    if (options.noise) faces.noiseTarget = static_cast<float>(*options.noise);
}

}  // namespace pfvox::tools

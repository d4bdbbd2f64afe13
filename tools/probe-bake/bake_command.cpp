#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <pfvox/bake.hpp>
#include <pfvox/files.hpp>
#include <pfvox/probe_file.hpp>
#include <sstream>

#include "common/depfile.hpp"
#include "common/inputs.hpp"
#include "common/interrupt.hpp"
#include "common/paths.hpp"
#include "common/text.hpp"
#include "probe-bake/bake_options.hpp"
#include "probe-bake/bake_report.hpp"
#include "probe-bake/commands.hpp"

namespace pfvox::tools {

namespace fs = std::filesystem;

namespace {

HelpText helpText() {
    return {.summary =
                "Bakes the indirect light of a scene: light on the faces of its voxels and a grid of probes "
                "for what "
                "moves, or light-field probes alone. What is up to date by its content is left alone.",
            .usage = {"probe-bake [bake] [options] <scene.toml | file.pf_vox> -o <file.pf_probe>"},
            .examples = {{"probe-bake scene.toml -o scene.pf_probe", "the whole scene"},
                         {"probe-bake scene.toml -o scene.pf_probe --resume", "go on after Ctrl-C"},
                         {"probe-bake scene.toml -o a.pf_probe --profile probes --probes 0:500",
                          "a part, for `probe-bake merge`"},
                         {"probe-bake hall.pf_vox -o hall.pf_probe --profile probes", "light-field probes"}}};
}

/// Shows how far the bake is, and stops it on Ctrl-C.
class ToolObserver final : public BakeObserver {
  public:
    ToolObserver(Reporter& reporter, std::string output) : reporter_(reporter), output_(std::move(output)) {}

    void progress(const BakeProgress& progress) override {
        last_ = progress;
        const auto now = Clock::now();
        if (now - shown_ < std::chrono::milliseconds(100)) return;
        shown_ = now;
        reporter_.progress(progressLine(output_, progress));
    }
    bool stopRequested() override { return isInterrupted(); }
    const BakeProgress& last() const { return last_; }

  private:
    using Clock = std::chrono::steady_clock;
    Reporter& reporter_;
    std::string output_;
    BakeProgress last_;
    Clock::time_point shown_;
};

/// What was at the place of the output before, for --if-changed.
struct Previous {
    std::optional<fs::file_time_type> time;
    std::optional<io::FileBytes> bytes;
};

Previous previousOf(const BakeOptions& options, const Limits& limits) {
    Previous previous;
    std::error_code error;
    if (!options.ifChanged || !fs::is_regular_file(options.output, error)) return previous;
    if (const auto time = fs::last_write_time(options.output, error); !error) previous.time = time;
    if (auto bytes = io::readFile(options.output, limits.maxFileBytes)) previous.bytes = *std::move(bytes);
    return previous;
}

std::string reasonFor(const BakeOptions& options, const ExistingBake& existing) {
    using State = ExistingBake::State;
    if (options.force && existing.state != State::None) return "--force";
    switch (existing.state) {
        case State::None:
            return "there was no output";
        case State::Unreadable:
            return "the existing output is not a complete PF_PROBE file of this version";
        case State::OtherProbes:
            return "the existing output holds other probes";
        case State::OtherContent:
            return "the scene, the settings, the program or the device changed since the last bake";
        case State::Damaged:
            return "the existing output was damaged (" + existing.damage + ")";
        case State::UpToDate:
            return "same scene, settings, program and device as in the last bake";
    }
    return {};
}

/// Fails when the output is one that must not be replaced: better now than after the bake.
Result<void> checkOutput(const BakeOptions& options) {
    auto status = io::checkReplaceable(options.output, {.replaceReadOnly = options.force});
    std::error_code error;
    if (!status && fs::is_regular_file(options.output, error))
        status.error().message += "; --force replaces it";
    return status;
}

/// Adds what the user can do about it.
Error withRemedy(Error error, const BakeOptions& options, const gpu::Device* device) {
    if (error.code == ErrorCode::GpuOutOfMemory && device != nullptr) {
        error.message += fmt::format(
            "; {} has {}, {} were in use. Smaller models, a smaller --profile or --resolution, "
            "or another --device need less",
            device->info().name, formatBytes(device->info().localMemoryBytes),
            formatBytes(device->memory().peakBytes));
    } else if (error.code == ErrorCode::FileNotWritable) {
        error.message += "; finished probes stay in " + probeJournalPath(options.output).string() +
                         ": make room and run again with --resume";
    }
    return error;
}

/// A grid that misses all models is a mistake, not a bake.
Result<void> checkGrid(const LoadedScene& scene) {
    if (scene.bounds.empty())
        return fail(ErrorCode::NothingToConvert, "the scene has no visible voxel: nothing to bake");
    const ProbeGrid& grid = scene.probes;
    const glm::dvec3 low = grid.worldOf(grid.start - grid.step);
    const glm::dvec3 high =
        grid.worldOf(grid.pointOf(static_cast<std::uint32_t>(grid.probeCount() - 1)) + grid.step);
    const bool apart =
        glm::any(glm::greaterThan(low, scene.bounds.max)) || glm::any(glm::lessThan(high, scene.bounds.min));
    if (!apart) return {};
    const auto text = [](const glm::dvec3& p) { return fmt::format("{:.2f} {:.2f} {:.2f}", p.x, p.y, p.z); };
    return fail(
        ErrorCode::BadValue,
        fmt::format("the probe grid ({} to {} m) is outside the scene ({} to {} m): set probeGridPos, "
                    "probeGridStep and probeGridCount, or leave them out",
                    text(low), text(high), text(scene.bounds.min), text(scene.bounds.max)));
}

/// Scene and models. What --depfile-known lists is there already: the list stands for it.
Result<DepfileRule> dependencies(const BakeOptions& options, const LoadedScene& scene, const Limits& limits) {
    const auto place = [](const fs::path& file) { return fs::absolute(file).lexically_normal(); };
    DepfileRule rule{.target = options.output, .prerequisites = {}};
    std::vector<fs::path> known;  // to the build or to the rule
    if (!options.depfileKnown.empty()) {
        PFVOX_TRY(const io::FileBytes, list, io::readFile(options.depfileKnown, limits.maxFileBytes));
        const auto text =
            std::string(reinterpret_cast<const char*>(list.bytes().data()), list.bytes().size());
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) known.push_back(place(line));
        rule.prerequisites.emplace_back(options.depfileKnown);
    }
    const auto add = [&](const fs::path& file) {
        if (std::ranges::count(known, place(file)) != 0) return;
        known.push_back(place(file));
        rule.prerequisites.push_back(file);
    };
    add(options.input);
    for (const PlacedAsset& part : scene.parts) {
        if (part.model < scene.scene.models.size())
            add(fs::path(options.input).parent_path() / scene.scene.models[part.model].path);
    }
    return rule;
}

/// --if-changed: the same bytes get their old time back. With a depfile and without it, what is up to date
/// gets the present one, or make would run the bake for ever.
void setTimeStamp(const BakeOptions& options, const Previous& previous, bool upToDate, const Limits& limits) {
    std::error_code ignored;
    if (upToDate && !options.ifChanged && !options.depfile.empty())
        fs::last_write_time(options.output, fs::file_time_type::clock::now(), ignored);
    if (upToDate || !previous.bytes || !previous.time) return;
    const auto now = io::readFile(options.output, limits.maxFileBytes);
    if (now && std::ranges::equal(now->bytes(), previous.bytes->bytes()))
        fs::last_write_time(options.output, *previous.time, ignored);
}

/// One run, from loaded scene to written file.
class BakeRun {
  public:
    BakeRun(const BakeOptions& options, const Limits& limits, Reporter& reporter)
        : options_(options), limits_(limits), reporter_(reporter) {
        outcome_.input = options.input;
        outcome_.output = options.output;
    }

    ExitCode run(const CLI::App& command) {
        DiagnosticList diagnostics;
        auto status = bake(diagnostics);
        outcome_.diagnostics = diagnostics.entries();
        reporter_.clearProgress();
        if (!usage_.empty()) return usageError(command, usage_);
        reporter_.diagnostics(options_.input, outcome_.diagnostics);
        if (!status) return failed(std::move(status).error());
        if (options_.common.json) reporter_.jsonLine(jsonText(bakeJson(outcome_)));
        reporter_.result(bakeText(outcome_, options_.explain));
        return ExitCode::Ok;
    }

  private:
    Result<void> bake(DiagnosticList& diagnostics) {
        PFVOX_TRY(const LoadedScene, scene, loadScene(options_.input, limits_, diagnostics));
        PFVOX_CHECK(checkGrid(scene));
        DepfileRule inputs;
        if (!options_.depfile.empty()) {
            PFVOX_TRY(DepfileRule, rule, dependencies(options_, scene, limits_));
            inputs = std::move(rule);
            // Better now than after the bake.
            PFVOX_CHECK(depfileText({inputs}, depfileReader(options_.ifChanged)));
        }
        auto settings = settingsOf(options_, scene.probes.probeCount());
        if (!settings) {
            usage_ = settings.error();
            return {};
        }
        const std::size_t warnings = Reporter::warningCount(diagnostics.entries());
        if (options_.warningsAsErrors && warnings != 0)
            return fail(ErrorCode::BadValue,
                        plural(warnings, "warning") + ", taken as errors: nothing baked");
        PFVOX_TRY(
            gpu::Device, device,
            gpu::Device::open({.selector = options_.device, .memoryBytes = options_.deviceMemoryMiB << 20}));
        outcome_.device = device.info().name;
        adaptTo(device.info(), options_, *settings);
        const ContentKey key = bakeContentKey(scene, *settings, device.info());
        const ProbeRange range =
            settings->range.value_or(ProbeRange{0, static_cast<std::uint32_t>(scene.probes.probeCount())});
        const ExistingBake existing = inspectBake(options_.output, key, range);
        outcome_.contentKey = key;
        outcome_.reason = reasonFor(options_, existing);
        outcome_.report.probes = range.size();
        const bool isUpToDate = !options_.force && existing.state == ExistingBake::State::UpToDate;
        const Previous previous = previousOf(options_, limits_);
        if (isUpToDate) {
            outcome_.status = BakeStatus::UpToDate;
            outcome_.report.upToDate = true;
            outcome_.report.fileBytes = existing.fileBytes;
            outcome_.report.counts = existing.counts;
        } else {
            PFVOX_CHECK(checkOutput(options_));
            outcome_.status = BakeStatus::Planned;
        }
        if (options_.dryRun) return {};
        if (!isUpToDate) {
            ToolObserver observer(reporter_, options_.output);
            auto report = bakeProbes(device, scene, *settings, options_.output, observer, diagnostics);
            last_ = observer.last();
            if (!report) return tl::make_unexpected(withRemedy(std::move(report).error(), options_, &device));
            outcome_.report = *report;
            outcome_.status = BakeStatus::Baked;
            outcome_.isRepair = existing.state == ExistingBake::State::Damaged;
        }
        setTimeStamp(options_, previous, isUpToDate, limits_);
        if (options_.depfile.empty()) return {};
        return writeDepfile(options_.depfile, {inputs}, depfileReader(options_.ifChanged));
    }

    ExitCode failed(Error error) {
        if (error.file.empty()) error.file = options_.input;
        outcome_.error = error;
        if (options_.common.json) reporter_.jsonLine(jsonText(bakeJson(outcome_)));
        if (error.code == ErrorCode::Cancelled) {
            reporter_.status(
                fmt::format("stopped: {} of {} are in {}; the same command with --resume goes on",
                            formatCount(last_.probesDone), plural(last_.probes, "probe"),
                            probeJournalPath(options_.output).string()));
        } else {
            reporter_.error(error);
        }
        return exitCodeOf(error.code);
    }

    const BakeOptions& options_;
    const Limits& limits_;
    Reporter& reporter_;
    BakeOutcome outcome_;
    BakeProgress last_;
    std::string usage_;
};

ExitCode listAllDevices(const BakeOptions& options, Reporter& reporter) {
    const auto devices = gpu::listDevices();
    if (!devices) {
        reporter.error(devices.error());
        return exitCodeOf(devices.error().code);
    }
    if (options.common.json) reporter.jsonLine(jsonText(devicesJson(*devices)));
    reporter.result(deviceLines(*devices));
    return ExitCode::Ok;
}

ExitCode runBake(const CLI::App& command, const BakeOptions& options) {
    ReporterSettings settings = options.common.reporterSettings();
    settings.warningsAsErrors = options.warningsAsErrors;
    if (options.noSummary && settings.verbosity == Verbosity::Normal)
        settings.verbosity = Verbosity::Warnings;
    Reporter reporter(settings);
    const auto limits = parseLimits(options.common.limits);
    if (!limits) return usageError(command, limits.error());
    if (options.listDevices) return listAllDevices(options, reporter);
    if (options.input.empty()) return usageError(command, "a scene or a PF_VOX file is required");
    if (options.output.empty()) return usageError(command, "--output is required");
    if (canonicalName(options.input) == canonicalName(options.output))
        return usageError(command, options.output + " is both the input and the output");
    // What is finished is in the journal.
    const OrderlyStop orderly;
    return BakeRun(options, *limits, reporter).run(command);
}

}  // namespace

Command makeBakeCommand(CLI::App& tool) {
    auto options = std::make_shared<BakeOptions>();
    CLI::App& command = addCommand(tool, "bake", helpText());
    addBakeOptions(command, *options);
    return {.app = &command, .run = [&command, options] { return runBake(command, *options); }};
}

}  // namespace pfvox::tools

#include "vox2pf/convert_run.hpp"

#include "common/batch.hpp"
#include "common/progress.hpp"
#include "vox2pf/convert_report.hpp"

namespace pfvox::tools {

ExitCode ConvertRun::run(std::vector<AssetTask> tasks) {
    tasks_ = std::move(tasks);
    outputs_ = OutputsOfRun(tasks_);
    results_.resize(tasks_.size());
    pending_.resize(tasks_.size());
    if (const auto names = checkDependencies(); !names) {
        reporter_.error(names.error());
        return exitCodeOf(names.error().code);
    }
    Progress progress(reporter_, tasks_.size());
    runBatch(tasks_.size(), {.threads = options_.common.threads, .failFast = options_.failFast},
             {.work = [&](std::size_t i) { return work(i); },
              .commit = [&](std::size_t i) { return commit(i); },
              .finished = [&](std::size_t i) { report(i); },
              .progressed =
                  [&](std::size_t i) {
                      progress.advance(results_[i].conversion ? results_[i].conversion->voxels : 0);
                  }});
    reporter_.clearProgress();
    reportUnstarted();
    const bool depfileGood = writeDependencies();
    reporter_.result(summary(tasks_, results_, progress.elapsedSeconds()));
    return depfileGood ? exitCode() : ExitCode::CannotReadOrWrite;
}

bool ConvertRun::work(std::size_t i) {
    const ConvertPolicy policy{.force = options_.force,
                               .noClobber = options_.noClobber,
                               .dryRun = options_.dryRun,
                               .ifChanged = options_.ifChanged,
                               .refreshTimeStamp = !options_.depfile.empty() && !options_.ifChanged,
                               .warningsAsErrors = options_.warningsAsErrors};
    if (tasks_[i].fault) {
        results_[i].outcome = Outcome::Failed;
        results_[i].error = tasks_[i].fault;
    } else if (tasks_[i].isScene) {
        results_[i] = carryScene(tasks_[i], outputs_, policy, limits_);
    } else {
        AssetResultAndOutput asset = beginAsset(tasks_[i], policy, limits_);
        results_[i] = std::move(asset.result);
        if (asset.output) pending_[i] = std::make_unique<io::AtomicFile>(*std::move(asset.output));
    }
    return results_[i].outcome != Outcome::Failed;
}

bool ConvertRun::commit(std::size_t i) {
    if (const auto output = std::move(pending_[i])) finishAsset(tasks_[i], std::move(*output), results_[i]);
    return results_[i].outcome != Outcome::Failed;
}

void ConvertRun::report(std::size_t i) {
    const AssetResult& result = results_[i];
    if (options_.common.json) reporter_.jsonLine(jsonText(assetJson(tasks_[i], result)));
    reporter_.diagnostics(tasks_[i].source, result.diagnostics);
    if (result.error) {
        reporter_.error(*result.error);
        return;
    }
    const bool single = tasks_.size() == 1;
    const bool isNews = result.outcome == Outcome::Converted || result.outcome == Outcome::Kept;
    if (options_.explain || options_.dryRun) {
        // What was asked for is a result. For one file it takes the place of the summary's line.
        if (!single || options_.explain)
            reporter_.result(assetLine(tasks_[i], result, options_.explain) + "\n");
    } else if (!single && (options_.common.verbose || (isNews && !reporter_.showsProgress()))) {
        reporter_.status(assetLine(tasks_[i], result, false));
    }
}

void ConvertRun::reportUnstarted() {
    if (!options_.common.json) return;
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
        if (results_[i].outcome == Outcome::NotStarted) {
            reporter_.jsonLine(jsonText(assetJson(tasks_[i], results_[i])));
        }
    }
}

DepfileRule ConvertRun::dependencies(const AssetTask& task) const {
    DepfileRule rule{.target = task.output, .prerequisites = {task.source}};
    if (!options_.settingsFile.empty() && !task.isScene)
        rule.prerequisites.emplace_back(options_.settingsFile);
    return rule;
}

/// Names that the depfile cannot tell are an error before anything is converted.
Result<void> ConvertRun::checkDependencies() const {
    if (options_.depfile.empty()) return {};
    for (const AssetTask& task : tasks_)
        PFVOX_CHECK(depfileText({dependencies(task)}, depfileReader(options_.ifChanged)));
    return {};
}

bool ConvertRun::writeDependencies() {
    if (options_.depfile.empty() || options_.dryRun) return true;
    std::vector<DepfileRule> rules;
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
        if (results_[i].outcome == Outcome::Failed || results_[i].outcome == Outcome::NotStarted) continue;
        rules.push_back(dependencies(tasks_[i]));
    }
    const auto written = writeDepfile(options_.depfile, rules, depfileReader(options_.ifChanged));
    if (!written) reporter_.error(written.error());
    return written.has_value();
}

ExitCode ConvertRun::exitCode() const {
    std::vector<ErrorCode> failures;
    for (const AssetResult& result : results_) {
        if (result.error) failures.push_back(result.error->code);
    }
    return exitCodeOf(failures, results_.size());
}

}  // namespace pfvox::tools

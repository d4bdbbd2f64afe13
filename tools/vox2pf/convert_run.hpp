// Convert run: all assets and scenes of one call of vox2pf convert, in parallel, with reports, depfile and
// exit code.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/command_line.hpp"
#include "common/depfile.hpp"
#include "common/reporter.hpp"
#include "vox2pf/carry_scene.hpp"
#include "vox2pf/convert_asset.hpp"
#include "vox2pf/settings.hpp"

namespace pfvox::tools {

struct ConvertOptions {
    CommonOptions common;
    InputWords inputs;
    std::string output;
    std::string baseDir;
    std::string settingsFile;
    std::string depfile;
    SettingsPatch patch;
    bool archive = false;
    bool force = false;
    bool noClobber = false;
    bool dryRun = false;
    bool explain = false;
    bool failFast = false;
    bool ifChanged = false;
    bool noSummary = false;
    bool warningsAsErrors = false;
};

/// One run of the command, from checked options to the exit code. Options, limits and reporter must outlive
/// it.
class ConvertRun {
  public:
    ConvertRun(const ConvertOptions& options, const Limits& limits, Reporter& reporter)
        : options_(options), limits_(limits), reporter_(reporter) {}

    ExitCode run(std::vector<AssetTask> tasks);

  private:
    bool work(std::size_t i);
    bool commit(std::size_t i);
    void report(std::size_t i);
    void reportUnstarted();
    DepfileRule dependencies(const AssetTask& task) const;
    Result<void> checkDependencies() const;
    bool writeDependencies();
    ExitCode exitCode() const;

    const ConvertOptions& options_;
    const Limits& limits_;
    Reporter& reporter_;
    std::vector<AssetTask> tasks_;
    std::vector<AssetResult> results_;
    OutputsOfRun outputs_;
    std::vector<std::unique_ptr<io::AtomicFile>> pending_;  ///< written, not yet in their places
};

}  // namespace pfvox::tools

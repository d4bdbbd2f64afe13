// Convert one asset: decides whether there is anything to do, does it, and says why.
//
// Up to date means content: the key in the header of the existing output against the key of the source bytes,
// the settings and the program; and the hashes of its parts against what it holds, so that damage is
// repaired. Time stamps are never read.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <pfvox/convert.hpp>
#include <pfvox/files.hpp>
#include <span>
#include <string>
#include <vector>

namespace pfvox::tools {

enum class Outcome {
    NotStarted,  ///< the run ended before
    Converted,
    UpToDate,  ///< the output is already what a conversion would give
    Kept,      ///< not up to date, but --no-clobber
    Planned,   ///< would be converted: --dry-run
    Failed,
};

/// The stable spelling in JSON: "converted", "up-to-date", ...
std::string_view toString(Outcome outcome);

struct ConvertPolicy {
    bool force = false;
    bool noClobber = false;
    bool dryRun = false;
    bool ifChanged = false;         ///< leave an output alone when the new bytes are the old ones
    bool refreshTimeStamp = false;  ///< an output that is up to date gets the present time
    bool warningsAsErrors = false;
};

/// What is not known, or has no meaning for the outcome, is nothing, and null in JSON.
struct AssetResult {
    Outcome outcome = Outcome::NotStarted;
    std::string reason;     ///< why it was converted or not, one clause
    bool isRepair = false;  ///< the output that is replaced was damaged
    std::optional<std::uint64_t> sourceBytes;
    std::optional<std::uint64_t> outputBytes;  ///< of what lies there now
    std::optional<std::uint32_t> sceneModels;  ///< of a scene
    std::optional<ConvertReport> counts;       ///< of an asset: of this, what its octrees tell
    std::optional<ConvertReport> conversion;   ///< of an asset, where one was done
    std::vector<Diagnostic> diagnostics;
    std::optional<Error> error;  ///< set exactly when Failed
};

struct AssetTask {
    std::filesystem::path source;
    std::filesystem::path output;
    ConvertSettings settings;
    bool isScene = false;             ///< a scene.toml: carryScene() instead of convertAsset()
    std::optional<Error> fault = {};  ///< what is wrong with the input already
};

/// Runs `work`. Whatever it fails with or throws becomes the error of `result`.
void guardResult(const AssetTask& task, AssetResult& result, const std::function<Result<void>()>& work);

/// Gives an output that stays as it is the present time, where the policy asks for it.
void refreshTimeStamp(const std::filesystem::path& output, const ConvertPolicy& policy);

/// Fails when the policy takes the warnings of `result` as errors.
Result<void> checkWarnings(const AssetResult& result, const ConvertPolicy& policy);

/// Fails when the output is one that must not be replaced, with the remedy.
Result<void> checkOutput(const AssetTask& task, const ConvertPolicy& policy);

/// Whether the output already holds exactly these bytes.
bool holdsBytes(const std::filesystem::path& output, std::span<const std::byte> bytes, const Limits& limits);

struct AssetResultAndOutput {
    AssetResult result;
    std::optional<io::AtomicFile>
        output;  ///< written, for finishAsset; not set when there is nothing to put in place
};

/// Everything but the wait for the disk. Never throws; whatever goes wrong is in the result. May be called
/// from several threads for different outputs.
AssetResultAndOutput beginAsset(const AssetTask& task, const ConvertPolicy& policy, const Limits& limits);

/// Puts the output in its place.
void finishAsset(const AssetTask& task, io::AtomicFile output, AssetResult& result);

}  // namespace pfvox::tools

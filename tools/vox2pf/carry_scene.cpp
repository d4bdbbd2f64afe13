#include "vox2pf/carry_scene.hpp"

#include <fmt/format.h>
#include <pfvox/files.hpp>
#include <pfvox/scene.hpp>

#include <algorithm>

#include "common/paths.hpp"
#include "common/text.hpp"
#include "vox2pf/commands.hpp"

namespace pfvox::tools {

namespace fs = std::filesystem;

bool isSceneName(const fs::path& file) {
    const std::string name = lowerCase(file.filename().string());
    return name == "scene.toml" || name.ends_with(".scene.toml");
}

OutputsOfRun::OutputsOfRun(std::span<const AssetTask> tasks) {
    for (const AssetTask& task : tasks) {
        if (task.isScene) continue;
        byPlace_.emplace(placeOf(task.source), Entry{task.source, task.output});
        byCanonical_.emplace(canonicalName(task.source), Entry{task.source, task.output});
        outputs_.insert({placeOf(task.output), canonicalName(task.output)});
    }
}

const fs::path* OutputsOfRun::outputOf(const fs::path& source) const {
    // Through a linked folder, ".." leads elsewhere than the text says.
    const auto isMeant = [&](const Entry& entry) {
        std::error_code error;
        return !fs::exists(source, error) || fs::equivalent(source, entry.source, error);
    };
    if (const auto found = byPlace_.find(placeOf(source)); found != byPlace_.end() && isMeant(found->second))
        return &found->second.output;
    const auto found = byCanonical_.find(canonicalName(source));
    return found == byCanonical_.end() ? nullptr : &found->second.output;
}

bool OutputsOfRun::writes(const fs::path& output) const {
    return outputs_.contains(placeOf(output)) || outputs_.contains(canonicalName(output));
}

namespace {

/// Finds the new paths of one scene's models.
class PathTurner {
  public:
    PathTurner(const AssetTask& task, const OutputsOfRun& outputs, Diagnostics& diagnostics)
        : from_(task.source.parent_path()),
          to_(task.output.parent_path()),
          outputs_(outputs),
          diagnostics_(diagnostics) {}

    std::optional<std::string> operator()(const ModelPathUse& use) {
        ++models_;
        const fs::path path(use.model.path);
        const fs::path named = from_ / path;
        if (const fs::path* output = outputs_.outputOf(named)) return fromNewPlace(*output);
        if (outputs_.writes(to_ / path)) return std::nullopt;  // named as it will be
        if (outputs_.writes(named)) return fromNewPlace(named);
        std::error_code error;
        if (!fs::exists(named, error)) {
            const auto meant = nearlyNamed(named);
            diagnostics_.warn(
                "scene-missing-model",
                fmt::format("{}: {} does not exist, and nothing of this run becomes it; the path "
                            "stays as it is{}",
                            use.place, use.model.path,
                            meant ? fmt::format("; did you mean {}?",
                                                meant->lexically_relative(from_).generic_string())
                                  : ""));
            return std::nullopt;
        }
        if (path.extension() == kPfVoxExtension) {
            return path.is_absolute() ? std::nullopt : std::optional(fromNewPlace(named));
        }
        const fs::path expected = fs::path(path).replace_extension(kPfVoxExtension);
        const fs::path output = (to_ / expected).lexically_normal();
        if (fs::exists(output, error)) return expected.generic_string();  // an earlier run converted it
        diagnostics_.warn("scene-model-not-converted",
                          fmt::format("{}: {} is no input of this run; the scene will look for {}", use.place,
                                      use.model.path, output.string()));
        return expected.generic_string();
    }

    std::uint32_t models() const { return models_; }

  private:
    std::string fromNewPlace(const fs::path& file) const {
        // Of a link among the outputs its own name, but folders as they are reached.
        const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
        const fs::path entry = canonicalName(folder) / file.filename();
        return entry.lexically_relative(canonicalName(to_.empty() ? "." : to_)).generic_string();
    }

    fs::path from_;
    fs::path to_;
    const OutputsOfRun& outputs_;
    Diagnostics& diagnostics_;
    std::uint32_t models_ = 0;
};

Result<std::string> turnedText(const AssetTask& task, const OutputsOfRun& outputs, const Limits& limits,
                               AssetResult& result) {
    PFVOX_TRY(const io::FileBytes, source,
              io::readFile(task.source, std::min(limits.maxFileBytes, kMaxSceneBytes)));
    const auto bytes = source.bytes();
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    DiagnosticList diagnostics;
    PathTurner turner(task, outputs, diagnostics);
    auto turned = withModelPaths(text, task.source, limits, diagnostics, std::ref(turner));
    result.sourceBytes = bytes.size();
    result.sceneModels = turner.models();
    result.diagnostics = diagnostics.entries();
    return turned;
}

/// Decides what happens to the output, and writes it where that is needed.
Result<void> carry(const AssetTask& task, const OutputsOfRun& outputs, const ConvertPolicy& policy,
                   const Limits& limits, AssetResult& result) {
    PFVOX_TRY(const std::string, text, turnedText(task, outputs, limits, result));
    PFVOX_CHECK(checkWarnings(result, policy));
    const auto bytes = std::as_bytes(std::span(text));
    std::error_code error;
    const bool present = fs::exists(task.output, error);
    const bool same = holdsBytes(task.output, bytes, limits);
    result.reason = !present       ? "there was no output"
                    : policy.force ? "--force"
                    : same         ? "the output holds these bytes already"
                                   : "the scene or the paths of its models changed";
    if (same && (!policy.force || policy.ifChanged)) {
        result.outcome = Outcome::UpToDate;
        result.outputBytes = bytes.size();
        refreshTimeStamp(task.output, policy);
        return {};
    }
    if (present && policy.noClobber) {
        result.outcome = Outcome::Kept;
        return {};
    }
    PFVOX_CHECK(checkOutput(task, policy));
    if (policy.dryRun) {
        result.outcome = Outcome::Planned;
        return {};
    }
    PFVOX_CHECK(io::writeFileAtomically(task.output, bytes, {.replaceReadOnly = policy.force}));
    result.outputBytes = bytes.size();
    result.outcome = Outcome::Converted;
    return {};
}

}  // namespace

AssetResult carryScene(const AssetTask& task, const OutputsOfRun& outputs, const ConvertPolicy& policy,
                       const Limits& limits) {
    AssetResult result;
    guardResult(task, result, [&] { return carry(task, outputs, policy, limits, result); });
    return result;
}

}  // namespace pfvox::tools

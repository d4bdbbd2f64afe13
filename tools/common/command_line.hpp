// Command line: what the tools of pfvox have in common when they read their arguments. CLI11 parses; this
// header gives every tool the same help page, the same error messages and the same common options.
//
// --help goes to stdout and exits 0. Wrong usage is a short text on stderr with the nearest option and exit
// code 2.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "common/exit_code.hpp"
#include "common/help_page.hpp"
#include "common/inputs.hpp"
#include "common/reporter.hpp"
#include "pfvox/limits.hpp"

namespace pfvox::tools {

/// A subcommand and what to do when it was chosen. The options that `run` reads live as long as `run` does.
struct Command {
    const CLI::App* app = nullptr;
    std::function<ExitCode()> run;
};

/// Names of option groups, in the order of the help page.
namespace group {
inline constexpr const char* kInputOutput = "Input and output";
inline constexpr const char* kConversion = "Conversion";
inline constexpr const char* kBuild = "In a build";
inline constexpr const char* kGeneral = "General";
}  // namespace group

/// Adds the default command in front of arguments that name none, so that `vox2pf a.vox -o out` works.
std::vector<std::string> withDefaultCommand(const CLI::App& tool, int argc, const char* const* argv);

/// Parses. Returns an exit code when the tool has nothing more to do: help or version printed, or wrong usage
/// reported.
std::optional<ExitCode> parseCommandLine(CLI::App& tool, const std::vector<std::string>& arguments);

/// Reports wrong usage that the parser cannot see.
ExitCode usageError(const CLI::App& command, const std::string& message);

/// A check for options: refuses what is not a finite number from `low` to `high`. (CLI::Range lets NaN pass.)
std::function<std::string(const std::string&)> numberFrom(double low, double high);

/// A check for options that name what is written: refuses an empty name, and "-", which elsewhere is standard
/// output.
std::function<std::string(const std::string&)> outputPath();

/// The inputs of a command that takes several, and how lists of them are written. `suffixes`: of the files
/// that completion offers.
void addInputs(CLI::App& command, InputWords& inputs, const std::vector<std::string>& suffixes);

/// `--name` and `--no-name` for one value. It holds what it held until one of them is given: CLI11's own
/// flags write their variable when they are declared, unless it is a plain bool.
CLI::Option* addSwitch(CLI::App& command, const std::string& name, bool& value, const std::string& meaning);
/// The same where what holds without them is decided later; `byDefault` is shown.
CLI::Option* addSwitch(CLI::App& command, const std::string& name, std::optional<bool>& value,
                       const std::string& meaning, const std::string& byDefault);
CLI::Option* addSwitch(CLI::App& command, const std::string& name, std::function<void(bool)> set,
                       const std::string& meaning, const std::string& byDefault);

/// Options of every subcommand.
struct CommonOptions {
    int threads = 0;
    bool quiet = false;
    bool verbose = false;
    bool json = false;
    std::string color = "auto";
    std::vector<std::string> limits;

    ReporterSettings reporterSettings() const;
};
void addCommonOptions(CLI::App& command, CommonOptions& options);

/// The default limits with every "name=value" applied. Values may end in K, M or G (powers of 1024). On
/// failure: what is wrong with which word.
tl::expected<Limits, std::string> parseLimits(const std::vector<std::string>& assignments);

}  // namespace pfvox::tools

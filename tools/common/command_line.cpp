#include "common/command_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <pfvox/files.hpp>

#include "common/text.hpp"
#include "common/unknown_option.hpp"

namespace pfvox::tools {

namespace {

constexpr int kMaxThreads = 1024;

void print(std::FILE* stream, const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stream);
}

const CLI::App& chosenCommand(const CLI::App& tool) {
    const auto chosen = tool.get_subcommands();
    return chosen.empty() ? tool : *chosen.front();
}

/// A first word that is nearly a command and names no file, or nothing.
std::optional<std::string> complaintAboutCommand(const CLI::App& tool,
                                                 const std::vector<std::string>& arguments) {
    std::error_code ignored;
    if (arguments.size() < 2 || std::filesystem::exists(arguments[1], ignored)) return std::nullopt;
    std::vector<std::string> commands;
    for (const CLI::App* command : tool.get_subcommands([](const CLI::App*) { return true; })) {
        commands.push_back(command->get_name());
    }
    const auto nearest = nearestWord(arguments[1], commands);
    if (!nearest) return std::nullopt;
    return fmt::format("{} is neither a command nor a file; did you mean {}?", arguments[1], *nearest);
}

/// CLI11 takes "[a,b]" among several values for a list of two. As an input it is the name of one file.
std::vector<std::string> withBracketsKept(const CLI::App& tool, std::vector<std::string> arguments) {
    const auto isNamed = [&](const CLI::App* app) { return app->get_name() == arguments.front(); };
    const auto commands = tool.get_subcommands(isNamed);
    if (commands.empty()) return arguments;
    bool onlyInputs = false;
    for (std::size_t i = 1; i < arguments.size(); ++i) {
        std::string& word = arguments[i];
        const CLI::Option* before = commands.front()->get_option_no_throw(arguments[i - 1]);
        const bool isValue = !onlyInputs && before != nullptr && before->get_items_expected_max() > 0;
        onlyInputs = onlyInputs || word == "--";
        if (!isValue && word.starts_with('[') && word.ends_with(']')) word.insert(0, "./");
    }
    return arguments;
}

}  // namespace

std::vector<std::string> withDefaultCommand(const CLI::App& tool, int argc, const char* const* argv) {
    std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
    if (arguments.empty()) return arguments;
    const std::string& first = arguments.front();
    const auto commands = tool.get_subcommands([](const CLI::App*) { return true; });
    const bool isCommand =
        std::ranges::any_of(commands, [&](const CLI::App* app) { return app->get_name() == first; });
    const bool isOfTool =
        first == "--help" || first == "-h" || first == "--version" || first.starts_with("--generate");
    if (isCommand || isOfTool) return arguments;
    arguments.insert(arguments.begin(), helpTextOf(tool).defaultCommand);
    return arguments;
}

std::optional<ExitCode> parseCommandLine(CLI::App& tool, const std::vector<std::string>& arguments) {
    if (arguments.empty()) {
        print(stderr, tool.help());
        return ExitCode::Usage;
    }
    try {
        const std::vector<std::string> words = withBracketsKept(tool, arguments);
        tool.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 pops from the back
    } catch (const CLI::CallForHelp&) {
        print(stdout, chosenCommand(tool).help());
        return ExitCode::Ok;
    } catch (const CLI::CallForVersion& version) {
        print(stdout, std::string(version.what()) + "\n");
        return ExitCode::Ok;
    } catch (const CLI::ParseError& error) {
        auto complaint = complaintAboutUnknownOption(tool, chosenCommand(tool));
        if (!complaint) complaint = complaintAboutCommand(tool, arguments);
        return usageError(chosenCommand(tool), complaint.value_or(error.what()));
    }
    return std::nullopt;
}

ExitCode usageError(const CLI::App& command, const std::string& message) {
    const CLI::App* tool = command.get_parent();
    const std::string name =
        tool == nullptr ? command.get_name() : tool->get_name() + " " + command.get_name();
    print(stderr, fmt::format("error: {}\nrun `{} --help` for the options\n", escaped(message), name));
    return ExitCode::Usage;
}

std::function<std::string(const std::string&)> numberFrom(double low, double high) {
    return [low, high](const std::string& text) -> std::string {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return {};
        return fmt::format("{} is not a number from {} to {}", text, low, high);
    };
}

std::function<std::string(const std::string&)> outputPath() {
    return [](const std::string& text) -> std::string {
        if (text == "-") return "nothing is written to standard output: name a file or folder, or ./- itself";
        const auto path = io::pathFromText(text);
        return path ? std::string() : path.error().message;
    };
}

void addInputs(CLI::App& command, InputWords& inputs, const std::vector<std::string>& suffixes) {
    command.add_option("input", inputs.words)
        ->required()
        ->check(suggestFiles(suffixes))
        ->group(group::kInputOutput);
    command
        .add_flag("-0,--null", inputs.nullSeparated,
                  "entries of lists end in NUL, as `find -print0` writes them")
        ->group(group::kInputOutput);
}

CLI::Option* addSwitch(CLI::App& command, const std::string& name, bool& value, const std::string& meaning) {
    return addSwitch(
        command, name, [&value](bool on) { value = on; }, meaning, (value ? "--" : "--no-") + name);
}

CLI::Option* addSwitch(CLI::App& command, const std::string& name, std::optional<bool>& value,
                       const std::string& meaning, const std::string& byDefault) {
    return addSwitch(
        command, name, [&value](bool on) { value = on; }, meaning, byDefault);
}

CLI::Option* addSwitch(CLI::App& command, const std::string& name, std::function<void(bool)> set,
                       const std::string& meaning, const std::string& byDefault) {
    return command
        .add_flag_function(
            fmt::format("--{0},!--no-{0}", name),
            [set = std::move(set)](std::int64_t count) { set(count > 0); }, meaning)
        ->check(showDefault(byDefault));
}

void addCommonOptions(CLI::App& command, CommonOptions& options) {
    command.add_option("-j,--jobs", options.threads, "threads, 0 = one for each processor")
        ->option_text("N")
        ->check(numberFrom(0, kMaxThreads))
        ->check(showDefault(options.threads))
        ->group(group::kGeneral);
    auto* quiet = command.add_flag("-q,--quiet", options.quiet, "print errors only")->group(group::kGeneral);
    command.add_flag("-v,--verbose", options.verbose, "print notes too, and a line for every file")
        ->excludes(quiet)
        ->group(group::kGeneral);
    command.add_flag("--json", options.json, "print one JSON object a file on stdout")
        ->group(group::kGeneral);
    command.add_option("--color", options.color, "auto, always or never; auto honors NO_COLOR")
        ->option_text("WHEN")
        ->check(CLI::IsMember({"auto", "always", "never"}))
        ->check(showDefault(options.color))
        ->group(group::kGeneral);
    command
        .add_option("--limit", options.limits,
                    "raise or lower a limit, such as maxFileBytes=1G; may be repeated")
        ->option_text("NAME=VALUE")
        ->expected(1)
        ->take_all()
        ->allow_extra_args(false)
        ->group(group::kGeneral);
}

ReporterSettings CommonOptions::reporterSettings() const {
    ReporterSettings settings;
    settings.color = color == "always"  ? ColorMode::Always
                     : color == "never" ? ColorMode::Never
                                        : ColorMode::Auto;
    settings.verbosity = quiet ? Verbosity::Quiet : verbose ? Verbosity::Verbose : Verbosity::Normal;
    settings.json = json;
    return settings;
}

}  // namespace pfvox::tools

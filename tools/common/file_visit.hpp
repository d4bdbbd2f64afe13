// File visit: commands that only read do the same with each of the files that they are asked about.
#pragma once

#include <functional>
#include <optional>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <string>
#include <vector>

#include "common/command_line.hpp"
#include "common/reporter.hpp"

namespace pfvox::tools {

struct ReadOptions {
    CommonOptions common;
    InputWords inputs;
};

/// `extension` is that of the files which the command reads.
void addReadOptions(CLI::App& command, ReadOptions& options, const std::string& extension);

/// Says that a file cannot be read, with --json as an object, too (docs/schema/read-failure.schema.json).
/// Returns the code.
ErrorCode reportFailure(Reporter& reporter, const std::filesystem::path& file, Error error);

/// What happens with one file: returns the code of its failure, or nothing when all is well.
using FileVisitor =
    std::function<std::optional<ErrorCode>(const std::filesystem::path&, const Limits&, Reporter&)>;

/// Looks at all inputs before the first is visited, and may mark some as faults. Returns what makes the whole
/// command wrong usage, if anything does.
using InputsCheck = std::function<std::string(std::vector<InputFile>&)>;

/// Visits every file that the inputs name, one after the other, each with `-j` threads. Of folders those with
/// this extension.
ExitCode visitFiles(const CLI::App& command, const ReadOptions& options, const std::string& extension,
                    const FileVisitor& visit, const InputsCheck& check = {});

}  // namespace pfvox::tools

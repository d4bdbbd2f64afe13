// What info and validate share: options, and the list of PF_VOX files they are asked about.
#pragma once

#include <functional>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <string>
#include <vector>

#include "common/command_line.hpp"
#include "common/reporter.hpp"

namespace pfvox::tools {

struct ReadOptions {
    CommonOptions common;
    std::vector<std::string> inputs;
};

void addReadOptions(CLI::App& command, ReadOptions& options);

/// What happens with one file: returns the code of its failure, or nothing when all is well.
using FileVisitor =
    std::function<std::optional<ErrorCode>(const std::filesystem::path&, const Limits&, Reporter&)>;

/// Visits every PF_VOX file that the inputs name, one after the other, each with `-j` threads.
ExitCode visitPfVoxFiles(const CLI::App& command, const ReadOptions& options, const FileVisitor& visit);

/// Adds what to do about it to the error of a file that is a source rather than a PF_VOX file.
Error withRemedy(Error error);

}  // namespace pfvox::tools

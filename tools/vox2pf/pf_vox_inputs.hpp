// What info, validate and export share: the PF_VOX files that they are asked about.
#pragma once

#include <pfvox/error.hpp>

#include "common/file_visit.hpp"

namespace pfvox::tools {

/// Visits every PF_VOX file that the inputs name, one after the other, each with `-j` threads.
ExitCode visitPfVoxFiles(const CLI::App& command, const ReadOptions& options, const FileVisitor& visit);

/// Adds what to do about it to the error of a file that is a source rather than a PF_VOX file.
Error withRemedy(Error error);

}  // namespace pfvox::tools

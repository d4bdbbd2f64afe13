// The subcommands of probe-bake: one source file each.
#pragma once

#include "common/command_line.hpp"

namespace pfvox::tools {

/// A scene to a PF_PROBE file.
Command makeBakeCommand(CLI::App& tool);
/// What is in a PF_PROBE file.
Command makeInfoCommand(CLI::App& tool);
/// Everything that is wrong with a PF_PROBE file.
Command makeValidateCommand(CLI::App& tool);
/// How two PF_PROBE files of one grid differ.
Command makeCompareCommand(CLI::App& tool);
/// Shards to one PF_PROBE file.
Command makeMergeCommand(CLI::App& tool);
/// Probes against path tracing.
Command makeVerifyCommand(CLI::App& tool);

/// Extension of the files that this tool writes.
inline constexpr const char* kPfProbeExtension = ".pf_probe";

}  // namespace pfvox::tools

// The subcommands of vox2pf: one source file each.
#pragma once

#include "common/command_line.hpp"

namespace pfvox::tools {

/// Sources to PF_VOX files.
Command makeConvertCommand(CLI::App& tool);
/// What is in a PF_VOX file.
Command makeInfoCommand(CLI::App& tool);
/// Everything that is wrong with a PF_VOX file.
Command makeValidateCommand(CLI::App& tool);
/// PF_VOX files back to a source format.
Command makeExportCommand(CLI::App& tool);

/// Extension of the files that this tool writes.
inline constexpr const char* kPfVoxExtension = ".pf_vox";

}  // namespace pfvox::tools

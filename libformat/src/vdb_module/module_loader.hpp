// Finds and opens the module that knows OpenVDB.
#pragma once

#include <filesystem>
#include <pfvox/error.hpp>
#include <span>
#include <vector>

#include "vdb_module/vdb_module.hpp"

namespace pfvox {

/// The module, opened by the first call and never closed. May be called from several threads.
/// Errors: UnsupportedFeature when it is missing, cannot be opened or is of another build; the message has
/// the remedy; LimitExceeded when the memory does not suffice.
Result<const VdbModule*> vdbModule();

/// The same in given folders, in their order; the first that has the file decides.
Result<const VdbModule*> openVdbModule(std::span<const std::filesystem::path> folders);

/// Where vdbModule() looks: below the library folder of the program's own tree, beside the program, and where
/// pfvox was meant to be installed.
std::vector<std::filesystem::path> moduleFolders();

/// A Diagnostics as the module takes it.
ReportTo reportTo(Diagnostics& diagnostics);

}  // namespace pfvox

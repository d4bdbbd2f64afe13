// Findings: what the validate commands print about a file (docs/schema/validate.schema.json).
#pragma once

#include <filesystem>
#include <pfvox/pf_vox.hpp>
#include <string>
#include <vector>

#include "common/json.hpp"
#include "common/reporter.hpp"

namespace pfvox::tools {

/// The object of one file.
Json findingsJson(const std::filesystem::path& file, const std::vector<Finding>& findings);

/// One line for each finding, then a verdict; lines end with a newline.
std::string findingsText(const std::filesystem::path& file, const std::vector<Finding>& findings,
                         const Reporter& reporter);

}  // namespace pfvox::tools

// Depfile: tells make and ninja what an output was made from, in Makefile syntax.
#pragma once

#include <filesystem>
#include <pfvox/error.hpp>
#include <string>
#include <vector>

namespace pfvox::tools {

struct DepfileRule {
    std::filesystem::path target;
    std::vector<std::filesystem::path> prerequisites;
};

/// One rule a line: "out/hall.pf_vox: assets/hall.vox". Spaces, '#' and '$' in names are escaped.
std::string depfileText(const std::vector<DepfileRule>& rules);

/// Writes the rules, complete or not at all. Errors: FileNotWritable.
Result<void> writeDepfile(const std::filesystem::path& file, const std::vector<DepfileRule>& rules);

}  // namespace pfvox::tools

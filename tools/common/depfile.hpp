// Depfile: tells make and ninja what an output was made from, in Makefile syntax.
//
// Names are text of another language here, so a name never gets into a depfile that its reader would take for
// anything but that name: a name that cannot be told is an error, and no depfile is written
// (docs/decisions/048-names-in-builds.md).
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

/// Whose rules of escaping count. Each also means CMake, which reads depfiles itself and writes new ones for
/// that program.
enum class DepfileReader { Make, Ninja };

/// --if-changed is for ninja, which looks at time stamps again after a command.
inline DepfileReader depfileReader(bool ifChanged) {
    return ifChanged ? DepfileReader::Ninja : DepfileReader::Make;
}

/// One rule a line: "out/hall.pf_vox: assets/hall.vox". Errors: BadValue with the file whose name the reader
/// cannot be told.
Result<std::string> depfileText(const std::vector<DepfileRule>& rules, DepfileReader reader);

/// Writes the rules, complete or not at all. Errors: as depfileText(), FileNotWritable.
Result<void> writeDepfile(const std::filesystem::path& file, const std::vector<DepfileRule>& rules,
                          DepfileReader reader);

}  // namespace pfvox::tools

// Output paths: where each input of a run is written.
//
// `-o` names a file when it ends in the wanted extension and one file goes in; otherwise it names a folder,
// in which the tree of an input folder is mirrored.
#pragma once

#include <filesystem>
#include <functional>
#include <pfvox/error.hpp>
#include <string>
#include <vector>

#include "common/inputs.hpp"

namespace pfvox::tools {

struct InputOutput {
    InputFile input;
    std::filesystem::path output;
};

/// Whether `output` names a file rather than a folder, by its looks.
bool namesOutputFile(const std::filesystem::path& output, const std::string& extension);

/// Pairs every input with its output; inputs for which `keepsName` holds keep their own extension. A file of
/// a searched folder that would be its own output is left out: it is an output of an earlier run. Inputs that
/// would become the same output get a fault each (FileNotWritable), so that the others go on; the same file
/// twice is taken once. The error text (wrong usage) names both sides when a named input would be
/// overwritten.
tl::expected<std::vector<InputOutput>, std::string> pairOutputs(
    std::vector<InputFile> inputs, const std::filesystem::path& output, const std::string& extension,
    const std::function<bool(const InputFile&)>& keepsName = {});

}  // namespace pfvox::tools

// JSON: how errors and diagnostics look in the --json output of every tool. The schemas are in docs/schema/.
#pragma once

#include <nlohmann/json.hpp>
#include <pfvox/error.hpp>
#include <span>
#include <string>

namespace pfvox::tools {

/// Keeps keys in the order in which they are set, so that output is stable and reads well.
using Json = nlohmann::ordered_json;

Json toJson(const Error& error);
Json toJson(const Diagnostic& diagnostic);
Json toJson(std::span<const Diagnostic> diagnostics);

/// One line of text. Bytes of file names that are not UTF-8 are replaced, never a reason to fail.
std::string jsonText(const Json& json);

}  // namespace pfvox::tools

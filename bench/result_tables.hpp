// Result tables: the Markdown tables of docs/, made of the JSON lines that benchmarks have printed, never by
// hand.
//
//     <!-- table NAME of FILE [FILE...] -->    files are relative to the folder of results (docs/results)
//     | ... |
//     <!-- end of table -->
//
// What lies between is replaced. A table of which a file is not there yet stays as it is.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pfvox::bench {

/// The lines of one or more files, in their order.
using ResultLines = std::vector<nlohmann::ordered_json>;

/// Lines of a table by its name: verify, trace-models, trace-primary, trace-shadow, trace-diffuse,
/// trace-bounces, trace-means. Throws std::runtime_error for another name and for lines that lack what the
/// table shows.
std::string tableOf(const std::string& name, const ResultLines& lines);

struct TabledDocument {
    std::string text;                 ///< with its tables made new
    std::vector<std::string> absent;  ///< files that tables name and that are not there
    std::size_t tables = 0;           ///< that were made
};

/// Throws std::runtime_error: as tableOf; a table without its end; a line that is not JSON.
TabledDocument withTables(const std::string& document, const std::filesystem::path& results);

}  // namespace pfvox::bench

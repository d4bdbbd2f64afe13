// Sets the figures of bench_format beside those of bench_peers and beside the targets, as one Markdown table.
// Run by bench/run-format: bench_compare <json of bench_format> [<json of bench_peers>]
// The best of all repetitions counts: on a shared machine everything else is somebody else's work.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace {

/// What is measured of a model, in which counter of which benchmark, ours and theirs.
struct Figure {
    const char* label;
    const char* counter;
    bool moreIsBetter;
    const char* ours;
    const char* openVdb;
    const char* nanoVdb;
};
constexpr const char* kMilliseconds = "real_time";
constexpr Figure kFigures[] = {
    {"complete build, Mvoxels/s", "Mvoxels/s", true, "complete", "openvdb_build/2", "nanovdb_build"},
    {"disk, B/voxel", "disk_B/voxel", false, "encode/3", "openvdb_load", "nanovdb_load_zip"},
    {"memory, B/voxel", "memory_B/voxel", false, "build", "openvdb_build/1", "nanovdb_build"},
    {"load, ms", kMilliseconds, false, "decode", "openvdb_load", "nanovdb_load_zip"},
    {"load, NanoVDB uncompressed, ms", kMilliseconds, false, "decode", "", "nanovdb_load_raw"},
};

/// The targets of docs/performance.md, in the order of kFigures.
struct Targets {
    const char* model;
    double values[std::size(kFigures)];
};
constexpr Targets kTargets[] = {
    {"sphere", {100, 0.020, 0.14, 30, 30}},
    {"shell", {100, 0.27, 4.5, 30, 30}},
    {"terrain", {100, 0.57, 3.1, 30, 30}},
};

/// "model/benchmark" and counter to the best value of all repetitions.
class Measurements {
  public:
    void read(const char* path) {
        std::ifstream file(path);
        const nlohmann::json report = nlohmann::json::parse(file);
        for (const auto& run : report.at("benchmarks")) {
            if (run.value("run_type", std::string("iteration")) != "iteration") continue;
            if (run.value("error_occurred", false)) continue;
            const std::string name = nameOf(run.at("name").get<std::string>());
            for (const auto& [key, value] : run.items()) {
                if (value.is_number()) keepBest(name, key, value.get<double>());
            }
        }
    }

    std::optional<double> find(const std::string& model, std::string_view benchmark,
                               const std::string& counter) const {
        const auto found = values_.find(model + '/' + std::string(benchmark) + ' ' + counter);
        if (found == values_.end()) return std::nullopt;
        return found->second;
    }

  private:
    /// Without the parts that the library appends: "sphere/encode/3/process_time/real_time" is
    /// "sphere/encode/3".
    static std::string nameOf(std::string name) {
        const std::size_t end = name.find("/process_time");
        return end == std::string::npos ? name : name.substr(0, end);
    }

    void keepBest(const std::string& name, const std::string& counter, double value) {
        // Our tree in memory is what lies on the GPU.
        const std::string key = name + ' ' + (counter == "gpu_B/voxel" ? "memory_B/voxel" : counter);
        const auto [entry, isNew] = values_.try_emplace(key, value);
        if (!isNew)
            entry->second =
                counter == "Mvoxels/s" ? std::max(entry->second, value) : std::min(entry->second, value);
    }

    std::map<std::string, double> values_;
};

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, value < 0.995 ? "%.3f" : value < 99.5 ? "%.2f" : "%.0f", value);
    return text;
}

std::string cell(std::optional<double> value) {
    return value ? number(*value) : "-";
}

std::string ratio(double ours, std::optional<double> theirs) {
    return theirs && *theirs > 0 ? number(ours / *theirs) : "-";
}

/// Prints one row; returns whether the target holds, or nothing where this was not measured.
std::optional<bool> printRow(const Measurements& measured, const Targets& targets, std::size_t index) {
    const Figure& figure = kFigures[index];
    const std::string model = targets.model;
    const auto ours = measured.find(model, figure.ours, figure.counter);
    if (!ours) return std::nullopt;
    const auto openVdb = measured.find(model, figure.openVdb, figure.counter);
    const auto nanoVdb = measured.find(model, figure.nanoVdb, figure.counter);
    const double target = targets.values[index];
    const bool holds = figure.moreIsBetter ? *ours >= target : *ours <= target;
    std::printf("| %s | %s | %s | %s %s | %s | %s | %s | %s | %s |\n", targets.model, figure.label,
                number(*ours).c_str(), figure.moreIsBetter ? ">=" : "<=", number(target).c_str(),
                holds ? "yes" : "NO", cell(openVdb).c_str(), ratio(*ours, openVdb).c_str(),
                cell(nanoVdb).c_str(), ratio(*ours, nanoVdb).c_str());
    return holds;
}

void printTable(const Measurements& measured) {
    std::puts("| model | figure | ours | target | holds | OpenVDB | ours/theirs | NanoVDB | ours/theirs |");
    std::puts("| --- | --- | ---: | ---: | --- | ---: | ---: | ---: | ---: |");
    int missed = 0;
    int rows = 0;
    for (const Targets& targets : kTargets) {
        for (std::size_t i = 0; i < std::size(kFigures); ++i) {
            const std::optional<bool> holds = printRow(measured, targets, i);
            rows += holds.has_value() ? 1 : 0;
            missed += holds == false ? 1 : 0;
        }
    }
    if (rows == 0) throw std::runtime_error("nothing of the three models was measured");
    std::printf(
        "\nTargets missed: %d. Build: OpenVDB Int32 on 2 threads, NanoVDB UInt8 on 1. "
        "Disk: OpenVDB blosc, NanoVDB zip.\n",
        missed);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fputs("usage: bench_compare <json of bench_format> [<json of bench_peers>]\n", stderr);
        return 2;
    }
    try {
        Measurements measured;
        for (int i = 1; i < argc; ++i) measured.read(argv[i]);
        printTable(measured);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_compare: %s\n", error.what());
        return 1;
    }
    return 0;
}

// Bake report: what probe-bake bake tells, for people and as JSON (docs/schema/bake.schema.json).
#pragma once

#include <optional>
#include <pfvox/bake.hpp>
#include <span>
#include <string>

#include "common/json.hpp"

namespace pfvox::tools {

enum class BakeStatus {
    Failed,    ///< with `error`
    Planned,   ///< --dry-run, or it did not come to the bake
    UpToDate,  ///< nothing was done
    Baked,
};

/// What came of one bake.
struct BakeOutcome {
    BakeStatus status = BakeStatus::Failed;
    bool isRepair = false;  ///< the output that was replaced was damaged
    std::string input;
    std::string output;
    std::string device;
    std::string reason;  ///< why it was baked or not, one clause
    std::optional<ContentKey>
        contentKey;     ///< of what was asked for; nothing = it failed before that was known
    BakeReport report;  ///< all of it is known of what was baked; `probes` once planned, `counts` and
                        ///< `fileBytes` when up to date
    std::vector<Diagnostic> diagnostics;
    std::optional<Error> error;
};

/// "hall.pf_probe: probe 12 of 960, 31.2 million rays/s, 2 min 05 s left"
std::string progressLine(const std::string& output, const BakeProgress& progress);

/// The end of a run, lines that each end with a newline.
std::string bakeText(const BakeOutcome& outcome, bool explain);

Json bakeJson(const BakeOutcome& outcome);

/// "0  Name (discrete, 139 GiB), driver", one line a device.
std::string deviceLines(std::span<const gpu::DeviceInfo> devices);
Json devicesJson(std::span<const gpu::DeviceInfo> devices);

}  // namespace pfvox::tools

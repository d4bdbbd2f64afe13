// Verify report: what `probe-bake verify` says and shows of one camera: a table row, a JSON line
// (docs/schema/verify.schema.json) and pictures.
#pragma once

#include <pfvox/verify.hpp>

#include "common/json.hpp"
#include "common/table.hpp"

namespace pfvox::tools {

/// One camera, and how its figures came about.
struct CameraVerdict {
    Camera camera;
    VerifiedPicture picture;
    VerifyScore score;
    std::uint32_t samples = 0;  ///< paths a pixel of the reference
    ReferenceTarget target;     ///< that the reference was meant to reach
};

/// Of a camera, with characters only that every file system takes.
std::string fileNameOf(const Camera& camera);

Table verdictTable();
void addRow(Table& table, const CameraVerdict& verdict);
Json verdictJson(const CameraVerdict& verdict);

/// Why the figures cannot be relied upon and what helps; empty when they can.
std::string uncertaintyOf(const CameraVerdict& verdict);

/// `<camera>-probes.png`, `-reference`, `-flip` and `-tiers`. Errors: FileNotWritable.
Result<void> writePictures(const std::filesystem::path& folder, const CameraVerdict& verdict);

}  // namespace pfvox::tools

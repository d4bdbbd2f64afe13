// Verify report: what `probe-bake verify` says and shows of one camera: a table row, a JSON line
// (docs/schema/verify.schema.json) and pictures.
#pragma once

#include <pfvox/verify.hpp>
#include <span>
#include <string>
#include <vector>

#include "common/json.hpp"
#include "common/table.hpp"

namespace pfvox::tools {

struct NamedCamera {
    Camera camera;
    std::string fileName;  ///< begins the names of its files; differs from those of other cameras
};

/// With characters only that every file system takes. Of all cameras of a scene at once, so that those of one
/// do not depend on which others are looked at.
std::vector<NamedCamera> namedCameras(std::span<const Camera> cameras);

/// One camera, and how its figures came about.
struct CameraVerdict {
    NamedCamera named;
    VerifiedPicture picture;
    VerifyScore score;
    std::uint32_t samples = 0;  ///< paths a pixel of the reference
    ReferenceTarget target;     ///< that the reference was meant to reach
};

Table verdictTable();
void addRow(Table& table, const CameraVerdict& verdict);
Json verdictJson(const CameraVerdict& verdict);

/// Why the figures cannot be relied upon and what helps; empty when they can.
std::string uncertaintyOf(const CameraVerdict& verdict);

/// `<camera>-probes.png`, `-reference`, `-flip` and `-tiers`. Errors: FileNotWritable.
Result<void> writePictures(const std::filesystem::path& folder, const CameraVerdict& verdict);

}  // namespace pfvox::tools

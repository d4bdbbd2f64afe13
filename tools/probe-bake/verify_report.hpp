// Verify report: what `probe-bake verify --json` says of one camera (docs/schema/verify.schema.json).
#pragma once

#include <pfvox/verify.hpp>

#include "common/json.hpp"

namespace pfvox::tools {

Json scoreJson(const Camera& camera, const VerifiedPicture& picture, const VerifyScore& score);

}  // namespace pfvox::tools

// Materials of the thesis program in our terms (docs/materials.md).
#pragma once

#include <pfvox/asset.hpp>
#include <pfvox/error.hpp>
#include <vector>

#include "import/legacy/legacy_layout.hpp"

namespace pfvox::import::legacy {

/// One material for each of the file's, with the same index. Values outside their range are clamped with a
/// diagnostic. Errors: BadValue for a type that the thesis program does not know and for numbers that are not
/// finite.
Result<std::vector<pfvox::Material>> convertMaterials(const LegacyFile& file, Diagnostics& diagnostics);

}  // namespace pfvox::import::legacy

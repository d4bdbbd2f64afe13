// Materials: from the MATL and MATT chunks of a VOX file to pfvox::Material. docs/import.md has the mapping
// as a table.
#pragma once

#include <pfvox/asset.hpp>
#include <pfvox/error.hpp>
#include <set>
#include <string>

#include "import/vox/chunks.hpp"

namespace pfvox::import::vox {

/// What a material chunk gave. The base color is not in it: that is the palette's.
struct MaterialRecord {
    Material material;
    std::set<std::string> unmappedKeys = {};  ///< properties that Material has no place for
    std::set<std::string> malformedKeys =
        {};  ///< values that are no numbers, or outside the property's range
};

/// The properties of a MATL chunk. A key that is missing has the default of Material; so has one that is
/// malformed, and values outside their range are moved to its nearest end.
MaterialRecord materialFromDict(const Dict& properties);

/// A material and the palette index that it belongs to: 1 to 255, or 0 for the unused entry.
struct MaterialChunk {
    std::int32_t paletteIndex = 0;
    MaterialRecord record;
};

/// Errors of both: Truncated, BadValue for an index outside the palette or an unknown MATT type.
Result<MaterialChunk> readMatl(Chunk& chunk);
/// The deprecated form, numbers instead of text.
Result<MaterialChunk> readMatt(Chunk& chunk);

}  // namespace pfvox::import::vox

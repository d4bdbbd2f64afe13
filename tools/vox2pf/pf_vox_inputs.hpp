// What info and export share about the PF_VOX files that they are asked about.
#pragma once

#include <pfvox/error.hpp>

namespace pfvox::tools {

/// Adds what to do about it to the error of a file that is a source rather than a PF_VOX file.
Error withRemedy(Error error);

}  // namespace pfvox::tools

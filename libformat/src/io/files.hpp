// The public header holds the declarations; the tools use them too.
#pragma once

#include <pfvox/files.hpp>

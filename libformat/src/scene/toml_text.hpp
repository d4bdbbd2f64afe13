// Values as TOML text.
#pragma once

#include <pfvox/math.hpp>
#include <string>
#include <string_view>

namespace pfvox::scene {

/// A basic string with its quotes; control characters, quotes and backslashes are escaped.
std::string tomlString(std::string_view text);

/// The shortest spelling that reads back as the same double, always a float of TOML: "1.0", "1e-07".
std::string tomlNumber(double value);

/// "[1.0, 2.5, 3.0]".
std::string tomlVector(const glm::dvec3& v);
std::string tomlVector(const glm::uvec3& v);

}  // namespace pfvox::scene

// SlicePattern: the file names of an SVX channel's slices. The manifest writes them as a printf format with
// one integer conversion ("density/slice%04d.png"); since it comes from the file, it never reaches printf.
#pragma once

#include <cstdint>
#include <optional>
#include <pfvox/error.hpp>
#include <string>
#include <string_view>

namespace pfvox::import::svx {

class SlicePattern {
  public:
    /// Accepts literal text, "%%", and exactly one %d, %i or %u with an optional width ("%04d" pads with
    /// zeros, "%4d" with spaces). Errors: BadValue with the reason.
    static Result<SlicePattern> parse(std::string_view text);

    /// The name of a slice; numbering starts at 0.
    std::string nameOf(std::uint32_t slice) const;

    /// The number in a name that this pattern can make, else nothing.
    std::optional<std::uint32_t> sliceOf(std::string_view name) const;

  private:
    std::string prefix_;
    std::string suffix_;
    std::size_t width_ = 0;
    char padding_ = ' ';
};

}  // namespace pfvox::import::svx

// Dict: the string-to-string tables in which a VOX file keeps attributes, and the numbers written in them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace pfvox::import::vox {

/// One DICT. Keys and values are views into the bytes of the file. Of equal keys the last one counts.
class Dict {
  public:
    using Entry = std::pair<std::string_view, std::string_view>;

    void add(std::string_view key, std::string_view value) { entries_.emplace_back(key, value); }
    std::optional<std::string_view> find(std::string_view key) const;
    /// Whether the key is there with a value that means yes: any whole number but 0.
    bool flag(std::string_view key) const;
    const std::vector<Entry>& entries() const { return entries_; }

  private:
    std::vector<Entry> entries_;
};

/// Numbers as text, read alike in every locale. Blanks around a number are skipped; anything else beside it
/// makes the result empty, as do infinity and NaN.
std::optional<std::int32_t> parseInt(std::string_view text);
std::optional<float> parseFloat(std::string_view text);
/// Exactly three numbers with blanks between them.
std::optional<std::array<std::int32_t, 3>> parseInt3(std::string_view text);
std::optional<std::array<float, 3>> parseFloat3(std::string_view text);

}  // namespace pfvox::import::vox

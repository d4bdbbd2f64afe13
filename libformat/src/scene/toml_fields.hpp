// Fields of a TOML document with everything that is wrong about them: complaints gather with their places, so
// that one run tells them all.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <pfvox/error.hpp>
#include <pfvox/math.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pfvox::scene {

/// "line 3, column 12".
std::string placeText(const toml::source_region& place);

/// Both ends belong to it.
struct Range {
    double low = 0.0;
    double high = 0.0;
};

class TomlFields {
  public:
    using Read = std::function<void(const toml::node&)>;
    using Known = std::vector<std::pair<std::string_view, Read>>;

    /// Calls the reader of each key that is there; other keys are warned about. `title` names the table.
    void readTable(const toml::table& table, std::string_view title, const Known& known);

    /// Readers of one value; a complaint leaves the field as it is.
    static std::optional<double> asNumber(const toml::node& node);
    Read number(std::string_view key, double& field, Range range);
    Read number(std::string_view key, std::optional<double>& field, Range range);
    Read vector(std::string_view key, glm::dvec3& field, Range range);
    Read vector(std::string_view key, std::optional<glm::dvec3>& field, Range range);
    Read counts(std::string_view key, glm::uvec3& field, std::uint32_t high);
    Read text(std::string_view key, std::string& field);
    Read flag(std::string_view key, bool& field);

    void error(const toml::source_region& place, std::string message, ErrorCode code = ErrorCode::BadValue);
    void warn(const toml::source_region& place, std::string id, std::string message);

    /// Sends the warnings in the order of the text. Fails with the first error if there is any; the next nine
    /// are further lines of its message.
    Result<void> finish(const std::filesystem::path& file, Diagnostics& diagnostics);

  private:
    struct Complaint {
        toml::source_region place;
        ErrorCode code = ErrorCode::BadValue;
        std::string id;  ///< of a warning
        std::string message;
    };
    std::optional<glm::dvec3> vectorIn(std::string_view key, const toml::node& node, Range range);
    std::optional<double> numberIn(std::string_view key, const toml::node& node, Range range);

    std::vector<Complaint> errors_;
    std::vector<Complaint> warnings_;
};

}  // namespace pfvox::scene

#include "common/findings.hpp"

#include <fmt/format.h>

#include "common/text.hpp"

namespace pfvox::tools {

Json findingsJson(const std::filesystem::path& file, const std::vector<Finding>& findings) {
    Json list = Json::array();
    for (const Finding& finding : findings) {
        Json json;
        json["id"] = finding.id;
        json["context"] = finding.context;
        json["offsetBytes"] = finding.offsetBytes ? Json(*finding.offsetBytes) : Json(nullptr);
        json["message"] = finding.message;
        list.push_back(json);
    }
    Json json;
    json["file"] = file.string();
    json["valid"] = findings.empty();
    json["findings"] = list;
    return json;
}

std::string findingsText(const std::filesystem::path& file, const std::vector<Finding>& findings,
                         const Reporter& reporter) {
    using Style = Reporter::Style;
    const std::string name = escaped(file.string());
    if (findings.empty()) return fmt::format("{}: {}\n", name, reporter.styled(Style::Good, "valid"));
    std::string text;
    for (const Finding& finding : findings) {
        const std::string offset = finding.offsetBytes ? fmt::format("@0x{:x}", *finding.offsetBytes) : "";
        const bool both = !finding.context.empty() && !offset.empty();
        const std::string place = finding.context + (both ? " " : "") + offset;
        text += fmt::format("{}: {}{}{} [{}]\n", name, escaped(place), place.empty() ? "" : ": ",
                            escaped(finding.message), finding.id);
    }
    return text +
           fmt::format("{}: {}\n", name, reporter.styled(Style::Bad, plural(findings.size(), "finding")));
}

}  // namespace pfvox::tools

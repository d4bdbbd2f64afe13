#include "common/json.hpp"

namespace pfvox::tools {

Json toJson(const Error& error) {
    Json json;
    json["code"] = toString(error.code);
    json["number"] = static_cast<int>(error.code);
    json["message"] = error.message;
    json["context"] = error.context;
    json["offsetBytes"] = error.offsetBytes ? Json(*error.offsetBytes) : Json(nullptr);
    return json;
}

Json toJson(const Diagnostic& diagnostic) {
    Json json;
    json["severity"] = diagnostic.severity == Severity::Warning ? "warning" : "note";
    json["id"] = diagnostic.id;
    json["message"] = diagnostic.message;
    json["offsetBytes"] = diagnostic.offsetBytes ? Json(*diagnostic.offsetBytes) : Json(nullptr);
    return json;
}

Json toJson(std::span<const Diagnostic> diagnostics) {
    Json json = Json::array();
    for (const Diagnostic& diagnostic : diagnostics) json.push_back(toJson(diagnostic));
    return json;
}

std::string jsonText(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace pfvox::tools

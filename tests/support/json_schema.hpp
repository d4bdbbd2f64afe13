// A checker for the part of JSON Schema that docs/schema/ uses: type, enum, required, properties,
// additionalProperties, items, and $ref to $defs of the same file.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pfvox::test {

class SchemaChecker {
  public:
    /// Everything about `value` that breaks the schema, with its place; empty = valid.
    static std::vector<std::string> check(const nlohmann::json& schema, const nlohmann::json& value) {
        SchemaChecker checker(schema);
        checker.visit(schema, value, "$");
        return checker.complaints_;
    }

  private:
    explicit SchemaChecker(const nlohmann::json& root) : root_(root) {}

    void visit(const nlohmann::json& schema, const nlohmann::json& value, const std::string& place) {
        if (schema.contains("$ref")) {
            const auto target = schema["$ref"].get<std::string>().substr(1);  // behind the #
            visit(root_.at(nlohmann::json::json_pointer(target)), value, place);
            return;
        }
        if (schema.contains("type") && !hasType(schema["type"], value)) {
            complaints_.push_back(place + " is not of type " + schema["type"].dump());
            return;
        }
        if (schema.contains("enum")) {
            const auto& allowed = schema["enum"];
            if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) {
                complaints_.push_back(place + " = " + value.dump() + " is not in " + allowed.dump());
            }
        }
        if (value.is_object()) visitObject(schema, value, place);
        if (value.is_array() && schema.contains("items")) {
            for (std::size_t i = 0; i < value.size(); ++i) {
                visit(schema["items"], value[i], place + "[" + std::to_string(i) + "]");
            }
        }
    }

    void visitObject(const nlohmann::json& schema, const nlohmann::json& value, const std::string& place) {
        for (const auto& name : schema.value("required", nlohmann::json::array())) {
            if (!value.contains(name)) complaints_.push_back(place + " lacks " + name.dump());
        }
        const nlohmann::json properties = schema.value("properties", nlohmann::json::object());
        for (const auto& [name, child] : value.items()) {
            if (properties.contains(name)) {
                visit(properties[name], child, place + "." + name);
            } else if (schema.contains("additionalProperties") && schema["additionalProperties"] == false) {
                complaints_.push_back(place + " has the undocumented key " + name);
            }
        }
    }

    static bool hasType(const nlohmann::json& type, const nlohmann::json& value) {
        if (type.is_array()) {
            return std::any_of(type.begin(), type.end(),
                               [&](const auto& one) { return hasType(one, value); });
        }
        if (type == "object") return value.is_object();
        if (type == "array") return value.is_array();
        if (type == "string") return value.is_string();
        if (type == "integer") return value.is_number_integer();
        if (type == "number") return value.is_number();
        if (type == "boolean") return value.is_boolean();
        return type == "null" && value.is_null();
    }

    const nlohmann::json& root_;
    std::vector<std::string> complaints_;
};

}  // namespace pfvox::test

#include "container/field_rules.hpp"

#include <fmt/format.h>

namespace pfvox::container {

namespace {

std::string possible(const FieldRule& rule) {
    if (rule.most < kMaxFloat) return fmt::format("{} to {}", rule.least, rule.most);
    return rule.least > -kMaxFloat ? fmt::format("finite numbers from {} up", rule.least) : "finite numbers";
}

}  // namespace

Result<void> checkFields(std::span<const FieldRule> rules, const void* record) {
    for (const FieldRule& rule : rules) {
        for (std::size_t i = 0; i < rule.count; ++i) {
            const double number = rule.numberAt(record, i);
            if (number >= rule.least && number <= rule.most) continue;
            return fail(ErrorCode::BadValue,
                        fmt::format("{} is {}: {} are possible", rule.name, number, possible(rule)));
        }
    }
    return {};
}

}  // namespace pfvox::container

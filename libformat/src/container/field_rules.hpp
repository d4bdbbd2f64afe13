// FieldRules: which numbers the fields of a record may hold. A format lists them once for each of its
// records; its reader and its writer both ask here.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <pfvox/error.hpp>
#include <span>
#include <string_view>
#include <type_traits>

namespace pfvox::container {

inline constexpr double kMaxFloat = static_cast<double>(std::numeric_limits<float>::max());

struct FieldRule {
    std::string_view name;
    double (*numberAt)(const void* record, std::size_t i);
    std::size_t count;  ///< of numbers: 1, or those of an array
    double least;
    double most;
};

namespace detail {
template <class Record, auto kMember>
double numberAt(const void* record, std::size_t i) {
    const auto& field = static_cast<const Record*>(record)->*kMember;
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(field)>>) {
        return static_cast<double>(field);
    } else {
        return static_cast<double>(field[i]);
    }
}
template <class Field>
inline constexpr std::size_t kNumbersOf = 1;
template <class Number, std::size_t kSize>
inline constexpr std::size_t kNumbersOf<std::array<Number, kSize>> = kSize;
}  // namespace detail

/// A field of numbers, each from `least` to `most`; NaN is in no range.
template <auto kMember, class Record, class Field>
constexpr FieldRule ruleOf(Field Record::*, std::string_view name, double least, double most) {
    return {name, &detail::numberAt<Record, kMember>, detail::kNumbersOf<Field>, least, most};
}

/// Errors: BadValue with the name of the field, what it holds and what is possible.
Result<void> checkFields(std::span<const FieldRule> rules, const void* record);

}  // namespace pfvox::container

/// The rule of a field: PFVOX_RULE(layout::Material, density, 0, kMaxFloat).
#define PFVOX_RULE(record, field, least, most) \
    ::pfvox::container::ruleOf<&record::field>(&record::field, #field, least, most)

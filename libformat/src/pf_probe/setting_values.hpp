// SettingValues: the settings of a bake as text and as the entries of a file. What walks over a list of
// settings (forEachProbeSetting, forEachFaceSetting) comes as `walk`: walk(visit, settings...).
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <pfvox/error.hpp>
#include <pfvox/face_light.hpp>
#include <pfvox/probe_settings.hpp>
#include <span>
#include <type_traits>
#include <vector>

#include "pf_probe/layout.hpp"

namespace pfvox::probe {

template <class T>
struct ValueOf {
    using Type = T;
};
template <class T>
struct ValueOf<std::optional<T>> {
    using Type = T;
};
/// Whether a setting of this type may be unknown.
template <class T>
inline constexpr bool kIsOptional = !std::is_same_v<T, typename ValueOf<T>::Type>;

inline std::string switchText(const ProbeSetting& setting, bool value) {
    if (!setting.option.starts_with("--")) return fmt::format("{} {}", setting.option, value ? "on" : "off");
    return value ? std::string(setting.option) : fmt::format("--no-{}", setting.option.substr(2));
}

/// "--bounces unlimited", "light sampling 1".
template <class T>
std::string valueText(const ProbeSetting& setting, const T& value) {
    if constexpr (std::is_same_v<T, bool>) {
        return switchText(setting, value);
    } else if constexpr (std::is_enum_v<T>) {
        return fmt::format("{} {}", setting.option, toString(value));
    } else {
        if (setting.id == kBouncesId && value == static_cast<T>(kUnlimitedBounces))
            return fmt::format("{} unlimited", setting.option);
        if (setting.id != kFilterId) return fmt::format("{} {}", setting.option, value);
        const std::string text = switchText(setting, value != 0);
        return value == 0 ? text : fmt::format("{} (revision {})", text, value);
    }
}
template <class T>
std::string valueText(const ProbeSetting& setting, const std::optional<T>& value) {
    return value ? valueText(setting, *value) : fmt::format("{} unknown", setting.option);
}

template <class T>
std::uint64_t bitsOf(const T& value) {
    if constexpr (std::is_same_v<T, float>) {
        return std::bit_cast<std::uint32_t>(value);
    } else {
        return static_cast<std::uint64_t>(value);
    }
}

/// Nothing where the bits are no value of the type.
template <class T>
std::optional<T> fromBits(std::uint64_t bits) {
    if constexpr (std::is_same_v<T, bool>) {
        return bits <= 1 ? std::optional(bits == 1) : std::nullopt;
    } else if constexpr (std::is_same_v<T, FaceCodec>) {
        return bits <= static_cast<std::uint64_t>(FaceCodec::Lossless) ? std::optional(FaceCodec(bits))
                                                                       : std::nullopt;
    } else if constexpr (std::is_same_v<T, std::uint64_t>) {
        return bits;
    } else {
        if (bits > 0xffffffffu) return std::nullopt;
        const auto word = static_cast<std::uint32_t>(bits);
        if constexpr (std::is_same_v<T, float>) {
            const auto value = std::bit_cast<float>(word);
            return std::isfinite(value) ? std::optional(value) : std::nullopt;
        } else {
            return word;
        }
    }
}

template <class Walk, class Settings>
std::vector<ProbeSettingDifference> settingDifferences(const Walk& walk, const Settings& first,
                                                       const Settings& second) {
    std::vector<ProbeSettingDifference> differences;
    const auto compare = [&](const ProbeSetting& setting, const auto& a, const auto& b) {
        if (a != b) differences.push_back({valueText(setting, a), valueText(setting, b)});
    };
    walk(compare, first, second);
    return differences;
}

/// Known settings with an id, ascending.
template <class Walk, class Settings>
std::vector<probe_layout::Setting> settingEntries(const Walk& walk, const Settings& settings) {
    std::vector<probe_layout::Setting> entries;
    const auto add = [&](const ProbeSetting& setting, const auto& value) {
        if (setting.id == 0) return;
        const auto push = [&](const auto& known) {
            entries.push_back({.id = setting.id, .reserved = 0, .value = bitsOf(known)});
        };
        if constexpr (kIsOptional<std::decay_t<decltype(value)>>) {
            if (value) push(*value);
        } else {
            push(value);
        }
    };
    walk(add, settings);
    std::ranges::sort(entries, {}, &probe_layout::Setting::id);
    return entries;
}

/// Ids of later versions are left out; optional settings without an entry stay as they are. Errors: BadValue,
/// BadStructure.
template <class Walk, class Settings>
Result<void> readSettingEntries(const Walk& walk, std::span<const probe_layout::Setting> entries,
                                Settings& settings) {
    Result<void> result;
    std::uint32_t last = 0;
    for (const probe_layout::Setting& entry : entries) {
        if (entry.id <= last)
            return fail(ErrorCode::BadStructure,
                        fmt::format("setting {} is not in ascending order", entry.id));
        if (entry.reserved != 0) return fail(ErrorCode::BadValue, "a reserved field is not 0");
        last = entry.id;
    }
    const auto take = [&](const ProbeSetting& setting, auto& value) {
        using Value = std::decay_t<decltype(value)>;
        if (setting.id == 0 || !result) return;
        const auto entry = std::ranges::find(entries, setting.id, &probe_layout::Setting::id);
        if (entry == entries.end()) {
            if constexpr (!kIsOptional<Value>)
                result = fail(ErrorCode::BadStructure, fmt::format("setting {} is missing", setting.name));
            return;
        }
        const auto known = fromBits<typename ValueOf<Value>::Type>(entry->value);
        if (known) {
            value = *known;
        } else {
            result = fail(ErrorCode::BadValue,
                          fmt::format("0x{:x} is not a value of {}", entry->value, setting.name));
        }
    };
    walk(take, settings);
    return result;
}

}  // namespace pfvox::probe

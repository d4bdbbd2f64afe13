#include "pf_probe/probe_settings.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <type_traits>

namespace pfvox {

namespace {

template <class T>
struct ValueOf {
    using Type = T;
};
template <class T>
struct ValueOf<std::optional<T>> {
    using Type = T;
};

std::string switchText(const ProbeSetting& setting, bool value) {
    if (!setting.option.starts_with("--")) return fmt::format("{} {}", setting.option, value ? "on" : "off");
    return value ? std::string(setting.option) : fmt::format("--no-{}", setting.option.substr(2));
}

template <class T>
std::string valueText(const ProbeSetting& setting, const T& value) {
    if constexpr (std::is_same_v<T, bool>) {
        return switchText(setting, value);
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

std::uint64_t bitsOf(float value) {
    return std::bit_cast<std::uint32_t>(value);
}
template <class T>
std::uint64_t bitsOf(T value) {
    return value;
}

template <class T>
std::optional<T> fromBits(std::uint64_t bits) {
    if constexpr (std::is_same_v<T, bool>) {
        return bits <= 1 ? std::optional(bits == 1) : std::nullopt;
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

}  // namespace

std::vector<ProbeSettingDifference> differencesOf(const ProbeBakeSettings& first,
                                                  const ProbeBakeSettings& second) {
    std::vector<ProbeSettingDifference> differences;
    const auto compare = [&](const ProbeSetting& setting, const auto& a, const auto& b) {
        if (a != b) differences.push_back({valueText(setting, a), valueText(setting, b)});
    };
    forEachProbeSetting(compare, first, second);
    return differences;
}

std::string probeSettingsText(const ProbeBakeSettings& settings) {
    std::string text;
    const auto add = [&](const ProbeSetting& setting, const auto& value) {
        if (setting.id != 0) text += (text.empty() ? "" : ", ") + valueText(setting, value);
    };
    forEachProbeSetting(add, settings);
    return text;
}

namespace probe {

std::vector<probe_layout::Setting> settingEntries(const ProbeBakeSettings& settings) {
    std::vector<probe_layout::Setting> entries;
    const auto add = [&](const ProbeSetting& setting, const auto& value) {
        if constexpr (!std::is_arithmetic_v<std::decay_t<decltype(value)>>) {
            if (value) entries.push_back({.id = setting.id, .reserved = 0, .value = bitsOf(*value)});
        }
    };
    forEachProbeSetting(add, settings);
    return entries;
}

Result<void> readSettingEntries(std::span<const probe_layout::Setting> entries, ProbeBakeSettings& settings) {
    Result<void> result;
    std::uint32_t last = 0;
    for (const probe_layout::Setting& entry : entries) {
        if (entry.id <= last)
            return fail(ErrorCode::BadStructure,
                        fmt::format("setting {} is not in ascending order", entry.id));
        if (entry.reserved != 0) return fail(ErrorCode::BadValue, "a reserved field is not 0");
        last = entry.id;
        const auto take = [&](const ProbeSetting& setting, auto& value) {
            using Value = std::decay_t<decltype(value)>;
            if constexpr (!std::is_arithmetic_v<Value>) {
                if (setting.id != entry.id) return;
                value = fromBits<typename ValueOf<Value>::Type>(entry.value);
                if (!value)
                    result = fail(ErrorCode::BadValue,
                                  fmt::format("0x{:x} is not a value of {}", entry.value, setting.name));
            }
        };
        forEachProbeSetting(take, settings);
        PFVOX_CHECK(result);
    }
    return {};
}

std::uint32_t bouncesOfInfo(const ProbeBakeSettings& settings) {
    const std::uint32_t bounces = settings.maxBounces.value_or(kUnlimitedBounces);
    return bounces == kUnlimitedBounces ? 0 : bounces;
}

std::optional<std::uint32_t> bouncesFromInfo(std::uint32_t stored) {
    return stored == 0 ? std::nullopt : std::optional(stored);
}

}  // namespace probe

}  // namespace pfvox

#include "pf_probe/probe_settings.hpp"

#include "pf_probe/setting_values.hpp"

namespace pfvox {

namespace {
constexpr auto kWalk = [](const auto& visit, auto&... settings) { forEachProbeSetting(visit, settings...); };
}

std::vector<ProbeSettingDifference> differencesOf(const ProbeBakeSettings& first,
                                                  const ProbeBakeSettings& second) {
    return probe::settingDifferences(kWalk, first, second);
}

std::string probeSettingsText(const ProbeBakeSettings& settings) {
    std::string text;
    const auto add = [&](const ProbeSetting& setting, const auto& value) {
        if (setting.id != 0) text += (text.empty() ? "" : ", ") + probe::valueText(setting, value);
    };
    forEachProbeSetting(add, settings);
    return text;
}

namespace probe {

std::vector<probe_layout::Setting> settingEntries(const ProbeBakeSettings& settings) {
    return settingEntries(kWalk, settings);
}

Result<void> readSettingEntries(std::span<const probe_layout::Setting> entries, ProbeBakeSettings& settings) {
    return readSettingEntries(kWalk, entries, settings);
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

// Probe settings: how the light of a probe field was computed. forEachProbeSetting() is the one list of them:
// the bytes of files, content hashes, reports and comparisons are made from it, so that a setting that is
// added there is in all of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pfvox {

inline constexpr std::uint32_t kUnlimitedBounces =
    0xffffffffu;  ///< of ProbeBakeSettings::maxBounces: until a path has no weight

/// Optional ones are unknown where there is nothing: files of PF_PROBE 1.0 do not keep them.
struct ProbeBakeSettings {
    std::uint64_t seed = 0;
    std::uint32_t tracedResolution = 0;  ///< of the maps that were traced, before any reduction
    std::uint32_t minSamples = 0;        ///< paths a texel
    std::uint32_t maxSamples = 0;        ///< equal to minSamples when not adaptive
    std::optional<std::uint32_t>
        maxBounces;                   ///< reflections of a path; kUnlimitedBounces = no limit but roulette
    float noiseTarget = 0.0f;         ///< relative standard error at which a tile stops; 0 = not adaptive
    std::optional<float> noiseFloor;  ///< radiance under which errors are relative to it
    std::optional<std::uint32_t> sampling;  ///< which light paths look for: a LightSampling
    std::optional<bool> stratified;         ///< Sobol points for the first two vertices
    std::optional<bool> relocate;           ///< probes were moved out of solids
    std::optional<std::uint32_t> filter;    ///< revision of the filter that light maps went through; 0 = none
    bool operator==(const ProbeBakeSettings&) const = default;

    bool isAdaptive() const { return noiseTarget > 0.0f; }
};

/// What a setting is called.
struct ProbeSetting {
    std::uint32_t id = 0;     ///< in section BAKE of a file; 0 = it stands in INFO
    std::string_view name;    ///< key in JSON: "maxBounces"
    std::string_view option;  ///< in messages: "--bounces", or words where no option sets it
};
inline constexpr std::uint32_t kBouncesId = 1;  ///< ProbeSetting::id of maxBounces
inline constexpr std::uint32_t kFilterId = 6;   ///< ProbeSetting::id of filter

/// Calls visit(ProbeSetting, value of the first settings, value of the second ...) for each setting.
template <class Visit, class... Settings>
void forEachProbeSetting(const Visit& visit, Settings&... of) {
    visit(ProbeSetting{0, "seed", "--seed"}, of.seed...);
    visit(ProbeSetting{0, "tracedResolution", "traced resolution"}, of.tracedResolution...);
    visit(ProbeSetting{0, "minSamples", "least samples"}, of.minSamples...);
    visit(ProbeSetting{0, "maxSamples", "most samples"}, of.maxSamples...);
    visit(ProbeSetting{0, "noiseTarget", "--noise"}, of.noiseTarget...);
    visit(ProbeSetting{kBouncesId, "maxBounces", "--bounces"}, of.maxBounces...);
    visit(ProbeSetting{2, "noiseFloor", "noise floor"}, of.noiseFloor...);
    visit(ProbeSetting{3, "sampling", "light sampling"}, of.sampling...);
    visit(ProbeSetting{4, "stratified", "stratified points"}, of.stratified...);
    visit(ProbeSetting{5, "relocate", "--relocate"}, of.relocate...);
    visit(ProbeSetting{kFilterId, "filter", "--filter"}, of.filter...);
}

/// A setting of two fields that is not the same, in words: "--bounces 2" and "--bounces 4", or "--bounces
/// unknown".
struct ProbeSettingDifference {
    std::string first;
    std::string second;
};
/// In the order of forEachProbeSetting(); empty = the same settings. Unknown and known are not the same.
std::vector<ProbeSettingDifference> differencesOf(const ProbeBakeSettings& first,
                                                  const ProbeBakeSettings& second);

/// The settings that are not in INFO, in words: "--bounces unlimited, noise floor 0.01, ...".
std::string probeSettingsText(const ProbeBakeSettings& settings);

}  // namespace pfvox

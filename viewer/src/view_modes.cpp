#include "view_modes.hpp"

#include <algorithm>
#include <array>

#include "shared/view.glsl.h"

namespace pfvox::viewer {

namespace {

using enum ViewNeeds;

constexpr std::array kModes{
    ViewEntry{ViewMode::Final, "final", '1', false, "1", "final: all light", Nothing, true},
    ViewEntry{ViewMode::Albedo, "albedo", '2', false, "2", "albedo", Nothing, false},
    ViewEntry{ViewMode::Normals, "normals", '3', false, "3", "normals", Nothing, false},
    ViewEntry{ViewMode::Material, "material", '4', false, "4", "material index", Nothing, false},
    ViewEntry{ViewMode::Depth, "depth", '5', false, "5", "depth in the octree", Nothing, false},
    ViewEntry{ViewMode::Steps, "steps", '6', false, "6", "traversal steps as a heat map", Nothing, false},
    ViewEntry{ViewMode::Lod, "lod", '7', false, "7", "level of detail that was hit", Nothing, false},
    ViewEntry{ViewMode::Indirect, "indirect", '8', false, "8", "indirect light alone", Probes, true},
    ViewEntry{ViewMode::Tiers, "tiers", '9', false, "9", "what gave the indirect light", Probes, false},
    ViewEntry{ViewMode::Field, "field", '0', false, "0", "rays traced through the probes", DepthMaps, false},
    ViewEntry{ViewMode::FieldDifference, "field-difference", '1', true, "Ctrl+1",
              "the same against the octree", DepthMaps, false},
    ViewEntry{ViewMode::AtlasLight, "atlas-light", '2', true, "Ctrl+2", "maps of the probes: light", Probes,
              true},
    ViewEntry{ViewMode::AtlasNormals, "atlas-normals", '3', true, "Ctrl+3", "maps of the probes: normals",
              DepthMaps, false},
    ViewEntry{ViewMode::AtlasDepth, "atlas-depth", '4', true, "Ctrl+4", "maps of the probes: distances",
              DepthMaps, false},
};
static_assert(kModes.size() == kViewModes && shared::kViewModeCount == kViewModes);

constexpr std::array kToneMaps{
    ToneMapEntry{ToneMap::Standard, "standard", "straight, then a shoulder"},
    ToneMapEntry{ToneMap::Linear, "linear", "clamped"},
    ToneMapEntry{ToneMap::Reinhard, "reinhard", "Reinhard, of the luminance"},
    ToneMapEntry{ToneMap::Aces, "aces", "like ACES film"},
    ToneMapEntry{ToneMap::Neutral, "neutral", "Khronos PBR Neutral"},
};

}  // namespace

std::span<const ViewEntry> viewModes() {
    return kModes;
}

const ViewEntry& entryOf(ViewMode mode) {
    return kModes[std::min(static_cast<std::size_t>(mode), kModes.size() - 1)];
}

std::optional<ViewMode> viewModeFrom(std::string_view name) {
    const auto found = std::ranges::find(kModes, name, &ViewEntry::name);
    return found == kModes.end() ? std::nullopt : std::optional(found->mode);
}

std::string_view toString(ViewMode mode) {
    return entryOf(mode).name;
}

bool isAtlas(ViewMode mode) {
    return mode == ViewMode::AtlasLight || mode == ViewMode::AtlasNormals || mode == ViewMode::AtlasDepth;
}

std::span<const ToneMapEntry> toneMaps() {
    return kToneMaps;
}

std::optional<ToneMap> toneMapFrom(std::string_view name) {
    const auto found = std::ranges::find(kToneMaps, name, &ToneMapEntry::name);
    return found == kToneMaps.end() ? std::nullopt : std::optional(found->toneMap);
}

std::string_view toString(ToneMap toneMap) {
    return kToneMaps[std::min(static_cast<std::size_t>(toneMap), kToneMaps.size() - 1)].name;
}

}  // namespace pfvox::viewer

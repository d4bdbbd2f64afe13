// Short ways to import bytes and to look at what came out.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <pfvox/import.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace pfvox::test {

using Bytes = std::vector<std::byte>;

inline Bytes readBytes(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const auto* data = reinterpret_cast<const std::byte*>(text.data());
    return {data, data + text.size()};
}

/// An import and everything that was said on the way.
struct Imported {
    Result<VoxelAsset> result;
    std::vector<Diagnostic> diagnostics;

    bool reported(std::string_view id) const {
        return std::ranges::any_of(diagnostics, [&](const Diagnostic& d) { return d.id == id; });
    }
    std::string errorText() const { return result ? "" : describe(result.error()); }
};

inline Imported importAs(std::span<const std::byte> bytes, const std::string& name,
                         const ImportSettings& settings = {}, const Limits& limits = {}) {
    DiagnosticList diagnostics;
    auto result = importBytes(bytes, name, settings, limits, diagnostics);
    return {std::move(result), diagnostics.entries()};
}

/// Voxels as a sorted set, small models only.
inline std::set<std::array<int, 3>> voxelSet(const VoxelModel& model) {
    std::set<std::array<int, 3>> voxels;
    const VoxelBox box = model.bounds();
    for (int z = box.min.z; z < box.max.z; ++z)
        for (int y = box.min.y; y < box.max.y; ++y)
            for (int x = box.min.x; x < box.max.x; ++x)
                if (model.at({x, y, z})) voxels.insert({x, y, z});
    return voxels;
}

/// The same set moved so that its lower corner is the origin.
inline std::set<std::array<int, 3>> movedToOrigin(const std::set<std::array<int, 3>>& voxels) {
    std::array<int, 3> low{INT32_MAX, INT32_MAX, INT32_MAX};
    for (const auto& v : voxels)
        for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], v[a]);
    std::set<std::array<int, 3>> moved;
    for (const auto& v : voxels) moved.insert({v[0] - low[0], v[1] - low[1], v[2] - low[2]});
    return moved;
}

}  // namespace pfvox::test

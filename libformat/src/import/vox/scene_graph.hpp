// Scene graph: follows the nodes of a VOX file from the root and gives every placement of a model.
//
// Nodes may have several parents, so this is a directed acyclic graph and not a tree; what it expands to is
// counted before anything is expanded.
#pragma once

#include <map>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "import/vox/scene_nodes.hpp"

namespace pfvox::import::vox {

struct SceneGraph {
    std::unordered_map<std::int32_t, Node> nodes;
    std::map<std::int32_t, LayerRecord> layers;

    bool hasShapes() const;
};

/// One placement of a model in the world, still in VOX axes.
struct Placement {
    std::uint32_t model = 0;
    /// Maps points that are measured from the model's pivot, floor(size / 2).
    GridTransform worldFromPivot;
    std::string_view name;      ///< of the nearest named node on the way up
    std::int32_t layerId = -1;  ///< of the nearest transform that has one
    bool hidden = false;        ///< a node or layer on the way is hidden
};

/// Translations beyond this are refused, so that world coordinates stay within int32.
inline constexpr std::int64_t kMaxTranslation = std::int64_t{1} << 30;

/// All placements in depth-first order, children in their listed order, at one animation frame.
/// Errors: BadReference for nodes and models that do not exist, BadStructure for cycles, BadValue for
/// translations beyond kMaxTranslation, LimitExceeded for maxGraphDepth, maxInstances and maxMemoryBytes.
Result<std::vector<Placement>> expandGraph(const SceneGraph& graph, std::uint32_t modelCount, int frame,
                                           const Limits& limits);

}  // namespace pfvox::import::vox

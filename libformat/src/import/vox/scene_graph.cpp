#include "import/vox/scene_graph.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace pfvox::import::vox {

namespace {

constexpr std::int32_t kRootId = 0;

/// What hangs below a node.
struct Extent {
    std::uint64_t instances = 0;
    std::uint32_t height = 0;  ///< nodes on the longest way down, this one included
};

/// Proves that the graph can be expanded within the limits. Every node is looked at once, whatever the number
/// of ways that lead to it.
class GraphChecker {
  public:
    GraphChecker(const SceneGraph& graph, std::uint32_t modelCount, const Limits& limits)
        : graph_(graph), modelCount_(modelCount), limits_(limits) {}

    Result<Extent> check(const Node& node, std::uint32_t depth) {
        if (const auto known = extents_.find(node.id); known != extents_.end()) {
            if (known->second) return *known->second;
            return node.fail(ErrorCode::BadStructure,
                             fmt::format("node {} is its own descendant; the file is damaged", node.id));
        }
        // Before the recursion goes on: this is what bounds the stack.
        if (depth >= limits_.maxGraphDepth) return tooDeep(node);
        extents_.emplace(node.id, std::nullopt);
        PFVOX_TRY(const Extent, extent, checkBelow(node, depth));
        if (extent.height > limits_.maxGraphDepth) return tooDeep(node);
        if (extent.instances > limits_.maxInstances) {
            return node.fail(
                ErrorCode::LimitExceeded,
                fmt::format("the scene graph expands to more than {} instances (limit maxInstances)",
                            limits_.maxInstances));
        }
        extents_[node.id] = extent;
        return extent;
    }

    /// Whether nothing below this node shows a model. The node was checked before.
    bool isBarren(std::int32_t id) const { return extents_.at(id)->instances == 0; }

  private:
    Result<Extent> checkBelow(const Node& node, std::uint32_t depth) {
        Extent extent{.instances = 0, .height = 1};
        for (const ShapeKey& key : node.shapeKeys) {
            if (key.model < 0 || static_cast<std::uint32_t>(key.model) >= modelCount_) {
                return node.fail(ErrorCode::BadReference,
                                 fmt::format("node {}: model {} does not exist, the file has {}", node.id,
                                             key.model, modelCount_));
            }
            extent.instances = 1;
        }
        for (const std::int32_t childId : node.children) {
            const auto child = graph_.nodes.find(childId);
            if (child == graph_.nodes.end()) {
                return node.fail(ErrorCode::BadReference,
                                 fmt::format("child node {} does not exist", childId));
            }
            PFVOX_TRY(const Extent, below, check(child->second, depth + 1));
            extent.instances += below.instances;
            extent.height = std::max(extent.height, below.height + 1);
            if (extent.instances > limits_.maxInstances) break;
        }
        return extent;
    }

    tl::unexpected<Error> tooDeep(const Node& node) const {
        return node.fail(
            ErrorCode::LimitExceeded,
            fmt::format("node {}: the scene graph is nested deeper than {} nodes (limit maxGraphDepth)",
                        node.id, limits_.maxGraphDepth));
    }

    const SceneGraph& graph_;
    const std::uint32_t modelCount_;
    const Limits& limits_;
    std::unordered_map<std::int32_t, std::optional<Extent>>
        extents_;  ///< nothing while a node is on the path
};

/// Expands a checked graph.
class GraphExpander {
  public:
    GraphExpander(const SceneGraph& graph, const GraphChecker& checker, int frame, std::size_t instances)
        : graph_(graph), checker_(checker), frame_(frame) {
        placements_.reserve(instances);
    }

    /// `state` is what the way down to `node` gave; its model is not known yet.
    Result<void> expand(const Node& node, Placement state) {
        if (node.hidden) state.hidden = true;
        if (!node.name.empty()) state.name = node.name;
        if (node.kind == Node::Kind::Shape) {
            if (node.shapeKeys.empty()) return {};
            state.model = static_cast<std::uint32_t>(keyAt(node.shapeKeys, frame_, node.loops).model);
            placements_.push_back(state);
            return {};
        }
        if (node.kind == Node::Kind::Transform) PFVOX_CHECK(applyTransform(node, state));
        for (const std::int32_t child : node.children) {
            if (!checker_.isBarren(child)) PFVOX_CHECK(expand(graph_.nodes.at(child), state));
        }
        return {};
    }

    std::vector<Placement> take() { return std::move(placements_); }

  private:
    Result<void> applyTransform(const Node& node, Placement& state) const {
        const TransformKey& key = keyAt(node.transformKeys, frame_, node.loops);
        state.worldFromPivot = state.worldFromPivot * key.parentFromChild;
        const glm::i64vec3 t = state.worldFromPivot.translation;
        if (std::max({std::abs(t.x), std::abs(t.y), std::abs(t.z)}) > kMaxTranslation) {
            return node.fail(
                ErrorCode::BadValue,
                fmt::format("node {} is moved to {} {} {}; at most {} voxels from the origin are possible",
                            node.id, t.x, t.y, t.z, kMaxTranslation));
        }
        if (const auto layer = graph_.layers.find(node.layerId); layer != graph_.layers.end()) {
            state.layerId = node.layerId;
            if (layer->second.hidden) state.hidden = true;
        }
        return {};
    }

    const SceneGraph& graph_;
    const GraphChecker& checker_;
    const int frame_;
    std::vector<Placement> placements_;
};

}  // namespace

bool SceneGraph::hasShapes() const {
    return std::ranges::any_of(nodes,
                               [](const auto& entry) { return entry.second.kind == Node::Kind::Shape; });
}

Result<std::vector<Placement>> expandGraph(const SceneGraph& graph, std::uint32_t modelCount, int frame,
                                           const Limits& limits) {
    const auto root = graph.nodes.find(kRootId);
    if (root == graph.nodes.end()) {
        return fail(ErrorCode::BadReference,
                    "the scene graph has no root: node 0 does not exist; the file is damaged");
    }
    GraphChecker checker(graph, modelCount, limits);
    PFVOX_TRY(const Extent, extent, checker.check(root->second, 0));
    if (extent.instances * sizeof(Placement) > limits.maxMemoryBytes) {
        return fail(
            ErrorCode::LimitExceeded,
            fmt::format("the {} instances of the scene graph take more than {} bytes (limit maxMemoryBytes)",
                        extent.instances, limits.maxMemoryBytes));
    }
    GraphExpander expander(graph, checker, frame, extent.instances);
    PFVOX_CHECK(expander.expand(root->second, {}));
    return expander.take();
}

}  // namespace pfvox::import::vox

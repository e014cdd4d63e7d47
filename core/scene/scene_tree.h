#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/scene/scene.h"

/// The scene as a tree of groups and parts. Linear in the scene's size times the groups' depth.
namespace nearfit {

/// Some parts and groups of a scene; a group stands for all that it holds, to any depth.
struct SceneNodes {
  std::vector<PartId> parts;
  std::vector<GroupId> groups;
  bool isEmpty() const noexcept { return parts.empty() && groups.empty(); }
  bool operator==(const SceneNodes&) const = default;
};

/// What stands directly in a group, or at the top; in the scene's order.
SceneNodes childrenOf(const Scene& scene, std::optional<GroupId> group);

/// Visits each group after the one that holds it, and after the groups before it in the same one with all
/// that they hold; `depth` counts the groups above.
void visitGroups(const Scene& scene, const std::function<void(const Group& group, std::size_t depth)>& visit);

/// All parts among the nodes and in their groups, each once, in the scene's order. Throws UsageError when the
/// scene does not have one of the nodes; so do the following.
std::vector<PartId> partsOf(const Scene& scene, const SceneNodes& nodes);
/// The groups among the nodes and those in them, the ones that hold others first.
std::vector<GroupId> groupsOf(const Scene& scene, const SceneNodes& nodes);
/// Without what stands in one of the groups anyway; each once, in the scene's order.
SceneNodes outermost(const Scene& scene, const SceneNodes& nodes);
/// The innermost group that holds all of the nodes; none when only the scene does, or there are no nodes.
std::optional<GroupId> commonGroup(const Scene& scene, const SceneNodes& nodes);

}  // namespace nearfit

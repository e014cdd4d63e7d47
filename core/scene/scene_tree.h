#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/scene/scene.h"

/// The scene as a tree of groups and parts. All functions are linear in the scene's size times
/// the groups' depth.
namespace nearfit {

/// Some parts and groups of a scene; a group stands for all its members, to any depth.
struct SceneNodes {
  std::vector<PartId> parts;
  std::vector<GroupId> groups;
  bool isEmpty() const noexcept { return parts.empty() && groups.empty(); }
  bool operator==(const SceneNodes&) const = default;
};

/// Direct members of a group, or of the top level; in scene order.
SceneNodes childrenOf(const Scene& scene, std::optional<GroupId> group);

/// Visits groups depth-first, parents before children, siblings in scene order. `depth` is the
/// number of ancestors.
void visitGroups(const Scene& scene, const std::function<void(const Group& group, std::size_t depth)>& visit);

/// All parts among the nodes and in their groups, to any depth, each once, in scene order. Throws UsageError
/// if a node is not in the scene; so do the functions below.
std::vector<PartId> partsOf(const Scene& scene, const SceneNodes& nodes);
/// All groups among the nodes and in them, to any depth, parents first.
std::vector<GroupId> groupsOf(const Scene& scene, const SceneNodes& nodes);
/// The nodes without those that a listed group contains; each once, in scene order.
SceneNodes outermost(const Scene& scene, const SceneNodes& nodes);
/// The part in whose frame the pose of a group is given: of the moving group Scene::movingPart(), of others the one that
/// would lead it, the first with a geometry in scene order. std::nullopt if the group has no parts.
std::optional<PartId> leadOfGroup(const Scene& scene, GroupId group);
/// Innermost group that contains all nodes; std::nullopt if there is none or `nodes` is empty.
std::optional<GroupId> commonGroup(const Scene& scene, const SceneNodes& nodes);

}  // namespace nearfit

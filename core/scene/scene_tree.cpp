#include "core/scene/scene_tree.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/base/error.h"

namespace nearfit {
namespace {

/// A set of nodes with fast look-up.
class NodeSet {
 public:
  NodeSet(const Scene& scene, const SceneNodes& nodes)
      : scene_(scene),
        parts_(nodes.parts.begin(), nodes.parts.end()),
        groups_(nodes.groups.begin(), nodes.groups.end()) {
    const auto fail = [](const char* kind, auto id) {
      throw UsageError(fmt::format("{} {}", kind, static_cast<std::uint32_t>(id)),
                       fmt::format("the scene has no such {}", kind), "choose one that is in the scene");
    };
    for (const PartId part : parts_)
      if (scene.find(part) == nullptr) fail("part", part);
    for (const GroupId group : groups_)
      if (scene.findGroup(group) == nullptr) fail("group", group);
  }

  bool has(PartId part) const { return parts_.contains(part); }
  bool has(GroupId group) const { return groups_.contains(group); }
  /// True if the group or one of its ancestors is among the nodes.
  bool holds(std::optional<GroupId> group) const {
    while (group && !groups_.contains(*group))
      group = scene_.findGroup(*group)->parent;
    return group.has_value();
  }

 private:
  const Scene& scene_;
  std::set<PartId> parts_;
  std::set<GroupId> groups_;
};

/// Groups from the top level down to `group`, inclusive.
std::vector<GroupId> pathTo(const Scene& scene, std::optional<GroupId> group) {
  std::vector<GroupId> path;
  for (; group; group = scene.findGroup(*group)->parent)
    path.push_back(*group);
  std::ranges::reverse(path);
  return path;
}

}  // namespace

SceneNodes childrenOf(const Scene& scene, std::optional<GroupId> group) {
  SceneNodes children;
  for (const Scene::GroupPtr& other : scene.groups()) {
    if (other->parent == group) children.groups.push_back(other->id);
  }
  for (const Scene::PartPtr& part : scene.parts()) {
    if (part->group == group) children.parts.push_back(part->id);
  }
  return children;
}

void visitGroups(const Scene& scene, const std::function<void(const Group&, std::size_t)>& visit) {
  std::map<std::optional<GroupId>, std::vector<const Group*>> children;
  for (const Scene::GroupPtr& group : scene.groups())
    children[group->parent].push_back(group.get());
  // Recursion depth is at most kMaxGroupDepth.
  const std::function<void(std::optional<GroupId>, std::size_t)> descend = [&](auto parent,
                                                                               std::size_t depth) {
    for (const Group* group : children[parent]) {
      visit(*group, depth);
      descend(group->id, depth + 1);
    }
  };
  descend(std::nullopt, 0);
}

std::vector<PartId> partsOf(const Scene& scene, const SceneNodes& nodes) {
  const NodeSet set(scene, nodes);
  std::vector<PartId> parts;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (set.has(part->id) || set.holds(part->group)) parts.push_back(part->id);
  }
  return parts;
}

std::vector<GroupId> groupsOf(const Scene& scene, const SceneNodes& nodes) {
  const NodeSet set(scene, nodes);
  std::vector<GroupId> groups;
  visitGroups(scene, [&](const Group& group, std::size_t) {
    if (set.holds(group.id)) groups.push_back(group.id);
  });
  return groups;
}

SceneNodes outermost(const Scene& scene, const SceneNodes& nodes) {
  const NodeSet set(scene, nodes);
  SceneNodes result;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (set.has(part->id) && !set.holds(part->group)) result.parts.push_back(part->id);
  }
  for (const Scene::GroupPtr& group : scene.groups()) {
    if (set.has(group->id) && !set.holds(group->parent)) result.groups.push_back(group->id);
  }
  return result;
}

std::optional<PartId> leadOfGroup(const Scene& scene, GroupId group) {
  if (scene.movingGroup() == group) return scene.movingPart();
  const std::vector<PartId> parts = partsOf(scene, {{}, {group}});
  if (parts.empty()) return std::nullopt;
  const auto withGeometry =
      std::ranges::find_if(parts, [&](PartId part) { return scene.get(part).geometry != nullptr; });
  return withGeometry != parts.end() ? *withGeometry : parts.front();
}

std::optional<GroupId> commonGroup(const Scene& scene, const SceneNodes& nodes) {
  const SceneNodes outer = outermost(scene, nodes);
  std::optional<std::vector<GroupId>> common;
  const auto meet = [&](std::optional<GroupId> group) {
    const std::vector<GroupId> path = pathTo(scene, group);
    if (!common) common = path;
    common->erase(std::ranges::mismatch(*common, path).in1, common->end());
  };
  for (const PartId part : outer.parts)
    meet(scene.find(part)->group);
  for (const GroupId group : outer.groups)
    meet(scene.findGroup(group)->parent);
  return common && !common->empty() ? std::optional(common->back()) : std::nullopt;
}

}  // namespace nearfit

// Commands about groups, and about parts and groups alike.
#include <algorithm>
#include <map>
#include <ranges>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/names.h"
#include "core/session/session.h"
#include "core/session/session_labels.h"

namespace nearfit {
namespace {

TakenNames groupNamesOf(const Scene& scene) {
  TakenNames names(kMaxGroupNameBytes);
  for (const Scene::GroupPtr& group : scene.groups())
    names.add(group->name);
  return names;
}

/// The group, or its nearest ancestor that is not locked.
std::optional<GroupId> openPlace(const Scene& scene, std::optional<GroupId> group) {
  while (group && scene.isLocked(*scene.findGroup(*group)))
    group = scene.findGroup(*group)->parent;
  return group;
}

/// Copies nodes within a scene.
class Copier {
 public:
  Copier(Scene& scene, const SceneNodes& outer) : scene_(scene), outer_(outer) {}

  SceneNodes copy() {
    const Scene before = scene_;
    TakenNames names = groupNamesOf(before);
    for (const GroupId id : groupsOf(before, outer_)) {
      Group group = *before.findGroup(id);
      const auto parent = group.parent ? copyOf_.find(*group.parent) : copyOf_.end();
      const bool isOuter = parent == copyOf_.end();
      if (isOuter) group.name = names.takeFree(group.name);
      group.parent = isOuter ? openPlace(before, group.parent) : parent->second;
      group.isLocked = false;
      copyOf_[id] = scene_.addGroup(group);
      if (isOuter) copies_.groups.push_back(copyOf_[id]);
    }
    copyParts(partsOf(before, outer_));
    return copies_;
  }

 private:
  void copyParts(const std::vector<PartId>& parts) {
    std::vector<Part> copies;
    std::vector<bool> areOuter;
    for (const PartId id : parts) {
      Part& part = copies.emplace_back(*scene_.find(id));
      const auto group = part.group ? copyOf_.find(*part.group) : copyOf_.end();
      areOuter.push_back(group == copyOf_.end());
      part.group = areOuter.back() ? openPlace(scene_, part.group) : group->second;
      part.isLocked = false;
      part.wasVisible.reset();
      if (parts.size() == 1) part.colour = scene_.nextColour();
    }
    const std::vector<PartId> ids = scene_.addAll(std::move(copies));
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (areOuter[i]) copies_.parts.push_back(ids[i]);
    }
  }

  Scene& scene_;
  const SceneNodes& outer_;
  std::map<GroupId, GroupId> copyOf_;
  SceneNodes copies_;
};

void putInto(Scene& scene, const SceneNodes& outer, std::optional<GroupId> target) {
  for (const GroupId id : outer.groups) {
    Group group = *scene.findGroup(id);
    if (std::exchange(group.parent, target) != target) scene.replaceGroup(std::move(group));
  }
  for (const PartId id : outer.parts) {
    Part part = *scene.find(id);
    if (std::exchange(part.group, target) != target) scene.replace(std::move(part));
  }
}

/// True if a group is the moving one, or in it; one without parts cannot be locked there either.
bool isInMovingGroup(const Scene& scene, std::optional<GroupId> group) {
  while (group && group != scene.movingGroup())
    group = scene.findGroup(*group)->parent;
  return group.has_value();
}

}  // namespace

void Session::setLocked(const SceneNodes& nodes, bool locked) {
  Scene next = scene();
  SceneNodes changed;
  // Throws if a node does not exist.
  const std::vector<PartId> parts = partsOf(scene(), nodes);
  const std::vector<GroupId> groups = groupsOf(scene(), nodes);
  const bool isMoving =
      std::ranges::any_of(parts, [&](PartId part) { return next.isMoving(part); }) ||
      std::ranges::any_of(groups, [&](GroupId group) { return isInMovingGroup(next, group); });
  if (locked && isMoving) next.setMovingPart(std::nullopt);
  for (const GroupId id : nodes.groups) {
    Group group = *next.findGroup(id);
    if (std::exchange(group.isLocked, locked) == locked) continue;
    next.replaceGroup(std::move(group));
    changed.groups.push_back(id);
  }
  for (const PartId id : nodes.parts) {
    Part part = *next.find(id);
    if (std::exchange(part.isLocked, locked) == locked) continue;
    next.replace(std::move(part));
    changed.parts.push_back(id);
  }
  if (changed.isEmpty()) return;
  commit(std::move(next), (locked ? "Lock " : "Unlock ") + nameOf(scene(), changed),
         steps::SetLocked{nodes, locked});
}

void Session::renameGroup(GroupId id, const std::string& name) {
  outermost(scene(), {{}, {id}});
  Group group = *scene().findGroup(id);
  scene().requireUnlocked(group);
  if (group.name == name) return;
  const std::string label = fmt::format("Rename {} to {}", group.name, name);
  group.name = name;
  Scene next = scene();
  next.replaceGroup(std::move(group));
  commit(std::move(next), label, steps::RenameGroup{id, name});
}

void Session::deleteNodes(const SceneNodes& nodes) {
  if (nodes.isEmpty()) return;
  Scene next = scene();
  for (const PartId id : partsOf(scene(), nodes))
    next.remove(id);
  for (const GroupId id : groupsOf(scene(), nodes) | std::views::reverse)
    next.removeGroup(id);
  commit(std::move(next), "Delete " + nameOf(scene(), nodes), steps::DeleteNodes{nodes});
}

SceneNodes Session::duplicate(const SceneNodes& nodes) {
  const SceneNodes outer = outermost(scene(), nodes);
  if (outer.isEmpty()) return {};
  Scene next = scene();
  SceneNodes copies = Copier(next, outer).copy();
  commit(std::move(next), "Duplicate " + nameOf(scene(), outer), steps::Duplicate{nodes});
  return copies;
}

GroupId Session::group(const SceneNodes& nodes, const std::string& name) {
  const SceneNodes outer = outermost(scene(), nodes);
  Scene next = scene();
  Group group;
  group.name = groupNamesOf(next).takeFree(name);
  group.parent = commonGroup(next, outer);
  const GroupId id = next.addGroup(std::move(group));
  putInto(next, outer, id);
  commit(std::move(next), "Group " + (outer.isEmpty() ? std::string("(empty)") : nameOf(scene(), outer)),
         steps::GroupNodes{nodes, name});
  return id;
}

void Session::ungroup(const std::vector<GroupId>& ids) {
  if (ids.empty()) return;
  const std::string label = "Ungroup " + nameOf(scene(), {{}, ids});
  Scene next = scene();
  for (const GroupId id : ids) {
    const Group* group = next.findGroup(id);
    if (group == nullptr) continue;  // Listed twice.
    next.requireUnlocked(*group);
    putInto(next, childrenOf(next, id), group->parent);
    next.removeGroup(id);
  }
  commit(std::move(next), label, steps::Ungroup{ids});
}

void Session::regroup(const SceneNodes& nodes, std::optional<GroupId> target) {
  const SceneNodes outer = outermost(scene(), nodes);
  SceneNodes moving;
  for (const PartId id : outer.parts)
    if (scene().find(id)->group != target) moving.parts.push_back(id);
  for (const GroupId id : outer.groups)
    if (scene().findGroup(id)->parent != target) moving.groups.push_back(id);
  if (moving.isEmpty()) return;
  Scene next = scene();
  putInto(next, moving, target);
  const std::string where = target ? "into " + next.findGroup(*target)->name : "to the top level";
  commit(std::move(next), fmt::format("Move {} {}", nameOf(scene(), moving), where),
         steps::Regroup{nodes, target});
}

}  // namespace nearfit

// Groups of a scene, what they lock, and isolation.
#include <algorithm>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/moving_body.h"
#include "core/scene/scene.h"

namespace nearfit {
namespace {

std::string quoted(const Group& group) {
  return fmt::format("group \"{}\"", group.name);
}

}  // namespace

const Group* Scene::findGroup(GroupId id) const noexcept {
  const auto it = std::ranges::lower_bound(groups_, id, {}, &Group::id);
  return it == groups_.end() || (*it)->id != id ? nullptr : it->get();
}

std::size_t Scene::indexOf(GroupId id) const {
  const auto it = std::ranges::lower_bound(groups_, id, {}, &Group::id);
  if (it == groups_.end() || (*it)->id != id) {
    throw UsageError(fmt::format("group {}", static_cast<std::uint32_t>(id)), "the scene has no such group",
                     "choose one that is in the scene");
  }
  return static_cast<std::size_t>(it - groups_.begin());
}

const Group* Scene::lockAt(std::optional<GroupId> group) const noexcept {
  for (const Group* g = group ? findGroup(*group) : nullptr; g != nullptr;
       g = g->parent ? findGroup(*g->parent) : nullptr) {
    if (g->isLocked) return g;
  }
  return nullptr;
}

std::size_t Scene::depthOf(std::optional<GroupId> group) const noexcept {
  std::size_t depth = 0;
  for (; group; ++depth)
    group = findGroup(*group)->parent;
  return depth;
}

bool Scene::isWithin(std::optional<GroupId> group, GroupId ancestor) const noexcept {
  while (group && *group != ancestor)
    group = findGroup(*group)->parent;
  return group.has_value();
}

void Scene::requireOpen(std::optional<GroupId> group) const {
  if (!group) return;
  indexOf(*group);
  if (const Group* lock = lockAt(group))
    throw UsageError(quoted(*lock), "it is locked: nothing can be added or taken out", "unlock it first");
}

void Scene::checkPlace(const Group& group) const {
  requireOpen(group.parent);
  std::size_t below = 1;
  const bool isNew = findGroup(group.id) == nullptr;
  const std::size_t depth = isNew ? 0 : depthOf(group.id);
  for (std::size_t i = 0; !isNew && i < groups_.size(); ++i) {
    const GroupId other = groups_[i]->id;
    if (isWithin(other, group.id)) below = std::max(below, 1 + depthOf(other) - depth);
  }
  if (depthOf(group.parent) + below <= kMaxGroupDepth) return;
  throw UsageError(quoted(group), fmt::format("groups would be nested more than {} deep", kMaxGroupDepth),
                   "move it to a higher level");
}

GroupId Scene::addGroup(Group group) {
  checkGroupName(group.name);
  group.id = GroupId{nextGroupId_};
  checkPlace(group);
  if (groups_.size() >= kMaxGroups) {
    throw UsageError(quoted(group), fmt::format("the scene has {} groups already", kMaxGroups),
                     "delete some first");
  }
  groups_.push_back(std::make_shared<const Group>(std::move(group)));
  return GroupId{nextGroupId_++};
}

std::vector<GroupId> Scene::addGroups(std::vector<Group> added,
                                      const std::vector<std::optional<std::size_t>>& parents) {
  for (std::size_t i = 0; i < added.size(); ++i) {
    checkGroupName(added[i].name);
    if (groups_.size() + i >= kMaxGroups) {
      throw UsageError(quoted(added[i]), fmt::format("the scene has {} groups already", kMaxGroups),
                       "delete some first");
    }
    std::size_t depth = 0;
    for (std::optional<std::size_t> at = i; at; at = parents[*at]) {
      // One that contains itself is nested without end.
      if (++depth > kMaxGroupDepth) {
        throw UsageError(quoted(added[i]),
                         fmt::format("groups would be nested more than {} deep", kMaxGroupDepth),
                         "move it to a higher level");
      }
    }
  }
  std::vector<GroupId> ids;
  for (std::size_t i = 0; i < added.size(); ++i)
    ids.push_back(GroupId{nextGroupId_++});
  for (std::size_t i = 0; i < added.size(); ++i) {
    added[i].id = ids[i];
    added[i].parent = parents[i] ? std::optional(ids[*parents[i]]) : std::nullopt;
    groups_.push_back(std::make_shared<const Group>(std::move(added[i])));
  }
  return ids;
}

void Scene::replaceGroup(Group group) {
  const std::size_t index = indexOf(group.id);
  const Group& before = *groups_[index];
  checkGroupName(group.name);
  Group withLock = before;
  withLock.isLocked = group.isLocked;
  if (group != withLock) requireUnlocked(before);
  if (group.parent != before.parent) {
    if (group.parent) indexOf(*group.parent);
    if (isWithin(group.parent, group.id))
      throw UsageError(quoted(before), "a group cannot contain itself", "put it into another group");
    checkPlace(group);
  }
  if (group.isLocked) requireNotMoving(group);
  groups_[index] = std::make_shared<const Group>(std::move(group));
  keepLead();
}

void Scene::removeGroup(GroupId id) {
  const std::size_t index = indexOf(id);
  requireUnlocked(*groups_[index]);
  const bool isEmpty = std::ranges::none_of(groups_, [id](const auto& g) { return g->parent == id; }) &&
                       std::ranges::none_of(parts_, [id](const auto& p) { return p->group == id; });
  if (!isEmpty) throw UsageError(quoted(*groups_[index]), "it is not empty", "empty it first");
  groups_.erase(groups_.begin() + static_cast<std::ptrdiff_t>(index));
}

void Scene::requireNotMoving(const Group& group) const {
  constexpr const char* kRemedy = "choose another moving part, or none, first";
  if (movingGroup_) {
    const bool isInside = group.id == *movingGroup_ || isWithin(group.parent, *movingGroup_);
    if (!isInside && !isWithin(movingGroup_, group.id)) return;
    throw UsageError(quoted(group),
                     fmt::format("{} is in hand and cannot be locked", quoted(*findGroup(*movingGroup_))),
                     kRemedy);
  }
  const Part* moving = movingPart_ ? find(*movingPart_) : nullptr;
  if (moving == nullptr || !isWithin(moving->group, group.id)) return;
  throw UsageError(quoted(group),
                   fmt::format("it contains the moving part \"{}\", which cannot be locked", moving->name),
                   kRemedy);
}

void Scene::setMovingGroup(GroupId id) {
  requireUnlocked(*groups_[indexOf(id)]);
  for (const GroupPtr& group : groups_) {
    if (isWithin(group->id, id)) requireUnlocked(*group);
  }
  const Part* lead = nullptr;
  for (const PartPtr& part : parts_) {
    if (!isWithin(part->group, id)) continue;
    requireUnlocked(*part);
    if (lead == nullptr || (lead->geometry == nullptr && part->geometry != nullptr)) lead = part.get();
  }
  if (lead == nullptr)
    throw UsageError(quoted(*findGroup(id)), "it has no parts that could be moved",
                     "put parts into it first");
  movingPart_ = lead->id;
  movingGroup_ = id;
  if (groupBodies_ == nullptr) groupBodies_ = std::make_shared<GroupBodies>();
}

void Scene::keepLead() noexcept {
  if (!movingGroup_) return;
  const Part* lead = movingPart_ ? find(*movingPart_) : nullptr;
  if (lead != nullptr && isWithin(lead->group, *movingGroup_)) return;
  movingPart_.reset();
  for (const PartPtr& part : parts_) {
    if (!isWithin(part->group, *movingGroup_)) continue;
    movingPart_ = part->id;
    return;
  }
  movingGroup_.reset();
}

bool Scene::isLocked(const Part& part) const noexcept {
  return part.isLocked || lockAt(part.group) != nullptr;
}

bool Scene::isLocked(const Group& group) const noexcept {
  return group.isLocked || lockAt(group.parent) != nullptr;
}

void Scene::requireUnlocked(const Part& part) const {
  const std::string what = fmt::format("part \"{}\"", part.name);
  if (part.isLocked) throw UsageError(what, "it is locked", "unlock it first");
  if (const Group* lock = lockAt(part.group))
    throw UsageError(what, fmt::format("its {} is locked", quoted(*lock)), "unlock that first");
}

void Scene::requireUnlocked(const Group& group) const {
  if (group.isLocked) throw UsageError(quoted(group), "it is locked", "unlock it first");
  if (const Group* lock = lockAt(group.parent))
    throw UsageError(quoted(group), fmt::format("its {} is locked", quoted(*lock)), "unlock that first");
}

void Scene::isolate(const std::vector<PartId>& parts) {
  if (parts.empty()) throw UsageError("isolation", "no part is given", "select the parts to show");
  std::unordered_set<PartId> shown;
  for (const PartId id : parts)
    shown.insert(parts_[indexOf(id)]->id);
  for (PartPtr& part : parts_) {
    Part next = *part;
    next.wasVisible = part->wasVisible.value_or(part->isVisible);
    next.isVisible = shown.contains(part->id);
    part = std::make_shared<const Part>(std::move(next));
  }
}

void Scene::endIsolation() {
  for (PartPtr& part : parts_) {
    if (!part->wasVisible) continue;
    Part next = *part;
    next.isVisible = *std::exchange(next.wasVisible, std::nullopt);
    part = std::make_shared<const Part>(std::move(next));
  }
}

bool Scene::isIsolated() const noexcept {
  return std::ranges::any_of(parts_, [](const PartPtr& part) { return part->wasVisible.has_value(); });
}

}  // namespace nearfit

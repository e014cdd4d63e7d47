#include "ui/model/selection.h"

#include <algorithm>
#include <ranges>
#include <unordered_set>
#include <utility>

namespace nearfit::ui {

Selection::Selection(Session& session, QObject* parent)
    : QObject(parent), session_(session), sceneSerial_(session.sceneSerial()) {
  changes_ = session_.onChange(SceneEvents::Stage::Model, [this] {
    // In another scene the same ids mean other parts.
    const bool isSameScene = std::exchange(sceneSerial_, session_.sceneSerial()) == session_.sceneSerial();
    isSameScene ? set(parts_, groups_) : set({});
  });
}

std::optional<PartId> Selection::current() const noexcept {
  return parts_.empty() ? std::nullopt : std::optional(parts_.back());
}

bool Selection::contains(PartId part) const noexcept {
  return std::ranges::find(parts_, part) != parts_.end();
}

void Selection::set(const std::vector<PartId>& parts, const std::vector<GroupId>& groups) {
  std::unordered_set<PartId> left;
  for (const Scene::PartPtr& part : session_.scene().parts())
    left.insert(part->id);
  // A duplicate keeps its last place, which may make it the current part.
  std::vector<PartId> next;
  for (const PartId part : std::views::reverse(parts)) {
    if (left.erase(part) == 1) next.push_back(part);
  }
  std::ranges::reverse(next);
  const std::unordered_set<PartId> chosen(next.begin(), next.end());
  std::vector<GroupId> nextGroups;
  for (const GroupId group : groups) {
    if (session_.scene().findGroup(group) == nullptr || std::ranges::count(nextGroups, group) > 0) continue;
    const bool isWhole = std::ranges::all_of(partsOf(session_.scene(), {{}, {group}}),
                                             [&](PartId part) { return chosen.contains(part); });
    if (isWhole) nextGroups.push_back(group);
  }
  if (next == parts_ && nextGroups == groups_) return;
  parts_ = std::move(next);
  groups_ = std::move(nextGroups);
  emit changed();
}

void Selection::select(std::optional<PartId> part) {
  set(part ? std::vector{*part} : std::vector<PartId>{});
}

void Selection::add(PartId part) {
  std::vector<PartId> next = parts_;
  next.push_back(part);
  set(next, groups_);
}

void Selection::toggle(PartId part) {
  if (!contains(part)) return add(part);
  std::vector<PartId> next = parts_;
  std::erase(next, part);
  set(next, groups_);
}

void Selection::selectAllVisible() {
  std::vector<PartId> next;
  for (const Scene::PartPtr& part : session_.scene().parts()) {
    if (part->isVisible) next.push_back(part->id);
  }
  set(next);
}

}  // namespace nearfit::ui

#include "core/scene/scene.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/haptic_limits.h"

namespace nearfit {
namespace {

void checkValues(const Part& part) {
  checkPartName(part.name);
  checkColour(part.colour);
  checkDensity(part.density);
  checkOpacity(part.opacity);
}

/// Number of parts that have each colour of the palette.
class ColourUses {
 public:
  explicit ColourUses(const std::vector<Scene::PartPtr>& parts) noexcept {
    for (const Scene::PartPtr& part : parts) {
      const auto* const colour = std::ranges::find(kPartPalette, part->colour);
      if (colour != kPartPalette.end()) ++uses_[static_cast<std::size_t>(colour - kPartPalette.begin())];
    }
  }
  /// The colour that the fewest parts have, which one more then has.
  Colour takeNext() noexcept {
    const auto fewest = std::ranges::min_element(uses_);
    ++*fewest;
    return kPartPalette[static_cast<std::size_t>(fewest - uses_.begin())];
  }

 private:
  std::array<std::size_t, kPartPalette.size()> uses_{};
};

}  // namespace

const Part* Scene::find(PartId id) const noexcept {
  const auto it = std::ranges::lower_bound(parts_, id, {}, &Part::id);
  return it == parts_.end() || (*it)->id != id ? nullptr : it->get();
}

const Part& Scene::get(PartId id) const {
  return *parts_[indexOf(id)];
}

const Part* Scene::findByName(std::string_view name) const noexcept {
  const auto it =
      std::find_if(parts_.begin(), parts_.end(), [name](const PartPtr& p) { return p->name == name; });
  return it == parts_.end() ? nullptr : it->get();
}

std::size_t Scene::indexOf(PartId id) const {
  const auto it = std::ranges::lower_bound(parts_, id, {}, &Part::id);
  if (it == parts_.end() || (*it)->id != id) {
    throw UsageError(fmt::format("part {}", static_cast<std::uint32_t>(id)), "the scene has no such part",
                     "choose one that is in the scene");
  }
  return static_cast<std::size_t>(it - parts_.begin());
}

TakenNames Scene::takenNames() const {
  TakenNames names(kMaxPartNameBytes);
  for (const PartPtr& part : parts_)
    names.add(part->name);
  return names;
}

void Scene::makeAddable(Part& part) const {
  checkValues(part);
  requireOpen(part.group);
  if (part.isLocked && movingGroup_ && isWithin(part.group, *movingGroup_)) {
    throw UsageError(fmt::format("part \"{}\"", part.name), "a locked part cannot be in the moving group",
                     "unlock it first");
  }
  part.worldFromPart = checkedPose(part.worldFromPart);
}

PartId Scene::append(Part part) {
  part.id = PartId{nextId_};
  parts_.push_back(std::make_shared<const Part>(std::move(part)));
  return PartId{nextId_++};
}

PartId Scene::add(Part part) {
  makeAddable(part);
  // A set of all names costs a hundred times as much as looking for one.
  if (findByName(part.name) != nullptr) part.name = takenNames().takeFree(part.name);
  return append(std::move(part));
}

std::vector<PartId> Scene::addAll(std::vector<Part> parts) {
  for (Part& part : parts)
    makeAddable(part);
  TakenNames names = takenNames();
  std::vector<PartId> ids;
  ids.reserve(parts.size());
  for (Part& part : parts) {
    part.name = names.takeFree(part.name);
    ids.push_back(append(std::move(part)));
  }
  return ids;
}

void Scene::replace(Part part) {
  const std::size_t index = indexOf(part.id);
  const Part& before = *parts_[index];
  checkValues(part);
  part.worldFromPart = checkedPose(part.worldFromPart);
  // A changed file may replace the geometry of a locked part.
  Part reloaded = before;
  reloaded.geometry = part.geometry;
  if (!differsOnlyInLookOrLock(reloaded, part)) requireUnlocked(before);
  if (part.group != before.group) requireOpen(part.group);
  const Part* namesake = part.name != before.name ? findByName(part.name) : nullptr;
  if (namesake != nullptr && namesake->id != part.id) {
    throw UsageError(fmt::format("part \"{}\"", before.name),
                     fmt::format("\"{}\" is the name of another part", part.name), "choose another name");
  }
  const bool willMove = movingGroup_ ? isWithin(part.group, *movingGroup_) : movingPart_ == part.id;
  if (part.isLocked && willMove) {
    throw UsageError(fmt::format("part \"{}\"", part.name),
                     movingGroup_ ? "it is in the moving group and cannot be locked"
                                  : "it is the moving part and cannot be locked",
                     "choose another moving part, or none, first");
  }
  if (part.name != before.name) renameInRules(before.name, part.name);
  parts_[index] = std::make_shared<const Part>(std::move(part));
  keepLead();
}

void Scene::remove(PartId id) {
  const std::size_t index = indexOf(id);
  requireUnlocked(*parts_[index]);
  parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(index));
  if (movingPart_ == id) movingPart_.reset();
  keepLead();
  std::erase_if(joints_, [id](const Joint& joint) { return joint.part == id || joint.base == id; });
  dropRecordsOf(id);
}

void Scene::setMovingPart(std::optional<PartId> id) {
  if (id) requireUnlocked(*parts_[indexOf(*id)]);
  movingPart_ = id;
  movingGroup_.reset();
}

bool Scene::isMoving(PartId id) const noexcept {
  if (!movingGroup_) return movingPart_ == id;
  const Part* part = find(id);
  return part != nullptr && isWithin(part->group, *movingGroup_);
}

std::vector<PartId> Scene::movingParts() const {
  if (!movingGroup_) return movingPart_ ? std::vector{*movingPart_} : std::vector<PartId>();
  std::vector<PartId> parts;
  for (const PartPtr& part : parts_) {
    if (isWithin(part->group, *movingGroup_)) parts.push_back(part->id);
  }
  return parts;
}

void Scene::setHaptics(const HapticSettings& haptics) {
  checkHaptics(haptics);
  haptics_ = haptics;
  haptics_.mapping.orientationOffset = checkedPose({haptics.mapping.orientationOffset, {}}).rotation;
}

std::vector<PartGeometryPtr> Scene::geometries() const {
  std::vector<PartGeometryPtr> geometries;
  for (const PartPtr& part : parts_) {
    if (part->geometry != nullptr) geometries.push_back(part->geometry);
  }
  return geometries;
}

Colour Scene::nextColour() const noexcept {
  return ColourUses(parts_).takeNext();
}

std::vector<Colour> Scene::nextColours(std::size_t count) const {
  ColourUses uses(parts_);
  std::vector<Colour> colours(count);
  for (Colour& colour : colours)
    colour = uses.takeNext();
  return colours;
}

void Scene::retireIdsOf(const Scene& other) noexcept {
  nextId_ = std::max(nextId_, other.nextId_);
  nextGroupId_ = std::max(nextGroupId_, other.nextGroupId_);
  nextJointId_ = std::max(nextJointId_, other.nextJointId_);
}

}  // namespace nearfit

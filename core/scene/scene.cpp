#include "core/scene/scene.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/haptic_limits.h"
#include "core/scene/names.h"

namespace nearfit {
namespace {

void checkValues(const Part& part) {
  checkPartName(part.name);
  checkColour(part.colour);
  checkDensity(part.density);
  checkOpacity(part.opacity);
}

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

PartId Scene::add(Part part) {
  checkValues(part);
  requireOpen(part.group);
  part.worldFromPart = checkedPose(part.worldFromPart);
  // A set of all names costs a hundred times as much as looking for one.
  if (findByName(part.name) != nullptr) {
    std::unordered_set<std::string_view> taken;
    for (const PartPtr& other : parts_)
      taken.insert(other->name);
    part.name = freeName(part.name, taken, kMaxPartNameBytes);
  }
  part.id = PartId{nextId_};
  parts_.push_back(std::make_shared<const Part>(std::move(part)));
  return PartId{nextId_++};
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
  if (part.isLocked && movingPart_ == part.id) {
    throw UsageError(fmt::format("part \"{}\"", part.name), "it is the moving part and cannot be locked",
                     "choose another moving part, or none, first");
  }
  parts_[index] = std::make_shared<const Part>(std::move(part));
}

void Scene::remove(PartId id) {
  const std::size_t index = indexOf(id);
  requireUnlocked(*parts_[index]);
  parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(index));
  if (movingPart_ == id) movingPart_.reset();
}

void Scene::setMovingPart(std::optional<PartId> id) {
  if (id) requireUnlocked(*parts_[indexOf(*id)]);
  movingPart_ = id;
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
  const auto uses = [this](const Colour& colour) {
    return std::count_if(parts_.begin(), parts_.end(), [&](const PartPtr& p) { return p->colour == colour; });
  };
  return *std::min_element(kPartPalette.begin(), kPartPalette.end(),
                           [&](const Colour& a, const Colour& b) { return uses(a) < uses(b); });
}

void Scene::retireIdsOf(const Scene& other) noexcept {
  nextId_ = std::max(nextId_, other.nextId_);
  nextGroupId_ = std::max(nextGroupId_, other.nextGroupId_);
}

}  // namespace nearfit

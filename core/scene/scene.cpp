#include "core/scene/scene.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/scene/haptic_limits.h"
#include "core/scene/palette.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

void checkColour(const Colour& colour) {
  for (const float channel : {colour.r, colour.g, colour.b}) {
    if (!(channel >= 0.0F && channel <= 1.0F)) {
      throw UsageError("colour", fmt::format("a channel is {}", channel),
                       "give each of r, g and b from 0 to 1");
    }
  }
}

/// "Peg 12" without its number: "Peg".
std::string withoutNumber(const std::string& name) {
  const std::size_t end = name.find_last_not_of("0123456789");
  if (end == std::string::npos || end + 1 == name.size() || name[end] != ' ' || end == 0) return name;
  return name.substr(0, end);
}

}  // namespace

double massOf(const Part& part) noexcept {
  return part.geometry != nullptr ? part.density * part.geometry->mass.volume : 0.0;
}

void checkDensity(double density) {
  if (density >= kMinDensity && density <= kMaxDensity) return;
  throw UsageError("density", fmt::format("{} kg/m^3 is out of range", density),
                   fmt::format("give a value from {} to {} kg/m^3", kMinDensity, kMaxDensity));
}

void checkPartName(const std::string& name) {
  if (name.empty()) throw UsageError("name", "a part's name is empty", "give it one");
  if (name.size() > kMaxPartNameBytes) {
    throw UsageError("name", fmt::format("a part's name is longer than {} bytes", kMaxPartNameBytes),
                     "shorten it");
  }
  if (!isPrintableUtf8(name)) {
    throw UsageError("name", "a part's name holds control characters or is not UTF-8", "use printable text");
  }
}

RigidTransform checkedPose(const RigidTransform& pose) {
  const glm::dvec3& t = pose.translation;
  for (const double coordinate : {t.x, t.y, t.z}) {
    if (std::isfinite(coordinate) && std::abs(coordinate) <= kMaxPosition) continue;
    throw UsageError("position", fmt::format("a coordinate is {} m", coordinate),
                     fmt::format("stay within {} m of the origin", kMaxPosition));
  }
  const double length = std::sqrt(glm::dot(pose.rotation, pose.rotation));
  if (!(std::abs(length - 1.0) <= kQuaternionSlack)) {
    throw UsageError("quaternion", fmt::format("its length is {}, not 1", length),
                     "give a unit quaternion in the order w, x, y, z");
  }
  // One that is unit up to rounding stays as it is, so that saving and loading changes no digit.
  return std::abs(length - 1.0) <= 1e-15 ? pose : pose.normalized();
}

const Part* Scene::find(PartId id) const noexcept {
  const auto it = std::find_if(parts_.begin(), parts_.end(), [id](const PartPtr& p) { return p->id == id; });
  return it == parts_.end() ? nullptr : it->get();
}

const Part* Scene::findByName(std::string_view name) const noexcept {
  const auto it =
      std::find_if(parts_.begin(), parts_.end(), [name](const PartPtr& p) { return p->name == name; });
  return it == parts_.end() ? nullptr : it->get();
}

std::size_t Scene::indexOf(PartId id) const {
  const auto it = std::find_if(parts_.begin(), parts_.end(), [id](const PartPtr& p) { return p->id == id; });
  if (it == parts_.end()) {
    throw UsageError(fmt::format("part {}", static_cast<std::uint32_t>(id)), "the scene has no such part",
                     "choose one that is in the scene");
  }
  return static_cast<std::size_t>(it - parts_.begin());
}

std::string Scene::freeName(const std::string& wanted) const {
  if (findByName(wanted) == nullptr) return wanted;
  const std::string stem = withoutNumber(wanted);
  for (std::size_t number = 2;; ++number) {
    const std::string suffix = fmt::format(" {}", number);
    std::string name = truncatedUtf8(stem, kMaxPartNameBytes - suffix.size()) + suffix;
    if (findByName(name) == nullptr) return name;
  }
}

PartId Scene::add(Part part) {
  checkPartName(part.name);
  checkColour(part.colour);
  checkDensity(part.density);
  part.worldFromPart = checkedPose(part.worldFromPart);
  part.name = freeName(part.name);
  part.id = PartId{nextId_};
  parts_.push_back(std::make_shared<const Part>(std::move(part)));
  return PartId{nextId_++};
}

void Scene::replace(Part part) {
  const std::size_t index = indexOf(part.id);
  checkPartName(part.name);
  checkColour(part.colour);
  checkDensity(part.density);
  part.worldFromPart = checkedPose(part.worldFromPart);
  const Part* namesake = findByName(part.name);
  if (namesake != nullptr && namesake->id != part.id) {
    throw UsageError(fmt::format("name \"{}\"", part.name), "another part has it", "choose another name");
  }
  if (part.isLocked && movingPart_ == part.id) {
    throw UsageError(fmt::format("part \"{}\"", part.name), "it is the moving part and cannot be locked",
                     "choose another moving part, or none, first");
  }
  parts_[index] = std::make_shared<const Part>(std::move(part));
}

void Scene::remove(PartId id) {
  parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(indexOf(id)));
  if (movingPart_ == id) movingPart_.reset();
}

void Scene::setMovingPart(std::optional<PartId> id) {
  if (id) {
    const Part& part = *parts_[indexOf(*id)];
    if (part.isLocked) {
      throw UsageError(fmt::format("part \"{}\"", part.name), "it is locked and cannot be the moving part",
                       "unlock it first");
    }
  }
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
}

}  // namespace nearfit

#include "core/session.h"

#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/scene/scene_file.h"

namespace nearfit {
namespace {

bool isSame(const RigidTransform& a, const RigidTransform& b) {
  return a.rotation == b.rotation && a.translation == b.translation;
}

const char* labelOfChange(const HapticSettings& from, const HapticSettings& to) {
  if (from.mode != to.mode) return "Change the mode";
  HapticSettings withNewSprings = from;
  withNewSprings.springs = to.springs;
  return withNewSprings == to ? "Change the springs" : "Change how contact feels";
}

}  // namespace

Part Session::existingPart(PartId id) const {
  const Part* part = scene().find(id);
  if (part == nullptr) {
    throw UsageError(fmt::format("part {}", static_cast<std::uint32_t>(id)), "the scene has no such part",
                     "choose one that is in the scene");
  }
  return *part;
}

Part Session::unlockedPart(PartId id) const {
  Part part = existingPart(id);
  if (part.isLocked)
    throw UsageError(fmt::format("part \"{}\"", part.name), "it is locked", "unlock it first");
  return part;
}

void Session::commit(Scene scene, std::string label) {
  past_.push_back(std::exchange(current_, {std::move(scene), std::move(label), nextSerial_++}));
  if (past_.size() > kMaxUndo) past_.pop_front();
  future_.clear();
  notify();
}

void Session::commitReplaced(Part part, std::string label) {
  Scene next = scene();
  next.replace(std::move(part));
  commit(std::move(next), std::move(label));
}

PartId Session::addPart(PartGeometryPtr geometry, const std::string& name,
                        const RigidTransform& worldFromPart) {
  Scene next = scene();
  Part part;
  part.name = name;
  part.geometry = std::move(geometry);
  part.worldFromPart = worldFromPart;
  part.colour = next.nextColour();
  const PartId id = next.add(std::move(part));
  const std::string label = "Add " + next.find(id)->name;
  commit(std::move(next), label);
  return id;
}

PartId Session::duplicatePart(PartId id) {
  Scene next = scene();
  Part part = existingPart(id);
  const std::string label = "Duplicate " + part.name;
  part.isLocked = false;
  part.colour = next.nextColour();
  const PartId copy = next.add(std::move(part));
  commit(std::move(next), label);
  return copy;
}

void Session::deletePart(PartId id) {
  const Part part = unlockedPart(id);
  Scene next = scene();
  next.remove(id);
  commit(std::move(next), "Delete " + part.name);
}

void Session::renamePart(PartId id, const std::string& name) {
  Part part = unlockedPart(id);
  if (part.name == name) return;
  const std::string label = fmt::format("Rename {} to {}", part.name, name);
  part.name = name;
  commitReplaced(std::move(part), label);
}

void Session::movePart(PartId id, const RigidTransform& worldFromPart, const std::string& verb) {
  Part part = unlockedPart(id);
  const RigidTransform pose = checkedPose(worldFromPart);
  if (isSame(part.worldFromPart, pose)) return;
  const std::string label = verb + " " + part.name;
  part.worldFromPart = pose;
  commitReplaced(std::move(part), label);
}

void Session::setColour(PartId id, const Colour& colour) {
  Part part = unlockedPart(id);
  if (part.colour == colour) return;
  const std::string label = "Recolour " + part.name;
  part.colour = colour;
  commitReplaced(std::move(part), label);
}

void Session::setDensity(PartId id, double density) {
  Part part = unlockedPart(id);
  if (part.density == density) return;
  const std::string label = "Change the density of " + part.name;
  part.density = density;
  commitReplaced(std::move(part), label);
}

void Session::setVisible(PartId id, bool visible) {
  Part part = existingPart(id);
  if (part.isVisible == visible) return;
  const std::string label = (visible ? "Show " : "Hide ") + part.name;
  part.isVisible = visible;
  commitReplaced(std::move(part), label);
}

void Session::setLocked(PartId id, bool locked) {
  Part part = existingPart(id);
  if (part.isLocked == locked) return;
  const std::string label = (locked ? "Lock " : "Unlock ") + part.name;
  part.isLocked = locked;
  commitReplaced(std::move(part), label);
}

void Session::setMovingPart(std::optional<PartId> id) {
  if (scene().movingPart() == id) return;
  Scene next = scene();
  next.setMovingPart(id);
  const std::string label =
      id ? fmt::format("Make {} the moving part", next.find(*id)->name) : "Let go of the moving part";
  commit(std::move(next), label);
}

void Session::setHaptics(const HapticSettings& haptics) {
  Scene next = scene();
  next.setHaptics(haptics);
  if (next.haptics() == scene().haptics()) return;
  const char* label = labelOfChange(scene().haptics(), next.haptics());
  commit(std::move(next), label);
}

void Session::reset(Scene scene, const std::filesystem::path& file) {
  current_ = {std::move(scene), {}, nextSerial_++};
  savedSerial_ = current_.serial;
  past_.clear();
  future_.clear();
  file_ = file;
  notify();
}

void Session::save(const std::filesystem::path& file) {
  writeSceneFile(scene(), file);
  file_ = file;
  savedSerial_ = current_.serial;
  notify();
}

void Session::undo() {
  if (past_.empty()) return;
  future_.push_back(std::exchange(current_, std::move(past_.back())));
  past_.pop_back();
  current_.scene.retireIdsOf(future_.back().scene);
  notify();
}

void Session::redo() {
  if (future_.empty()) return;
  past_.push_back(std::exchange(current_, std::move(future_.back())));
  future_.pop_back();
  current_.scene.retireIdsOf(past_.back().scene);
  notify();
}

void Session::onChange(std::function<void()> listener) {
  listeners_.push_back(std::move(listener));
}

void Session::notify() const {
  // Copied: a listener may add another.
  const std::vector<std::function<void()>> listeners = listeners_;
  for (const std::function<void()>& listener : listeners)
    listener();
}

}  // namespace nearfit

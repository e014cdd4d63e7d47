#include "core/session/session.h"

#include <algorithm>
#include <ranges>
#include <utility>

#include <fmt/format.h>

#include "core/scene/scene_file.h"
#include "core/session/session_labels.h"

namespace nearfit {
namespace {

/// Names the one setting that differs; a general label if several do.
const char* labelOfChange(const HapticSettings& from, const HapticSettings& to) {
  using Take = void (*)(HapticSettings&, const HapticSettings&);
  constexpr std::pair<const char*, Take> kChanges[] = {
      {"Feel settings: springs", [](auto& a, const auto& b) { a.springs = b.springs; }},
      {"Feel settings: margin", [](auto& a, const auto& b) { a.proxy.margin = b.proxy.margin; }},
      {"Feel settings: friction", [](auto& a, const auto& b) { a.proxy.friction = b.proxy.friction; }},
      {"Feel settings: coupling", [](auto& a, const auto& b) { a.coupling = b.coupling; }},
      {"Feel settings: weight", [](auto& a, const auto& b) { a.weight = b.weight; }},
      {"Feel settings: scale", [](auto& a, const auto& b) { a.mapping.scale = b.mapping.scale; }},
      {"Feel settings: locked axes",
       [](auto& a, const auto& b) {
         a.mapping.translationLocks = b.mapping.translationLocks;
         a.mapping.rotationLocks = b.mapping.rotationLocks;
       }},
  };
  if (from.mode != to.mode) return "Feel settings: mode";
  for (const auto& [label, take] : kChanges) {
    HapticSettings changed = from;
    take(changed, to);
    if (changed == to) return label;
  }
  return "Feel settings";
}

}  // namespace

void Session::commit(Scene scene, Step step, SessionCommand command) {
  const std::uint64_t serial = nextSerial_++;
  past_.push_back(std::exchange(
      current_, {std::move(scene), std::move(step), serial, serial, std::move(command), false}));
  if (past_.size() > kMaxUndo) past_.pop_front();
  future_.clear();
  events_.notify();
}

PartId Session::addPart(PartGeometryPtr geometry, const std::string& name,
                        const RigidTransform& worldFromPart) {
  return addNodes({{}, {{std::move(geometry), name, worldFromPart, {}, {}}}}).parts.front();
}

std::vector<PartId> Session::addParts(const std::vector<NewPart>& parts) {
  // Each gets a colour of its own, those that share a geometry too.
  const std::vector<Colour> colours = scene().nextColours(parts.size());
  NewNodes nodes;
  nodes.parts.reserve(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i)
    nodes.parts.push_back({parts[i].geometry, parts[i].name, {}, colours[i], {}});
  return addNodes(nodes).parts;
}

SceneNodes Session::addNodes(const NewNodes& nodes) {
  if (nodes.parts.empty() && nodes.groups.empty()) return {};
  Scene next = scene();
  const SceneNodes added = addTo(next, nodes);
  const std::string label = "Add " + nameOf(next, added);
  commit(std::move(next), label, steps::AddNodes{nodes});
  return added;
}

void Session::setMovingPart(std::optional<PartId> id) {
  if (scene().movingPart() == id && !scene().movingGroup()) return;
  Scene next = scene();
  next.setMovingPart(id);
  const std::string label =
      id ? fmt::format("Make {} the moving part", next.find(*id)->name) : "Clear the moving part";
  commit(std::move(next), label, steps::SetMovingPart{id});
}

void Session::setMovingGroup(GroupId id) {
  if (scene().movingGroup() == id) return;
  Scene next = scene();
  next.setMovingGroup(id);
  const std::string label = fmt::format("Make {} the moving group", next.findGroup(id)->name);
  commit(std::move(next), label, steps::SetMovingGroup{id});
}

void Session::moveMoving(const RigidTransform& worldFromPart, const std::string& verb) {
  if (scene().movingPart()) moveParts(scene().movingParts(), *scene().movingPart(), worldFromPart, verb);
}

void Session::setHaptics(const HapticSettings& haptics, const std::string& label) {
  Scene next = scene();
  next.setHaptics(haptics);
  if (next.haptics() == scene().haptics()) return;
  const std::string change = label.empty() ? labelOfChange(scene().haptics(), next.haptics()) : label;
  commit(std::move(next), change, steps::SetHaptics{haptics, label});
}

void Session::begin(Scene scene, const std::filesystem::path& file) {
  const std::uint64_t serial = nextSerial_++;
  current_ = {std::move(scene), {}, serial, serial, {}, false};
  past_.clear();
  future_.clear();
  file_ = file;
  ++sceneSerial_;
}

void Session::reset(Scene scene, const std::filesystem::path& file) {
  begin(std::move(scene), file);
  savedSerial_ = current_.serial;
  events_.notify();
}

void Session::restore(Scene scene, const std::filesystem::path& file) {
  begin(std::move(scene), file);
  savedSerial_ = nextSerial_++;  // Matches no state.
  events_.notify();
}

void Session::save(const std::filesystem::path& file) {
  writeSceneFile(scene(), file);
  file_ = file;
  savedSerial_ = current_.serial;
  events_.notify();
}

void Session::stepBack() {
  future_.push_back(std::exchange(current_, std::move(past_.back())));
  past_.pop_back();
  current_.scene.retireIdsOf(future_.back().scene);
}

void Session::stepOn() {
  past_.push_back(std::exchange(current_, std::move(future_.back())));
  future_.pop_back();
  current_.scene.retireIdsOf(past_.back().scene);
}

void Session::undo() {
  if (past_.empty()) return;
  stepBack();
  events_.notify();
}

void Session::redo() {
  if (future_.empty()) return;
  stepOn();
  events_.notify();
}

std::vector<Session::Step> Session::history() const {
  std::vector<Step> steps;
  steps.reserve(past_.size() + 1 + future_.size());
  for (const State& state : past_)
    steps.push_back(state.step);
  steps.push_back(current_.step);
  for (const State& state : std::views::reverse(future_))
    steps.push_back(state.step);
  return steps;
}

Session::Reached Session::reached(std::size_t index) const {
  const State& state = index < past_.size() ? past_[index] : current_;
  return {state.stepSerial, state.serial, state.scene, state.command ? &*state.command : nullptr,
          state.restatesRecords};
}

void Session::goTo(std::size_t index) {
  if (index == past_.size() || index > past_.size() + future_.size()) return;
  while (past_.size() > index)
    stepBack();
  while (past_.size() < index)
    stepOn();
  events_.notify();
}

std::size_t Session::changesSinceSave() const noexcept {
  const auto isSaved = [this](const State& state) { return state.serial == savedSerial_; };
  if (isSaved(current_)) return 0;
  const auto before = std::find_if(past_.rbegin(), past_.rend(), isSaved);
  if (before != past_.rend()) return static_cast<std::size_t>(before - past_.rbegin()) + 1;
  const auto after = std::find_if(future_.rbegin(), future_.rend(), isSaved);
  if (after != future_.rend()) return static_cast<std::size_t>(after - future_.rbegin()) + 1;
  return past_.size() + 1;
}

}  // namespace nearfit

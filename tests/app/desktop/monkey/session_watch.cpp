#include "tests/app/desktop/monkey/session_watch.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/haptics/haptic_settings.h"
#include "ui/model/selection.h"
#include "ui/widgets/paths.h"

namespace nearfit::test {
namespace {

std::string textOf(const RigidTransform& pose) {
  const glm::dquat& q = pose.rotation;
  const glm::dvec3& t = pose.translation;
  return fmt::format("{:a} {:a} {:a} {:a} {:a} {:a} {:a}", q.w, q.x, q.y, q.z, t.x, t.y, t.z);
}

std::string textOf(const HapticSettings& haptics) {
  const SpringParameters& s = haptics.springs;
  const CouplingSettings& c = haptics.coupling;
  const WeightSettings& w = haptics.weight;
  const WorkspaceMapping& m = haptics.mapping;
  std::string text =
      fmt::format("{} {:a} {:a} {:a} {} {} {:a} {:a} {} {:a} {:a} {:a} {:a} {} {} {:a}",
                  static_cast<int>(haptics.mode), s.cutoff, s.stiffness, s.damping, static_cast<int>(s.law),
                  s.onePerArea, haptics.proxy.margin, haptics.proxy.friction, c.isAutomatic, c.stiffness,
                  c.damping, c.rotationalStiffness, c.rotationalDamping, w.hasWeight, w.hasInertia, m.scale);
  for (std::size_t i = 0; i < 3; ++i)
    text += fmt::format(" {}{}", m.translationLocks[i], m.rotationLocks[i]);
  return text;
}

std::string textOf(const Part& part) {
  return fmt::format("{} '{}' {} {} {} {} {} {} {} {} {} {} {} {}\n", static_cast<unsigned>(part.id),
                     part.name, static_cast<const void*>(part.geometry.get()), textOf(part.worldFromPart),
                     part.colour.r, part.colour.g, part.colour.b, part.density, part.opacity, part.isVisible,
                     part.isLocked, part.group ? static_cast<long>(*part.group) : -1L,
                     part.wasVisible.has_value(), part.wasVisible.value_or(false));
}

}  // namespace

std::string textOf(const Scene& scene) {
  std::string text = textOf(scene.haptics());
  text += fmt::format("\nmoving {}\n", scene.movingPart() ? static_cast<long>(*scene.movingPart()) : -1L);
  for (const Scene::GroupPtr& group : scene.groups()) {
    text += fmt::format("group {} '{}' {} {}\n", static_cast<unsigned>(group->id), group->name,
                        group->parent ? static_cast<long>(*group->parent) : -1L, group->isLocked);
  }
  for (const Scene::PartPtr& part : scene.parts())
    text += textOf(*part);
  return text;
}

SessionWatch::SessionWatch(DesktopDriver& driver) : d_(driver) {
  // After all of the application, which is what it looks at.
  changes_ = d_.session().onChange(SceneEvents::Stage::Application, [this] { see(); });
  QObject::connect(d_.action("solid"), &QAction::toggled, &context_, [this] { wasSolid_ = false; });
  see();
}

void SessionWatch::expect(bool isTrue, const QString& fault) {
  if (!isTrue) faults_ << fault;
}

void SessionWatch::see() {
  Session& session = d_.session();
  const std::string text = textOf(session.scene());
  const auto [state, isNew] = known_.emplace(session.stateSerial(), text);
  expect(state->second == text,
         QStringLiteral("state %1 is another than before:\n%2instead of\n%3")
             .arg(session.stateSerial())
             .arg(QString::fromStdString(text), QString::fromStdString(state->second)));
  const bool isSolid = d_.action("solid")->isChecked();
  const std::string label = session.undoText();
  if (isNew && isSolid && wasSolid_ && session.historyIndex() == lastIndex_ + 1 &&
      (label.starts_with("Move ") || label.starts_with("Turn ")))
    seeSolidMove(last_, session.scene());
  last_ = session.scene();
  lastIndex_ = session.historyIndex();
  wasSolid_ = isSolid;
  checkTitle();
}

void SessionWatch::seeSolidMove(const Scene& before, const Scene& after) {
  // What is in hand is where the servo has it, not where the scene has.
  const std::optional<PartId> inHand =
      d_.application.servo().status().isTaken() ? after.movingPart() : std::nullopt;
  const auto isMoved = [](const Part& was, const Part& is) {
    return textOf(was.worldFromPart) != textOf(is.worldFromPart);
  };
  for (const Scene::PartPtr& part : after.parts()) {
    const Part* was = before.find(part->id);
    if (was == nullptr || part->id == inHand || !part->isVisible || !isMoved(*was, *part)) continue;
    for (const Scene::PartPtr& other : after.parts()) {
      const Part* otherWas = before.find(other->id);
      if (otherWas == nullptr || other->id == part->id || other->id == inHand || !other->isVisible ||
          isMoved(*otherWas, *other))
        continue;
      expect(!doMeet(*part, *other) || doMeet(*was, *otherWas),
             QStringLiteral("%1 was moved solidly, and meets %2")
                 .arg(QString::fromStdString(part->name), QString::fromStdString(other->name)));
    }
  }
}

bool SessionWatch::doMeet(const Part& a, const Part& b) {
  const std::pair key(a.geometry.get(), b.geometry.get());
  auto found = pairs_.find(key);
  if (found == pairs_.end()) {
    found =
        pairs_.emplace(key, Pair{a.geometry, b.geometry, PoseCertifier(a.geometry->mesh, b.geometry->mesh)})
            .first;
  }
  return found->second.certifier.doMeet(a.worldFromPart.inverse() * b.worldFromPart);
}

void SessionWatch::check() {
  checkSelection();
  checkTitle();
  checkHistory();
  checkSelection();
}

void SessionWatch::checkSelection() {
  const ui::Selection& selection = d_.window().selection();
  const Scene& scene = d_.session().scene();
  std::set<PartId> each;
  for (const PartId part : selection.parts()) {
    expect(scene.find(part) != nullptr, QStringLiteral("a part is selected that the scene does not have"));
    expect(each.insert(part).second, QStringLiteral("a part is selected twice"));
  }
  for (const GroupId group : selection.groups())
    expect(scene.findGroup(group) != nullptr,
           QStringLiteral("a group is selected that the scene does not have"));
  const std::optional<PartId> moving = scene.movingPart();
  expect(!moving || scene.find(*moving) != nullptr, QStringLiteral("the moving part is none of the scene"));
}

void SessionWatch::checkTitle() {
  const Session& session = d_.session();
  const bool isMarked = d_.window().isWindowModified();
  // A part in hand that has moved is not saved either.
  const bool mayBeHand = isMarked && d_.application.servo().status().isTaken();
  expect(isMarked == session.isModified() || mayBeHand,
         QStringLiteral("the title's mark says %1").arg(isMarked));
  const QString name =
      session.file().empty() ? QStringLiteral("Untitled") : ui::fromPath(session.file().filename());
  expect(d_.window().windowTitle().startsWith(name), QStringLiteral("the title is not of %1").arg(name));
}

void SessionWatch::checkHistory() {
  Session& session = d_.session();
  const std::size_t here = session.historyIndex(), steps = session.history().size();
  const std::uint64_t serial = session.stateSerial();
  const std::string text = textOf(session.scene());
  // Some steps one by one, as a user does, and the rest at once; see() compares each state that it meets.
  for (int i = 0; i < 5; ++i)
    d_.action("undo")->trigger();
  session.goTo(0);
  expect(!session.canUndo(), QStringLiteral("undo goes on behind the first state"));
  session.goTo(steps - 1);
  expect(!session.canRedo(), QStringLiteral("redo goes on behind the last state"));
  session.goTo(here);
  expect(session.history().size() == steps && session.historyIndex() == here,
         QStringLiteral("undo and redo have changed the history"));
  expect(session.stateSerial() == serial && textOf(session.scene()) == text,
         QStringLiteral("undo and redo did not come back"));
}

}  // namespace nearfit::test

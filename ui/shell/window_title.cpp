#include "ui/shell/window_title.h"

#include <QMainWindow>

#include <glm/geometric.hpp>

#include "core/session/session.h"
#include "ui/model/hand_state.h"
#include "ui/widgets/paths.h"

namespace nearfit::ui {
namespace {

/// True if the poses differ by more than rounding.
bool isElsewhere(const RigidTransform& a, const RigidTransform& b) {
  constexpr double kSlack = 1e-9;  ///< [m]; for rotations half the angle [rad].
  const glm::dquat turn = glm::conjugate(a.rotation) * b.rotation;
  return glm::distance(a.translation, b.translation) > kSlack ||
         glm::length(glm::dvec3(turn.x, turn.y, turn.z)) > kSlack;
}

}  // namespace

WindowTitle::WindowTitle(Session& session, const HandState& hand, QMainWindow* window)
    : QObject(window), session_(session), hand_(hand), window_(window) {
  connect(&hand_, &HandState::changed, this, &WindowTitle::showModified);
  connect(&hand_, &HandState::snapshotShown, this, &WindowTitle::showModified);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { show(); });
  show();
}

void WindowTitle::show() {
  const QString name = session_.file().empty() ? tr("Untitled") : fromPath(session_.file().filename());
  window_->setWindowTitle(name + QStringLiteral("[*] – Nearfit"));
  showModified();
}

void WindowTitle::showModified() {
  const std::optional<PartId> part = hand_.part();
  const Part* held = part ? session_.scene().find(*part) : nullptr;
  const bool hasMoved = held != nullptr && isElsewhere(hand_.partPose(), held->worldFromPart);
  const bool isModified = session_.isModified() || hasMoved;
  if (window_->isWindowModified() != isModified) window_->setWindowModified(isModified);
}

}  // namespace nearfit::ui

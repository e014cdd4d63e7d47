#include "ui/model/move_guard.h"

#include <utility>

#include "ui/model/hand_state.h"
#include "ui/model/pose_subject.h"
#include "ui/widgets/names.h"

namespace nearfit::ui {

MoveGuard::MoveGuard(const Session& session, const HandState& hand, QObject* parent)
    : QObject(parent), session_(session), hand_(hand) {
  connect(&hand, &HandState::changed, this, &MoveGuard::changed);
}

void MoveGuard::setReplaying(bool isReplaying) {
  if (std::exchange(isReplaying_, isReplaying) != isReplaying) emit changed();
}

bool MoveGuard::isReplayed(PartId part) const {
  return isReplaying_ && session_.scene().isMoving(part);
}

QString MoveGuard::lockOf(const Part& part) const {
  const Scene& scene = session_.scene();
  const QString name = shortName(part.name);
  if (part.isLocked) return tr("%1 is locked: unlock it to move it").arg(name);
  for (std::optional<GroupId> id = part.group; id; id = scene.findGroup(*id)->parent) {
    const Group& group = *scene.findGroup(*id);
    if (group.isLocked)
      return tr("%1 is locked by its group %2: unlock the group to move it").arg(name, shortName(group.name));
  }
  return {};
}

QString MoveGuard::refusalOfScene(const Part& part) const {
  const QString lock = lockOf(part);
  if (!lock.isEmpty() || !isReplayed(part.id)) return lock;
  return tr("A recording moves %1: close the recording to place it").arg(shortName(part.name));
}

QString MoveGuard::refusalOf(const Part& part) const {
  const QString refusal = refusalOfScene(part);
  if (!refusal.isEmpty() || !hand_.holds(part.id)) return refusal;
  if (hand_.holdsGroup())
    return tr("%1 is in the group in hand: stop feeling it to place it").arg(shortName(part.name));
  if (hand_.isHeldBy(Hand::Device)) return tr("The device holds this part");
  return hand_.isHeldBy(Hand::Scripted) ? tr("The scripted hand holds this part") : QString();
}

QString MoveGuard::refusalOf(const std::vector<PartId>& parts) const {
  bool isLed = false;
  for (const PartId id : parts) {
    const Part* part = session_.scene().find(id);
    if (part == nullptr) continue;
    const QString refusal = refusalOf(*part);
    if (!refusal.isEmpty()) return refusal;
    isLed = isLed || (hand_.isHeldBy(Hand::Manual) && hand_.holds(id));
  }
  if (!isLed || parts.size() == 1) return {};
  return tr("One of these parts is in hand: stop feeling it, or select only the others");
}

QString MoveGuard::refusalOf(const PoseSubject& subject) const {
  if (!subject.isGroupInHand || !hand_.holdsGroup()) return refusalOf(subject.parts);
  for (const PartId id : subject.parts) {
    const Part* part = session_.scene().find(id);
    const QString refusal = part != nullptr ? refusalOfScene(*part) : QString();
    if (!refusal.isEmpty()) return refusal;
  }
  if (hand_.isHeldBy(Hand::Device)) return tr("The device holds this group");
  return hand_.isHeldBy(Hand::Scripted) ? tr("The scripted hand holds this group") : QString();
}

}  // namespace nearfit::ui

#include "ui/panels/parts/joint_actions.h"

#include <QAction>
#include <QMenu>
#include <algorithm>
#include <utility>

#include "core/session/session.h"
#include "ui/model/joint_names.h"
#include "ui/model/scene_work.h"
#include "ui/model/selection.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/names.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// More are not listed one by one: a menu must fit the screen.
constexpr std::size_t kMaxListed = 12;

std::vector<JointId> idsOf(const std::vector<Joint>& joints) {
  std::vector<JointId> ids;
  ids.reserve(joints.size());
  for (const Joint& joint : joints)
    ids.push_back(joint.id);
  return ids;
}

bool isAnyOn(const std::vector<Joint>& joints) {
  return std::ranges::any_of(joints, &Joint::isOn);
}

}  // namespace

JointActions::JointActions(Session& session, const Selection& selection, const SceneWork& work,
                           Attempt attempt, QObject* parent)
    : QObject(parent),
      session_(session),
      selection_(selection),
      work_(work),
      attempt_(std::move(attempt)),
      remove_(makeAction(this, "removeJoint", tr("&Remove joint"), QStringLiteral("delete"),
                         QStringLiteral("Shift+Del"),
                         tr("Let the selected parts go: remove their joints; they stay where they are"))),
      turn_(makeAction(this, "turnJoint", tr("&Turn off joint"), QStringLiteral("joint-off"), {},
                       tr("Turn the joints of the selected parts off or on; those that are off do nothing"))),
      menu_(std::make_unique<QMenu>(tr("&Joints"))) {
  menu_->setObjectName(QStringLiteral("jointsMenu"));
  menu_->setIcon(icon(QStringLiteral("joint")));
  menu_->setToolTipsVisible(true);
  menu_->addActions({remove_, turn_});
  connect(remove_, &QAction::triggered, this, &JointActions::removeAll);
  connect(turn_, &QAction::triggered, this, &JointActions::turnAll);
  connect(&selection_, &Selection::changed, this, &JointActions::update);
  connect(&work_, &SceneWork::busyChanged, this, &JointActions::update);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { update(); });
  update();
}

JointActions::~JointActions() = default;

std::vector<Joint> JointActions::selectedJoints() const {
  return jointsOfParts(session_.scene(), selection_.parts());
}

void JointActions::update() {
  const std::vector<Joint> joints = selectedJoints();
  const auto isLocked = [this](const Joint& joint) {
    return session_.scene().isLocked(session_.scene().get(joint.part));
  };
  const bool canAct = !joints.empty() && !work_.isBusy() && std::ranges::none_of(joints, isLocked);
  for (QAction* action : {remove_, turn_})
    action->setEnabled(canAct);
  menu_->menuAction()->setEnabled(canAct);
  const bool areMany = joints.size() > 1, isOn = joints.empty() || isAnyOn(joints);
  remove_->setText(areMany ? tr("&Remove all %1 joints").arg(joints.size()) : tr("&Remove joint"));
  turn_->setText(isOn ? (areMany ? tr("&Turn off all joints") : tr("&Turn off joint"))
                      : (areMany ? tr("&Turn on all joints") : tr("&Turn on joint")));
  turn_->setIcon(icon(isOn ? QStringLiteral("joint-off") : QStringLiteral("joint")));
  list(areMany && canAct ? joints : std::vector<Joint>{});
}

void JointActions::list(const std::vector<Joint>& joints) {
  for (QAction* action : std::exchange(each_, {})) {
    menu_->removeAction(action);
    // One of them may be what runs.
    action->deleteLater();
  }
  if (joints.size() > kMaxListed) return;
  const bool areOfOne = selection_.parts().size() == 1;
  const auto textOf = [&](const Joint& joint) {
    const QString text = jointText(session_.scene(), joint);
    return areOfOne ? text : tr("%1: %2").arg(shortName(session_.scene().get(joint.part).name), text);
  };
  const auto add = [this](const QString& text, const QString& help, const char* name) {
    auto* action = new QAction(QString(text).replace(QChar('&'), QStringLiteral("&&")), this);
    action->setObjectName(QLatin1String(name));
    action->setToolTip(help);
    menu_->addAction(action);
    each_.push_back(action);
    return action;
  };
  if (!joints.empty()) each_.push_back(menu_->addSeparator());
  for (const Joint& joint : joints) {
    QAction* action = add(textOf(joint), tr("Turn this joint on or off"), "turnOneJoint");
    action->setCheckable(true);
    action->setChecked(joint.isOn);
    connect(action, &QAction::triggered, this, [this, id = joint.id](bool isOn) { turn({id}, isOn); });
  }
  if (!joints.empty()) each_.push_back(menu_->addSeparator());
  for (const Joint& joint : joints) {
    QAction* action =
        add(tr("Remove: %1").arg(textOf(joint)), tr("Remove this joint alone"), "removeOneJoint");
    connect(action, &QAction::triggered, this, [this, id = joint.id] { remove({id}); });
  }
}

void JointActions::toggle(PartId part) {
  const std::vector<Joint> joints = jointsOfParts(session_.scene(), {part});
  turn(idsOf(joints), !isAnyOn(joints));
}

void JointActions::removeAll() {
  remove(idsOf(selectedJoints()));
}

void JointActions::turnAll() {
  const std::vector<Joint> joints = selectedJoints();
  turn(idsOf(joints), !isAnyOn(joints));
}

void JointActions::remove(const std::vector<JointId>& joints) {
  attempt_(tr("The joint could not be removed."), [&] { session_.removeJoints(joints); });
}

void JointActions::turn(const std::vector<JointId>& joints, bool isOn) {
  attempt_(tr("The joint could not be turned on or off."), [&] { session_.setJointsOn(joints, isOn); });
}

}  // namespace nearfit::ui

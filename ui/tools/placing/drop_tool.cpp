#include "ui/tools/placing/drop_tool.h"

#include <QAction>
#include <QMenu>
#include <algorithm>
#include <memory>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/placing/drop.h"
#include "core/placing/push.h"
#include "ui/model/hand_state.h"
#include "ui/model/move_guard.h"
#include "ui/model/scene_work.h"
#include "ui/model/selection.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/format.h"
#include "ui/widgets/names.h"
#include "ui/widgets/progress_dialog.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

struct Way {
  const char* name;
  const char* text;
  glm::dvec3 direction;
};
const Way kWays[] = {{"Down", QT_TRANSLATE_NOOP("DropTool", "&Down (−Z)"), {0, 0, -1}},
                     {"Up", QT_TRANSLATE_NOOP("DropTool", "&Up (+Z)"), {0, 0, 1}},
                     {"Left", QT_TRANSLATE_NOOP("DropTool", "&Left (−X)"), {-1, 0, 0}},
                     {"Right", QT_TRANSLATE_NOOP("DropTool", "&Right (+X)"), {1, 0, 0}},
                     {"Front", QT_TRANSLATE_NOOP("DropTool", "&Front (−Y)"), {0, -1, 0}},
                     {"Back", QT_TRANSLATE_NOOP("DropTool", "&Back (+Y)"), {0, 1, 0}}};

QString nameOf(const Scene& scene, PartId part) {
  const Part* found = scene.find(part);
  return found != nullptr ? shortName(found->name) : QString();
}

constexpr int kNamed = 3;

QString overlapText(const QString& name, const QString& against) {
  return DropTool::tr("%1 already touches or overlaps %2: move them apart, or hide %2.").arg(name, against);
}

QString freeWayText(const QString& name) {
  return DropTool::tr("Nothing in that direction; %1 was not moved.").arg(name);
}

}  // namespace

DropTool::DropTool(const Context& context, QWidget* window)
    : QObject(window),
      session_(context.session),
      selection_(context.selection),
      view_(context.view),
      guard_(context.guard),
      hand_(context.hand),
      work_(context.work),
      window_(window),
      picker_(session_, view_, colours::kAccent, this) {
  picker_.setFilter(FeatureFilter::Faces);
  connect(&picker_, &FeaturePicker::picked, this, &DropTool::take);
  connect(&picker_, &FeaturePicker::cancelled, this, &DropTool::stopAsking);
  connect(&picker_, &FeaturePicker::told, this, [this](const QString& text) {
    if (picker_.isActive() && !text.isEmpty()) emit noted(text);
  });
  connect(&selection_, &Selection::changed, this, &DropTool::updateAvailability);
  connect(&guard_, &MoveGuard::changed, this, &DropTool::updateAvailability);
  connect(&hand_, &HandState::changed, this, &DropTool::updateAvailability);
  connect(&work_, &SceneWork::busyChanged, this, &DropTool::updateAvailability);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { updateAvailability(); });
}

DropTool::~DropTool() = default;

void DropTool::addTo(QMenu& menu) {
  menu.addMenu(makeMenu(Kind::Drop));
  menu.addMenu(makeMenu(Kind::Push));
  updateAvailability();
}

QMenu* DropTool::makeMenu(Kind kind) {
  const bool isDrop = kind == Kind::Drop;
  auto* menu = new QMenu(isDrop ? tr("&Drop to contact") : tr("&Push until held"), window_);
  menu->setIcon(icon(isDrop ? QStringLiteral("drop") : QStringLiteral("push")));
  menu->setToolTipsVisible(true);
  const QString tip = isDrop ? tr("Move straight to the first contact")
                             : tr("Move to the first contact, then slide along what is touched until held");
  const auto add = [&](const QString& name, const QString& text) {
    QAction* action = menu->addAction(text);
    action->setObjectName((isDrop ? QStringLiteral("drop") : QStringLiteral("push")) + name);
    action->setToolTip(tip);
    actions_.push_back(action);
    return action;
  };
  for (const Way& way : kWays) {
    connect(add(QLatin1String(way.name), tr(way.text)), &QAction::triggered, this,
            [this, kind, direction = way.direction] { run(kind, direction); });
  }
  if (isDrop) actions_[0]->setShortcut(QKeySequence(Qt::Key_D));
  menu->addSeparator();
  connect(add(QStringLiteral("ToFace"), tr("Towards a fa&ce…")), &QAction::triggered, this,
          [this, kind] { askForFace(kind); });
  return menu;
}

void DropTool::updateAvailability() {
  // While the servo holds a part, the hand moves it.
  const bool isFree = !hand_.status().isTaken() && !work_.isBusy() && !task_.isRunning();
  const bool canMove = isFree && session_.scene().parts().size() > 1 && !selection_.isEmpty() &&
                       guard_.refusalOf(selection_.parts()).isEmpty();
  for (QAction* action : actions_)
    action->setEnabled(canMove);
  if (!canMove) stopAsking();
}

void DropTool::askForFace(Kind kind) {
  wanted_ = kind;
  picker_.start([this](const Part& part) {
    return selection_.contains(part.id) ? tr("Click a flat face of another part") : QString();
  });
  emit noted(tr("Click the flat face to move the part towards; Esc cancels"));
}

void DropTool::stopAsking() {
  picker_.stop();
}

void DropTool::take(const FeaturePick& pick) {
  const Part* part = session_.scene().find(pick.part);
  stopAsking();
  if (part != nullptr) run(wanted_, -placed(pick.picked.feature, part->worldFromPart).direction);
}

void DropTool::run(Kind kind, const glm::dvec3& direction) {
  const std::vector<PartId> parts = selection_.parts();
  if (parts.empty() || task_.isRunning()) return;
  work_.prepareHierarchies([this, kind, parts, direction](bool isReady) {
    if (isReady && parts == selection_.parts() && !task_.isRunning()) compute(kind, parts, direction);
  });
}

void DropTool::compute(Kind kind, const std::vector<PartId>& parts, const glm::dvec3& direction) {
  const auto outcome = std::make_shared<Outcome>();
  const Scene scene = session_.scene();
  const auto job = [kind, parts, direction, scene, outcome](const ProgressCallback& progress) {
    *outcome = kind == Kind::Drop ? dropped(scene, parts, direction, progress)
                                  : pushed(scene, parts, direction, progress);
  };
  const QString text =
      kind == Kind::Drop ? tr("Looking for the first contact") : tr("Pushing until the part is held");
  runWithDialog(task_, tr("Nearfit"), text, window_, job, [=, this](const std::exception_ptr& error) {
    if (!error) return finish(kind, parts, scene, *outcome);
    if (!isCancelled(error)) emit failed(describe(tr("The part could not be moved."), error));
  });
}

DropTool::Outcome DropTool::dropped(const Scene& scene, const std::vector<PartId>& parts,
                                    const glm::dvec3& direction, const ProgressCallback& progress) {
  const DropResult result = dropParts(scene, parts, {direction, 0.0}, progress);
  Outcome outcome;
  outcome.against = nameOf(scene, result.against);
  outcome.travel = result.travel;
  outcome.worldFromLead = scene.find(parts.back())->worldFromPart;
  outcome.worldFromLead.translation += result.shift;
  const QString name = nameOf(scene, result.moved);
  if (result.outcome == DropResult::Outcome::Overlapping) {
    outcome.problem = overlapText(name, outcome.against);
  } else if (result.outcome == DropResult::Outcome::NothingMet) {
    outcome.problem = freeWayText(nameOf(scene, parts.back()));
  } else if (result.travel == 0.0) {
    outcome.problem = tr("%1 already touches %2 and was not moved.").arg(name, outcome.against);
  }
  return outcome;
}

DropTool::Outcome DropTool::pushed(const Scene& scene, const std::vector<PartId>& parts,
                                   const glm::dvec3& direction, const ProgressCallback& progress) {
  const PushResult result = pushParts(scene, parts, direction, progress);
  const Part& lead = *scene.find(parts.back());
  const QString name = shortName(lead.name);
  QStringList against;
  for (const PartId id : result.against)
    against << QString::fromStdString(scene.find(id)->name);
  Outcome outcome;
  outcome.against = listOfNames(against, kNamed);
  outcome.worldFromLead = result.poses.back();
  outcome.travel = glm::distance(outcome.worldFromLead.translation, lead.worldFromPart.translation);
  switch (result.outcome) {
    case PushResult::Outcome::Overlapping:
      outcome.problem = overlapText(name, outcome.against);
      break;
    case PushResult::Outcome::SlippedPast:
      outcome.problem = tr("Nothing holds %1 in that direction: it would slide past %2. It was not moved.")
                            .arg(name, outcome.against);
      break;
    case PushResult::Outcome::NothingMet:
      outcome.problem = freeWayText(name);
      break;
    case PushResult::Outcome::Held:
      // A part that was pushed there before may move by so little again.
      if (outcome.travel <= dropGap(lead.geometry->mesh.bounds().diagonal()))
        outcome.problem = tr("%1 is already held by %2 and was not moved.").arg(name, outcome.against);
      break;
  }
  return outcome;
}

void DropTool::finish(Kind kind, const std::vector<PartId>& parts, const Scene& before,
                      const Outcome& outcome) {
  if (!outcome.problem.isEmpty()) {
    emit noted(outcome.problem);
    return;
  }
  const Part *was = before.find(parts.back()), *is = session_.scene().find(parts.back());
  const bool isSame = is != nullptr && is->worldFromPart == was->worldFromPart;
  if (!isSame) return;
  try {
    session_.moveParts(parts, parts.back(), outcome.worldFromLead, kind == Kind::Drop ? "Drop" : "Push");
  } catch (...) {
    emit failed(describe(tr("The part could not be moved."), std::current_exception()));
    return;
  }
  emit noted(tr("%1 moved %2 and touches %3")
                 .arg(nameOf(before, parts.back()), formatLength(outcome.travel), outcome.against));
}

}  // namespace nearfit::ui

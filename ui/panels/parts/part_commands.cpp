#include "ui/panels/parts/part_commands.h"

#include <QAction>
#include <QColorDialog>
#include <QMenu>
#include <QTimer>
#include <algorithm>
#include <utility>

#include "core/scene/document_load.h"
#include "core/scene/refinement.h"
#include "core/session/session.h"
#include "ui/model/hand_state.h"
#include "ui/model/scene_work.h"
#include "ui/model/selection.h"
#include "ui/panels/parts/joint_actions.h"
#include "ui/panels/parts/parts_panel.h"
#include "ui/panels/parts/tree_actions.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/names.h"

namespace nearfit::ui {
namespace {

QColor shown(const Colour& colour) {
  return QColor::fromRgbF(static_cast<double>(colour.r), static_cast<double>(colour.g),
                          static_cast<double>(colour.b));
}

Colour partColour(const QColor& colour) {
  return {static_cast<float>(colour.redF()), static_cast<float>(colour.greenF()),
          static_cast<float>(colour.blueF())};
}

QString unitHelp() {
  return PartCommands::tr("Change the unit of the selected parts; shows the size in each unit");
}

}  // namespace

PartCommands::PartCommands(const Context& context, PartsPanel& panel, QWidget* window)
    : QObject(window), context_(context), panel_(panel), window_(window) {
  const auto run = [this](const QString& heading, const auto& command) { attempt(heading, command); };
  tree_ = new TreeActions(context.session, context.selection, context.work, run, this);
  joints_ = new JointActions(context.session, context.selection, context.work, run, this);
  makeActions();
  makeMenu();
  connectActions();
  connectPanel(panel);
  panel.setMenuActions(menu_);
  connect(&context.selection, &Selection::changed, this, &PartCommands::update);
  connect(&context.work, &SceneWork::busyChanged, this, &PartCommands::update);
  changes_ = context.session.onChange(SceneEvents::Stage::Panels, [this] { update(); });
  update();
}

void PartCommands::makeActions() {
  duplicate =
      makeAction(this, "duplicate", tr("&Duplicate"), QStringLiteral("duplicate"), QStringLiteral("Ctrl+D"),
                 tr("Add a copy of the selected parts and groups; it shares their meshes"));
  rename = makeAction(this, "rename", tr("Re&name"), QStringLiteral("rename"), Qt::Key_F2,
                      tr("Rename the selected part or group"));
  recolour =
      makeAction(this, "recolour", tr("&Colour…"), {}, {}, tr("Change the colour of the selected parts"));
  changeUnit = makeAction(this, "changeUnit", tr("Chang&e unit…"), {}, {}, unitHelp());
  check = makeAction(this, "check", tr("Check &mesh…"), QStringLiteral("findings"), QStringLiteral("Ctrl+M"),
                     tr("Show what is wrong with the mesh of the selected part and where, and repair it"));
  refine = makeAction(
      this, "refine", tr("Re&fine…"), {}, {},
      tr("Make the triangles of the selected parts finer or coarser, if their file holds exact surfaces"));
  takeInHand =
      makeAction(this, "takeInHand", tr("&Take in hand"), QStringLiteral("hand"), QStringLiteral("Ctrl+H"),
                 tr("Make the selected part the moving part, or the selected group move as one"));
  remove = makeAction(this, "remove", tr("De&lete"), QStringLiteral("delete"), QKeySequence::Delete,
                      tr("Delete the selected parts and groups from the scene; their files stay"));
  selectAll = makeAction(this, "selectAll", tr("Select &all"), {}, QKeySequence::SelectAll,
                         tr("Select all visible parts"));
  selectNone = makeAction(this, "selectNone", tr("Select n&one"), {}, QStringLiteral("Ctrl+Shift+A"),
                          tr("Clear the selection"));
}

void PartCommands::makeMenu() {
  auto* separator = new QAction(this);
  separator->setSeparator(true);
  menu_ = QList<QAction*>{takeInHand, rename, recolour, changeUnit, refine, check, duplicate} +
          tree_->list() + QList<QAction*>{joints_->menu().menuAction(), separator, remove};
  for (QAction* action : menu_)
    action->setShortcutVisibleInContextMenu(true);
}

void PartCommands::connectActions() {
  Selection& selection = context_.selection;
  connect(duplicate, &QAction::triggered, this, &PartCommands::duplicateSelected);
  connect(rename, &QAction::triggered, &panel_, &PartsPanel::editName);
  connect(recolour, &QAction::triggered, this, &PartCommands::recolourSelected);
  connect(changeUnit, &QAction::triggered, this,
          [this] { emit unitChangeRequested(context_.selection.parts()); });
  connect(refine, &QAction::triggered, this, [this] { emit refineRequested(context_.selection.parts()); });
  connect(check, &QAction::triggered, this, &PartCommands::checkRequested);
  connect(takeInHand, &QAction::triggered, this, &PartCommands::takeSelected);
  connect(remove, &QAction::triggered, this, &PartCommands::deleteSelected);
  connect(selectAll, &QAction::triggered, &selection, &Selection::selectAllVisible);
  connect(selectNone, &QAction::triggered, &selection, [&selection] { selection.select({}); });
  connect(tree_, &TreeActions::lockRequested, this, &PartCommands::setLocked);
}

void PartCommands::connectPanel(PartsPanel& panel) {
  Session& session = context_.session;
  connect(&panel, &PartsPanel::movingPartRequested, this, &PartCommands::take);
  connect(&panel, &PartsPanel::movingGroupRequested, this, &PartCommands::takeGroup);
  connect(&panel, &PartsPanel::lockRequested, this, &PartCommands::setLocked);
  connect(&panel, &PartsPanel::jointToggleRequested, joints_, &JointActions::toggle);
  connect(&panel, &PartsPanel::findingsRequested, this, [this](PartId part) {
    // Several parts may be selected: the one whose badge was clicked is shown.
    if (context_.selection.current() != part) context_.selection.select(part);
    emit checkRequested();
  });
  connect(&panel, &PartsPanel::renameRefused, this, &PartCommands::noted);
  connect(&panel, &PartsPanel::renameRequested, this, [this, &session](PartId part, const QString& name) {
    attempt(tr("The part could not be renamed."), [&] { session.renamePart(part, name.toStdString()); });
  });
  connect(&panel, &PartsPanel::groupRenameRequested, this,
          [this, &session](GroupId group, const QString& name) {
            attempt(tr("The group could not be renamed."),
                    [&] { session.renameGroup(group, name.toStdString()); });
          });
  connect(&panel, &PartsPanel::visibilityRequested, this,
          [this, &session](const std::vector<PartId>& parts, bool isVisible) {
            attempt(tr("The part could not be hidden or shown."),
                    [&] { session.setVisible(parts, isVisible); });
          });
  // Deferred: the tree view is still handling the drop, which a model change would disturb.
  connect(&panel, &PartsPanel::regroupRequested, this,
          [this, &session](const SceneNodes& nodes, std::optional<GroupId> target) {
            QTimer::singleShot(0, this, [this, &session, nodes, target] {
              attempt(tr("The parts could not be moved there."), [&] { session.regroup(nodes, target); });
            });
          });
}

void PartCommands::update() {
  const Scene& scene = context_.session.scene();
  const std::optional<PartId> current = context_.selection.current();
  const Part* part = current ? scene.find(*current) : nullptr;
  const bool isAnySelected = !context_.selection.isEmpty();
  const bool canAct = isAnySelected && !context_.work.isBusy();
  // Locks prevent neither copying a part nor changing its look.
  for (QAction* action : {duplicate, recolour})
    action->setEnabled(canAct);
  for (QAction* action : {rename, remove, takeInHand})
    action->setEnabled(canAct && !(part != nullptr && scene.isLocked(*part)));
  const auto isLocked = [&scene](PartId id) {
    const Part* selected = scene.find(id);
    return selected != nullptr && scene.isLocked(*selected);
  };
  const std::vector<PartId> selected = context_.selection.parts();
  const auto canRefine = [&scene](PartId id) {
    const Part* each = scene.find(id);
    return each != nullptr && isRefinable(*each);
  };
  const bool areFree = canAct && part != nullptr && std::ranges::none_of(selected, isLocked);
  const auto hasFixedUnit = [&scene](PartId id) {
    const Part* each = scene.find(id);
    return each != nullptr && each->geometry != nullptr && !canChangeUnit(*each->geometry);
  };
  const bool isUnitFixed = std::ranges::any_of(selected, hasFixedUnit);
  changeUnit->setEnabled(areFree && !isUnitFixed);
  setHelp(*changeUnit, isUnitFixed ? tr("The file of a selected part stores its unit, and sizes are right in "
                                        "that: export it from the CAD system in another size")
                                   : unitHelp());
  refine->setEnabled(areFree && std::ranges::all_of(selected, canRefine));
  // Looking is possible at any time.
  check->setEnabled(part != nullptr);
  selectAll->setEnabled(!scene.parts().empty());
  selectNone->setEnabled(isAnySelected);
}

void PartCommands::attempt(const QString& heading, const std::function<void()>& command) {
  try {
    command();
  } catch (...) {
    emit failed(describe(heading, std::current_exception()));
    panel_.refresh();
  }
}

void PartCommands::take(std::optional<PartId> part) {
  const Scene& scene = context_.session.scene();
  if (scene.movingPart() == part && !scene.movingGroup()) return;
  takeAnother(tr("The part could not be taken in hand."), [&] { context_.session.setMovingPart(part); });
}

void PartCommands::takeGroup(GroupId group) {
  if (context_.session.scene().movingGroup() == group) return;
  takeAnother(tr("The group could not be taken in hand."), [&] { context_.session.setMovingGroup(group); });
}

void PartCommands::takeSelected() {
  if (const std::optional<GroupId> group = selectedGroup()) return takeGroup(*group);
  if (context_.selection.current()) take(context_.selection.current());
}

std::optional<GroupId> PartCommands::selectedGroup() const {
  const SceneNodes outer = outermost(context_.session.scene(), context_.selection.nodes());
  return outer.groups.size() == 1 && outer.parts.empty() ? std::optional(outer.groups.front()) : std::nullopt;
}

void PartCommands::takeAnother(const QString& heading, const std::function<void()>& command) {
  // Stopping puts what is in hand down where it is; without it the pose felt would be lost.
  const bool wasRunning = context_.hand.status().isTaken();
  emit servoStopRequested();
  attempt(heading, command);
  if (wasRunning) emit servoStartRequested();
}

void PartCommands::setLocked(const SceneNodes& nodes, bool isLocked) {
  const Scene& scene = context_.session.scene();
  const std::vector<PartId> parts = partsOf(scene, nodes);
  const auto moving = std::ranges::find_if(parts, [&](PartId part) { return scene.isMoving(part); });
  const bool isMoving = isLocked && moving != parts.end();
  const QString name = isMoving ? shortName(scene.find(*moving)->name) : QString();
  if (isMoving && context_.hand.status().isTaken())
    return emit noted(tr("%1 is being felt: stop (F6) before you lock it").arg(name));
  attempt(tr("The parts could not be locked or unlocked."), [&] {
    context_.session.setLocked(nodes, isLocked);
    if (isMoving) emit noted(tr("%1 is locked and no longer in hand").arg(name));
  });
}

void PartCommands::deleteSelected() {
  const SceneNodes nodes = context_.selection.nodes();
  const Scene& scene = context_.session.scene();
  const std::vector<PartId> parts = partsOf(scene, nodes);
  const auto held = std::ranges::find_if(parts, [this](PartId part) { return context_.hand.holds(part); });
  const bool isHeld = held != parts.end();
  const QString name = isHeld ? shortName(scene.get(*held).name) : QString();
  if (isHeld) emit servoStopRequested();
  attempt(tr("The part could not be deleted."), [&] {
    context_.session.deleteNodes(nodes);
    if (isHeld) emit noted(tr("Feeling has stopped: %1 was deleted").arg(name));
  });
}

void PartCommands::duplicateSelected() {
  attempt(tr("The part could not be duplicated."), [this] {
    const SceneNodes copies = context_.session.duplicate(context_.selection.nodes());
    context_.selection.set(partsOf(context_.session.scene(), copies), copies.groups);
  });
}

void PartCommands::recolourSelected() {
  const std::optional<PartId> id = context_.selection.current();
  const Part* part = id ? context_.session.scene().find(*id) : nullptr;
  if (part == nullptr) return;
  const QColor chosen =
      QColorDialog::getColor(shown(part->colour), window_, tr("Colour of %1").arg(shortName(part->name)));
  if (!chosen.isValid()) return;
  attempt(tr("The part could not be coloured."),
          [&] { context_.session.setColour(context_.selection.parts(), partColour(chosen)); });
}

}  // namespace nearfit::ui

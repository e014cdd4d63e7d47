#include "ui/panels/parts/tree_actions.h"

#include <QAction>
#include <QMenu>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/session/session.h"
#include "ui/model/scene_work.h"
#include "ui/model/selection.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

TreeActions::TreeActions(Session& session, Selection& selection, const SceneWork& work, Attempt attempt,
                         QObject* parent)
    : QObject(parent), session_(session), selection_(selection), work_(work), attempt_(std::move(attempt)) {
  group_ = make("group", tr("&Group"), "folder", "Ctrl+G",
                tr("Put the selected parts and groups into a new group"), &TreeActions::groupSelected);
  ungroup_ = make("ungroup", tr("Ungrou&p"), {}, "Ctrl+Shift+G",
                  tr("Dissolve the selected groups; their contents stay"), &TreeActions::ungroupSelected);
  visible_ =
      make("toggleVisible", tr("&Hide"), "eye", "H",
           tr("Hide or show the selected parts; hidden parts are not felt"), &TreeActions::toggleVisible);
  lock_ = make("toggleLock", tr("Loc&k"), "lock", "Ctrl+L",
               tr("Lock or unlock the selected parts and groups"), &TreeActions::toggleLock);
  isolate_ = make("isolate", tr("&Isolate"), "isolate", "I",
                  tr("Show only the selected parts; hidden parts are not felt"), &TreeActions::isolate);
  endIsolation_ = make("endIsolation", tr("End i&solation"), {}, "Shift+I",
                       tr("Show the parts that were visible before"), &TreeActions::endIsolation);
  setUpTransparency();
  connect(&selection_, &Selection::changed, this, &TreeActions::update);
  connect(&work_, &SceneWork::busyChanged, this, &TreeActions::update);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { update(); });
  update();
}

TreeActions::~TreeActions() = default;

QAction* TreeActions::make(const char* name, const QString& text, const QString& iconName,
                           const QString& keys, const QString& help, void (TreeActions::*run)()) {
  QAction* action = makeAction(this, name, text, iconName, QKeySequence(keys), help);
  connect(action, &QAction::triggered, this, run);
  return action;
}

void TreeActions::setUpTransparency() {
  transparency_ = std::make_unique<QMenu>(tr("Transparenc&y"));
  transparency_->setObjectName(QStringLiteral("transparencyMenu"));
  for (const int percent : {0, 25, 50, 75, 90}) {
    QAction* action = transparency_->addAction(percent == 0 ? tr("Opaque") : tr("%1 %").arg(percent));
    const double opacity = 1.0 - percent / 100.0;
    action->setObjectName(QStringLiteral("transparency%1").arg(percent));
    action->setCheckable(true);
    action->setData(opacity);
    connect(action, &QAction::triggered, this, [this, opacity] { setOpacity(opacity); });
    opacities_.push_back(action);
  }
}

void TreeActions::addTo(QMenu& menu) const {
  menu.addSeparator();
  menu.addActions({group_, ungroup_, visible_, lock_, isolate_, endIsolation_});
  menu.addMenu(transparency_.get());
}

QList<QAction*> TreeActions::list() const {
  return {group_, ungroup_, visible_, lock_, isolate_, endIsolation_, transparency_->menuAction()};
}

bool TreeActions::areAll(const std::function<bool(const Part&)>& predicate) const {
  const std::vector<PartId>& parts = selection_.parts();
  return !parts.empty() && std::ranges::all_of(parts, [&](PartId id) {
    const Part* part = session_.scene().find(id);
    return part != nullptr && predicate(*part);
  });
}

void TreeActions::update() {
  const bool isBusy = work_.isBusy(), hasParts = !selection_.parts().empty();
  for (QAction* action : {visible_, isolate_, transparency_->menuAction()})
    action->setEnabled(!isBusy && hasParts);
  for (QAction* action : {group_, lock_})
    action->setEnabled(!isBusy && !selection_.isEmpty());
  ungroup_->setEnabled(!isBusy && !selection_.groups().empty());
  endIsolation_->setEnabled(!isBusy && session_.scene().isIsolated());
  const bool areShown = areAll([](const Part& part) { return part.isVisible; });
  visible_->setText(areShown || !hasParts ? tr("&Hide") : tr("S&how"));
  visible_->setIcon(icon(areShown || !hasParts ? QStringLiteral("eye-off") : QStringLiteral("eye")));
  lock_->setText(areNodesLocked() ? tr("Unloc&k") : tr("Loc&k"));
  for (QAction* action : opacities_) {
    const double opacity = action->data().toDouble();
    action->setChecked(areAll([&](const Part& part) { return std::abs(part.opacity - opacity) < 1e-9; }));
  }
}

void TreeActions::groupSelected() {
  attempt_(tr("The parts could not be grouped."), [this] {
    const SceneNodes nodes = selection_.nodes();
    const GroupId group = session_.group(nodes);
    selection_.set(nodes.parts, {group});
  });
}

void TreeActions::ungroupSelected() {
  attempt_(tr("The group could not be ungrouped."), [this] { session_.ungroup(selection_.groups()); });
}

void TreeActions::toggleVisible() {
  const bool areShown = areAll([](const Part& part) { return part.isVisible; });
  attempt_(tr("The parts could not be hidden or shown."),
           [&] { session_.setVisible(selection_.parts(), !areShown); });
}

bool TreeActions::areNodesLocked() const {
  const SceneNodes nodes = outermost(session_.scene(), selection_.nodes());
  const auto isPart = [this](PartId id) { return session_.scene().find(id)->isLocked; };
  const auto isGroup = [this](GroupId id) { return session_.scene().findGroup(id)->isLocked; };
  return !nodes.isEmpty() && std::ranges::all_of(nodes.parts, isPart) &&
         std::ranges::all_of(nodes.groups, isGroup);
}

void TreeActions::toggleLock() {
  emit lockRequested(outermost(session_.scene(), selection_.nodes()), !areNodesLocked());
}

void TreeActions::isolate() {
  attempt_(tr("The parts could not be isolated."), [this] { session_.isolate(selection_.parts()); });
}

void TreeActions::endIsolation() {
  session_.endIsolation();
}

void TreeActions::setOpacity(double opacity) {
  attempt_(tr("The parts could not be made transparent."),
           [&] { session_.setOpacity(selection_.parts(), opacity); });
  // A click on the checked action unchecks it, even if the opacity stays.
  update();
}

}  // namespace nearfit::ui

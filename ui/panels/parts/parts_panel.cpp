#include "ui/panels/parts/parts_panel.h"

#include <QAction>
#include <QDockWidget>
#include <QHeaderView>
#include <QLineEdit>
#include <QVBoxLayout>
#include <algorithm>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/session/session.h"
#include "ui/model/parts_model.h"
#include "ui/model/selection.h"
#include "ui/panels/parts/parts_view.h"

namespace nearfit::ui {
namespace {

/// With more parts the filter is shown.
constexpr std::size_t kMany = 12;

/// Adds the rows of these nodes, neighbours as one range: the selection model compares each range with each.
template <class Id>
void addRows(const PartsModel& model, const std::vector<Id>& ids, QItemSelection& rows) {
  QModelIndex first, last;
  for (const Id id : ids) {
    const QModelIndex next = model.indexOf(id);
    if (first.isValid() && next.row() == last.row() + 1 && next.parent() == first.parent()) {
      last = next;
      continue;
    }
    if (first.isValid()) rows.select(first, last);
    first = last = next;
  }
  if (first.isValid()) rows.select(first, last);
}

}  // namespace

PartsPanel::PartsPanel(Session& session, Selection& selection, QWidget* parent)
    : QWidget(parent),
      session_(session),
      selection_(selection),
      model_(new PartsModel(this)),
      view_(new PartsView(this)),
      filter_(new QLineEdit(this)) {
  view_->setObjectName(QStringLiteral("partsView"));
  view_->setAccessibleName(tr("Groups and parts"));
  view_->setModel(model_);
  auto* names = new NameDelegate(
      [this](const QModelIndex& row, const QString& name) { return model_->renameRefusal(row, name); }, this);
  view_->setItemDelegateForColumn(PartsModel::Name, names);
  connect(names, &NameDelegate::refused, this, &PartsPanel::renameRefused);
  QHeaderView* header = view_->header();
  header->setStretchLastSection(false);
  header->setMinimumSectionSize(28);
  header->setSectionResizeMode(PartsModel::Name, QHeaderView::Stretch);
  for (const int column : {PartsModel::Moving, PartsModel::Visible, PartsModel::Locked, PartsModel::Joints,
                           PartsModel::Findings}) {
    header->setSectionResizeMode(column, QHeaderView::Fixed);
    header->resizeSection(column, 30);
  }
  view_->setColumnHidden(PartsModel::Findings, true);
  filter_->setObjectName(QStringLiteral("partsFilter"));
  filter_->setPlaceholderText(tr("Find a part or group"));
  filter_->setAccessibleName(filter_->placeholderText());
  filter_->setClearButtonEnabled(true);
  filter_->hide();
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  layout->addWidget(filter_);
  layout->addWidget(view_);
  setTabOrder(filter_, view_);

  connect(filter_, &QLineEdit::textChanged, view_, &PartsView::setFilter);
  connect(view_, &QTreeView::clicked, this, &PartsPanel::clickCell);
  connect(view_->selectionModel(), &QItemSelectionModel::selectionChanged, this, &PartsPanel::takeSelection);
  connect(&selection_, &Selection::changed, this, [this] { showSelection(Reveal::Yes); });
  connect(model_, &PartsModel::renameRequested, this, &PartsPanel::renameRequested);
  connect(model_, &PartsModel::groupRenameRequested, this, &PartsPanel::groupRenameRequested);
  connect(model_, &PartsModel::regroupRequested, this, &PartsPanel::regroupRequested);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { refresh(); });
  refresh();
}

QWidget* PartsPanel::list() const noexcept {
  return view_;
}

void PartsPanel::refresh() {
  const Scene& scene = session_.scene();
  const std::vector<GroupId> expanded = expandedGroups();
  const std::unordered_set<GroupId> before(known_.begin(), known_.end());
  scene_ = scene;
  model_->setScene(scene);
  // A reset of the model closes every group and drops the selection, without a signal.
  known_.clear();
  for (const Scene::GroupPtr& group : scene.groups()) {
    known_.push_back(group->id);
    if (!before.contains(group->id)) view_->expand(model_->indexOf(group->id));
  }
  for (const GroupId group : expanded) {
    const QModelIndex index = model_->indexOf(group);
    if (index.isValid()) view_->expand(index);
  }
  view_->setColumnHidden(PartsModel::Joints, scene.joints().empty());
  view_->setRootIsDecorated(!scene.groups().empty());
  const bool areMany = scene.parts().size() > kMany;
  if (!areMany) filter_->clear();
  filter_->setVisible(areMany);
  if (!filter_->text().isEmpty()) view_->setFilter(filter_->text());
  // A closed group stays closed, whatever it holds.
  showSelection(Reveal::No);
}

std::vector<GroupId> PartsPanel::expandedGroups() const {
  std::vector<GroupId> expanded;
  for (const GroupId group : known_) {
    if (view_->isExpanded(model_->indexOf(group))) expanded.push_back(group);
  }
  return expanded;
}

void PartsPanel::takeSelection() {
  if (isShowing_) return;
  SceneNodes rows;
  for (const QModelIndex& row : view_->selectionModel()->selectedRows()) {
    if (const std::optional<PartId> part = model_->partAt(row)) rows.parts.push_back(*part);
    if (const std::optional<GroupId> group = model_->groupAt(row)) rows.groups.push_back(*group);
  }
  const std::vector<PartId> chosen = partsOf(scene_, rows);
  const std::unordered_set<PartId> left(chosen.begin(), chosen.end());
  // Those that stay keep their order, so that the current one stays current.
  std::vector<PartId> parts = selection_.parts();
  std::erase_if(parts, [&](PartId part) { return !left.contains(part); });
  const std::unordered_set<PartId> kept(parts.begin(), parts.end());
  const std::optional<PartId> current = model_->partAt(view_->currentIndex());
  for (const PartId part : chosen) {
    if (!kept.contains(part)) parts.push_back(part);
  }
  if (current && left.contains(*current) && !kept.contains(*current)) parts.push_back(*current);
  selection_.set(parts, rows.groups);
}

void PartsPanel::showSelection(Reveal reveal) {
  QItemSelection rows;
  const SceneNodes outer = outermost(scene_, selection_.nodes());
  addRows(*model_, outer.groups, rows);
  addRows(*model_, outer.parts, rows);
  const bool wasShowing = std::exchange(isShowing_, true);
  QItemSelectionModel& model = *view_->selectionModel();
  model.select(rows, QItemSelectionModel::ClearAndSelect | QItemSelectionModel::Rows);
  if (!model.isSelected(model.currentIndex())) {
    const QModelIndex current = selection_.current() ? model_->indexOf(*selection_.current()) : QModelIndex();
    if (current.isValid() && reveal == Reveal::Yes) view_->scrollTo(current);
    // The view scrolls by itself to a new current row.
    view_->setAutoScroll(reveal == Reveal::Yes);
    model.setCurrentIndex(current, QItemSelectionModel::NoUpdate);
    view_->setAutoScroll(true);
  }
  isShowing_ = wasShowing;
}

void PartsPanel::showFindings(std::map<PartId, FindingsBadge> findings) {
  view_->setColumnHidden(PartsModel::Findings, findings.empty());
  model_->setFindings(std::move(findings));
}

void PartsPanel::setMenuActions(const QList<QAction*>& actions) {
  view_->addActions(actions);
}

void PartsPanel::editName() {
  if (auto* dock = qobject_cast<QDockWidget*>(parentWidget())) {
    dock->show();
    dock->raise();
  }
  const QModelIndex row = view_->currentIndex().siblingAtColumn(PartsModel::Name);
  if (row.isValid() && view_->selectionModel()->isSelected(row)) view_->edit(row);
}

SceneNodes PartsPanel::nodesOf(const QModelIndex& index) const {
  if (view_->selectionModel()->isSelected(index)) return outermost(scene_, selection_.nodes());
  SceneNodes nodes;
  if (const std::optional<PartId> part = model_->partAt(index)) nodes.parts.push_back(*part);
  if (const std::optional<GroupId> group = model_->groupAt(index)) nodes.groups.push_back(*group);
  return nodes;
}

void PartsPanel::clickCell(const QModelIndex& index) {
  switch (index.column()) {
    case PartsModel::Moving:
      if (const std::optional<PartId> part = model_->partAt(index))
        emit movingPartRequested(scene_.isMoving(*part) ? std::nullopt : part);
      if (const std::optional<GroupId> group = model_->groupAt(index)) {
        if (scene_.movingGroup() == group)
          emit movingPartRequested(std::nullopt);
        else
          emit movingGroupRequested(*group);
      }
      break;
    case PartsModel::Visible:
      return toggleVisible(index);
    case PartsModel::Locked:
      return toggleLock(index);
    case PartsModel::Joints:
      if (const std::optional<PartId> part = model_->partAt(index)) emit jointToggleRequested(*part);
      break;
    case PartsModel::Findings:
      if (const std::optional<PartId> part = model_->partAt(index)) emit findingsRequested(*part);
      break;
    default:
      break;
  }
}

void PartsPanel::toggleVisible(const QModelIndex& index) {
  std::vector<PartId> here;
  if (const std::optional<PartId> part = model_->partAt(index)) here = {*part};
  if (const std::optional<GroupId> group = model_->groupAt(index)) here = partsOf(scene_, {{}, {*group}});
  // The clicked row decides which way all go.
  const bool isShown = std::ranges::all_of(here, [this](PartId id) { return scene_.find(id)->isVisible; });
  emit visibilityRequested(partsOf(scene_, nodesOf(index)), !isShown);
}

void PartsPanel::toggleLock(const QModelIndex& index) {
  bool isLocked = false;
  if (const std::optional<PartId> part = model_->partAt(index)) isLocked = scene_.find(*part)->isLocked;
  if (const std::optional<GroupId> group = model_->groupAt(index))
    isLocked = scene_.findGroup(*group)->isLocked;
  emit lockRequested(nodesOf(index), !isLocked);
}

}  // namespace nearfit::ui

#include "ui/panels/parts_panel.h"

#include <QAction>
#include <QHeaderView>
#include <QTreeView>
#include <QVBoxLayout>

#include "ui/parts_model.h"

namespace nearfit::ui {

PartsPanel::PartsPanel(QWidget* parent)
    : QWidget(parent), model_(new PartsModel(this)), view_(new QTreeView(this)) {
  view_->setObjectName(QStringLiteral("partsView"));
  view_->setModel(model_);
  view_->setRootIsDecorated(false);
  view_->setUniformRowHeights(true);
  view_->setHeaderHidden(true);
  view_->setSelectionBehavior(QAbstractItemView::SelectRows);
  view_->setSelectionMode(QAbstractItemView::SingleSelection);
  view_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed);
  view_->setContextMenuPolicy(Qt::ActionsContextMenu);
  view_->setIconSize(QSize(18, 18));
  view_->setIndentation(0);
  QHeaderView* header = view_->header();
  header->setStretchLastSection(false);
  header->setMinimumSectionSize(28);
  header->setSectionResizeMode(PartsModel::Name, QHeaderView::Stretch);
  for (const int column : {PartsModel::Moving, PartsModel::Visible, PartsModel::Locked}) {
    header->setSectionResizeMode(column, QHeaderView::Fixed);
    header->resizeSection(column, 30);
  }
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(view_);

  connect(view_, &QTreeView::clicked, this, &PartsPanel::clickCell);
  connect(view_->selectionModel(), &QItemSelectionModel::selectionChanged, this,
          &PartsPanel::selectionChanged);
  connect(model_, &PartsModel::renameRequested, this, &PartsPanel::renameRequested);
}

void PartsPanel::setScene(const Scene& scene) {
  const std::optional<PartId> before = selected();
  scene_ = scene;
  model_->setScene(scene);
  if (before != selected()) select(before);
}

std::optional<PartId> PartsPanel::selected() const {
  const QModelIndexList rows = view_->selectionModel()->selectedRows();
  return rows.isEmpty() ? std::nullopt : model_->partAt(rows.first());
}

void PartsPanel::select(std::optional<PartId> part) {
  const QModelIndex index = part ? model_->indexOf(*part) : QModelIndex();
  if (index.isValid()) {
    view_->setCurrentIndex(index);
  } else {
    view_->setCurrentIndex({});
    view_->clearSelection();
  }
  // A reset of the model drops the selection without a signal.
  emit selectionChanged();
}

void PartsPanel::setMenuActions(const QList<QAction*>& actions) {
  view_->addActions(actions);
}

void PartsPanel::editName() {
  if (const std::optional<PartId> part = selected()) view_->edit(model_->indexOf(*part));
}

void PartsPanel::clickCell(const QModelIndex& index) {
  const std::optional<PartId> id = model_->partAt(index);
  const Part* part = id ? scene_.find(*id) : nullptr;
  if (part == nullptr) return;
  const bool isMoving = scene_.movingPart() == part->id;
  switch (index.column()) {
    case PartsModel::Moving:
      emit movingPartRequested(isMoving ? std::nullopt : id);
      break;
    case PartsModel::Visible:
      emit visibilityRequested(part->id, !part->isVisible);
      break;
    case PartsModel::Locked:
      emit lockRequested(part->id, !part->isLocked);
      break;
    default:
      break;
  }
}

}  // namespace nearfit::ui

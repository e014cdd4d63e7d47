#include "ui/panels/parts/parts_view.h"

#include <QApplication>
#include <QEvent>
#include <QPalette>

#include "ui/model/parts_model.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

PartsView::PartsView(QWidget* parent) : QTreeView(parent) {
  setUniformRowHeights(true);
  setHeaderHidden(true);
  setSelectionBehavior(QAbstractItemView::SelectRows);
  setSelectionMode(QAbstractItemView::ExtendedSelection);
  setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed);
  setContextMenuPolicy(Qt::ActionsContextMenu);
  setIconSize(QSize(18, 18));
  setIndentation(16);
  setExpandsOnDoubleClick(false);
  setDragDropMode(QAbstractItemView::DragDrop);
  setDefaultDropAction(Qt::MoveAction);
  setDragEnabled(true);
  setDropIndicatorShown(true);
  setAutoExpandDelay(600);
  showHighlight();
}

// The style itself fills the indentation of a selected row: let it use the style sheet's colour.
void PartsView::showHighlight() {
  const QColor fill = themed(QColor(0xd3, 0xe5, 0xf8));
  QPalette pale = QApplication::palette();
  if (palette().color(QPalette::Highlight) == fill) return;
  pale.setColor(QPalette::Highlight, fill);
  pale.setColor(QPalette::HighlightedText, pale.color(QPalette::Text));
  setPalette(pale);
}

void PartsView::changeEvent(QEvent* event) {
  QTreeView::changeEvent(event);
  if (event->type() == QEvent::PaletteChange || event->type() == QEvent::StyleChange) showHighlight();
}

void PartsView::setFilter(const QString& text) {
  for (int row = 0; row < model()->rowCount(); ++row)
    filterRow(row, {}, text, false);
}

bool PartsView::filterRow(int row, const QModelIndex& parent, const QString& text, bool isWithinMatch) {
  const QModelIndex index = model()->index(row, PartsModel::Name, parent);
  // Members of a matching group stay too.
  const bool isMatch = isWithinMatch || index.data().toString().contains(text, Qt::CaseInsensitive);
  bool stays = isMatch;
  for (int child = 0; child < model()->rowCount(index); ++child)
    stays = filterRow(child, index, text, isMatch) || stays;
  if (isRowHidden(row, parent) == stays) setRowHidden(row, parent, !stays);
  if (!text.isEmpty() && stays && model()->rowCount(index) > 0) expand(index);
  return stays;
}

QItemSelectionModel::SelectionFlags PartsView::selectionCommand(const QModelIndex& index,
                                                                const QEvent* event) const {
  const bool isMouse =
      event != nullptr && (event->type() == QEvent::MouseButtonPress ||
                           event->type() == QEvent::MouseButtonRelease || event->type() == QEvent::MouseMove);
  if (isMouse && index.isValid() && index.column() != PartsModel::Name) return QItemSelectionModel::NoUpdate;
  return QTreeView::selectionCommand(index, event);
}

}  // namespace nearfit::ui

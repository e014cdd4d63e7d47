#include "ui/panels/parts/parts_view.h"

#include <QApplication>
#include <QEvent>
#include <QKeyEvent>
#include <QLineEdit>
#include <QPalette>
#include <QToolTip>
#include <utility>

#include "ui/model/parts_model.h"
#include "ui/widgets/fault_style.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

QString textOf(const QWidget& editor) {
  const auto* line = qobject_cast<const QLineEdit*>(&editor);
  return line != nullptr ? line->text() : QString();
}

bool isFinish(int key) {
  return key == Qt::Key_Return || key == Qt::Key_Enter || key == Qt::Key_Tab || key == Qt::Key_Backtab;
}

}  // namespace

NameDelegate::NameDelegate(Refusal refusal, QObject* parent)
    : QStyledItemDelegate(parent), refusal_(std::move(refusal)) {}

QWidget* NameDelegate::createEditor(QWidget* parent, const QStyleOptionViewItem& option,
                                    const QModelIndex& index) const {
  edited_ = index;
  QWidget* editor = QStyledItemDelegate::createEditor(parent, option, index);
  if (auto* line = qobject_cast<QLineEdit*>(editor)) {
    connect(line, &QLineEdit::textEdited, line, [line] {
      line->setStyleSheet({});
      line->setAccessibleDescription({});
      QToolTip::hideText();
    });
  }
  return editor;
}

bool NameDelegate::mark(QWidget& editor) const {
  const QString reason = edited_.isValid() ? refusal_(edited_, textOf(editor)) : QString();
  if (reason.isEmpty()) return false;
  editor.setStyleSheet(QLatin1String(kFaultyStyle));
  editor.setAccessibleDescription(reason);
  QToolTip::showText(editor.mapToGlobal(QPoint(0, editor.height())), reason, &editor, editor.rect(),
                     kFaultTime);
  return true;
}

bool NameDelegate::eventFilter(QObject* watched, QEvent* event) {
  auto* editor = qobject_cast<QWidget*>(watched);
  const bool isDone = event->type() == QEvent::KeyPress && isFinish(static_cast<QKeyEvent*>(event)->key());
  if (editor != nullptr && isDone && mark(*editor)) return true;
  // The editor waits for the user to return, but must know that it has lost the focus.
  if (editor != nullptr && event->type() == QEvent::FocusOut && mark(*editor)) return false;
  return QStyledItemDelegate::eventFilter(watched, event);
}

void NameDelegate::setModelData(QWidget* editor, QAbstractItemModel* model, const QModelIndex& index) const {
  const QString reason = refusal_(index, textOf(*editor));
  if (reason.isEmpty()) return QStyledItemDelegate::setModelData(editor, model, index);
  emit refused(reason);
}

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

#include "ui/panels/parts/name_delegate.h"

#include <QKeyEvent>
#include <QLineEdit>
#include <QToolTip>
#include <utility>

#include "ui/widgets/fault_style.h"

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

}  // namespace nearfit::ui

#include "tests/app/desktop/monkey/dialog_answers.h"

#include <QAbstractSpinBox>
#include <QApplication>
#include <QDialog>
#include <QFileDialog>
#include <QLineEdit>
#include <QMenu>
#include <QTimer>

#include "tests/app/desktop/desktop_driver.h"
#include "tests/app/desktop/monkey/monkey_hands.h"

namespace nearfit::test {

using namespace monkey;

namespace {

constexpr int kBetweenMs = 5, kMaxTries = 10;

}  // namespace

DialogAnswers::DialogAnswers(const MonkeyFiles& files, unsigned seed) : files_(files), random_(seed) {
  schedule();
}

bool DialogAnswers::isSomethingOpen() {
  return QApplication::activePopupWidget() != nullptr || QApplication::activeModalWidget() != nullptr;
}

/// A new timer each time: one whose slot waits inside a dialog does not fire in there.
void DialogAnswers::schedule() {
  QTimer::singleShot(kBetweenMs, this, [this] {
    schedule();
    answer();
  });
}

void DialogAnswers::answer() {
  if (QWidget* popup = QApplication::activePopupWidget()) return answerPopup(*popup);
  QWidget* modal = QApplication::activeModalWidget();
  if (modal == nullptr || !modal->isVisible()) return;
  if (auto* files = qobject_cast<QFileDialog*>(modal)) return answerFiles(*files);
  answerDialog(*modal);
}

int DialogAnswers::triesWith(QWidget& widget) {
  if (last_ != &widget) {
    last_ = &widget;
    tries_ = 0;
    say(QStringLiteral("  opened: %1 '%2'").arg(nameOf(widget), widget.windowTitle()));
  }
  return ++tries_;
}

void DialogAnswers::close(QWidget& widget) {
  say(QStringLiteral("  close it"));
  if (auto* dialog = qobject_cast<QDialog*>(&widget)) {
    dialog->reject();
  } else {
    widget.close();
  }
}

void DialogAnswers::answerPopup(QWidget& popup) {
  if (triesWith(popup) > kMaxTries) return close(popup);
  const double how = random_.in(0.0, 1.0);
  if (how < 0.2) {
    const QPoint at = placeIn(popup, random_);
    say(QStringLiteral("  click %1,%2 in it").arg(at.x()).arg(at.y()));
    return click(&popup, at);
  }
  const int keys[] = {Qt::Key_Down, Qt::Key_Down, Qt::Key_Up, Qt::Key_Right, Qt::Key_Return, Qt::Key_Escape};
  const int key = keys[pick(random_, 6)];
  say(QStringLiteral("  key %1 in it").arg(key, 0, 16));
  press(&popup, key);
}

void DialogAnswers::answerFiles(QFileDialog& dialog) {
  if (triesWith(dialog) > 4 || random_.flip(0.2)) return close(dialog);
  const bool isSaving = dialog.acceptMode() == QFileDialog::AcceptSave;
  const QString file = isSaving ? files_.forSaving(dialog.defaultSuffix(), random_) : files_.any(random_);
  // What it would open by itself, or by a click, is anywhere; a folder it would only go into.
  if (QFileInfo(file).isDir()) return close(dialog);
  say(QStringLiteral("  choose %1").arg(file));
  chooseFile(&dialog, file);
}

void DialogAnswers::answerDialog(QWidget& dialog) {
  if (triesWith(dialog) > kMaxTries) return close(dialog);
  QList<QWidget*> usable;
  for (QWidget* child : dialog.findChildren<QWidget*>()) {
    if (child->isVisible() && child->isEnabled() && child->window() == &dialog) usable << child;
  }
  if (usable.isEmpty() || random_.flip(0.2)) {
    const int key = random_.flip(0.5) ? Qt::Key_Return : Qt::Key_Escape;
    say(QStringLiteral("  key %1").arg(key, 0, 16));
    return press(&dialog, key);
  }
  QWidget* widget = usable[pick(random_, usable.size())];
  if (qobject_cast<QLineEdit*>(widget) != nullptr && random_.flip(0.5)) {
    const QString text = someText(random_);
    say(QStringLiteral("  type '%1' into %2").arg(text, nameOf(*widget)));
    return type(widget, text);
  }
  const QPoint at = placeIn(*widget, random_);
  say(QStringLiteral("  click %1 at %2,%3").arg(nameOf(*widget)).arg(at.x()).arg(at.y()));
  click(widget, at);
}

}  // namespace nearfit::test

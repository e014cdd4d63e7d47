#pragma once

#include <QDialog>
#include <QElapsedTimer>
#include <QPointer>
#include <QTimer>
#include <deque>
#include <functional>
#include <utility>

#include "tests/app/desktop/desktop_driver.h"

namespace nearfit::test {

/// Answers the modal dialogs of a test in the order in which it expects them, from a timer while it exists. Rejects any
/// other dialog, and one that is not answered in time: the test then fails instead of hanging in the call that opened the
/// dialog. Leaves progress dialogs alone, which end by themselves, unless one is expected.
class DialogAnswers {
 public:
  /// Answers a dialog. False: it does not take an answer yet, and is asked again.
  using Answer = std::function<bool(QDialog&)>;

  DialogAnswers() {
    timer_.setInterval(10);
    QObject::connect(&timer_, &QTimer::timeout, &timer_, [this] { look(); });
    timer_.start();
  }

  /// @param kind  Object name of the dialog; "file" for one that chooses files.
  DialogAnswers& expect(const QString& kind, Answer answer) {
    expected_.emplace_back(kind, std::move(answer));
    return *this;
  }
  DialogAnswers& expectFile(const QString& file) {
    return expect(QStringLiteral("file"), [file](QDialog& dialog) {
      chooseFile(qobject_cast<QFileDialog*>(&dialog), file);
      return !dialog.isVisible();
    });
  }
  DialogAnswers& expectButton(const QString& kind, QDialogButtonBox::StandardButton button) {
    return expect(kind, [button](QDialog& dialog) {
      auto* choice = dialog.findChild<QDialogButtonBox*>()->button(button);
      if (choice == nullptr || !choice->isEnabled()) return false;
      QTest::mouseClick(choice, Qt::LeftButton);
      // A progress dialog that is cancelled stays until the work has ended.
      return true;
    });
  }
  /// Dialogs that came unexpected or took no answer; then those that did not come.
  QStringList faults() const {
    QStringList all = rejected_;
    for (const auto& [kind, answer] : expected_)
      all << QStringLiteral("no ") + kind;
    return all;
  }

 private:
  static QString kindOf(const QDialog& dialog) {
    const bool choosesFiles = qobject_cast<const QFileDialog*>(&dialog) != nullptr;
    return choosesFiles ? QStringLiteral("file") : dialog.objectName();
  }

  void look() {
    auto* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
    // An answer may run an event loop.
    if (isAnswering_ || dialog == nullptr || !dialog->isVisible()) return;
    if (dialog != seen_) {
      seen_ = dialog;
      since_.start();
    }
    const QString kind = kindOf(*dialog);
    const bool isExpected = !expected_.empty() && expected_.front().first == kind;
    if (!isExpected && kind == QStringLiteral("progressDialog")) return;
    if (isExpected && since_.elapsed() < kQtPatienceMs) {
      const Answer answer = expected_.front().second;
      isAnswering_ = true;
      if (answer(*dialog)) expected_.pop_front();
      isAnswering_ = false;
      return;
    }
    rejected_ << kind;
    dialog->reject();
  }

  QTimer timer_;
  std::deque<std::pair<QString, Answer>> expected_;
  QStringList rejected_;
  QPointer<QDialog> seen_;
  QElapsedTimer since_;  ///< Since `seen_` was seen first.
  bool isAnswering_ = false;
};

/// Opens a file by Ctrl+O.
inline void pressOpen(DesktopDriver& d, DialogAnswers& answers, const QString& file) {
  answers.expectFile(file);
  pressShortcut(d, Qt::Key_O, Qt::ControlModifier);
}

}  // namespace nearfit::test

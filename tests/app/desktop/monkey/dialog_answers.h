#pragma once

#include <QObject>
#include <QPointer>

#include "tests/app/desktop/monkey/monkey_files.h"

class QDialog;
class QFileDialog;
class QWidget;

namespace nearfit::test {

/// Answers modal dialogs and menus by random means, from inside the calls that wait for them; each is closed
/// after some tries. File dialogs are only given names in a temporary folder: they could do anything there
/// is.
class DialogAnswers : public QObject {
 public:
  DialogAnswers(const MonkeyFiles& files, unsigned seed);

  /// Whether something is open that the window waits for.
  static bool isSomethingOpen();

 private:
  void schedule();
  void answer();
  void answerPopup(QWidget& popup);
  void answerFiles(QFileDialog& dialog);
  void answerDialog(QWidget& dialog);
  void close(QWidget& widget);
  /// How often it has been tried with this one.
  int triesWith(QWidget& widget);

  const MonkeyFiles& files_;
  RandomValues random_;
  QPointer<QWidget> last_;
  int tries_ = 0;
};

}  // namespace nearfit::test

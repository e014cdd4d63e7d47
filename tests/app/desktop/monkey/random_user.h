#pragma once

#include <memory>

#include "tests/app/desktop/desktop_driver.h"
#include "tests/app/desktop/fake_device.h"
#include "tests/app/desktop/monkey/dialog_answers.h"
#include "tests/app/desktop/monkey/monkey_files.h"

namespace nearfit::test {

/// Somebody who does anything at all with the window, by real events, one after the other. The same seed does
/// the same, as far as threads let it. Each act is a line of the log.
class RandomUser {
 public:
  /// @param driver, devices, files  Outlive this; the devices are the driver's.
  RandomUser(DesktopDriver& driver, FakeSource& devices, MonkeyFiles& files, unsigned seed);

  void act();
  /// Lets go of everything, and waits until nothing is under way. False when that does not come.
  bool settle();

 private:
  struct Act {
    double weight;
    void (RandomUser::*act)();
  };
  static const std::vector<Act>& acts();

  // In the view.
  void dragInView();
  void clickInView();
  void wheelInView();
  QPoint placeInView();
  // Anywhere.
  void useWidget();
  void typeNumber();
  void pressKey();
  void triggerAction();
  void openMenu();
  void useList();
  // From outside.
  void dropFiles();
  void feel();
  void changeDevices();
  void changeFile();
  void resize();
  void wait();

  void moveBesideTheHand();
  void keepSmall();
  QList<QAction*> actions() const;
  ui::MainWindow& window() { return d_.window(); }

  DesktopDriver& d_;
  FakeSource& devices_;
  MonkeyFiles& files_;
  RandomValues random_;
  int acts_ = 0;
  DialogAnswers answers_;
};

}  // namespace nearfit::test

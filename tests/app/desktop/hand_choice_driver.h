#pragma once

#include <QComboBox>

#include "tests/app/desktop/desktop_driver.h"
#include "tests/support/eventually.h"

namespace nearfit::test {

/// Waits for a hand whose name has `name` in it, and chooses it by keys.
inline void chooseHandNamed(DesktopDriver& d, const QString& name) {
  auto* box = d.widget<QComboBox>("hand");
  QTRY_VERIFY(box->findText(name, Qt::MatchContains) >= 0);
  const int wanted = box->findText(name, Qt::MatchContains);
  box->setFocus();
  for (int keys = 0; keys < 10 && box->currentIndex() != wanted; ++keys)
    QTest::keyClick(box, box->currentIndex() < wanted ? Qt::Key_Down : Qt::Key_Up);
  QCOMPARE(box->currentIndex(), wanted);
}

/// Arms the device in hand and waits. Where a thread does not run for 20 ms the device is stopped, and has to be: its user
/// resets it and arms it again.
template <class Condition>
bool armedUntil(DesktopDriver& d, Condition&& isTrue) {
  return eventually([&] {
    QTest::qWait(10);
    const ui::ServoStatus& status = d.application.servo().status();
    if (status.isArmed && isTrue()) return true;
    if (status.isBusy || status.isArmed) return false;
    for (const char* name : {"resetDevice", "arm"}) {
      auto* button = d.widget<QPushButton>(name);
      if (!button->isVisible()) continue;
      QTest::mouseClick(button, Qt::LeftButton);
      break;
    }
    return false;
  });
}

}  // namespace nearfit::test

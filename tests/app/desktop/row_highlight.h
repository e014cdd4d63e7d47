#pragma once

#include <QLabel>
#include <QTableView>
#include <functional>

#include "tests/app/desktop/desktop_driver.h"

namespace nearfit::test {

/// A table of pairs of parts, a row of which the view shows with a label.
struct PairTable {
  QTableView& table;
  QLabel& label;
  std::function<void()> clickRow;  ///< Clicks a row whose pair is shown.
};

/// Checks that the view shows a pair until another part is selected, or Escape is pressed in the view or in the table, which
/// leaves the selection alone.
/// @param first, other  Parts that are selected before and after.
inline void checkThatAPairIsShownUntilTheNextSelectionOrEscape(DesktopDriver& d, const PairTable& pairs,
                                                               const char* first, const char* other) {
  ui::Selection& selection = d.window().selection();
  selection.set({d.partId(first)});
  const auto showPair = [&] {
    pairs.clickRow();
    return QTest::qWaitFor([&pairs] { return pairs.label.isVisible(); });
  };
  QVERIFY(showPair());
  selection.set({d.partId(other)});
  QVERIFY(!pairs.label.isVisible());
  QVERIFY(!pairs.table.selectionModel()->hasSelection());
  QVERIFY2(showPair(), "another click of the same row shows it again");
  const std::vector<PartId> selected = selection.parts();
  for (QWidget* focus :
       {static_cast<QWidget*>(&d.window().viewport()), static_cast<QWidget*>(&pairs.table)}) {
    QTest::keyClick(focus, Qt::Key_Escape);
    QVERIFY(!pairs.label.isVisible());
    QVERIFY2(selection.parts() == selected, "the selection is the user's");
    QVERIFY(showPair());
  }
  // The view shows no pair then.
  const QImage with = d.picture();
  QTest::keyClick(&pairs.table, Qt::Key_Escape);
  QVERIFY(differentPixels(d.picture(), with) > 100);
}

}  // namespace nearfit::test

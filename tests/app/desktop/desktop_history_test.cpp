#include <QDockWidget>
#include <QListView>
#include <QMenu>
#include <QStatusBar>

#include "tests/app/desktop/desktop_driver.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

const RigidTransform kAside{{1, 0, 0, 0}, {0.1, 0.0, 0.0}}, kAbove{{1, 0, 0, 0}, {0.0, 0.0, 0.2}};

QStringList rows(const QListView& view) {
  QStringList texts;
  for (int row = 0; row < view.model()->rowCount(); ++row)
    texts << view.model()->index(row, 0).data().toString();
  return texts;
}

void clickRow(QListView* view, int row) {
  const QModelIndex index = view->model()->index(row, 0);
  view->scrollTo(index);
  QTest::mouseClick(view->viewport(), Qt::LeftButton, {}, view->visualRect(index).center());
}

bool isBold(const QListView& view, int row) {
  return view.model()->index(row, 0).data(Qt::FontRole).value<QFont>().bold();
}

}  // namespace

class DesktopHistoryTest : public QObject {
  Q_OBJECT

 private slots:
  void listsTheStepsAndMarksThePresentOne();
  void clickGoesThere();
  void keysGoThereToo();
  void menuNamesTheStep();
  void theStatusBarSaysWhatWasUndoneAndRedone();
  void whatComesBackIsSeenFromWhereItWas();
};

void DesktopHistoryTest::listsTheStepsAndMarksThePresentOne() {
  DesktopDriver d;
  auto* view = d.widget<QListView>("historyView");
  QCOMPARE(rows(*view), QStringList{QStringLiteral("Beginning")});
  d.addCubes();
  d.session().movePart(d.partId("fixed"), kAside);
  const QStringList all{QStringLiteral("Beginning"), QStringLiteral("Add 2 parts"),
                        QStringLiteral("Make moving the moving part"), QStringLiteral("Move fixed, 100 mm")};
  QCOMPARE(rows(*view), all);
  QVERIFY(isBold(*view, 3));
  pressShortcut(d, Qt::Key_Z, Qt::ControlModifier);
  QCOMPARE(rows(*view), all);
  QVERIFY(isBold(*view, 2));
  QVERIFY(!isBold(*view, 3));
  d.choose("unit-in");
  QCOMPARE(rows(*view).last(), QStringLiteral("Move fixed, 3.94 in"));
  d.choose("unit-mm");
  QCOMPARE(rows(*view), all);
}

void DesktopHistoryTest::clickGoesThere() {
  DesktopDriver d;
  d.addCubes();
  d.session().movePart(d.partId("fixed"), kAside);
  d.session().movePart(d.partId("fixed"), kAbove);
  d.widget<QDockWidget>("historyDock")->raise();
  auto* view = d.widget<QListView>("historyView");
  QTRY_VERIFY(view->isVisible());
  clickRow(view, 3);
  QCOMPARE(d.part("fixed").worldFromPart.translation.x, 0.1);
  clickRow(view, 0);
  QVERIFY(d.session().scene().parts().empty());
  clickRow(view, 4);
  QCOMPARE(d.part("fixed").worldFromPart.translation.z, 0.2);
}

void DesktopHistoryTest::keysGoThereToo() {
  DesktopDriver d;
  d.addCubes();
  d.widget<QDockWidget>("historyDock")->raise();
  auto* view = d.widget<QListView>("historyView");
  QTRY_VERIFY(view->isVisible());
  view->setFocus();
  QTest::keyClick(view, Qt::Key_Home);
  QCOMPARE(d.session().scene().parts().size(), std::size_t{2});
  QTest::keyClick(view, Qt::Key_Return);
  QVERIFY(d.session().scene().parts().empty());
}

void DesktopHistoryTest::menuNamesTheStep() {
  DesktopDriver d;
  d.addCubes();
  d.session().renamePart(d.partId("fixed"), "Nut & bolt");
  d.session().movePart(d.partId("Nut & bolt"), kAside);
  QCOMPARE(d.action("undo")->text(), QStringLiteral("&Undo Move Nut && bolt"));
  d.choose("undo");
  QCOMPARE(d.action("redo")->text(), QStringLiteral("&Redo Move Nut && bolt"));
}

/// Undo of a feel setting is not seen in the view.
void DesktopHistoryTest::theStatusBarSaysWhatWasUndoneAndRedone() {
  DesktopDriver d;
  d.addCubes();
  const QStatusBar* bar = d.window().statusBar();
  d.session().renamePart(d.partId("fixed"), "Nut & bolt");
  d.session().movePart(d.partId("Nut & bolt"), kAside);
  HapticSettings settings = d.session().scene().haptics();
  settings.proxy.friction = 0.25;
  d.session().setHaptics(settings);
  pressShortcut(d, Qt::Key_Z, Qt::ControlModifier);
  QCOMPARE(bar->currentMessage(), QStringLiteral("Undone: Feel settings: friction"));
  pressShortcut(d, Qt::Key_Z, Qt::ControlModifier);
  QCOMPARE(bar->currentMessage(), QStringLiteral("Undone: Move Nut & bolt"));
  pressShortcut(d, Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
  QCOMPARE(bar->currentMessage(), QStringLiteral("Redone: Move Nut & bolt"));
  pressShortcut(d, Qt::Key_Y, Qt::ControlModifier);
  QCOMPARE(bar->currentMessage(), QStringLiteral("Redone: Feel settings: friction"));
}

void DesktopHistoryTest::whatComesBackIsSeenFromWhereItWas() {
  DesktopDriver d;
  d.addCubes();
  d.choose("viewFront");
  const glm::dvec3 away = d.window().viewport().projection().away();
  d.choose("selectAll");
  d.choose("remove");
  QVERIFY(d.session().scene().parts().empty());
  d.choose("undo");
  QCOMPARE(d.session().scene().parts().size(), std::size_t{2});
  QVERIFY(glm::distance(d.window().viewport().projection().away(), away) < 1e-12);
}

NEARFIT_QT_SUITE(DesktopHistoryTest, runDesktopTest<DesktopHistoryTest>)
#include "desktop_history_test.moc"

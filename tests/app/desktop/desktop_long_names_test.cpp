#include <QComboBox>
#include <QDockWidget>
#include <QMenu>

#include "tests/app/desktop/desktop_driver.h"
#include "ui/model/parts_model.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// The longest that a part may be called, of the widest letter.
const std::string kLong(195, 'W');

/// What must not depend on how long a name is.
QVector<QSize> sizesOf(DesktopDriver& d) {
  QVector<QSize> sizes{d.window().size(), d.window().minimumSizeHint()};
  for (const QDockWidget* dock : d.window().findChildren<QDockWidget*>())
    sizes << dock->size() << dock->minimumSizeHint();
  return sizes;
}

}  // namespace

class DesktopLongNamesTest : public QObject {
  Q_OBJECT

 private slots:
  void theWindowAndItsDocksStayAsWideAsTheyWere();
  void theHeadingIsWholeInItsToolTip();
  void whatUndoTakesBackIsCutInTheMenu();
};

void DesktopLongNamesTest::theWindowAndItsDocksStayAsWideAsTheyWere() {
  DesktopDriver d;
  d.addCubes();
  for (const char* dock : {"clearanceDock", "timelineDock"})
    d.choose(panelEntry(d.widget<QDockWidget>(dock)));
  d.clickPart(1, ui::PartsModel::Name);
  QTRY_COMPARE(d.text("poseHeading"), QStringLiteral("moving"));
  QTest::qWait(100);
  const QVector<QSize> before = sizesOf(d);
  d.session().renamePart(d.partId("moving"), kLong);
  QTRY_COMPARE(d.text("poseHeading").size(), 195);
  QTest::qWait(100);
  QCOMPARE(sizesOf(d), before);
  QVERIFY(d.widget<QComboBox>("clearancePart")->currentText().contains(QString::fromStdString(kLong)));
  keepPictures(d.window(), QStringLiteral("long-name"));
}

void DesktopLongNamesTest::theHeadingIsWholeInItsToolTip() {
  DesktopDriver d;
  d.addCubes();
  d.session().renamePart(d.partId("moving"), kLong);
  d.clickPart(1, ui::PartsModel::Name);
  auto* heading = d.widget<QLabel>("poseHeading");
  QTRY_VERIFY(heading->toolTip().contains(QString::fromStdString(kLong)));
  QVERIFY(heading->width() <= d.widget<QDockWidget>("poseDock")->width());
}

void DesktopLongNamesTest::whatUndoTakesBackIsCutInTheMenu() {
  DesktopDriver d;
  d.addCubes();
  d.session().renamePart(d.partId("moving"), kLong);
  QVERIFY(d.action("undo")->text().startsWith(QStringLiteral("&Undo Rename moving to")));
  QVERIFY2(d.action("undo")->text().size() < 60, qPrintable(d.action("undo")->text()));
  d.session().undo();
  QVERIFY(d.action("redo")->text().size() < 60);
}

NEARFIT_QT_SUITE(DesktopLongNamesTest, runDesktopTest<DesktopLongNamesTest>)
#include "desktop_long_names_test.moc"

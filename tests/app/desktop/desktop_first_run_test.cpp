#include <QSettings>

#include "tests/app/desktop/desktop_driver.h"
#include "ui/widgets/preferences.h"

using namespace nearfit;
using namespace nearfit::test;

/// What the program shows when it is started, the first time and later.
class DesktopFirstRunTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void theFirstRunExplainsItselfOnTheDemo();
  void laterRunsStartEmpty();
  void aFirstRunWithFilesOpensThemAlone();
  void theDemoThatIsAskedForIsNeverSavedOver();
};

void DesktopFirstRunTest::theFirstRunExplainsItselfOnTheDemo() {
  DesktopDriver d;
  d.application.show({}, false);
  QTRY_VERIFY(d.widget<QFrame>("tour")->isVisible());
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{4});
  QVERIFY(d.session().scene().movingPart());
  QVERIFY(!d.session().isModified());
  QVERIFY(d.text("tourText").contains(QStringLiteral("scene")));
  QTest::keyClick(d.widget<QPushButton>("tourNext"), Qt::Key_Escape);
  QTRY_VERIFY(!d.widget<QFrame>("tour")->isVisible());
}

void DesktopFirstRunTest::laterRunsStartEmpty() {
  DesktopDriver first;
  first.application.show({}, false);
  QTRY_VERIFY(first.widget<QFrame>("tour")->isVisible());
  DesktopDriver second;
  second.application.show({}, false);
  QTRY_VERIFY(second.widget<QFrame>("welcome")->isVisible());
  QTest::qWait(500);
  QVERIFY(!second.widget<QFrame>("tour")->isVisible());
  QVERIFY(second.session().scene().parts().empty());
}

void DesktopFirstRunTest::aFirstRunWithFilesOpensThemAlone() {
  DesktopDriver d;
  d.addCubes();
  const QString scene = QString::fromStdString((d.folder.path() / "own.nearfit").string());
  d.session().save(scene.toStdString());
  DesktopDriver first;
  first.application.show({scene}, false);
  QTRY_COMPARE(first.session().scene().parts().size(), std::size_t{2});
  QVERIFY(!first.widget<QFrame>("tour")->isVisible());
  // That was the first run: the next says nothing either.
  DesktopDriver second;
  second.application.show({}, false);
  QTest::qWait(500);
  QVERIFY(!second.widget<QFrame>("tour")->isVisible());
}

void DesktopFirstRunTest::theDemoThatIsAskedForIsNeverSavedOver() {
  ui::Preferences::takeFirstRun();
  DesktopDriver d;
  d.application.show({}, true);
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{4});
  QVERIFY(!d.widget<QFrame>("tour")->isVisible());
  QVERIFY(d.session().file().empty());
}

NEARFIT_QT_SUITE(DesktopFirstRunTest, runDesktopTest<DesktopFirstRunTest>)
#include "desktop_first_run_test.moc"

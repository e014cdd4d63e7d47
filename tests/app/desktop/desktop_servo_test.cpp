#include <QComboBox>
#include <QDoubleSpinBox>
#include <QMessageBox>
#include <QStatusBar>
#include <QToolButton>

#include "tests/app/desktop/desktop_driver.h"
#include "ui/model/parts_model.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// Chooses a hand in the list as a user does and starts the servo by its button.
void startWith(DesktopDriver& d, ui::Hand hand) {
  auto* box = d.widget<QComboBox>("hand");
  box->setFocus();
  QTest::keyClick(box, Qt::Key_Home);
  for (int i = 0; i < box->count() && box->currentData().value<ui::Hand>() != hand; ++i) {
    QTest::keyClick(box, Qt::Key_Down);
  }
  QCOMPARE(box->currentData().value<ui::Hand>(), hand);
  QTest::mouseClick(d.widget<QPushButton>("startStop"), Qt::LeftButton);
  QTRY_VERIFY(d.application.servo().isRunning());
  // On a busy machine there was a dialog that showed progress, and without a window manager nobody gives
  // the window the keys back.
  QTRY_VERIFY(QApplication::activeModalWidget() == nullptr);
  QApplication::setActiveWindow(&d.window());
}

/// The moving part goes where the hand is, and each minimum pushes: what the tests of springs are about.
void useSprings(DesktopDriver& d) {
  HapticSettings settings = d.session().scene().haptics();
  settings.mode = HapticMode::Springs;
  d.session().setHaptics(settings);
}

}  // namespace

class DesktopServoTest : public QObject {
  Q_OBJECT

 private slots:
  void needsAMovingPart();
  void aGreyFeelSaysWhyInItsTips();
  void aPartThatWasAddedIsSelectedAndTakenInHandByOneClick();
  void hierarchiesAreBuiltInTheBackgroundBeforeItStarts();
  void showsTheOneMinimumBetweenTwoFaces();
  void rateCountsTheTicksOfTheServosOwnTime();
  void manualHandFollowsKeysAndNumbers();
  void scriptedHandClosesThreeQuartersOfTheGapOfSprings();
  void whatHasMovedInHandIsMarkedAsNotSavedAtOnce();
  void stoppingIsOneStepOfUndo();
  void springsChangeWhileItRuns();
  void partsComeAndGoWhileItRuns();
  void deletingThePartInHandStops();
  void undoThatTakesThePartOutOfTheHandSaysSo();
  void anotherSceneStopsThoughItsIdsAreTheSame();
  void restingServoDrawsNothing();
};

void DesktopServoTest::needsAMovingPart() {
  DesktopDriver d;
  d.addCubes();
  d.session().setMovingPart(std::nullopt);
  QVERIFY(!d.widget<QPushButton>("startStop")->isEnabled());
  d.clickPart(1, ui::PartsModel::Name);
  pressShortcut(d, Qt::Key_H, Qt::ControlModifier);
  QVERIFY(d.widget<QPushButton>("startStop")->isEnabled());
}

void DesktopServoTest::aGreyFeelSaysWhyInItsTips() {
  DesktopDriver d;
  QAction* start = d.action("start");
  const auto* button = d.widget<QPushButton>("startStop");
  const auto says = [&](const QString& word) {
    return !start->isEnabled() && start->toolTip().contains(word) && start->statusTip().contains(word) &&
           !button->isEnabled() && button->toolTip().contains(word) && button->statusTip().contains(word) &&
           d.text("whyNotFelt").contains(word);
  };
  QVERIFY(says(QStringLiteral("two parts")));
  QVERIFY(!d.widget<QToolButton>("takeInHandButton")->isVisible());
  d.addCubes();
  QVERIFY(start->isEnabled() && start->statusTip().isEmpty() && button->toolTip().isEmpty());
  QVERIFY(start->toolTip().contains(QStringLiteral("F5")));
  QVERIFY(!d.widget<QLabel>("whyNotFelt")->isVisible());
  d.session().setMovingPart(std::nullopt);
  QVERIFY(says(QStringLiteral("Ctrl+H")));
}

void DesktopServoTest::aPartThatWasAddedIsSelectedAndTakenInHandByOneClick() {
  DesktopDriver d;
  d.add({d.movingFile});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{1});
  d.window().document().addParts({d.fixedFile}, 1e-3);
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2});
  QTRY_COMPARE(d.window().selection().current(), std::optional(d.partId("fixed")));
  QCOMPARE(d.window().selection().parts().size(), std::size_t{1});
  auto* take = d.widget<QToolButton>("takeInHandButton");
  QTRY_VERIFY(take->isVisible() && take->isEnabled());
  QTest::mouseClick(take, Qt::LeftButton);
  QCOMPARE(d.session().scene().movingPart(), std::optional(d.partId("fixed")));
  QVERIFY(!take->isVisible());
  QVERIFY(d.widget<QPushButton>("startStop")->isEnabled());
}

void DesktopServoTest::hierarchiesAreBuiltInTheBackgroundBeforeItStarts() {
  DesktopDriver d;
  d.addCubes();
  // Showing, naming and moving parts needs none.
  d.clickPart(1, ui::PartsModel::Name);
  d.type<QDoubleSpinBox>("positionX", "1");
  QVERIFY(!areHierarchiesReady(d.session().scene().geometries()));
  QTest::mouseClick(d.widget<QPushButton>("startStop"), Qt::LeftButton);
  QVERIFY(d.window().document().isBusy());
  QVERIFY(!d.application.servo().isRunning());
  QTRY_VERIFY(d.application.servo().isRunning());
  QVERIFY(areHierarchiesReady(d.session().scene().geometries()));
  // A part that comes later is built in the background too, and felt once it is there.
  d.add({writeOff(d.folder.path() / "ball.off", icosphereMesh(0.02, 3))});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  QTRY_VERIFY(areHierarchiesReady(d.session().scene().geometries()));
  QVERIFY(d.application.servo().isRunning());
}

void DesktopServoTest::showsTheOneMinimumBetweenTwoFaces() {
  DesktopDriver d;
  d.addCubes();
  useSprings(d);
  QCOMPARE(d.text("statusRate"), QStringLiteral("Servo off"));
  startWith(d, ui::Hand::Manual);
  QTRY_COMPARE(d.text("statusMinima"), QStringLiteral("Minima 1"));
  QCOMPARE(d.text("statusDistance"), QStringLiteral("Min distance 5.00 mm"));
  // 200 N/m over the 5 mm that are left to the cutoff of 10 mm, once the force has been let in.
  QTRY_COMPARE(d.text("force"), QStringLiteral("1.00 N"));
  QTRY_VERIFY(d.text("statusRate").startsWith(QStringLiteral("Servo ")) &&
              d.text("statusRate") != "Servo 0 Hz");
  QVERIFY(d.text("statusLateness").contains(QStringLiteral("p99")));
  pressShortcut(d, Qt::Key_F6);
  QVERIFY(!d.application.servo().isRunning());
  QCOMPARE(d.text("statusRate"), QStringLiteral("Servo off"));
}

void DesktopServoTest::rateCountsTheTicksOfTheServosOwnTime() {
  DesktopDriver d;
  d.addCubes();
  ServoSnapshot newest, before;
  int measured = 0;
  connect(&d.application.servo(), &desktop::ServoController::snapshotArrived, this,
          [&](const ServoSnapshot& snapshot) { newest = snapshot; });
  connect(&d.application.servo(), &desktop::ServoController::statusChanged, this,
          [&](const ui::ServoStatus& status) {
            if (before.tick > 0 && newest.tick > before.tick) {
              const double rate =
                  static_cast<double>(newest.tick - before.tick) / (newest.time - before.time);
              QVERIFY2(std::abs(status.rate - rate) < 1e-6, qPrintable(QString::number(status.rate)));
              // A period is a millisecond: skipped ones make the rate lower, nothing makes it higher.
              QVERIFY2(status.rate < 1000.001, qPrintable(QString::number(status.rate)));
              ++measured;
            }
            before = newest;
          });
  startWith(d, ui::Hand::Manual);
  QTRY_VERIFY(measured >= 3);
}

void DesktopServoTest::manualHandFollowsKeysAndNumbers() {
  DesktopDriver d;
  d.addCubes();
  d.clickPart(1, ui::PartsModel::Name);
  d.type<QDoubleSpinBox>("nudgeStep", "0.5");
  startWith(d, ui::Hand::Manual);
  QTRY_COMPARE(d.text("statusDistance"), QStringLiteral("Min distance 5.00 mm"));
  ui::Viewport& view = d.window().viewport();
  view.setFocus();
  for (int i = 0; i < 4; ++i)
    QTest::keyClick(&view, Qt::Key_PageDown);
  QTRY_COMPARE(d.text("statusDistance"), QStringLiteral("Min distance 3.00 mm"));
  d.type<QDoubleSpinBox>("positionZ", "1");
  QTRY_COMPARE(d.text("statusDistance"), QStringLiteral("Min distance 6.00 mm"));
  // Up by a drag with Shift: in the view from the front that is along z, and along no other axis.
  QTest::keyClick(&view, Qt::Key_1);
  QTest::mousePress(&view, Qt::LeftButton, Qt::ShiftModifier, {200, 200});
  for (int y = 199; y >= 190; --y) {
    QMouseEvent move(QEvent::MouseMove, QPointF(200, y), Qt::NoButton, Qt::LeftButton, Qt::ShiftModifier);
    QApplication::sendEvent(&view, &move);
  }
  QTest::mouseRelease(&view, Qt::LeftButton, Qt::ShiftModifier, {200, 190});
  QTRY_VERIFY(d.widget<QDoubleSpinBox>("positionZ")->value() > 1.0);
  QCOMPARE(d.widget<QDoubleSpinBox>("positionX")->value(), 0.0);
  QCOMPARE(d.widget<QDoubleSpinBox>("positionY")->value(), 0.0);
  d.type<QDoubleSpinBox>("positionZ", "1");
  QTRY_COMPARE(d.text("statusDistance"), QStringLiteral("Min distance 6.00 mm"));
  // Until it is put down, the scene has the part where it was.
  QCOMPARE(d.part("moving").worldFromPart.translation.z, 0.0);
  QTest::mouseClick(d.widget<QPushButton>("startStop"), Qt::LeftButton);
  QVERIFY(std::abs(d.part("moving").worldFromPart.translation.z - 0.001) < 1e-12);
}

void DesktopServoTest::scriptedHandClosesThreeQuartersOfTheGapOfSprings() {
  DesktopDriver d;
  d.addCubes();
  useSprings(d);
  double least = 1.0;
  connect(&d.application.servo(), &desktop::ServoController::snapshotArrived, this,
          [&](const ServoSnapshot& snapshot) { least = std::min(least, snapshot.distance); });
  startWith(d, ui::Hand::Scripted);
  QTRY_VERIFY(least < 0.0014);
  QTest::qWait(500);
  QVERIFY2(least > 0.0008, "the wobble must not reach contact");
}

void DesktopServoTest::whatHasMovedInHandIsMarkedAsNotSavedAtOnce() {
  DesktopDriver d;
  d.addCubes();
  const auto file = d.folder.path() / "pair.nearfit";
  d.session().save(file);
  startWith(d, ui::Hand::Manual);
  QTRY_VERIFY(d.isFeltAtX(0.0));
  QVERIFY2(!d.window().isWindowModified(), "it is where it was");
  d.clickPart(1, ui::PartsModel::Name);
  d.type<QDoubleSpinBox>("positionX", "1");
  QTRY_VERIFY(d.isFeltAtX(0.001));
  QTRY_VERIFY(d.window().isWindowModified());
  QVERIFY(d.application.servo().isRunning());
  QVERIFY2(!d.session().isModified(), "it is still in hand");
  pressShortcut(d, Qt::Key_S, Qt::ControlModifier);
  QTRY_VERIFY2(!d.window().isWindowModified(), "saving puts it into the scene, and it stays there");
  QVERIFY(d.application.servo().isRunning());
  d.type<QDoubleSpinBox>("positionX", "2");
  QTRY_VERIFY(d.window().isWindowModified());
  pressShortcut(d, Qt::Key_F6);
  QTRY_VERIFY(!d.application.servo().isRunning());
  QVERIFY(d.window().isWindowModified());
  pressShortcut(d, Qt::Key_Z, Qt::ControlModifier);
  QVERIFY(!d.window().isWindowModified());
}

void DesktopServoTest::stoppingIsOneStepOfUndo() {
  DesktopDriver d;
  d.addCubes();
  startWith(d, ui::Hand::Manual);
  d.clickPart(1, ui::PartsModel::Name);
  d.type<QDoubleSpinBox>("positionX", "3");
  d.type<QDoubleSpinBox>("positionX", "4");
  QTRY_COMPARE(d.text("statusMinima"), QStringLiteral("Minima 1"));
  QTRY_VERIFY(d.isFeltAtX(0.004));
  pressShortcut(d, Qt::Key_F6);
  QCOMPARE(QString::fromStdString(d.session().undoText()), QStringLiteral("Feel moving"));
  QVERIFY(std::abs(d.part("moving").worldFromPart.translation.x - 0.004) < 1e-12);
  pressShortcut(d, Qt::Key_Z, Qt::ControlModifier);
  QCOMPARE(d.part("moving").worldFromPart.translation.x, 0.0);
}

void DesktopServoTest::springsChangeWhileItRuns() {
  DesktopDriver d;
  d.addCubes();
  useSprings(d);
  startWith(d, ui::Hand::Manual);
  QTRY_COMPARE(d.text("force"), QStringLiteral("1.00 N"));
  QTest::mouseClick(d.widget<QPushButton>("settingsButton"), Qt::LeftButton);
  QVERIFY(d.widget<QDialog>("feelDialog")->isVisible());
  // Soft enough for ticks of several milliseconds: a busy machine holds back what is stiffer (boundedSprings()).
  d.type<QDoubleSpinBox>("stiffness", "100");
  QTRY_COMPARE(d.text("force"), QStringLiteral("0.50 N"));
  d.type<QDoubleSpinBox>("cutoff", "7");
  // 100 N/m over 2 mm.
  QTRY_COMPARE(d.text("force"), QStringLiteral("0.20 N"));
  auto* mode = d.widget<QComboBox>("mode");
  mode->setFocus();
  QTest::keyClick(mode, Qt::Key_Down);
  // The greatest push, 100 N/m over 7 mm, is now at half the cutoff: k (c - d) d = 4 * 0.7 * 2/7 * 5/7 N.
  QTRY_COMPARE(d.text("force"), QStringLiteral("0.57 N"));
  QCOMPARE(d.session().scene().haptics().springs.law, SpringLaw::Printed);
  d.session().undo();
  QTRY_COMPARE(d.text("force"), QStringLiteral("0.20 N"));
}

void DesktopServoTest::partsComeAndGoWhileItRuns() {
  DesktopDriver d;
  d.addCubes();
  startWith(d, ui::Hand::Manual);
  QTRY_COMPARE(d.text("statusMinima"), QStringLiteral("Minima 1"));
  const auto ceiling = writeOff(d.folder.path() / "ceiling.off",
                                boxMesh(glm::dvec3(0.04, 0.04, 0.01), glm::dvec3(0, 0, 0.052)));
  // Its lower face is 2 mm above the moving cube.
  d.add({ceiling});
  QTRY_COMPARE(d.text("statusMinima"), QStringLiteral("Minima 2"));
  QTRY_COMPARE(d.text("statusDistance"), QStringLiteral("Min distance 2.00 mm"));
  d.clickPart(2, ui::PartsModel::Visible);
  QTRY_COMPARE(d.text("statusMinima"), QStringLiteral("Minima 1"));
  QVERIFY(d.application.servo().isRunning());
}

void DesktopServoTest::deletingThePartInHandStops() {
  DesktopDriver d;
  d.addCubes();
  startWith(d, ui::Hand::Manual);
  d.clickPart(1, ui::PartsModel::Name);
  pressShortcut(d, Qt::Key_Delete);
  QVERIFY(!d.application.servo().isRunning());
  QVERIFY(d.session().scene().findByName("moving") == nullptr);
  // It stopped without a word.
  QCOMPARE(d.window().statusBar()->currentMessage(),
           QStringLiteral("Feeling has stopped: moving was deleted"));
}

void DesktopServoTest::undoThatTakesThePartOutOfTheHandSaysSo() {
  DesktopDriver d;
  d.addCubes();
  startWith(d, ui::Hand::Manual);
  // Adding the parts is the first step.
  for (int steps = 0; steps < 3 && d.application.servo().isRunning(); ++steps)
    d.choose("undo");
  QVERIFY(!d.application.servo().isRunning());
  const QString note = d.window().statusBar()->currentMessage();
  QVERIFY2(note.startsWith(QStringLiteral("Undone: ")), qPrintable(note));
  QVERIFY2(note.endsWith(QStringLiteral(". Feeling has stopped: moving is no longer in hand")),
           qPrintable(note));
}

// It went on with whatever part of the other scene had the same number.
void DesktopServoTest::anotherSceneStopsThoughItsIdsAreTheSame() {
  DesktopDriver d;
  d.addCubes();
  startWith(d, ui::Hand::Manual);
  Scene other = d.session().scene();
  d.session().reset(other);
  QVERIFY(!d.application.servo().isRunning());
  QVERIFY(d.session().scene().movingPart());
}

void DesktopServoTest::restingServoDrawsNothing() {
  DesktopDriver d;
  d.addCubes();
  startWith(d, ui::Hand::Manual);
  QTRY_COMPARE(d.text("statusMinima"), QStringLiteral("Minima 1"));
  QVERIFY(d.comesToRest());
}

NEARFIT_QT_SUITE(DesktopServoTest, runDesktopTest<DesktopServoTest>)
#include "desktop_servo_test.moc"

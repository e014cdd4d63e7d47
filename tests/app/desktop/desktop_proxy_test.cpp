#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFrame>
#include <utility>

#include "core/scene/haptic_limits.h"
#include "tests/app/desktop/desktop_driver.h"
#include "ui/model/feel_mode.h"
#include "ui/model/hand_state.h"
#include "ui/model/parts_model.h"
#include "ui/view3d/glyphs/colour_legend.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// What the servo of a driver tells.
class Watch : public QObject {
 public:
  explicit Watch(DesktopDriver& driver) {
    connect(&driver.application.servo(), &desktop::ServoController::handReturned, this,
            [this] { ++returns; });
    connect(&driver.application.servo(), &desktop::ServoController::snapshotArrived, this,
            [this](const ServoSnapshot& snapshot) {
              if (snapshot.tick < newest.tick) ++restarts;
              newest = snapshot;
              least = std::min(least, snapshot.distance);
              if (snapshot.contactCount == 0) return;
              most = std::max(most, glm::length(snapshot.wrench.force));
              const double x = snapshot.proxy.translation.x;
              lowest = std::min(lowest, x);
              highest = std::max(highest, x);
            });
  }
  ServoSnapshot newest;
  int returns = 0;                      ///< Of the hand to the part.
  int restarts = 0;                     ///< Of the servo, which then counts its ticks anew.
  double least = 1.0;                   ///< Distance [m].
  double most = 0.0;                    ///< Force in contact [N].
  double lowest = 1.0, highest = -1.0;  ///< Of the part along x, in contact [m].
};

void start(DesktopDriver& d, ui::Hand hand) {
  auto* box = d.widget<QComboBox>("hand");
  box->setFocus();
  QTest::keyClick(box, Qt::Key_Home);
  for (int i = 0; i < box->count() && box->currentData().value<ui::Hand>() != hand; ++i)
    QTest::keyClick(box, Qt::Key_Down);
  d.clickPart(1, ui::PartsModel::Name);
  pressShortcut(d, Qt::Key_F5);
  QTRY_VERIFY(d.application.servo().isRunning());
}

/// Brings the hand 3.1 mm beyond where contact stops the part.
void pressDown(DesktopDriver& d) {
  d.type<QDoubleSpinBox>("positionZ", "-8");
  QTRY_VERIFY(d.text("lead").startsWith(QStringLiteral("3.1")));
}

/// Goes one mode on or back in the panel's list, by the keyboard.
void changeMode(DesktopDriver& d, Qt::Key key) {
  auto* mode = d.widget<QComboBox>("panelMode");
  mode->setFocus();
  QTest::keyClick(mode, key);
}

double value(DesktopDriver& d, const char* field) {
  return d.widget<QDoubleSpinBox>(field)->value();
}

constexpr double kMargin = 1e-4;  ///< Of a new scene [m].

}  // namespace

/// The cubes of the driver: contact is 5 mm below where the moving one begins, less the margin.
class DesktopProxyTest : public QObject {
  Q_OBJECT

 private slots:
  void partStopsAtContactWhileTheHandGoesOn();
  void handThatPressesSlidesThePart();
  void stepsMoveTheHandOnFromWhereItIs();
  void lettingGoTakesTheHandBackToThePart();
  void scriptedHandPressesAndSlides();
  void partThatOverlapsIsNamed();
  void faultIsToldAndAStartAnewOffered();
  void modeIsChosenInThePanel();
  void scriptedHandBeginsAgainInAnotherMode();
  void numbersChangeWithThePictureThatShowsThem();
  void whatWasFeltLastStaysInGreyUntilTheSceneChanges();
  void aChangeOfModeBringsTheHandBackToThePart();
  void aChangeOfHandLeavesThePartWhereItIs();
  void marginBeyondTheCutoffIsExplained();
  void lockedAxesHoldTheManualHand();
};

void DesktopProxyTest::partStopsAtContactWhileTheHandGoesOn() {
  DesktopDriver d;
  d.addCubes();
  Watch watch(d);
  start(d, ui::Hand::Manual);
  d.type<QDoubleSpinBox>("positionZ", "-8");
  // The part stops a margin above contact, at -4.9 mm; the hand is 3.1 mm ahead.
  QTRY_VERIFY(isNear(value(d, "positionZ"), -4.9, 0.011));
  QTRY_VERIFY(d.text("lead").startsWith(QStringLiteral("3.1")));
  QVERIFY(d.text("contacts").toInt() >= 1);
  const auto force = [&] { return glm::length(watch.newest.wrench.force); };
  const auto pull = [&] { return watch.newest.coupling.stiffness * 3.1e-3; };
  QTRY_VERIFY(force() > 0.98 * pull() && force() < 1.02 * pull());
  QVERIFY(watch.least > 0.5 * kMargin);
  pressShortcut(d, Qt::Key_F6);
  // What is kept is where the part is, not the hand.
  QVERIFY(isNear(d.part("moving").worldFromPart.translation.z, -0.0049, 1.1e-5));
  QCOMPARE(QString::fromStdString(d.session().undoText()), QStringLiteral("Feel moving"));
}

void DesktopProxyTest::handThatPressesSlidesThePart() {
  DesktopDriver d;
  d.addCubes();
  start(d, ui::Hand::Manual);
  pressDown(d);
  // One number is typed; the hand keeps the others, and so goes on pressing.
  d.type<QDoubleSpinBox>("positionX", "2");
  QTRY_VERIFY(isNear(value(d, "positionX"), 2.0, 1e-3));
  QVERIFY(isNear(value(d, "positionZ"), -4.9, 0.011));
  QVERIFY(d.text("lead").startsWith(QStringLiteral("3.1")));
}

void DesktopProxyTest::stepsMoveTheHandOnFromWhereItIs() {
  DesktopDriver d;
  d.addCubes();
  Watch watch(d);
  start(d, ui::Hand::Manual);
  d.type<QDoubleSpinBox>("positionZ", "-6");
  QTRY_VERIFY(d.text("lead").startsWith(QStringLiteral("1.1")));
  // By the field's arrows: a millimetre each.
  auto* field = d.widget<QDoubleSpinBox>("positionZ");
  QTest::keyClick(field, Qt::Key_Down);
  QTRY_VERIFY(isNear(watch.newest.handle.translation.z, -0.007, 1e-9));
  // By the keys of the view.
  d.type<QDoubleSpinBox>("nudgeStep", "0.5");
  ui::Viewport& view = d.window().viewport();
  view.setFocus();
  QTest::keyClick(&view, Qt::Key_PageDown);
  QTest::keyClick(&view, Qt::Key_PageDown);
  QTRY_VERIFY(isNear(watch.newest.handle.translation.z, -0.008, 1e-9));
  QVERIFY(isNear(watch.newest.proxy.translation.z, -0.0049, 1.1e-5));
}

void DesktopProxyTest::lettingGoTakesTheHandBackToThePart() {
  DesktopDriver d;
  d.addCubes();
  QVERIFY(!d.action("letGo")->isEnabled());
  start(d, ui::Hand::Manual);
  pressDown(d);
  QTRY_VERIFY(d.text("force") != QStringLiteral("0.00 N"));
  pressShortcut(d, Qt::Key_F7);
  QTRY_COMPARE(d.text("lead"), QStringLiteral("0.00 mm"));
  QTRY_COMPARE(d.text("force"), QStringLiteral("0.00 N"));
  // From there it moves at once.
  QVERIFY(isNear(value(d, "positionZ"), -4.9, 0.011));
}

void DesktopProxyTest::scriptedHandPressesAndSlides() {
  DesktopDriver d;
  d.addCubes();
  Watch watch(d);
  start(d, ui::Hand::Scripted);
  // A sweep takes 4 s; on a loaded machine the window hears of too few ticks of one.
  QTRY_VERIFY(watch.newest.tick > 3900);
  QTRY_VERIFY2(watch.most > 1.0, "it presses well");
  QTRY_VERIFY2(watch.highest - watch.lowest > 1e-3, "it slides along contact");
  QVERIFY2(watch.least > 0.25 * kMargin, qPrintable(QString::number(watch.least)));
  pressShortcut(d, Qt::Key_F6);
}

void DesktopProxyTest::partThatOverlapsIsNamed() {
  DesktopDriver d;
  d.addCubes();
  d.session().movePart(d.partId("moving"), {{1.0, 0.0, 0.0, 0.0}, {0.0, 0.0, -0.01}});
  start(d, ui::Hand::Manual);
  auto* notice = d.widget<QFrame>("feelNotice");
  QTRY_VERIFY(notice->isVisible());
  QCOMPARE(d.text("noticeText"),
           QStringLiteral("Overlaps fixed, which is not felt until the two are apart."));
  QVERIFY(!d.widget<QPushButton>("restart")->isVisible());
  // Pulled out, it is felt again.
  d.type<QDoubleSpinBox>("positionZ", "2");
  QTRY_VERIFY(!notice->isVisible());
  d.type<QDoubleSpinBox>("positionZ", "-8");
  QTRY_VERIFY(isNear(value(d, "positionZ"), -4.9, 0.011));
}

void DesktopProxyTest::faultIsToldAndAStartAnewOffered() {
  DesktopDriver d;
  d.addCubes();
  Watch watch(d);
  start(d, ui::Hand::Manual);
  QTRY_VERIFY(watch.newest.tick > 300);
  ServoSnapshot faulty = watch.newest;
  faulty.fault = ServoFault::PoseNotFinite;
  d.window().hand().showSnapshot(faulty);
  QVERIFY(d.text("noticeText").contains(QStringLiteral("check the device")));
  auto* restart = d.widget<QPushButton>("restart");
  QVERIFY(restart->isVisible());
  QTest::mouseClick(restart, Qt::LeftButton);
  QTRY_VERIFY(d.application.servo().isRunning());
  QTRY_COMPARE(watch.restarts, 1);
  QTRY_VERIFY(!d.widget<QFrame>("feelNotice")->isVisible());
}

void DesktopProxyTest::modeIsChosenInThePanel() {
  DesktopDriver d;
  d.addCubes();
  auto* mode = d.widget<QComboBox>("panelMode");
  QCOMPARE(mode->currentData().value<ui::FeelMode>(), ui::FeelMode::Proxy);
  mode->setFocus();
  QTest::keyClick(mode, Qt::Key_Down);
  QCOMPARE(d.session().scene().haptics().mode, HapticMode::Springs);
  QCOMPARE(d.widget<QComboBox>("mode")->currentData().value<ui::FeelMode>(), ui::FeelMode::LinearSprings);
  d.session().undo();
  QCOMPARE(mode->currentData().value<ui::FeelMode>(), ui::FeelMode::Proxy);
}

void DesktopProxyTest::scriptedHandBeginsAgainInAnotherMode() {
  DesktopDriver d;
  d.addCubes();
  Watch watch(d);
  start(d, ui::Hand::Scripted);
  // It presses, with the hand beyond contact.
  QTRY_VERIFY(watch.newest.handle.translation.z < -0.0055);
  changeMode(d, Qt::Key_Down);
  QTRY_COMPARE(watch.returns, 1);
  QTRY_VERIFY(watch.newest.mode == HapticMode::Springs && watch.newest.tick > 2000);
  QVERIFY2(watch.least > 0.1 * kMargin, "springs are not pushed through");
  QVERIFY2(watch.newest.proxy.translation.z < -0.0045, "it begins where the part is");
  QCOMPARE(QString::fromStdString(d.session().undoText()), QStringLiteral("Feel settings: mode"));
}

/// Stop wiped the numbers that it was pressed for.
/// Panel and status bar had the next tick's numbers while the legend and the arrows had those of the last one.
void DesktopProxyTest::numbersChangeWithThePictureThatShowsThem() {
  DesktopDriver d;
  d.addCubes();
  const auto* legend = d.widget<ui::ColourLegend>("colourLegend");
  const auto ofLegend = [&] {
    return QStringList{d.text("force"), d.text("torque"), d.text("contacts"), d.text("lead")};
  };
  const auto numbers = [&] {
    return ofLegend() + QStringList{d.text("distance"), d.text("statusDistance"), d.text("statusMinima")};
  };
  QStringList drawn = numbers();
  int changes = 0, early = 0, apart = 0;
  QObject watch;
  // Both come after all that the window itself has connected.
  connect(&d.window().hand(), &ui::HandState::snapshotDrawn, &watch, [&] {
    const QStringList before = std::exchange(drawn, numbers());
    changes += drawn != before ? 1 : 0;
    apart += ofLegend() != legend->values() ? 1 : 0;
  });
  connect(&d.window().hand(), &ui::HandState::snapshotShown, &watch,
          [&] { early += numbers() != drawn ? 1 : 0; });
  start(d, ui::Hand::Manual);
  pressDown(d);
  QTRY_COMPARE(d.text("statusDistance"), QStringLiteral("Min distance ") + d.text("distance"));
  QVERIFY2(changes >= 1, "something was felt");
  QCOMPARE(early, 0);
  QCOMPARE(apart, 0);
}

void DesktopProxyTest::whatWasFeltLastStaysInGreyUntilTheSceneChanges() {
  DesktopDriver d;
  d.addCubes();
  start(d, ui::Hand::Manual);
  pressDown(d);
  const auto* lead = d.widget<QLabel>("lead");
  QVERIFY(lead->isEnabled());
  pressShortcut(d, Qt::Key_F6);
  QTRY_VERIFY(!d.application.servo().isRunning());
  QVERIFY(!lead->isEnabled());
  QVERIFY(d.text("lead").startsWith(QStringLiteral("3.1")));
  QVERIFY(d.text("contacts").toInt() >= 1);
  // The status bar and the view go on showing the same, as past.
  const auto* distance = d.widget<QLabel>("statusDistance");
  QVERIFY(!distance->isEnabled());
  QCOMPARE(distance->text(), QStringLiteral("Min distance ") + d.text("distance"));
  QCOMPARE(d.text("statusMinima"), QStringLiteral("Minima ") + d.text("minima"));
  QVERIFY(d.widget<QWidget>("colourLegend")->isVisible());
  d.type<QDoubleSpinBox>("positionX", "1");
  QCOMPARE(d.text("lead"), QStringLiteral("–"));
  QCOMPARE(distance->text(), QStringLiteral("Min distance –"));
  QVERIFY(distance->isEnabled());
  QVERIFY(!d.widget<QWidget>("colourLegend")->isVisible());
  // They are black again once something is felt.
  start(d, ui::Hand::Manual);
  QTRY_VERIFY(lead->isEnabled());
  QTRY_VERIFY(d.text("statusDistance") != QStringLiteral("Min distance –"));
  QVERIFY(distance->isEnabled());
}

/// The part went through the floor to where the hand was: 17 mm below, and overlapped in the proxy mode.
void DesktopProxyTest::aChangeOfModeBringsTheHandBackToThePart() {
  DesktopDriver d;
  d.addCubes();
  Watch watch(d);
  start(d, ui::Hand::Manual);
  pressDown(d);
  const double rest = watch.newest.proxy.translation.z;
  changeMode(d, Qt::Key_Down);
  QTRY_COMPARE(watch.returns, 1);
  QTRY_VERIFY(watch.newest.mode == HapticMode::Springs && watch.newest.tick > 50);
  QVERIFY(isNear(watch.newest.proxy.translation.z, rest, 1e-9));
  QVERIFY(isNear(d.window().hand().handPose().translation.z, rest, 1e-9));
  changeMode(d, Qt::Key_Up);
  QTRY_COMPARE(watch.returns, 2);
  QTRY_VERIFY(watch.newest.mode == HapticMode::Proxy && watch.newest.tick > 50);
  QVERIFY(isNear(watch.newest.proxy.translation.z, rest, 1e-5));
  QCOMPARE(watch.newest.overlappingCount, 0U);
  // The hand moves on from the part, and is stopped as before.
  d.type<QDoubleSpinBox>("positionZ", "-6");
  QTRY_VERIFY(d.text("lead").startsWith(QStringLiteral("1.1")));
  pressShortcut(d, Qt::Key_F6);
  QVERIFY(isNear(d.part("moving").worldFromPart.translation.z, rest, 1e-5));
}

void DesktopProxyTest::aChangeOfHandLeavesThePartWhereItIs() {
  DesktopDriver d;
  d.addCubes();
  Watch watch(d);
  start(d, ui::Hand::Manual);
  pressDown(d);
  // What it counts anew must be less, however late its first snapshot is.
  QTRY_VERIFY(watch.newest.tick > 1000);
  const double rest = watch.newest.proxy.translation.z;
  auto* hands = d.widget<QComboBox>("hand");
  hands->setFocus();
  QTest::keyClick(hands, Qt::Key_Up);
  QCOMPARE(hands->currentData().value<ui::Hand>(), ui::Hand::Scripted);
  QTRY_COMPARE(watch.restarts, 1);
  QVERIFY(isNear(d.part("moving").worldFromPart.translation.z, rest, 1e-5));
  QTRY_VERIFY(watch.newest.tick > 50);
  QVERIFY2(watch.least > 0.25 * kMargin, "it never met the other part");
}

void DesktopProxyTest::marginBeyondTheCutoffIsExplained() {
  DesktopDriver d;
  d.addCubes();
  QTest::mouseClick(d.widget<QPushButton>("settingsButton"), Qt::LeftButton);
  const std::string before = d.session().undoText();
  // The cutoff is 10 mm.
  d.type<QDoubleSpinBox>("margin", "20");
  QVERIFY(d.text("refusal").contains(QStringLiteral("greater than the cutoff")));
  QVERIFY(d.widget<QLabel>("refusal")->isVisible());
  QCOMPARE(d.session().scene().haptics().proxy.margin, kMargin);
  QCOMPARE(value(d, "margin"), 0.1);
  QCOMPARE(d.session().undoText(), before);
  d.type<QDoubleSpinBox>("margin", "0.05");
  QVERIFY(!d.widget<QLabel>("refusal")->isVisible());
  QVERIFY(isNear(d.session().scene().haptics().proxy.margin, 5e-5, 1e-15));
  d.session().undo();
  QCOMPARE(value(d, "margin"), 0.1);
}

void DesktopProxyTest::lockedAxesHoldTheManualHand() {
  DesktopDriver d;
  d.addCubes();
  HapticSettings settings = d.session().scene().haptics();
  settings.mapping.translationLocks[0] = true;
  // A device would be scaled; numbers of the scene are not.
  settings.mapping.scale = 3.0;
  d.session().setHaptics(settings);
  Watch watch(d);
  start(d, ui::Hand::Manual);
  d.type<QDoubleSpinBox>("positionX", "4");
  d.type<QDoubleSpinBox>("positionY", "3");
  QTRY_VERIFY(isNear(watch.newest.proxy.translation.y, 0.003, 1e-6));
  QVERIFY(isNear(watch.newest.proxy.translation.x, 0.0, 1e-9));
}

NEARFIT_QT_SUITE(DesktopProxyTest, runDesktopTest<DesktopProxyTest>)
#include "desktop_proxy_test.moc"

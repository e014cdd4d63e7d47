// Devices behind makers' drivers: which of them are missing, one that is felt over what stands in for its driver, and what
// devices with fewer motors than axes do not show.
#include <QtTest>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "app/desktop/servo_report.h"
#include "tests/app/desktop/drivers_fixture.h"
#include "tests/app/desktop/hand_choice_driver.h"
#include "tests/makers/maker_bench.h"
#include "tests/makers/maker_contact.h"
#include "ui/widgets/error_box.h"

using namespace nearfit;
using namespace nearfit::test;

class DesktopDriversTest : public QObject {
  Q_OBJECT

 private slots:
  void eachMissingDriverIsAGreyEntryThatSaysWhatToInstall();
  // Once a driver is loaded it stays, so the order counts.
  void aMissingDriverOfForceDimensionIsGreyBesideDevicesOfOthers();
  void devicesOfDriversThatAreThereCanBeChosen();
  void aServiceOfHaplysThatDoesNotRunIsGreyBesideDevicesOfOthers();
  void aDeviceOfAMakersDriverLeadsThePartAndPushesOnceItIsArmed_data();
  void aDeviceOfAMakersDriverLeadsThePartAndPushesOnceItIsArmed();
  void theGripOfADeviceWithAGripperIsShown();
  void aTouchSaysThatTorqueIsNotFelt();
  void anOmega3SaysThatItSensesNoTurning();
  void whatPushesAlongAllOrDoesNotPushSaysNothing();
  void aDeviceThatIsStoppedSaysOnlyWhy();

 private:
  static DeviceInfo infoOf(int sensed, int pushed) {
    DeviceInfo info;
    info.sensedAxes = sensed;
    info.forceAxes = pushed;
    return info;
  }
};

namespace {

/// Its friction holds the handle a little off where the forces would balance [N].
constexpr double kRestingSlack = 1.2 * StandinDevice::kFriction;
/// The panel rounds, and shows a picture of some hundredths of a second before [N].
constexpr double kShownSlack = 0.1;
/// So far down the hand wants the handle: less than the weakest motors can hold [m].
constexpr double kPressedTo = 0.012;
/// Where the cubes' faces meet; the last digits are those of turning a handle's pose into the part's [m].
constexpr double kFaceBelow = -0.005 - 1e-9;

}  // namespace

void DesktopDriversTest::eachMissingDriverIsAGreyEntryThatSaysWhatToInstall() {
  DriversFixture f;
  for (const auto& [maker, remedy] :
       {std::pair{"OpenHaptics", "Touch_Setup"}, std::pair{"Force Dimension", "SDK"},
        std::pair{"Haply", "haply-inverse-service"}}) {
    const QString name = QString::fromLatin1(maker) + QStringLiteral(": driver not installed");
    QTRY_VERIFY2(f.box()->findText(name) >= 0, maker);
    const int row = f.box()->findText(name);
    QVERIFY(!f.isEnabled(row));
    QVERIFY(f.box()->itemData(row, Qt::ToolTipRole).toString().contains(QLatin1String(remedy)));
  }
  checkOpenList(f,
                {QStringLiteral("OpenHaptics"), QStringLiteral("Force Dimension"), QStringLiteral("Haply")},
                QStringLiteral("drivers-missing"));
}

void DesktopDriversTest::aMissingDriverOfForceDimensionIsGreyBesideDevicesOfOthers() {
  const MakerBench touch(kMakerModels[0]);
  MakerBench haply(kMakerModels[6]);
  DriversFixture f(std::to_string(haply.service().port()));
  checkOpenList(f, {QStringLiteral("Force Dimension")}, QStringLiteral("drivers-without-forcedimension"));
}

void DesktopDriversTest::devicesOfDriversThatAreThereCanBeChosen() {
  // The loader knows what stands in for the makers' libraries by their names from here on.
  const MakerBench touch(kMakerModels[0]), omega(kMakerModels[3]);
  MakerBench haply(kMakerModels[6]);
  DriversFixture f(std::to_string(haply.service().port()));
  checkOpenList(f, {}, QStringLiteral("drivers-present"));
  QVERIFY(f.box()->findText(QStringLiteral("driver not installed"), Qt::MatchContains) < 0);
}

void DesktopDriversTest::aServiceOfHaplysThatDoesNotRunIsGreyBesideDevicesOfOthers() {
  const MakerBench touch(kMakerModels[0]), omega(kMakerModels[3]);
  DriversFixture f;
  checkOpenList(f, {QStringLiteral("Haply")}, QStringLiteral("drivers-without-haply"));
}

void DesktopDriversTest::aDeviceOfAMakersDriverLeadsThePartAndPushesOnceItIsArmed_data() {
  QTest::addColumn<int>("model");
  QTest::addColumn<QString>("name");
  QTest::newRow("Touch") << 0 << QString::fromLatin1(kDriverRows[0].device);
  QTest::newRow("omega.6") << 3 << QString::fromLatin1(kDriverRows[1].device);
  QTest::newRow("Inverse3") << 6 << QString::fromLatin1(kDriverRows[2].device);
}

void DesktopDriversTest::aDeviceOfAMakersDriverLeadsThePartAndPushesOnceItIsArmed() {
  QFETCH(int, model);
  QFETCH(QString, name);
  const MakerModel& maker = kMakerModels.at(static_cast<std::size_t>(model));
  const bool isService = maker.maker == Maker::Haply;
  MakerBench bench(maker);
  StandinDevice& device = bench.device();
  DriversFixture f(isService ? std::to_string(bench.service().port()) : std::string(kNoHaply));
  QVector<ui::Failure> failures;
  f.d.window().setFailureSink([&](const ui::Failure& failure) { failures << failure; });
  f.d.addCubes();
  double lowest = 0.0, strongest = 0.0;
  QObject::connect(&f.d.application.servo(), &desktop::ServoController::snapshotArrived, &f.d.application,
                   [&](const ServoSnapshot& snapshot) {
                     lowest = std::min(lowest, snapshot.proxy.translation.z);
                     strongest = std::max(strongest, glm::length(snapshot.wrench.force));
                   });
  chooseHandNamed(f.d, name);
  if (QTest::currentTestFailed()) return;
  auto* startStop = f.d.widget<QPushButton>("startStop");
  QTest::mouseClick(startStop, Qt::LeftButton);
  QTRY_VERIFY(f.d.application.servo().isRunning());
  QTRY_VERIFY2(f.d.text("deviceState").startsWith(QStringLiteral("Not armed")),
               qPrintable(f.d.text("deviceState")));

  // The hand presses the part, 5 mm above the fixed one, down to it, and nothing pushes.
  device.target.set({0.0, 0.0, -kPressedTo});
  QTRY_VERIFY2(lowest < -0.004, "the device leads the part");
  QCOMPARE(strongest, 0.0);
  QCOMPARE(device.force.get()[2], 0.0);

  // Armed, its motors hold the hand, and the panel shows what they do.
  double force = 0.0, pull = 0.0, shown = 0.0;
  const bool isHeld = armedUntil(f.d, [&] {
    const Triple pushed = device.force.get();
    force = pushed[2];
    pull = kContactHand * (device.position.get()[2] + kPressedTo);
    shown = f.d.text("force").section(' ', 0, 0).toDouble();
    return force > 0.5 && std::abs(force - pull) <= kRestingSlack &&
           std::abs(shown - std::hypot(pushed[0], pushed[1], pushed[2])) <= kShownSlack;
  });
  QVERIFY2(isHeld, qPrintable(QStringLiteral("%1 N, the hand %2 N, shown %3 N, %4")
                                  .arg(force)
                                  .arg(pull)
                                  .arg(shown)
                                  .arg(f.d.text("deviceState"))));

  QTest::mouseClick(f.d.widget<QPushButton>("arm"), Qt::LeftButton);
  QTRY_VERIFY(!f.d.application.servo().status().isArmed);
  QTRY_COMPARE(device.force.get()[2], 0.0);
  // A service knows of no opening.
  if (!isService) QVERIFY(device.isOpen);
  QTest::mouseClick(startStop, Qt::LeftButton);
  QTRY_VERIFY(!device.isOpen);
  QVERIFY2(lowest >= kFaceBelow, qPrintable(QString::number(lowest)));
  // Where it was stopped, arming it in that moment may have been refused; nothing else goes wrong.
  for (const ui::Failure& failure : failures)
    QCOMPARE(failure.summary, QStringLiteral("The device could not be armed."));
}

void DesktopDriversTest::theGripOfADeviceWithAGripperIsShown() {
  for (const MakerModel& model : {kMakerModels[4], kMakerModels[3]}) {
    MakerBench bench(model);
    DriversFixture f;
    f.d.addCubes();
    chooseHandNamed(f.d, QStringLiteral("Force Dimension device 1"));
    if (QTest::currentTestFailed()) return;
    int snapshots = 0;
    QObject::connect(&f.d.application.servo(), &desktop::ServoController::snapshotArrived, &f.d.application,
                     [&] { ++snapshots; });
    QTest::mouseClick(f.d.widget<QPushButton>("startStop"), Qt::LeftButton);
    QTRY_VERIFY(snapshots > 2);
    const bool hasGripper = model.model == 104;
    QTRY_COMPARE(f.d.widget<QLabel>("grip")->isVisible(), hasGripper);
    if (hasGripper) {
      QTRY_COMPARE(f.d.text("grip"), QStringLiteral("21.5°"));
      bench.device().grip = std::numbers::pi / 12.0;
      QTRY_COMPARE(f.d.text("grip"), QStringLiteral("15.0°"));
    }
    QTest::mouseClick(f.d.widget<QPushButton>("startStop"), Qt::LeftButton);
    QTRY_VERIFY(!bench.device().isOpen);
  }
}

void DesktopDriversTest::aTouchSaysThatTorqueIsNotFelt() {
  for (const DeviceState state : {DeviceState::Ready, DeviceState::Armed})
    QVERIFY(desktop::missingAxesText(state, infoOf(6, 3)).contains(QStringLiteral("no motors for torque")));
}

void DesktopDriversTest::anOmega3SaysThatItSensesNoTurning() {
  QVERIFY(desktop::missingAxesText(DeviceState::Armed, infoOf(3, 3))
              .contains(QStringLiteral("senses no turning")));
}

void DesktopDriversTest::whatPushesAlongAllOrDoesNotPushSaysNothing() {
  QCOMPARE(desktop::missingAxesText(DeviceState::Armed, infoOf(6, 6)), QString());
  QCOMPARE(desktop::missingAxesText(DeviceState::Armed, infoOf(6, 0)), QString());
}

void DesktopDriversTest::aDeviceThatIsStoppedSaysOnlyWhy() {
  for (const DeviceState state : {DeviceState::Fault, DeviceState::Lost, DeviceState::Uncalibrated})
    QCOMPARE(desktop::missingAxesText(state, infoOf(6, 3)), QString());
}

NEARFIT_QT_SUITE(DesktopDriversTest, runDesktopTest<DesktopDriversTest>)

#include "desktop_drivers_test.moc"

#include <QComboBox>
#include <QProgressBar>
#include <QToolButton>
#include <cmath>
#include <memory>

#include "tests/app/desktop/desktop_driver.h"
#include "tests/app/desktop/fake_device.h"
#include "ui/widgets/error_box.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

const ui::DeviceChoice kArm{QStringLiteral("arm"), QStringLiteral("Fake arm"), {}, true};
const ui::DeviceChoice kForbidden{QStringLiteral("forbidden"), QStringLiteral("Forbidden arm"),
                                  QStringLiteral("You have no permission to open it."), false};

/// An application whose devices are fake, with two cubes.
struct DeviceFixture {
  explicit DeviceFixture(QVector<ui::DeviceChoice> devices = {}) {
    source->devices = std::move(devices);
    d = std::make_unique<DesktopDriver>(std::unique_ptr<desktop::DeviceSource>(source));
    handle = source->handle;
    d->window().setFailureSink([this](const ui::Failure& failure) { failures << failure; });
    d->addCubes();
  }
  void plug(const QVector<ui::DeviceChoice>& devices) {
    source->devices = devices;
    d->application.watcher().poll();
  }
  QStringList names() {
    QStringList names;
    for (int i = 0; i < box()->count(); ++i)
      names << box()->itemText(i);
    return names;
  }
  QComboBox* box() { return d->widget<QComboBox>("hand"); }
  void choose(const QString& name) {
    box()->setFocus();
    const int wanted = box()->findText(name);
    for (int keys = 0; keys < 10 && box()->currentIndex() != wanted; ++keys)
      QTest::keyClick(box(), box()->currentIndex() < wanted ? Qt::Key_Down : Qt::Key_Up);
    QCOMPARE(box()->currentText(), name);
  }
  void feel() {
    QTest::mouseClick(d->widget<QPushButton>("startStop"), Qt::LeftButton);
    QTRY_VERIFY(d->application.servo().isRunning());
  }
  /// Of the part in hand, once it is put down.
  double x() { return d->part("moving").worldFromPart.translation.x; }

  FakeSource* source = new FakeSource;
  QVector<ui::Failure> failures;
  std::unique_ptr<DesktopDriver> d;
  std::shared_ptr<Handle> handle;
};

}  // namespace

class DesktopDeviceTest : public QObject {
  Q_OBJECT

 private slots:
  void theManualHandIsTheDefaultUnlessADeviceIsThere();
  void theChosenHandIsRememberedInLaterRuns();
  void devicesComeAndGoInTheChoice();
  void whatCannotBeUsedSaysWhyAndCannotBeChosen();
  void aDeviceLeadsThePartAndIsNotArmed();
  void theButtonAloneArms();
  void aDeviceIsArmedOnlyOnceItIsCalibrated();
  void thatNoneIsPluggedInIsSaidWithWhatCanBe();
  void unpluggingPutsThePartDownAndSaysWhy();
  void aDeviceThatIsGoneWhenItIsTakenIsAFailure();
  void changingTheHandChangesTheDevice();
  void openingShowsHowFarItIsWhileTheWindowGoesOn();
  void cancellingAnOpeningAnswersAtOnceHoweverItHangs();
  void stoppingAnswersAtOnceWhileArmingHangs();
  void aFaultStaysUntilItIsResetAndArmsNothing();
  void aDeviceThatLeavesBeforeTheStartIsMissedAndNotReplaced();
};

void DesktopDeviceTest::theManualHandIsTheDefaultUnlessADeviceIsThere() {
  QSettings().clear();
  QCOMPARE(DeviceFixture().box()->currentText(), QStringLiteral("Manual hand"));
  QCOMPARE(DeviceFixture({kForbidden}).box()->currentText(), QStringLiteral("Manual hand"));
  QCOMPARE(DeviceFixture({kForbidden, kArm}).box()->currentText(), kArm.name);
  DeviceFixture f;
  f.plug({kArm});
  QCOMPARE(f.box()->currentText(), kArm.name);
}

void DesktopDeviceTest::theChosenHandIsRememberedInLaterRuns() {
  QSettings().clear();
  DeviceFixture({kArm}).choose(QStringLiteral("Scripted hand"));
  QCOMPARE(DeviceFixture({kArm}).box()->currentText(), QStringLiteral("Scripted hand"));
  DeviceFixture({kArm}).choose(QStringLiteral("Manual hand"));
  QCOMPARE(DeviceFixture({kArm}).box()->currentText(), QStringLiteral("Manual hand"));
  DeviceFixture({kArm}).choose(kArm.name);
  // A recording is chosen anew in each run.
  DeviceFixture({kArm}).choose(QStringLiteral("Recorded hand"));
  QCOMPARE(DeviceFixture({kArm}).box()->currentText(), kArm.name);
  DeviceFixture without;
  QCOMPARE(without.box()->currentText(), QStringLiteral("Manual hand"));
}

void DesktopDeviceTest::devicesComeAndGoInTheChoice() {
  DeviceFixture f;
  const QStringList always{QStringLiteral("Scripted hand"), QStringLiteral("Manual hand"),
                           QStringLiteral("Recorded hand")};
  QCOMPARE(f.names(), always);
  f.plug({kArm});
  QCOMPARE(f.names(), always + QStringList{kArm.name});
  f.choose(kArm.name);
  // What is chosen stays so while others come.
  f.plug({kForbidden, kArm});
  QCOMPARE(f.box()->currentText(), kArm.name);
  f.plug({kForbidden});
  QCOMPARE(f.names(), always + QStringList{kForbidden.name});
  QCOMPARE(f.box()->currentText(), always[1]);
  // Plugged in again, it is what the user chose.
  f.plug({kForbidden, kArm});
  QCOMPARE(f.box()->currentText(), kArm.name);
}

void DesktopDeviceTest::whatCannotBeUsedSaysWhyAndCannotBeChosen() {
  DeviceFixture f({kForbidden});
  f.box()->setFocus();
  for (int i = 0; i < 5; ++i)
    QTest::keyClick(f.box(), Qt::Key_Down);
  QCOMPARE(f.box()->currentText(), QStringLiteral("Recorded hand"));
  QCOMPARE(f.box()->itemData(3, Qt::ToolTipRole).toString(), kForbidden.note);
}

void DesktopDeviceTest::aDeviceLeadsThePartAndIsNotArmed() {
  DeviceFixture f({kArm});
  f.handle->moveTo({0.5, 0.0, 0.0});  // Wherever the device is, the part stays.
  f.choose(kArm.name);
  f.feel();
  QTRY_VERIFY(f.d->text("deviceState").startsWith(QStringLiteral("Not armed")));
  QTRY_VERIFY(f.d->text("statusRate") != QStringLiteral("Servo off"));
  QTRY_VERIFY(f.d->isFeltAtX(0.0));
  f.handle->moveTo({0.503, 0.0, 0.0});
  QTRY_VERIFY(f.d->isFeltAtX(0.003));
  QTest::mouseClick(f.d->widget<QPushButton>("startStop"), Qt::LeftButton);
  QVERIFY(!f.d->application.servo().isRunning());
  QVERIFY2(std::abs(f.x() - 0.003) < 1e-4, qPrintable(QString::number(f.x())));
  QCOMPARE(f.handle->arms.load(), 0);
  QTRY_COMPARE(f.handle->stops.load(), 1);
  QVERIFY(f.failures.isEmpty());
}

void DesktopDeviceTest::theButtonAloneArms() {
  DeviceFixture f({kArm});
  f.choose(kArm.name);
  auto* arm = f.d->widget<QPushButton>("arm");
  QVERIFY(!arm->isVisible());
  f.feel();
  QTRY_VERIFY(arm->isVisible());
  QCOMPARE(f.handle->arms.load(), 0);
  QTest::mouseClick(arm, Qt::LeftButton);
  QTRY_COMPARE(f.handle->arms.load(), 1);
  QTRY_VERIFY(f.d->text("deviceState").startsWith(QStringLiteral("Armed")));
  QTest::mouseClick(arm, Qt::LeftButton);
  QTRY_COMPARE(f.handle->disarms.load(), 1);
  QTRY_VERIFY(f.d->text("deviceState").startsWith(QStringLiteral("Not armed")));
  // A new start is not armed, whatever the last one was.
  QTest::mouseClick(arm, Qt::LeftButton);
  QTRY_COMPARE(f.handle->arms.load(), 2);
  QTest::mouseClick(f.d->widget<QPushButton>("startStop"), Qt::LeftButton);
  QVERIFY(!arm->isVisible());
  f.feel();
  QTRY_VERIFY(f.d->text("deviceState").startsWith(QStringLiteral("Not armed")));
}

void DesktopDeviceTest::aDeviceIsArmedOnlyOnceItIsCalibrated() {
  DeviceFixture f({kArm});
  f.handle->needsCalibration = true;
  f.choose(kArm.name);
  f.feel();
  auto* calibrate = f.d->widget<QPushButton>("calibrate");
  QTRY_VERIFY(calibrate->isVisible());
  QVERIFY(!f.d->widget<QPushButton>("arm")->isVisible());
  QVERIFY(f.d->text("deviceState").startsWith(QStringLiteral("Not calibrated")));
  // The part stays, and not because of the clutch.
  const auto* note = f.d->widget<QLabel>("clutchNote");
  QTRY_VERIFY(note->isVisible());
  QVERIFY(!f.d->action("clutch")->isChecked());
  QVERIFY2(note->text().contains(QStringLiteral("calibrated")), qPrintable(note->text()));
  keepPictures(f.d->window(), QStringLiteral("uncalibrated"));
  QTest::mouseClick(calibrate, Qt::LeftButton);
  QTRY_COMPARE(f.handle->calibrations.load(), 1);
  QTRY_VERIFY(f.d->widget<QPushButton>("arm")->isVisible());
  QVERIFY(!calibrate->isVisible());
  QTRY_VERIFY(!note->isVisible());
  QTest::mouseClick(f.d->widget<QToolButton>("clutchButton"), Qt::LeftButton);
  QTRY_VERIFY(note->isVisible());
  QVERIFY2(note->text().contains(QStringLiteral("reposition")), qPrintable(note->text()));
}

void DesktopDeviceTest::thatNoneIsPluggedInIsSaidWithWhatCanBe() {
  DeviceFixture f;
  const auto* none = f.d->widget<QLabel>("noDevice");
  QTRY_VERIFY(none->isVisible());
  QCOMPARE(none->text(), QStringLiteral("No device is plugged in."));
  for (const char* kind : {"OpenHap", "SpaceMouse", "Falcon", "WoodenHaptics"})
    QVERIFY2(none->toolTip().contains(QLatin1String(kind)), qPrintable(none->toolTip()));
  QVERIFY2(!f.names().contains(none->text()), "it is no hand");
  keepPictures(f.d->window(), QStringLiteral("no-device"));
  f.plug({kArm});
  QTRY_VERIFY(!none->isVisible());
  f.plug({});
  QTRY_VERIFY(none->isVisible());
  f.plug({kForbidden});
  QTRY_VERIFY(!none->isVisible());
}

void DesktopDeviceTest::unpluggingPutsThePartDownAndSaysWhy() {
  DeviceFixture f({kArm});
  f.choose(kArm.name);
  f.feel();
  QTRY_VERIFY(f.d->isFeltAtX(0.0));
  f.handle->moveTo({0.002, 0.0, 0.0});
  QTRY_VERIFY(f.d->isFeltAtX(0.002));
  f.handle->isUnplugged = true;
  f.plug({});
  QTRY_VERIFY(!f.d->application.servo().isRunning());
  QTRY_COMPARE(f.handle->stops.load(), 1);
  QCOMPARE(f.failures.size(), 1);
  QVERIFY(f.failures[0].summary.contains(QStringLiteral("lost")));
  QVERIFY(f.failures[0].details.contains(QStringLiteral("It was unplugged")));
  QVERIFY2(std::abs(f.x() - 0.002) < 1e-4, qPrintable(QString::number(f.x())));
  // One step of undo brings it back to where it was taken.
  f.d->session().undo();
  QCOMPARE(f.x(), 0.0);
}

void DesktopDeviceTest::aDeviceThatIsGoneWhenItIsTakenIsAFailure() {
  DeviceFixture f({kArm});
  f.choose(kArm.name);
  f.source->devices.clear();
  QTest::mouseClick(f.d->widget<QPushButton>("startStop"), Qt::LeftButton);
  QTRY_COMPARE(f.failures.size(), 1);
  QVERIFY(f.failures[0].details.contains(QStringLiteral("It is not plugged in")));
  QVERIFY(!f.d->application.servo().isRunning());
}

void DesktopDeviceTest::changingTheHandChangesTheDevice() {
  DeviceFixture f({kArm});
  f.choose(QStringLiteral("Manual hand"));
  f.feel();
  QCOMPARE(f.handle->starts.load(), 0);
  f.choose(kArm.name);
  QTRY_COMPARE(f.handle->starts.load(), 1);
  QTRY_VERIFY(f.d->application.servo().isRunning());
  f.choose(QStringLiteral("Manual hand"));
  QTRY_COMPARE(f.handle->stops.load(), 1);
}

void DesktopDeviceTest::openingShowsHowFarItIsWhileTheWindowGoesOn() {
  DeviceFixture f({kArm});
  f.handle->opensSlowly = true;
  f.choose(kArm.name);
  auto* startStop = f.d->widget<QPushButton>("startStop");
  auto* bar = f.d->widget<QProgressBar>("opening");
  QVERIFY(!bar->isVisible());
  QTest::mouseClick(startStop, Qt::LeftButton);
  QTRY_COMPARE(f.handle->starts.load(), 1);
  QTRY_VERIFY(bar->isVisible());
  QCOMPARE(bar->maximum(), 0);  // Not known yet: it moves to and fro.
  QVERIFY(f.d->text("deviceState").startsWith(QStringLiteral("Opening")));
  f.handle->fraction = 0.4;
  QTRY_COMPARE(bar->maximum() > 0 ? 100 * bar->value() / bar->maximum() : 0, 40);
  QVERIFY(!f.d->application.servo().isRunning());
  QCOMPARE(startStop->text(), QStringLiteral("Cancel"));
  // The scene can be worked with meanwhile: the part is taken where it is then.
  f.d->session().movePart(f.d->partId("moving"), {{1.0, 0.0, 0.0, 0.0}, {0.001, 0.0, 0.0}});
  f.handle->opensSlowly = false;
  QTRY_VERIFY(f.d->application.servo().isRunning());
  QVERIFY(!bar->isVisible());
  QTRY_VERIFY(f.d->isFeltAtX(0.001));
  QTest::mouseClick(startStop, Qt::LeftButton);
  QVERIFY2(std::abs(f.x() - 0.001) < 1e-4, qPrintable(QString::number(f.x())));
}

void DesktopDeviceTest::cancellingAnOpeningAnswersAtOnceHoweverItHangs() {
  DeviceFixture f({kArm});
  f.handle->opensSlowly = true;
  f.choose(kArm.name);
  auto* startStop = f.d->widget<QPushButton>("startStop");
  QTest::mouseClick(startStop, Qt::LeftButton);
  QTRY_COMPARE(f.handle->starts.load(), 1);
  QTest::mouseClick(startStop, Qt::LeftButton);
  // It still hangs, and the window is through with it.
  QVERIFY(f.handle->opensSlowly);
  QVERIFY(!f.d->application.servo().status().isTaken());
  QCOMPARE(startStop->text(), QStringLiteral("Feel"));
  QCOMPARE(f.handle->stops.load(), 0);
  f.handle->opensSlowly = false;
  QTRY_COMPARE(f.handle->stops.load(), 1);
  QVERIFY(!f.d->application.servo().isRunning());
  QVERIFY(f.failures.isEmpty());
  f.feel();
  QCOMPARE(f.handle->starts.load(), 2);
}

void DesktopDeviceTest::stoppingAnswersAtOnceWhileArmingHangs() {
  DeviceFixture f({kArm});
  f.choose(kArm.name);
  f.feel();
  auto* arm = f.d->widget<QPushButton>("arm");
  QTRY_VERIFY(arm->isVisible());
  f.handle->armsSlowly = true;
  QTest::mouseClick(arm, Qt::LeftButton);
  QTest::mouseClick(f.d->widget<QPushButton>("startStop"), Qt::LeftButton);
  QVERIFY(f.handle->armsSlowly);
  QVERIFY(!f.d->application.servo().isRunning());
  QCOMPARE(f.handle->stops.load(), 0);
  f.handle->armsSlowly = false;
  QTRY_COMPARE(f.handle->stops.load(), 1);
  QVERIFY(f.failures.isEmpty());
}

void DesktopDeviceTest::aFaultStaysUntilItIsResetAndArmsNothing() {
  DeviceFixture f({kArm});
  f.choose(kArm.name);
  f.feel();
  auto* arm = f.d->widget<QPushButton>("arm");
  auto* reset = f.d->widget<QPushButton>("resetDevice");
  QTRY_VERIFY(arm->isVisible());
  QVERIFY(!reset->isVisible());
  QTest::mouseClick(arm, Qt::LeftButton);
  QTRY_VERIFY(f.d->text("deviceState").startsWith(QStringLiteral("Armed")));
  f.handle->isFaulty = true;
  QTRY_VERIFY(reset->isVisible());
  QVERIFY(f.d->text("deviceState").startsWith(QStringLiteral("Stopped")));
  QVERIFY(!arm->isVisible());
  f.handle->isFaulty = false;
  QTest::qWait(50);
  QVERIFY2(reset->isVisible(), "what stopped it is over, and the fault is not");
  QTest::mouseClick(reset, Qt::LeftButton);
  QTRY_VERIFY(f.d->text("deviceState").startsWith(QStringLiteral("Not armed")));
  QCOMPARE(f.handle->resets.load(), 1);
  QCOMPARE(f.handle->arms.load(), 1);
  QVERIFY(!reset->isVisible());
  QTRY_VERIFY(arm->isVisible());
  QTest::mouseClick(arm, Qt::LeftButton);
  QTRY_COMPARE(f.handle->arms.load(), 2);
}

void DesktopDeviceTest::aDeviceThatLeavesBeforeTheStartIsMissedAndNotReplaced() {
  // The hand that stands in for the device took the part.
  DeviceFixture f({kArm});
  f.choose(kArm.name);
  QTest::mouseClick(f.d->widget<QPushButton>("startStop"), Qt::LeftButton);
  QVERIFY2(!f.d->application.servo().status().isTaken(), "hierarchies are made first");
  f.plug({});
  QCOMPARE(f.box()->currentText(), QStringLiteral("Manual hand"));
  QTRY_COMPARE(f.failures.size(), 1);
  QVERIFY(f.failures[0].details.contains(QStringLiteral("It is not plugged in")));
  QVERIFY(!f.d->application.servo().status().isTaken());
}

NEARFIT_QT_SUITE(DesktopDeviceTest, runDesktopTest<DesktopDeviceTest>)

#include "desktop_device_test.moc"

// The limits of a device in hand, as they are told and enforced, and settings that are changed while it is
// felt.
#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QTabBar>
#include <QTabWidget>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

#include <glm/geometric.hpp>

#include "tests/app/desktop/desktop_driver.h"
#include "tests/app/desktop/fake_device.h"
#include "ui/model/parts_model.h"
#include "ui/widgets/format.h"
#include "ui/widgets/number_field.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// A fake arm that says what it bears, and keeps the most that it was sent.
class LimitedDevice final : public HapticDevice {
 public:
  struct Sent {
    std::atomic<double> force{0.0}, torque{0.0};
  };
  LimitedDevice(std::shared_ptr<Handle> handle, const DeviceLimits& limits, std::shared_ptr<Sent> sent)
      : arm_(std::move(handle)), limits_(limits), sent_(std::move(sent)) {}

  DeviceInfo info() const override { return {"Fake arm", 6, limits_}; }
  DeviceState state() const noexcept override { return arm_.state(); }
  std::string stateNote() const override { return arm_.stateNote(); }
  ReportCounters counters() const noexcept override { return arm_.counters(); }
  void start(const RigidTransform& pose, const ProgressCallback& progress = {}) override {
    arm_.start(pose, progress);
  }
  void stop() noexcept override { arm_.stop(); }
  void arm() override { arm_.arm(); }
  void disarm() noexcept override { arm_.disarm(); }
  void calibrate() override { arm_.calibrate(); }
  void reset() override { arm_.reset(); }
  bool waitForHandle(Nanoseconds deadline) noexcept override { return arm_.waitForHandle(deadline); }
  bool readHandle(HandleInput& input) noexcept override { return arm_.readHandle(input); }
  void sendWrench(const Wrench& wrench) noexcept override {
    // One thread sends.
    sent_->force = std::max(sent_->force.load(), glm::length(wrench.force));
    sent_->torque = std::max(sent_->torque.load(), glm::length(wrench.torque));
  }

 private:
  FakeDevice arm_;
  DeviceLimits limits_;
  std::shared_ptr<Sent> sent_;
};

class LimitedSource final : public desktop::DeviceSource {
 public:
  explicit LimitedSource(const DeviceLimits& limits) : limits_(limits) {}
  bool hasChanged() override { return false; }
  QVector<ui::DeviceChoice> list() override {
    return {{QStringLiteral("arm"), QStringLiteral("Fake arm"), {}, true}};
  }
  QString find(const QString& wanted) override { return wanted; }
  std::unique_ptr<HapticDevice> make(const QString&) override {
    return std::make_unique<LimitedDevice>(handle, limits_, sent);
  }

  std::shared_ptr<Handle> handle = std::make_shared<Handle>();
  std::shared_ptr<LimitedDevice::Sent> sent = std::make_shared<LimitedDevice::Sent>();

 private:
  DeviceLimits limits_;
};

/// Two cubes, one of them to be led by an arm with limits of its own, or by the manual hand.
struct LimitsFixture {
  explicit LimitsFixture(const DeviceLimits& limits = {}) {
    auto source = std::make_unique<LimitedSource>(limits);
    handle = source->handle;
    sent = source->sent;
    d = std::make_unique<DesktopDriver>(std::move(source));
    QObject::connect(&d->application.servo(), &desktop::ServoController::snapshotArrived, &d->application,
                     [this](const ServoSnapshot& snapshot) { newest = snapshot; });
    d->addCubes();
  }
  const HapticSettings& settings() { return d->session().scene().haptics(); }
  void click(const char* button) { QTest::mouseClick(d->widget<QPushButton>(button), Qt::LeftButton); }
  /// On the box itself: beside its text a click does nothing.
  void check(const char* box) {
    auto* found = d->widget<QCheckBox>(box);
    QTest::mouseClick(found, Qt::LeftButton, {}, {8, found->height() / 2});
  }
  void openTab(const QString& title) {
    auto* tabs = d->widget<QTabWidget>("feelTabs");
    for (int i = 0; i < tabs->count(); ++i) {
      if (tabs->tabText(i) == title)
        QTest::mouseClick(tabs->tabBar(), Qt::LeftButton, {}, tabs->tabBar()->tabRect(i).center());
    }
    QCOMPARE(tabs->tabText(tabs->currentIndex()), title);
  }
  /// By its name: the recorded hand is as good as a device.
  void feelWithArm() {
    auto* hands = d->widget<QComboBox>("hand");
    hands->setFocus();
    QTest::keyClick(hands, Qt::Key_End);
    QCOMPARE(hands->currentText(), QStringLiteral("Fake arm"));
    click("startStop");
    QTRY_VERIFY(d->application.servo().isRunning());
  }
  void openSettings() {
    click("settingsButton");
    QTRY_VERIFY(d->widget<QDialog>("feelDialog")->isVisible());
  }
  /// The hand goes 3.1 mm beyond where contact stops the part, and stays.
  void press() {
    d->startWith(ui::Hand::Manual);
    d->clickPart(1, ui::PartsModel::Name);
    d->type<ui::NumberField>("positionZ", "-8");
    QTRY_VERIFY(newest.contactCount > 0 && isNear(newest.proxy.translation.z, -0.0049, 1.1e-5));
  }
  QString held(double stiffness) {
    return QStringLiteral("limited to %1 N/m").arg(ui::formatNumber(stiffness));
  }

  std::shared_ptr<Handle> handle;
  std::shared_ptr<LimitedDevice::Sent> sent;
  std::unique_ptr<DesktopDriver> d;
  ServoSnapshot newest;
};

DeviceLimits weakArm() {
  DeviceLimits limits;
  limits.maxForce = 1.5;
  limits.maxTorque = 0.05;
  limits.forceSlew = 300.0;
  limits.torqueSlew = 10.0;
  limits.damping = 0.5;
  return limits;
}

}  // namespace

class DesktopLimitsTest : public QObject {
  Q_OBJECT

 private slots:
  void theSettingsTellTheLimitsOfTheDeviceInHand();
  void whatIsWishedBeyondTheDeviceIsHeldAndTold();
  void aForceBeyondTheDeviceIsHeldAndSaidToBe();
  void theMarginIsChangedWhileItIsFeltAndReverted();
  void frictionHoldsThePartOnceItIsSet();
  void couplingAndPresetAreFeltAtOnceAndReverted();
  void inertiaIsOneStepOfUndo();
};

void DesktopLimitsTest::theSettingsTellTheLimitsOfTheDeviceInHand() {
  LimitsFixture f(weakArm());
  f.openSettings();
  auto* mode = f.d->widget<QComboBox>("mode");
  mode->setFocus();
  QTest::keyClick(mode, Qt::Key_Down);
  QCOMPARE(f.settings().mode, HapticMode::Springs);
  const QString usual = QStringLiteral("at most 10 N and 1 N·m, changing by at most 2000 N/s and 200 N·m/s");
  const QString weak = QStringLiteral("at most 1.5 N and 0.05 N·m, changing by at most 300 N/s and 10 N·m/s");
  const auto limits = [&] { return f.d->text("springLimits"); };
  QVERIFY2(limits().contains(usual), qPrintable(limits()));
  f.feelWithArm();
  if (QTest::currentTestFailed()) return;
  QTRY_VERIFY2(limits().contains(weak), qPrintable(limits()));
  QTRY_VERIFY2(f.d->text("springBound").contains(QStringLiteral("device damping of 0.5 N·s/m")),
               qPrintable(f.d->text("springBound")));
  f.d->choose("stop");
  QTRY_VERIFY2(limits().contains(usual), qPrintable(limits()));
}

void DesktopLimitsTest::whatIsWishedBeyondTheDeviceIsHeldAndTold() {
  LimitsFixture f(weakArm());
  f.openSettings();
  f.check("automaticCoupling");
  QVERIFY(!f.settings().coupling.isAutomatic);
  f.d->type<ui::NumberField>("couplingStiffness", "1500");
  const auto note = [&] { return f.d->text("couplingStiffnessNote"); };
  // 2 * 1 N s/m in 1 ms, of a device that nobody knows yet.
  QCOMPARE(note(), QStringLiteral("at most 2000 N/m"));
  f.feelWithArm();
  if (QTest::currentTestFailed()) return;
  QTRY_VERIFY(f.newest.tick > 300);
  // 2 * 0.5 N s/m in the period as it is measured.
  QTRY_VERIFY2(note() == f.held(2.0 * 0.5 / f.newest.period), qPrintable(note()));
  QVERIFY(isNear(f.newest.coupling.stiffness, 1.0 / f.newest.period, 1e-6));
  QVERIFY(f.d->text("boundReason").contains(QStringLiteral("the device's damping of 0.5 N·s/m")));
  // What it can render is.
  f.d->type<ui::NumberField>("couplingStiffness", "100");
  QTRY_COMPARE(f.newest.coupling.stiffness, 100.0);
  QTRY_VERIFY2(note().startsWith(QStringLiteral("at most ")), qPrintable(note()));
  f.d->type<ui::NumberField>("couplingStiffness", "1500");
  QTRY_VERIFY2(note().startsWith(QStringLiteral("limited to ")), qPrintable(note()));
  f.d->choose("stop");
  QTRY_COMPARE(note(), QStringLiteral("at most 2000 N/m"));
}

void DesktopLimitsTest::aForceBeyondTheDeviceIsHeldAndSaidToBe() {
  DeviceLimits limits;
  limits.maxForce = 1.5;
  LimitsFixture f(limits);
  f.feelWithArm();
  if (QTest::currentTestFailed()) return;
  QTRY_VERIFY(f.newest.tick > 10);
  QCOMPARE(f.d->text("clamped"), QString());
  f.click("arm");
  QTRY_VERIFY(f.d->application.servo().status().isArmed);
  // Some 1280 N/m over 0.6 mm: within what it bears.
  f.handle->moveTo({0.0, 0.0, -0.0055});
  QTRY_VERIFY(glm::length(f.newest.wrench.force) > 0.05);
  QCOMPARE(f.d->text("clamped"), QString());
  f.handle->moveTo({0.0, 0.0, -0.009});
  QTRY_COMPARE(f.d->text("clamped"), QStringLiteral("Limited to the device's maximum."));
  QVERIFY(f.d->widget<QLabel>("clamped")->isVisible());
  QTRY_COMPARE(f.d->text("force"), QStringLiteral("1.50 N"));
  QTRY_VERIFY(glm::length(f.newest.unclampedWrench.force) > 1.55);
  f.handle->moveTo({0.0, 0.0, 0.0});
  QTRY_COMPARE(f.d->text("clamped"), QString());
  f.d->choose("stop");
  QVERIFY2(f.sent->force > 1.4 && f.sent->force <= 1.5 + 1e-9, qPrintable(QString::number(f.sent->force)));
}

void DesktopLimitsTest::theMarginIsChangedWhileItIsFeltAndReverted() {
  LimitsFixture f;
  f.press();
  f.openSettings();
  const std::size_t before = f.d->session().historyIndex();
  f.d->type<ui::NumberField>("margin", "0.5");
  // Contact is 5 mm below where the part began.
  QTRY_VERIFY(isNear(f.newest.proxy.translation.z, -0.0045, 3e-5));
  QCOMPARE(f.d->session().historyIndex(), before + 1);
  QVERIFY(f.d->application.servo().isRunning());
  f.click("revert");
  QCOMPARE(f.settings().proxy.margin, 1e-4);
  QTRY_VERIFY(isNear(f.newest.proxy.translation.z, -0.0049, 1.1e-5));
}

void DesktopLimitsTest::frictionHoldsThePartOnceItIsSet() {
  LimitsFixture f;
  f.press();
  f.openSettings();
  const auto x = [&] { return f.newest.proxy.translation.x; };
  const auto hand = [&] { return f.newest.handle.translation.x; };
  f.d->type<ui::NumberField>("friction", "1");
  QTRY_COMPARE(f.settings().proxy.friction, 1.0);
  // Aside by less than it presses: it sticks.
  f.d->type<ui::NumberField>("positionX", "2");
  QTRY_VERIFY(isNear(hand(), 0.002, 1e-9));
  const std::uint64_t then = f.newest.tick;
  QTRY_VERIFY(f.newest.tick > then + 300);
  QVERIFY2(isNear(x(), 0.0, 1e-4), qPrintable(QString::number(x())));
  f.click("revert");
  QCOMPARE(f.settings().proxy.friction, 0.0);
  QTRY_VERIFY2(isNear(x(), 0.002, 1e-5), qPrintable(QString::number(x())));
}

void DesktopLimitsTest::couplingAndPresetAreFeltAtOnceAndReverted() {
  LimitsFixture f;
  f.press();
  const auto stiffness = [&] { return f.newest.coupling.stiffness; };
  const auto isFeltAs = [&] {
    const double lead = glm::distance(f.newest.handle.translation, f.newest.proxy.translation);
    const double force = glm::length(f.newest.wrench.force);
    return lead > 2e-3 && isNear(force, stiffness() * lead, 0.02 * force);
  };
  // As stiff as the device allows: four fifths of 2 (1 - 0.2) N s/m in the period as it is measured.
  const auto isStiff = [&] { return isNear(stiffness() * f.newest.period, 1.28, 1e-6); };
  QTRY_VERIFY(isFeltAs());
  QVERIFY(isStiff());
  f.openSettings();
  auto* preset = f.d->widget<QComboBox>("preset");
  preset->setFocus();
  QTest::keyClick(preset, Qt::Key_Home);
  QCOMPARE(preset->currentText(), QStringLiteral("Soft"));
  QTRY_COMPARE(stiffness(), 250.0);
  QTRY_VERIFY(isFeltAs());
  f.d->type<ui::NumberField>("couplingStiffness", "400");
  QTRY_COMPARE(stiffness(), 400.0);
  QTRY_VERIFY(isFeltAs());
  QCOMPARE(f.d->text("couplingStiffnessNote").left(8), QStringLiteral("at most "));
  f.click("revert");
  QVERIFY(f.settings().coupling.isAutomatic);
  QTRY_VERIFY(isStiff() && isFeltAs());
  QCOMPARE(preset->currentText(), QStringLiteral("Stiff"));
}

void DesktopLimitsTest::inertiaIsOneStepOfUndo() {
  LimitsFixture f;
  f.press();
  f.openSettings();
  f.openTab(QStringLiteral("Weight"));
  auto* inertia = f.d->widget<QCheckBox>("inertia");
  QVERIFY(inertia->isVisible() && inertia->isEnabled() && !inertia->isChecked());
  const std::size_t before = f.d->session().historyIndex();
  HapticSettings expected = f.settings();
  f.check("inertia");
  expected.weight.hasInertia = true;
  QVERIFY(f.settings() == expected);
  QCOMPARE(f.d->session().historyIndex(), before + 1);
  QVERIFY(f.d->application.servo().isRunning());
  pressShortcut(*f.d, Qt::Key_Z, Qt::ControlModifier);
  QVERIFY(!f.settings().weight.hasInertia);
  QVERIFY(!inertia->isChecked());
  QCOMPARE(f.d->session().historyIndex(), before);
  pressShortcut(*f.d, Qt::Key_Y, Qt::ControlModifier);
  QVERIFY(f.settings().weight.hasInertia);
  QVERIFY(inertia->isChecked());
  // Springs leave the part where the hand is: there it has none.
  auto* mode = f.d->widget<QComboBox>("mode");
  mode->setFocus();
  QTest::keyClick(mode, Qt::Key_Down);
  QCOMPARE(f.settings().mode, HapticMode::Springs);
  QVERIFY(!inertia->isEnabled());
}

NEARFIT_QT_SUITE(DesktopLimitsTest, runDesktopTest<DesktopLimitsTest>)
#include "desktop_limits_test.moc"

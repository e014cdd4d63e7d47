#include "ui/panels/feel/feel_dialog.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QStackedWidget>
#include <QtTest>
#include <optional>

#include <glm/gtc/quaternion.hpp>

#include "core/scene/haptic_limits.h"
#include "tests/support/qt/qt_suite.h"
#include "tests/support/temporary_folder.h"
#include "ui/model/feel_mode.h"
#include "ui/model/preset_store.h"

using namespace nearfit;

class FeelDialogTest : public QObject {
  Q_OBJECT

 private slots:
  void init();
  void changesOnlyTheFieldThatWasEdited();
  void offersWhatASceneAllowsAndNoMore();
  void showingIsNoEdit();
  void unitOfStiffnessFollowsTheLaw();
  void modeShowsItsOwnParametersAlone();
  void changingTheLawKeepsTheGreatestPush();
  void tellsTheBoundOfTheDevice();
  void wishesBeyondTheBoundAreShownAsHeld();
  void aTickOfBeforeAWishIsNotItsLimit();
  void aPresetBeyondTheBoundIsShownAsHeld();
  void automaticCouplingShowsWhatIsInForce();
  void springsTellWhatIsEnforced();
  void springsBeyondWhatIsPassiveAreMarked();
  void oneSpringForEachAreaIsAsked();
  void anglesOfTheOrientationBecomeAQuaternion();
  void locksAreSixSwitches();
  void returnInAFieldDoesNotClose();
  void revertTakesBackAllSinceItWasOpened();
  void refusedValuesGoBackWithTheReason();
  void fitsASmallScreen();

 private:
  template <class Widget>
  Widget* widget(const char* name) {
    return dialog_->findChild<Widget*>(QLatin1String(name));
  }
  QDoubleSpinBox* field(const char* name) { return widget<QDoubleSpinBox>(name); }
  void type(const char* name, const char* number) {
    field(name)->selectAll();
    QTest::keyClicks(field(name), QLatin1String(number));
    QTest::keyClick(field(name), Qt::Key_Return);
  }
  void show(const HapticSettings& settings) {
    Scene scene;
    scene.setHaptics(settings);
    dialog_->showScene(scene);
  }
  QString note(const char* name) { return widget<QLabel>(name)->text(); }

  test::TemporaryFolder folder_;
  std::unique_ptr<ui::PresetStore> presets_;
  std::unique_ptr<ui::FeelDialog> dialog_;
  std::optional<HapticSettings> edited_;
};

namespace {

HapticSettings withSprings(const SpringParameters& springs) {
  HapticSettings settings;
  settings.mode = HapticMode::Springs;
  settings.springs = springs;
  return settings;
}

}  // namespace

void FeelDialogTest::init() {
  dialog_.reset();
  presets_ = std::make_unique<ui::PresetStore>(folder_.path() / "presets.json");
  dialog_ = std::make_unique<ui::FeelDialog>(*presets_);
  edited_.reset();
  connect(dialog_.get(), &ui::FeelDialog::settingsEdited, this,
          [this](const HapticSettings& settings) { edited_ = settings; });
}

void FeelDialogTest::changesOnlyTheFieldThatWasEdited() {
  // Numbers with more digits than the fields show.
  HapticSettings before = withSprings({1.23456789e-3, 333.333333, 0.123456789, SpringLaw::Linear});
  before.proxy.margin = 1.23456789e-7;
  before.coupling.rotationalDamping = 1.23456789e-5;
  show(before);
  type("stiffness", "500");
  QVERIFY(edited_);
  HapticSettings expected = before;
  expected.springs.stiffness = 500.0;
  QVERIFY(*edited_ == expected);
  type("cutoff", "2.5");
  QVERIFY(std::abs(edited_->springs.cutoff - 2.5e-3) < 1e-18);
  expected.springs.cutoff = edited_->springs.cutoff;
  QVERIFY(*edited_ == expected);
}

void FeelDialogTest::offersWhatASceneAllowsAndNoMore() {
  QCOMPARE(field("cutoff")->minimum(), kMinCutoff * 1e3);
  QCOMPARE(field("cutoff")->maximum(), kMaxCutoff * 1e3);
  QCOMPARE(field("stiffness")->maximum(), kMaxStiffness);
  QCOMPARE(field("printedStiffness")->maximum(), kMaxPrintedStiffness);
  QCOMPARE(field("margin")->minimum(), kMinMargin * 1e3);
  QCOMPARE(field("friction")->maximum(), kMaxFriction);
  QCOMPARE(field("rotationalStiffness")->maximum(), kMaxRotationalStiffness);
  QCOMPARE(field("gravityZ")->minimum(), -kMaxGravity);
  QCOMPARE(field("scale")->maximum(), kMaxScale);
  QVERIFY(field("scale")->toolTip().contains(QStringLiteral("From 0.001 to 1000")));
  show(withSprings({}));
  type("damping", "-3");
  QVERIFY2(!edited_ || edited_->springs.damping >= 0.0, "damping that drives is refused");
}

void FeelDialogTest::showingIsNoEdit() {
  show(withSprings({0.5, 10.0, 1.0, SpringLaw::Printed}));
  QVERIFY(!edited_);
  QCOMPARE(field("cutoff")->value(), 500.0);
}

void FeelDialogTest::unitOfStiffnessFollowsTheLaw() {
  show(withSprings({0.01, 10.0, 0.0, SpringLaw::Linear}));
  QVERIFY(!field("stiffness")->isHidden() && field("printedStiffness")->isHidden());
  QVERIFY(field("stiffness")->text().endsWith(QStringLiteral(" N/m")));
  show(withSprings({0.01, 10.0, 0.0, SpringLaw::Printed}));
  QVERIFY(field("stiffness")->isHidden() && !field("printedStiffness")->isHidden());
  QVERIFY(field("printedStiffness")->text().endsWith(QStringLiteral(" N/m²")));
}

void FeelDialogTest::modeShowsItsOwnParametersAlone() {
  dialog_->show();
  QVERIFY(field("margin")->isVisible() && !field("stiffness")->isVisible());
  auto* mode = widget<QComboBox>("mode");
  mode->setFocus();
  QTest::keyClick(mode, Qt::Key_Down);
  QVERIFY(edited_);
  QVERIFY(edited_->mode == HapticMode::Springs && edited_->springs.law == SpringLaw::Linear);
  QVERIFY(!field("margin")->isVisible() && field("stiffness")->isVisible() && field("cutoff")->isVisible());
  QTest::keyClick(mode, Qt::Key_Down);
  QVERIFY(edited_->mode == HapticMode::Springs && edited_->springs.law == SpringLaw::Printed);
  QVERIFY(field("printedStiffness")->isVisible());
}

void FeelDialogTest::changingTheLawKeepsTheGreatestPush() {
  // Linear: 200 N/m over 10 mm, 2 N. As printed: k c^2 / 4 = 2 N for k = 80,000 N/m^2.
  const HapticSettings linear = withSprings({0.01, 200.0, 0.0, SpringLaw::Linear});
  const HapticSettings printed = ui::withMode(linear, ui::FeelMode::PrintedSprings);
  QVERIFY(std::abs(printed.springs.stiffness - 80'000.0) < 1e-6);
  QVERIFY(std::abs(ui::withMode(printed, ui::FeelMode::LinearSprings).springs.stiffness - 200.0) < 1e-9);
  // What no scene would take is not asked for.
  const HapticSettings hard = withSprings({10.0, 1e9, 0.0, SpringLaw::Printed});
  QCOMPARE(ui::withMode(hard, ui::FeelMode::LinearSprings).springs.stiffness, kMaxStiffness);
  QVERIFY(ui::withMode(printed, ui::FeelMode::Proxy).springs == printed.springs);
}

void FeelDialogTest::tellsTheBoundOfTheDevice() {
  HapticSettings settings;
  settings.coupling = {false, 500.0, 0.2, 0.5, 0.0};
  show(settings);
  DeviceLimits device;
  device.damping = 1.0;
  device.rotationalDamping = 1e-3;
  dialog_->setDevice(device);
  // K < 2 (b - B) / T: 2 (1 - 0.2) / 1 ms, and 2 * 0.001 / 1 ms; damping up to half of the device's.
  QCOMPARE(note("couplingStiffnessNote"), QStringLiteral("at most 1600 N/m"));
  QCOMPARE(note("couplingDampingNote"), QStringLiteral("at most 0.5 N·s/m"));
  QCOMPARE(note("rotationalStiffnessNote"), QStringLiteral("at most 2 N·m/rad"));
  QVERIFY(note("boundReason").contains(QStringLiteral("1.00 ms")));
  // A servo that is found to be slower allows less.
  dialog_->show();
  ServoSnapshot snapshot;
  snapshot.period = 2e-3;
  snapshot.coupling = {500.0, 0.2, 0.5, 0.0, false};
  dialog_->showSnapshot(snapshot);
  QCOMPARE(note("couplingStiffnessNote"), QStringLiteral("at most 800 N/m"));
  dialog_->clearSnapshot();
  QCOMPARE(note("couplingStiffnessNote"), QStringLiteral("at most 1600 N/m"));
}

void FeelDialogTest::wishesBeyondTheBoundAreShownAsHeld() {
  HapticSettings settings;
  settings.coupling = {false, 1000.0, 0.0, 0.5, 0.0};
  show(settings);
  QCOMPARE(note("couplingStiffnessNote"), QStringLiteral("at most 2000 N/m"));
  type("couplingStiffness", "5000");
  QCOMPARE(edited_->coupling.stiffness, 5000.0);
  QCOMPARE(note("couplingStiffnessNote"), QStringLiteral("limited to 2000 N/m"));
  QCOMPARE(note("rotationalStiffnessNote"), QStringLiteral("at most 2 N·m/rad"));
}

/// "limited to 250 N/m" flashed up after 400 was typed: a tick of before was still to be drawn.
void FeelDialogTest::aTickOfBeforeAWishIsNotItsLimit() {
  HapticSettings settings;
  settings.coupling = {false, 400.0, 0.0, 0.5, 0.0};
  show(settings);
  dialog_->show();
  ServoSnapshot snapshot;
  snapshot.period = 1e-3;
  snapshot.coupling = {250.0, 0.0, 0.5, 0.0, false};
  dialog_->showSnapshot(snapshot);
  QCOMPARE(note("couplingStiffnessNote"), QStringLiteral("at most 2000 N/m"));
}

void FeelDialogTest::aPresetBeyondTheBoundIsShownAsHeld() {
  std::optional<HapticSettings> chosen;
  connect(dialog_.get(), &ui::FeelDialog::presetChosen, this,
          [&](const HapticSettings& settings) { chosen = settings; });
  show({});
  DeviceLimits weak;
  weak.damping = 0.2;
  dialog_->setDevice(weak);
  auto* presets = widget<QComboBox>("preset");
  presets->setFocus();
  QTest::keyClick(presets, Qt::Key_Up);
  QCOMPARE(presets->currentText(), QStringLiteral("Medium"));
  QVERIFY(chosen && chosen->coupling.stiffness == 600.0);
  // 2 (0.2 - 0.1) / 1 ms.
  QCOMPARE(note("couplingStiffnessNote"), QStringLiteral("limited to 200 N/m"));
  QVERIFY(!edited_);
}

void FeelDialogTest::automaticCouplingShowsWhatIsInForce() {
  HapticSettings settings;
  settings.coupling.stiffness = 123.0;
  show(settings);
  QVERIFY(!field("couplingStiffness")->isEnabled());
  // Four fifths of 2 (1 - 0.2) / 1 ms.
  QCOMPARE(field("couplingStiffness")->value(), 1280.0);
  dialog_->show();
  ServoSnapshot snapshot;
  snapshot.period = 1e-3;
  snapshot.coupling = {640.0, 0.1, 0.25, 0.0, false};
  dialog_->showSnapshot(snapshot);
  QCOMPARE(field("couplingStiffness")->value(), 640.0);
  QVERIFY(!edited_);
  QTest::mouseClick(widget<QCheckBox>("automaticCoupling"), Qt::LeftButton, {}, QPoint(8, 8));
  QVERIFY(edited_ && !edited_->coupling.isAutomatic);
  QCOMPARE(edited_->coupling.stiffness, 123.0);
  QCOMPARE(field("couplingStiffness")->value(), 123.0);
  QVERIFY(field("couplingStiffness")->isEnabled());
}

void FeelDialogTest::springsTellWhatIsEnforced() {
  show(withSprings({0.01, 200.0, 0.0, SpringLaw::Linear}));
  DeviceLimits device;
  device.maxForce = 8.0;
  device.maxTorque = 0.5;
  device.forceSlew = 1600.0;
  device.torqueSlew = 100.0;
  device.damping = 1.5;
  dialog_->setDevice(device);
  QVERIFY(note("springLimits")
              .contains(QStringLiteral("at most 8 N and 0.5 N·m, changing by at most 1600 N/s "
                                       "and 100 N·m/s")));
  // 2 b / T, in all.
  QVERIFY(note("springBound").startsWith(QStringLiteral("Limit on the total stiffness")));
  QVERIFY2(note("springBound").contains(QStringLiteral("up to 3000 N/m, at a servo period of 1.00 ms")),
           qPrintable(note("springBound")));
  QVERIFY(!note("springBound").contains(QStringLiteral("now")));
  // Over a scale of two, half the damping at the handle.
  HapticSettings scaled = withSprings({0.01, 200.0, 0.0, SpringLaw::Linear});
  scaled.mapping.scale = 2.0;
  show(scaled);
  QVERIFY(note("springBound").contains(QStringLiteral("up to 1500 N/m")));
}

void FeelDialogTest::springsBeyondWhatIsPassiveAreMarked() {
  DeviceLimits device;
  device.damping = 1.0;
  dialog_->setDevice(device);
  show(withSprings({0.01, 200.0, 0.05, SpringLaw::Linear}));
  dialog_->show();
  ServoSnapshot snapshot;
  snapshot.mode = HapticMode::Springs;
  snapshot.period = 2e-3;
  snapshot.lmdCount = 30;
  snapshot.areaCount = 3;
  dialog_->showSnapshot(snapshot);
  // 2 (1 - 3 * 0.05) / 2 ms = 850 N/m, for three.
  QVERIFY2(note("springBound").contains(QStringLiteral("up to 850 N/m, at a servo period of 2.00 ms")),
           qPrintable(note("springBound")));
  QVERIFY(note("springBound").endsWith(QStringLiteral("Springs now: 3, felt in full.")));
  const QString calm = widget<QLabel>("springBound")->styleSheet();
  snapshot.areaCount = 40;
  snapshot.springShares = {0.25, 0.1};
  dialog_->showSnapshot(snapshot);
  // Damping has half of the device's at most: 2 (1 - 0.5) / 2 ms.
  QVERIFY2(note("springBound").contains(QStringLiteral("up to 500 N/m")), qPrintable(note("springBound")));
  QVERIFY2(note("springBound").endsWith(QStringLiteral("Springs now: 40; felt of them: 25 %.")),
           qPrintable(note("springBound")));
  QVERIFY(widget<QLabel>("springBound")->styleSheet() != calm);
  dialog_->clearSnapshot();
  QVERIFY(!note("springBound").contains(QStringLiteral("now")));
  QCOMPARE(widget<QLabel>("springBound")->styleSheet(), calm);
}

void FeelDialogTest::oneSpringForEachAreaIsAsked() {
  show(withSprings({0.01, 200.0, 0.0, SpringLaw::Linear}));
  QVERIFY(!widget<QCheckBox>("onePerArea")->isChecked());
  dialog_->show();
  QTest::mouseClick(widget<QCheckBox>("onePerArea"), Qt::LeftButton, {}, QPoint(8, 8));
  QVERIFY(edited_ && edited_->springs.onePerArea);
  HapticSettings expected = withSprings({0.01, 200.0, 0.0, SpringLaw::Linear});
  expected.springs.onePerArea = true;
  QVERIFY(*edited_ == expected);
}

void FeelDialogTest::anglesOfTheOrientationBecomeAQuaternion() {
  type("orientationZ", "90");
  QVERIFY(edited_);
  const glm::dvec3 turned = edited_->mapping.orientationOffset * glm::dvec3(1, 0, 0);
  QVERIFY(glm::distance(turned, glm::dvec3(0, 1, 0)) < 1e-12);
  type("orientationX", "90");
  // About x first, then about z: y goes up.
  const glm::dvec3 up = edited_->mapping.orientationOffset * glm::dvec3(0, 1, 0);
  QVERIFY(glm::distance(up, glm::dvec3(0, 0, 1)) < 1e-12);
  QCOMPARE(field("orientationZ")->value(), 90.0);
}

void FeelDialogTest::locksAreSixSwitches() {
  const char* names[6] = {"lockX", "lockY", "lockZ", "lockRx", "lockRy", "lockRz"};
  for (std::size_t i = 0; i < 6; ++i) {
    widget<QCheckBox>(names[i])->click();
    QVERIFY(i < 3 ? edited_->mapping.translationLocks[i] : edited_->mapping.rotationLocks[i - 3]);
  }
  widget<QCheckBox>("lockRy")->click();
  QVERIFY(edited_->mapping.rotationLocks == (std::array{true, false, true}));
}

void FeelDialogTest::revertTakesBackAllSinceItWasOpened() {
  const HapticSettings atFirst;
  show(atFirst);
  dialog_->show();
  auto* revert = widget<QPushButton>("revert");
  QVERIFY(!revert->isEnabled());
  type("margin", "0.25");
  type("friction", "0.3");
  QVERIFY(edited_ && edited_->proxy.friction == 0.3);
  QVERIFY(revert->isEnabled());
  QTest::mouseClick(revert, Qt::LeftButton);
  QVERIFY(*edited_ == atFirst);
  QVERIFY(!revert->isEnabled());
  // Closed and opened again, it goes back to what is set then.
  type("friction", "0.4");
  dialog_->close();
  dialog_->show();
  QVERIFY(!revert->isEnabled());
}

void FeelDialogTest::returnInAFieldDoesNotClose() {
  dialog_->show();
  type("friction", "0.2");
  QCOMPARE(edited_->proxy.friction, 0.2);
  QVERIFY(dialog_->isVisible());
}

void FeelDialogTest::refusedValuesGoBackWithTheReason() {
  const HapticSettings before;
  type("margin", "20");
  QCOMPARE(edited_->proxy.margin, 0.02);
  dialog_->showRefusal(QStringLiteral("Not applied"));
  show(before);
  QCOMPARE(field("margin")->value(), 0.1);
  QVERIFY(!widget<QLabel>("refusal")->isHidden());
  dialog_->showRefusal({});
  QVERIFY(widget<QLabel>("refusal")->isHidden());
}

void FeelDialogTest::fitsASmallScreen() {
  dialog_->show();
  dialog_->showRefusal(
      QStringLiteral("Something that needs two lines, because it says what and why and how. ").repeated(2));
  for (const char* name : {"couplingStiffness", "rotationalDamping"})
    QVERIFY2(field(name)->height() >= field(name)->sizeHint().height(), "no field is squeezed");
  QVERIFY2(dialog_->height() <= 700, qPrintable(QString::number(dialog_->height())));
  QVERIFY2(dialog_->width() <= 480, qPrintable(QString::number(dialog_->width())));
}

NEARFIT_QT_SUITE(FeelDialogTest, test::runQtTest<FeelDialogTest>)
#include "feel_dialog_test.moc"

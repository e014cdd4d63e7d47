// The user's hand without a device, by mouse and keys, and what the window says and sets of devices.
#include <QCheckBox>
#include <QClipboard>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QMouseEvent>
#include <QTabWidget>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <vtkCamera.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>

#include "core/math/rotation_vector.h"
#include "device/common/passive_device.h"
#include "device/common/rate_control.h"
#include "device/thread/monotonic_clock.h"
#include "tests/app/desktop/desktop_driver.h"
#include "ui/model/selection.h"
#include "ui/tools/placing/hand_control.h"
#include "ui/widgets/preferences.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// The two cubes, the moving one in the manual hand, seen from the front: x to the right, z up.
struct ByMouse {
  ByMouse() {
    d.addCubes();
    d.choose("viewFront");
    QObject::connect(&d.window().handControl(), &ui::HandControl::handMoved, &d.window(),
                     [this](const RigidTransform& pose) { hand = pose; });
  }
  void feel() {
    auto* box = d.widget<QComboBox>("hand");
    box->setFocus();
    for (int i = 0; i < box->count() && box->currentData().value<ui::Hand>() != ui::Hand::Manual; ++i)
      QTest::keyClick(box, Qt::Key_Down);
    QTest::mouseClick(d.widget<QPushButton>("startStop"), Qt::LeftButton);
    QTRY_VERIFY(d.application.servo().isRunning());
    QTRY_COMPARE(d.text("statusMinima"), QStringLiteral("Minima 1"));
    hand = d.part("moving").worldFromPart;
  }
  void send(QEvent::Type type, const QPoint& at, Qt::MouseButton button, Qt::KeyboardModifiers keys) {
    const bool isDown = type != QEvent::MouseButtonRelease;
    QMouseEvent event(type, at, view().mapToGlobal(at), button,
                      isDown ? Qt::MouseButtons(Qt::LeftButton) : Qt::NoButton, keys);
    QApplication::sendEvent(&view(), &event);
  }
  /// In ten steps, as a mouse does.
  void drag(const QPoint& way, Qt::KeyboardModifiers keys) {
    const QPoint from = view().rect().center() - way / 2;
    send(QEvent::MouseButtonPress, from, Qt::LeftButton, keys);
    for (int i = 1; i <= 10; ++i)
      send(QEvent::MouseMove, from + way * i / 10, Qt::NoButton, keys);
    send(QEvent::MouseButtonRelease, from + way, Qt::LeftButton, keys);
  }
  ui::Viewport& view() { return d.window().viewport(); }
  vtkRenderer& renderer() { return *view().renderWindow()->GetRenderers()->GetFirstRenderer(); }
  glm::dvec3 eye() {
    const double* place = renderer().GetActiveCamera()->GetPosition();
    return {place[0], place[1], place[2]};
  }
  glm::dvec3 centre() { return hand.applyToPoint(d.part("moving").geometry->mass.centre); }

  DesktopDriver d;
  RigidTransform hand;
};

bool isNearPoint(const glm::dvec3& a, const glm::dvec3& b, double slack) {
  return glm::length(a - b) <= slack;
}

/// Rate settings that the device got last.
struct Told {
  RateSettings rate;
};

class PushedDevice final : public PassiveDevice, public RateDriven {
 public:
  explicit PushedDevice(std::shared_ptr<Told> told) : told_(std::move(told)) {}
  void setRate(const RateSettings& settings) override { told_->rate = settings; }
  DeviceInfo info() const override { return {"Pushed", 0, DeviceLimits{}}; }
  DeviceState state() const noexcept override { return DeviceState::Armed; }
  std::string stateNote() const override { return {}; }
  ReportCounters counters() const noexcept override { return {}; }
  void start(const RigidTransform&, const ProgressCallback& = {}) override {}
  void stop() noexcept override {}
  bool waitForHandle(Nanoseconds deadline) noexcept override {
    waitUntil(deadline);
    return false;
  }
  bool readHandle(HandleInput& input) noexcept override {
    input = {};
    input.hasOwnFrame = true;
    return true;
  }
  void sendWrench(const Wrench&) noexcept override {}

 private:
  std::shared_ptr<Told> told_;
};

class PushedSource final : public desktop::DeviceSource {
 public:
  bool hasChanged() override { return false; }
  QVector<ui::DeviceChoice> list() override { return devices; }
  QString find(const QString& wanted) override { return wanted; }
  std::unique_ptr<HapticDevice> make(const QString&) override { return std::make_unique<PushedDevice>(told); }

  QVector<ui::DeviceChoice> devices{{QStringLiteral("pushed"), QStringLiteral("Pushed"), {}, true}};
  std::shared_ptr<Told> told = std::make_shared<Told>();
};

}  // namespace

class DesktopHandTest : public QObject {
  Q_OBJECT

 private slots:
  void theCameraHasWhatIsNotTheHands();
  void shiftedKeysTurn();
  void withoutASelectionTheNumbersAreThoseOfThePartInHand();
  void feelPutsTheKeysIntoTheViewWhichShowsIt();
  void spaceMouseSettingsReachTheDeviceAndAreKept();
  void whatKeepsDevicesFromBeingUsedIsShownWithTheCommand();
};

void DesktopHandTest::theCameraHasWhatIsNotTheHands() {
  ByMouse m;
  glm::dvec3 eye = m.eye();
  const auto place = m.d.part("moving").worldFromPart.translation;
  m.drag({60, 30}, Qt::ShiftModifier);
  QVERIFY2(!isNearPoint(m.eye(), eye, 1e-6), "nothing is in hand: Shift and dragging pan");
  QVERIFY(isNearPoint(m.d.part("moving").worldFromPart.translation, place, 0.0));
  m.feel();
  eye = m.eye();
  const RigidTransform before = m.hand;
  m.drag({60, 30}, Qt::ShiftModifier);
  QVERIFY(isNearPoint(m.eye(), eye, 0.0));
  QVERIFY(!isNearPoint(m.hand.translation, before.translation, 1e-6));
  const RigidTransform moved = m.hand;
  m.drag({60, 30}, Qt::NoModifier);
  QVERIFY2(!isNearPoint(m.eye(), eye, 1e-6), "orbiting stays possible");
  QVERIFY(isNearPoint(m.hand.translation, moved.translation, 0.0));
}

void DesktopHandTest::shiftedKeysTurn() {
  ByMouse m;
  m.feel();
  const glm::dvec3 middle = m.centre();
  m.d.type<QDoubleSpinBox>("turnStep", "2.5");
  m.view().setFocus();
  QTest::keyClick(&m.view(), Qt::Key_PageUp, Qt::ShiftModifier);
  QVERIFY(isNearPoint(rotationVector(m.hand.rotation), {0.0, 0.0, 2.5 * kDegree}, 1e-12));
  QTest::keyClick(&m.view(), Qt::Key_PageDown, Qt::ShiftModifier);
  QTest::keyClick(&m.view(), Qt::Key_Left, Qt::ShiftModifier);
  QVERIFY(isNearPoint(rotationVector(m.hand.rotation), {-2.5 * kDegree, 0.0, 0.0}, 1e-12));
  QVERIFY(isNearPoint(m.centre(), middle, 1e-12));
  QTest::keyClick(&m.view(), Qt::Key_Up);
  QVERIFY(isNearPoint(m.centre(), middle + glm::dvec3(0.0, 1e-4, 0.0), 1e-12));
}

/// They were empty and grey while the part moved.
void DesktopHandTest::withoutASelectionTheNumbersAreThoseOfThePartInHand() {
  ByMouse m;
  m.feel();
  m.d.window().selection().select(std::nullopt);
  QCOMPARE(m.d.text("poseHeading"), QStringLiteral("moving"));
  auto* z = m.d.widget<QDoubleSpinBox>("positionZ");
  QVERIFY(z->isEnabled());
  m.d.type<QDoubleSpinBox>("positionZ", "2");
  QVERIFY(isNearPoint(m.hand.translation, {0.0, 0.0, 0.002}, 1e-12));
  QTRY_VERIFY(m.d.felt && std::abs(m.d.felt->translation.z - 0.002) < 1e-6);
  m.view().setFocus();
  QTest::keyClick(&m.view(), Qt::Key_PageUp);
  QTRY_VERIFY(std::abs(z->value() - 2.1) < 1e-3);
  m.d.choose("stop");
  QTRY_VERIFY(!m.d.application.servo().isRunning());
  QCOMPARE(m.d.text("poseHeading"), QStringLiteral("moving"));
  QVERIFY(z->isEnabled());
  m.d.session().setMovingPart(std::nullopt);
  QCOMPARE(m.d.text("poseHeading"), QStringLiteral("No part selected"));
  QVERIFY(!z->isEnabled());
}

/// They went on to the list of parts, and Page Down selected another part.
void DesktopHandTest::feelPutsTheKeysIntoTheViewWhichShowsIt() {
  ByMouse m;
  m.d.chooseHand(ui::Hand::Manual);
  m.d.clickPart(0, 0);
  const auto isFramed = [&] {
    const auto edges = m.view().findChildren<QWidget*>(QStringLiteral("viewFocusEdge"));
    return edges.size() == 4 &&
           std::all_of(edges.begin(), edges.end(), [](const QWidget* edge) { return edge->isVisible(); });
  };
  QVERIFY(!isFramed());
  pressShortcut(m.d, Qt::Key_F5);
  QTRY_VERIFY(m.d.application.servo().isRunning());
  // Without a window manager, a menu that was open takes the focus from the window for good, a moment later.
  m.d.window().activateWindow();
  QTRY_COMPARE(QApplication::focusWidget(), static_cast<QWidget*>(&m.view()));
  QVERIFY(isFramed());
  QTRY_COMPARE(m.d.text("statusMinima"), QStringLiteral("Minima 1"));
  QTest::keyClick(QApplication::focusWidget(), Qt::Key_PageUp);
  QTRY_VERIFY(m.hand.translation.z > 0.0);
  QVERIFY(m.d.window().selection().parts() == std::vector{m.d.partId("fixed")});
  m.d.partsView()->setFocus();
  QTRY_VERIFY(!isFramed());
}

void DesktopHandTest::spaceMouseSettingsReachTheDeviceAndAreKept() {
  const auto open = [](DesktopDriver& d) {
    d.choose("feelSettings");
    d.widget<QTabWidget>("feelTabs")->setCurrentIndex(3);
  };
  const auto source = new PushedSource;
  const auto told = source->told;
  {
    DesktopDriver d{std::unique_ptr<desktop::DeviceSource>(source)};
    d.addCubes();
    open(d);
    d.type<QDoubleSpinBox>("rateSpeed", "300");
    auto* box = d.widget<QComboBox>("hand");
    box->setFocus();
    while (box->currentText() != QStringLiteral("Pushed"))
      QTest::keyClick(box, Qt::Key_Down);
    QTest::mouseClick(d.widget<QPushButton>("startStop"), Qt::LeftButton);
    QTRY_VERIFY(d.application.servo().isRunning());
    QCOMPARE(told->rate.fullSpeed, 0.3);
    // In hand, too, and at once.
    QTest::mouseClick(d.widget<QCheckBox>("rateReversedRz"), Qt::LeftButton);
    QTest::mouseClick(d.widget<QCheckBox>("rateOnY"), Qt::LeftButton);
    QVERIFY(told->rate.isInverted[5]);
    QVERIFY(!told->rate.isEnabled[1]);
  }
  RateSettings expected;
  expected.fullSpeed = 0.3;
  expected.isInverted[5] = true;
  expected.isEnabled[1] = false;
  QVERIFY(ui::Preferences::rate() == expected);
  DesktopDriver again;
  open(again);
  QCOMPARE(again.widget<QDoubleSpinBox>("rateSpeed")->value(), 300.0);
  QVERIFY(again.widget<QCheckBox>("rateReversedRz")->isChecked());
  QTest::mouseClick(again.widget<QPushButton>("rateUsual"), Qt::LeftButton);
  QVERIFY(ui::Preferences::rate() == RateSettings{});
  QVERIFY(!again.widget<QCheckBox>("rateReversedRz")->isChecked());
}

void DesktopHandTest::whatKeepsDevicesFromBeingUsedIsShownWithTheCommand() {
  auto source = std::make_unique<PushedSource>();
  ui::DeviceChoice forbidden{QStringLiteral("forbidden"), QStringLiteral("SpaceNavigator"),
                             QStringLiteral("You have no permission to open it; run: sudo mend."), false};
  forbidden.isMendable = true;
  forbidden.command = QStringLiteral("sudo mend");
  ui::DeviceChoice notice{
      {}, QStringLiteral("Plug-in"), QStringLiteral("wrong.so: it is no plug-in."), false};
  notice.isMendable = true;
  source->devices << forbidden << notice;
  DesktopDriver d(std::move(source));
  QVERIFY(d.widget<QLabel>("deviceNotices")->isVisible());
  QVERIFY(d.text("deviceNotices").contains(QStringLiteral("SpaceNavigator: You have no permission")));
  QVERIFY(d.text("deviceNotices").contains(QStringLiteral("Plug-in: wrong.so: it is no plug-in.")));
  QCOMPARE(d.widget<QComboBox>("hand")->findText(QStringLiteral("Plug-in")), -1);
  QTest::mouseClick(d.widget<QPushButton>("copyCommand"), Qt::LeftButton);
  QCOMPARE(QApplication::clipboard()->text(), QStringLiteral("sudo mend"));
}

NEARFIT_QT_SUITE(DesktopHandTest, runDesktopTest<DesktopHandTest>)
#include "desktop_hand_test.moc"

// The window with a device plugged in, used by its widgets alone. Runs under nearfit-emulate, which plugs an
// emulated OpenHap device into this very program: the real registry, driver and libusb find it.
#include <QToolBar>
#include <QToolButton>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "app/desktop/device_source.h"
#include "core/servo/motion_reader.h"
#include "tests/app/desktop/desktop_driver.h"
#include "tests/app/desktop/hand_choice_driver.h"
#include "tests/exact/pose_certifier.h"
#include "ui/widgets/error_box.h"
#include "ui/widgets/number_field.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// The emulated hand goes round a circle of 40 mm across, beside and below where it began, a turn in 4 s: a
/// quarter of the way the moving cube is pressed onto the fixed one, as deep as 15 mm.
struct Plugged {
  Plugged() {
    d.window().setFailureSink([this](const ui::Failure& failure) { failures << failure; });
    d.addCubes();
    QObject::connect(&d.application.servo(), &desktop::ServoController::snapshotArrived, &d.application,
                     [this](const ServoSnapshot& snapshot) { see(snapshot); });
  }
  void see(const ServoSnapshot& snapshot) {
    ++pictures;
    force = glm::length(snapshot.wrench.force);
    strongest = std::max(strongest, force);
    const glm::dvec3& at = snapshot.proxy.translation;
    const bool isOver = std::abs(at.x) < 0.03 && std::abs(at.y) < 0.03;
    if (isOver) lowest = std::min(lowest, at.z);
    if (shown.empty() || shown.back().translation != at) shown.push_back(snapshot.proxy);
  }
  /// How many of the poses that were shown have the part in the fixed one; forgets them.
  std::ptrdiff_t posesWithin() {
    const PoseCertifier certifier(d.part("fixed").geometry->mesh, d.part("moving").geometry->mesh);
    return std::ranges::count(certifier.meetings(std::exchange(shown, {})), char{1});
  }
  void click(const char* button) { QTest::mouseClick(d.widget<QPushButton>(button), Qt::LeftButton); }
  std::filesystem::path path(const char* name) { return d.folder.path() / name; }
  QString file(const char* name) { return QString::fromStdString(path(name).string()); }
  /// By the button in the tool bar; no file ends it.
  void record(const QString& file) {
    if (!file.isEmpty()) whenModal<QFileDialog>([file](QFileDialog* dialog) { chooseFile(dialog, file); });
    auto* bar = d.widget<QToolBar>("toolBar");
    auto* button = bar->widgetForAction(d.action("record"));
    QVERIFY(button->isVisible());
    QTest::mouseClick(button, Qt::LeftButton);
  }
  /// As the button says.
  int recordedSeconds() {
    const QString text = d.action("record")->text();
    return text.section('(', 1).section(' ', 0, 0).toInt();
  }

  DesktopDriver d{desktop::makeDeviceSource()};
  QVector<ui::Failure> failures;
  std::uint64_t pictures = 0;
  double force = 0.0, strongest = 0.0, lowest = 0.0;
  std::vector<RigidTransform> shown;
};

}  // namespace

class DesktopPluggedTest : public QObject {
  Q_OBJECT

 private slots:
  void itsUserChoosesItIsLedByItArmsItFeelsAndPutsThePartDown();
  void howItReportsIsShownWhileItLeads();
  void whatItLeadsIsRecordedByTheButtonAndReplayed();
};

void DesktopPluggedTest::itsUserChoosesItIsLedByItArmsItFeelsAndPutsThePartDown() {
  Plugged p;
  chooseHandNamed(p.d, QStringLiteral("OpenHap"));
  p.click("startStop");
  QTRY_VERIFY(p.d.application.servo().isRunning());
  QTRY_VERIFY(p.d.widget<QPushButton>("arm")->isVisible());
  QVERIFY(p.d.text("deviceState").startsWith(QStringLiteral("Not armed")));

  // It leads, into contact too, and nothing pushes.
  QTRY_VERIFY2(p.lowest < -0.004, "the hand brings the part down to the fixed one");
  QCOMPARE(p.strongest, 0.0);

  QVERIFY2(armedUntil(p.d, [&] { return p.force > 0.5; }), qPrintable(p.d.text("deviceState")));
  QVERIFY(!p.shown.empty());
  QCOMPARE(p.posesWithin(), std::ptrdiff_t{0});

  const double armed = p.strongest;
  QVERIFY(armed > 0.5);
  p.click("arm");
  QTRY_VERIFY(!p.d.application.servo().status().isArmed);
  // Pressed all the time, it is felt no more: for longer than the hand's way round.
  QTRY_COMPARE(p.force, 0.0);
  p.strongest = 0.0;
  const std::uint64_t before = p.pictures;
  QTRY_VERIFY(p.pictures > before + 20);
  QCOMPARE(p.strongest, 0.0);

  p.click("startStop");
  QVERIFY(!p.d.application.servo().status().isTaken());
  QCOMPARE(p.posesWithin(), std::ptrdiff_t{0});
  QCOMPARE(QString::fromStdString(p.d.session().undoText()), QStringLiteral("Feel moving"));
  QVERIFY(glm::length(p.d.part("moving").worldFromPart.translation) < 0.1);

  // Taken up again it is not armed.
  QTRY_VERIFY(p.d.widget<QPushButton>("startStop")->isEnabled());
  p.click("startStop");
  QTRY_VERIFY(p.d.application.servo().isRunning());
  QTRY_VERIFY(p.d.widget<QPushButton>("arm")->isVisible());
  QVERIFY(!p.d.application.servo().status().isArmed);
  p.click("startStop");
  // Where it was stopped, arming it in that moment may have been refused; nothing else goes wrong.
  for (const ui::Failure& failure : p.failures)
    QCOMPARE(failure.summary, QStringLiteral("The device could not be armed."));
}

void DesktopPluggedTest::howItReportsIsShownWhileItLeads() {
  Plugged p;
  chooseHandNamed(p.d, QStringLiteral("OpenHap"));
  p.click("startStop");
  QTRY_VERIFY(p.d.application.servo().isRunning());
  QTRY_VERIFY2(p.d.text("reportRate").endsWith(QStringLiteral(" Hz")), qPrintable(p.d.text("reportRate")));
  QTRY_VERIFY2(p.d.text("reportJitter").startsWith(QStringLiteral("± ")),
               qPrintable(p.d.text("reportJitter")));
  QVERIFY(p.d.widget<QLabel>("reportRate")->isVisible());
  bool isNumber = false;
  p.d.text("reportsLost").toInt(&isNumber);
  QVERIFY(isNumber);
  p.click("startStop");
  QVERIFY(!p.d.widget<QLabel>("reportRate")->isVisible());
  QVERIFY(p.failures.isEmpty());
}

void DesktopPluggedTest::whatItLeadsIsRecordedByTheButtonAndReplayed() {
  Plugged p;
  chooseHandNamed(p.d, QStringLiteral("OpenHap"));
  p.click("startStop");
  QTRY_VERIFY(p.pictures > 5);
  const QString led = p.file("led.csv");
  p.record(led);
  // Some way of the circle.
  QTRY_VERIFY2(p.recordedSeconds() >= 1, qPrintable(p.d.action("record")->text()));
  p.record({});
  QTRY_VERIFY(QFile::exists(led));
  QVERIFY(p.d.application.servo().isRunning());
  p.click("startStop");
  const std::vector<MotionRow> felt = readMotion(p.path("led.csv"));
  QVERIFY(felt.size() > 20);
  const double recorded = felt.back().time - felt.front().time;
  QVERIFY2(recorded > 0.4, qPrintable(QString::number(recorded)));

  // On the timeline, to its end.
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, led); });
  QApplication::setActiveWindow(&p.d.window());
  pressShortcut(p.d, Qt::Key_F8, Qt::ShiftModifier);
  QTRY_COMPARE(p.d.text("timelineName"), QStringLiteral("led.csv"));
  const double length = felt.back().time - felt.front().time;
  QTRY_VERIFY(std::abs(p.d.text("timelineTime").section(' ', 0, 0).toDouble() - length) < 2e-3);
  QTest::mouseClick(p.d.widget<QToolButton>("timelineClose"), Qt::LeftButton);

  // As the hand, beside the device: the part goes the same way from where it is now, far above the other.
  p.d.choose("undo");
  p.d.clickPart(1, 0);
  p.d.type<ui::NumberField>("positionZ", "100");
  const glm::dvec3 high = p.d.part("moving").worldFromPart.translation;
  QCOMPARE(high, glm::dvec3(0.0, 0.0, 0.1));
  p.shown.clear();
  chooseHandNamed(p.d, QStringLiteral("Recorded hand"));
  if (QTest::currentTestFailed()) return;
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, led); });
  p.click("startStop");
  // It ends by itself.
  QTRY_COMPARE(QString::fromStdString(p.d.session().undoText()), QStringLiteral("Feel moving"));
  QVERIFY(!p.d.application.servo().status().isTaken());
  const glm::dvec3 way = felt.back().handle.translation - felt.front().handle.translation;
  const glm::dvec3 end = p.d.part("moving").worldFromPart.translation;
  QVERIFY2(glm::distance(end, high + way) < 3e-3,
           qPrintable(QStringLiteral("%1 %2 %3").arg(end.x).arg(end.y).arg(end.z)));
  double farthest = 0.0;
  for (const RigidTransform& pose : p.shown)
    farthest = std::max(farthest, glm::distance(pose.translation, high));
  QVERIFY2(farthest > 5e-3, qPrintable(QString::number(farthest)));
  QVERIFY(p.failures.isEmpty());
}

NEARFIT_QT_SUITE(DesktopPluggedTest, runDesktopTest<DesktopPluggedTest>)
#include "desktop_plugged_test.moc"

#include <QComboBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QSlider>
#include <QTableView>
#include <QToolButton>
#include <QWheelEvent>

#include "core/servo/motion_reader.h"
#include "tests/app/desktop/export_driver.h"
#include "ui/model/clearance_model.h"
#include "ui/model/parts_model.h"
#include "ui/panels/plots/plot_view.h"
#include "ui/panels/replay/timeline_track.h"
#include "ui/widgets/error_box.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

constexpr int kRecordedRows = 2001;

/// The application with two cubes and a recording of two seconds, in which the part goes 20 mm along x and
/// the hand 30 mm, with a force that grows.
struct TimelineFixture {
  TimelineFixture() {
    d.window().setFailureSink([this](const ui::Failure& failure) { failures << failure; });
    d.addCubes();
    MotionWriter writer(d.folder.path() / "felt.csv");
    for (int i = 0; i < kRecordedRows; ++i) {
      MotionRow row;
      row.time = 5.0 + 1e-3 * i;
      row.proxy.translation.x = 0.02 * i / (kRecordedRows - 1);
      row.handle.translation.x = 0.03 * i / (kRecordedRows - 1);
      // One tick's peak.
      row.wrench.force.x = i == 1234 ? 9.0 : 2.0 * i / (kRecordedRows - 1);
      row.distance = 0.005;
      row.tickTime = 20e-6;
      row.lateness = 60e-6;
      writer.write(row);
    }
    writer.finish();
  }
  QString file(const char* name) { return QString::fromStdString((d.folder.path() / name).string()); }
  void openByMenu() {
    whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, file("felt.csv")); });
    pressShortcut(d, Qt::Key_F8, Qt::ShiftModifier);
    QTRY_COMPARE(d.text("timelineName"), QStringLiteral("felt.csv"));
  }
  /// Stopped at its start.
  void openPaused() {
    openByMenu();
    press("timelinePlay");
    auto* scale = d.widget<QSlider>("timelineScale");
    scale->setFocus();
    QTest::keyClick(scale, Qt::Key_Home);
    QTRY_COMPARE(shownTime(), 0.0);
  }
  void press(const char* button) { QTest::mouseClick(d.widget<QToolButton>(button), Qt::LeftButton); }
  double shownTime() { return d.text("timelineTime").section(' ', 0, 0).toDouble(); }
  ui::PlotView* plots() { return d.widget<ui::PlotView>("plotView"); }
  void showPlots() { d.choose(panelEntry(d.widget<QDockWidget>("plotsDock"))); }

  DesktopDriver d;
  QVector<ui::Failure> failures;
};

}  // namespace

class DesktopTimelineTest : public QObject {
  Q_OBJECT

 private slots:
  void aRecordingIsPlayedToItsEndAndClosedWithoutATrace();
  void theTimelineIsAsHighAsItsContentAndDrawsTheRecording();
  void theFeelPanelHasTheNumbersOfTheRecordingAndSaysSo();
  void scrubbingAndSteppingGoToAnyTick();
  void aMinDistanceThatIsOnlyABoundIsSaidToBeOne();
  void itGoesAtTheChosenSpeedAndLoops();
  void clearancesAreOfThePoseShown();
  void takingAPartInHandEndsTheReplay();
  void whatIsNoRecordingIsToldWithItsLine();
  void withoutAPartInHandThereIsNothingToMove();
  void whatIsFeltIsRecordedFromTheButtonAndPlayed();
  void aRecordingThatCannotBeWrittenIsToldAndThePartStaysInHand();
  void plotsShowTheRecordingWithEveryPeak();
  void plotsAreDrawnOnlyWhileShownAndWhenSomethingIsNew();
  void plotsPauseZoomAndAreExported();
};

void DesktopTimelineTest::aRecordingIsPlayedToItsEndAndClosedWithoutATrace() {
  TimelineFixture f;
  QTRY_VERIFY(f.d.window().viewport().pictureCount() > 0);
  const std::string undo = f.d.session().undoText();
  f.openByMenu();
  QTRY_VERIFY(f.d.widget<QDockWidget>("timelineDock")->isVisible());
  const int before = f.d.window().viewport().pictureCount();
  // It plays at once.
  QTRY_COMPARE(f.shownTime(), 2.0);
  QVERIFY(f.d.window().viewport().pictureCount() > before + 3);
  QVERIFY2(f.d.text("timelineNote").contains(QStringLiteral("Force 2.00 N")),
           qPrintable(f.d.text("timelineNote")));
  f.press("timelineClose");
  QCOMPARE(f.d.text("timelineName"), QStringLiteral("No recording is open."));
  QCOMPARE(f.d.session().undoText(), undo);
  QCOMPARE(f.d.part("moving").worldFromPart.translation.x, 0.0);
  QVERIFY(f.failures.isEmpty());
}

/// It took 250 pixels of the window, most of them empty, and drew nothing.
void DesktopTimelineTest::theTimelineIsAsHighAsItsContentAndDrawsTheRecording() {
  TimelineFixture f;
  f.openPaused();
  const auto* dock = f.d.widget<QDockWidget>("timelineDock");
  auto* track = f.d.widget<ui::TimelineTrack>("timelineTrack");
  QTRY_VERIFY(track->isVisible() && track->width() > 50);
  QTRY_COMPARE(dock->widget()->height(), dock->widget()->sizeHint().height());
  QVERIFY2(dock->widget()->height() < 9 * track->fontMetrics().lineSpacing(),
           qPrintable(QString::number(dock->widget()->height())));
  // 5 mm all along, below the ends of the scale.
  const auto* scale = f.d.widget<QSlider>("timelineScale");
  QCOMPARE(track->curves().maxDistance, 0.005);
  QCOMPARE(track->curves().exact.size(), std::size_t{1});
  QVERIFY(track->curves().atLeast.empty());
  const QPolygonF line = track->curves().exact.front();
  const double left = track->x() + line.first().x(), right = track->x() + line.last().x();
  QVERIFY(left > scale->x() && left < scale->x() + 20);
  QVERIFY(right < scale->geometry().right() + 1 && right > scale->geometry().right() - 20);
  // A press goes to that time.
  const QPoint middle(qRound(0.5 * (line.first().x() + line.last().x())), track->height() / 2);
  QTest::mouseClick(track, Qt::LeftButton, {}, middle);
  QVERIFY(std::abs(f.shownTime() - 1.0) < 0.02);
  const int before = dock->height();
  f.press("timelineClose");
  QTRY_VERIFY(dock->height() < before);
}

/// It had none, while the legend and the timeline had them.
void DesktopTimelineTest::theFeelPanelHasTheNumbersOfTheRecordingAndSaysSo() {
  TimelineFixture f;
  const auto heading = [&] {
    return f.d.widget<QWidget>("feltNumbers")
        ->findChild<QLabel*>(QString(), Qt::FindDirectChildrenOnly)
        ->text();
  };
  QCOMPARE(heading(), QStringLiteral("Felt"));
  f.openByMenu();
  QTRY_COMPARE(f.shownTime(), 2.0);
  QCOMPARE(heading(), QStringLiteral("Felt in the recording"));
  QCOMPARE(f.d.text("force"), QStringLiteral("2.00 N"));
  QVERIFY2(f.d.text("distance").startsWith(QStringLiteral("5.0")), qPrintable(f.d.text("distance")));
  // The hand went 10 mm further than the part.
  QVERIFY2(f.d.text("lead").contains(QStringLiteral("10")), qPrintable(f.d.text("lead")));
  f.press("timelineClose");
  QCOMPARE(heading(), QStringLiteral("Felt"));
  QCOMPARE(f.d.text("force"), QStringLiteral("–"));
}

void DesktopTimelineTest::scrubbingAndSteppingGoToAnyTick() {
  TimelineFixture f;
  f.openPaused();
  auto* scale = f.d.widget<QSlider>("timelineScale");
  QTRY_VERIFY(scale->width() > 50);
  QTest::mouseClick(scale, Qt::LeftButton, {}, scale->rect().center());
  QTRY_VERIFY(std::abs(f.shownTime() - 1.0) < 0.05);
  QTest::mouseClick(scale, Qt::LeftButton, {}, {2, scale->height() / 2});
  QTRY_COMPARE(f.shownTime(), 0.0);
  f.press("timelineForward");
  f.press("timelineForward");
  QCOMPARE(f.shownTime(), 0.002);
  f.press("timelineBack");
  QCOMPARE(f.shownTime(), 0.001);
  auto* play = f.d.widget<QToolButton>("timelinePlay");
  play->setFocus();
  QTest::keyClick(play->parentWidget(), Qt::Key_Right, Qt::ShiftModifier);
  QCOMPARE(f.shownTime(), 0.101);
}

void DesktopTimelineTest::aMinDistanceThatIsOnlyABoundIsSaidToBeOne() {
  TimelineFixture f;
  MotionWriter writer(f.d.folder.path() / "felt.csv");
  for (int i = 0; i < 10; ++i) {
    MotionRow row;
    row.time = 1e-3 * i;
    row.distance = 0.00026;
    row.isDistanceBound = i == 9;
    writer.write(row);
  }
  writer.finish();
  // It plays to its last row, the only one with a bound.
  f.openByMenu();
  QTRY_VERIFY2(f.d.text("timelineNote").contains(QStringLiteral("Clearance at least 0.26 mm")),
               qPrintable(f.d.text("timelineNote")));
  auto* scale = f.d.widget<QSlider>("timelineScale");
  scale->setFocus();
  QTest::keyClick(scale, Qt::Key_Home);
  QTRY_VERIFY2(f.d.text("timelineNote").contains(QStringLiteral("Clearance 0.26 mm")),
               qPrintable(f.d.text("timelineNote")));
}

void DesktopTimelineTest::itGoesAtTheChosenSpeedAndLoops() {
  TimelineFixture f;
  f.openPaused();
  auto* speed = f.d.widget<QComboBox>("timelineSpeed");
  speed->setFocus();
  QTest::keyClick(speed, Qt::Key_End);
  QCOMPARE(speed->currentText(), QStringLiteral("10×"));
  f.press("timelineLoop");
  f.press("timelinePlay");
  // It has begun again when an earlier time is shown.
  double last = 0.0;
  bool hasLooped = false;
  QTRY_VERIFY([&] {
    const double now = f.shownTime();
    hasLooped = hasLooped || now < last;
    last = now;
    return hasLooped;
  }());
  f.press("timelinePlay");
  const double paused = f.shownTime();
  QTest::qWait(60);
  QCOMPARE(f.shownTime(), paused);
}

/// The table, and the line in the view, kept the pose from before.
void DesktopTimelineTest::clearancesAreOfThePoseShown() {
  TimelineFixture f;
  f.d.add({writeOff(f.d.folder.path() / "beside.off", boxMesh(glm::dvec3(0.02), {0.05, 0.0, 0.035}))});
  QTRY_COMPARE(f.d.session().scene().parts().size(), std::size_t{3});
  f.d.choose(panelEntry(f.d.widget<QDockWidget>("clearanceDock")));
  auto* table = f.d.widget<QTableView>("clearanceTable");
  const auto cell = [&](int row, int column) { return table->model()->index(row, column).data().toString(); };
  QTRY_COMPARE(cell(1, ui::ClearanceModel::Distance), QStringLiteral("30.0 mm"));
  table->selectRow(1);
  const auto* label = f.d.widget<QLabel>("clearanceLabel");
  QTRY_VERIFY(label->isVisible());
  f.openPaused();
  auto* scale = f.d.widget<QSlider>("timelineScale");
  // The part goes 20 mm towards the one beside it.
  QTest::keyClick(scale, Qt::Key_End);
  QVERIFY2(!label->isVisible(), "the line is not of the pose shown");
  QTRY_COMPARE(cell(1, ui::ClearanceModel::Distance), QStringLiteral("10.0 mm"));
  QTRY_VERIFY(label->isVisible());
  QCOMPARE(label->text(), QStringLiteral("10.0 mm"));
  f.press("timelineClose");
  QTRY_COMPARE(cell(1, ui::ClearanceModel::Distance), QStringLiteral("30.0 mm"));
}

void DesktopTimelineTest::takingAPartInHandEndsTheReplay() {
  TimelineFixture f;
  f.openByMenu();
  f.d.startWith(ui::Hand::Manual);
  QCOMPARE(f.d.text("timelineName"), QStringLiteral("No recording is open."));
  QVERIFY(!f.d.action("openRecording")->isEnabled());
  QTRY_VERIFY(f.d.application.servo().statistics().ticks > 10);
  f.d.choose("stop");
  QVERIFY(f.d.action("openRecording")->isEnabled());
  QVERIFY(std::abs(f.d.part("moving").worldFromPart.translation.x) < 1e-6);
}

void DesktopTimelineTest::whatIsNoRecordingIsToldWithItsLine() {
  TimelineFixture f;
  std::string text = readBytes(f.d.folder.path() / "felt.csv");
  const std::size_t third = text.find('\n', text.find('\n') + 1) + 1;
  text.replace(third, 5, "what,");
  f.d.folder.write("felt.csv", text);
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, f.file("felt.csv")); });
  pressShortcut(f.d, Qt::Key_F8, Qt::ShiftModifier);
  QTRY_COMPARE(f.failures.size(), 1);
  QVERIFY2(f.failures[0].details.contains(QStringLiteral("felt.csv:3")), qPrintable(f.failures[0].details));
  QCOMPARE(f.d.text("timelineName"), QStringLiteral("No recording is open."));
}

void DesktopTimelineTest::withoutAPartInHandThereIsNothingToMove() {
  TimelineFixture f;
  f.d.session().setMovingPart({});
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, f.file("felt.csv")); });
  pressShortcut(f.d, Qt::Key_F8, Qt::ShiftModifier);
  QTRY_COMPARE(f.failures.size(), 1);
  QVERIFY(f.failures[0].details.contains(QStringLiteral("Take in hand the part")));
}

void DesktopTimelineTest::whatIsFeltIsRecordedFromTheButtonAndPlayed() {
  TimelineFixture f;
  f.d.startWith(ui::Hand::Manual);
  QTRY_VERIFY(f.d.application.servo().statistics().ticks > 10);
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, f.file("mine.csv")); });
  pressShortcut(f.d, Qt::Key_F8, Qt::NoModifier);
  QVERIFY(f.d.action("record")->isChecked());
  f.d.clickPart(1, ui::PartsModel::Name);
  f.d.type<QDoubleSpinBox>("positionZ", "2");
  QTRY_COMPARE(f.d.text("statusDistance"), QStringLiteral("Min distance 7.00 mm"));
  pressShortcut(f.d, Qt::Key_F8, Qt::NoModifier);
  QVERIFY(!f.d.action("record")->isChecked());
  QVERIFY(f.d.application.servo().isRunning());
  const auto rows = readMotion(f.d.folder.path() / "mine.csv");
  QVERIFY(std::abs(rows.back().proxy.translation.z - 0.002) < 1e-6);
  QVERIFY(std::abs(rows.front().proxy.translation.z) < 1e-6);
  f.d.choose("stop");
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, f.file("mine.csv")); });
  pressShortcut(f.d, Qt::Key_F8, Qt::ShiftModifier);
  QTRY_COMPARE(f.d.text("timelineName"), QStringLiteral("mine.csv"));
  QVERIFY(f.failures.isEmpty());
}

void DesktopTimelineTest::aRecordingThatCannotBeWrittenIsToldAndThePartStaysInHand() {
  TimelineFixture f;
  f.d.startWith(ui::Hand::Manual);
  f.d.application.servo().recordTo(f.file("none/felt.csv"));
  QCOMPARE(f.failures.size(), 1);
  QVERIFY(f.d.application.servo().isRunning());
  QVERIFY(!f.d.action("record")->isChecked());
}

void DesktopTimelineTest::plotsShowTheRecordingWithEveryPeak() {
  TimelineFixture f;
  f.showPlots();
  f.openByMenu();
  QTRY_VERIFY(f.plots()->redrawCount() > 0);
  QTRY_VERIFY(std::abs(f.plots()->timeRange().upper - 2.0) < 1e-9);
  QCPRange values;
  QTRY_VERIFY([&] {
    bool isFound = false;
    values = f.plots()->graph(0)->getValueRange(isFound);
    return isFound && std::abs(values.upper - 9.0) < 1e-5;
  }());
  // Closed, it is as it was: nothing has been felt.
  f.press("timelineClose");
  QTRY_COMPARE(f.plots()->graph(0)->dataCount(), 0);
}

void DesktopTimelineTest::plotsAreDrawnOnlyWhileShownAndWhenSomethingIsNew() {
  TimelineFixture f;
  f.d.startWith(ui::Hand::Scripted);
  QTRY_VERIFY(f.d.application.servo().statistics().ticks > 200);
  QCOMPARE(f.plots()->redrawCount(), 0);
  f.showPlots();
  QTRY_VERIFY(f.plots()->redrawCount() > 3);
  // What was felt before is there too.
  QTRY_VERIFY(f.plots()->graph(0)->dataCount() > 100);
  f.d.choose("stop");
  QTest::qWait(200);
  const int still = f.plots()->redrawCount();
  QTest::qWait(200);
  QCOMPARE(f.plots()->redrawCount(), still);
}

void DesktopTimelineTest::plotsPauseZoomAndAreExported() {
  TimelineFixture f;
  f.showPlots();
  f.d.startWith(ui::Hand::Scripted);
  QTRY_VERIFY(f.plots()->graph(0)->dataCount() > 50);
  f.press("pausePlots");
  const auto lastTime = [&] { return (f.plots()->graph(0)->data()->constEnd() - 1)->key; };
  QTest::qWait(80);
  const double paused = lastTime();
  QTest::qWait(150);
  QCOMPARE(lastTime(), paused);
  f.press("pausePlots");
  QTRY_VERIFY(lastTime() > paused);

  const double width = f.plots()->timeRange().size();
  const QPoint middle = f.plots()->rect().center() / 2;
  QWheelEvent wheel(middle, f.plots()->mapToGlobal(middle), {}, {0, 240}, Qt::NoButton, Qt::NoModifier,
                    Qt::NoScrollPhase, false);
  QApplication::sendEvent(f.plots(), &wheel);
  QTRY_VERIFY(f.plots()->timeRange().size() < 0.9 * width);
  QVERIFY(!f.plots()->isFollowing());
  f.press("followPlots");
  QVERIFY(f.plots()->isFollowing());

  f.d.choose("stop");
  const std::vector<std::pair<const char*, const char*>> exports{{"exportPlotTable", "plot.csv"},
                                                                 {"exportPlotPicture", "plot.png"}};
  for (const auto& [button, name] : exports) {
    whenModal<QFileDialog>([&, name = name](QFileDialog* dialog) { chooseFile(dialog, f.file(name)); });
    f.press(button);
    QTRY_VERIFY(QFile::exists(f.file(name)));
  }
  QVERIFY(readBytes(f.d.folder.path() / "plot.csv").starts_with("t_s,force_N"));
  QCOMPARE(QImage(f.file("plot.png")).size(), f.plots()->size());
}

NEARFIT_QT_SUITE(DesktopTimelineTest, runDesktopTest<DesktopTimelineTest>)
#include "desktop_timeline_test.moc"

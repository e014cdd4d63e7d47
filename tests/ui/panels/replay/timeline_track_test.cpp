#include "ui/panels/replay/timeline_track.h"

#include <QSignalSpy>
#include <QtTest>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/qt/qt_suite.h"

using namespace nearfit;
using ui::TrackCurves;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const QRectF kPlot(100.0, 10.0, 400.0, 50.0);

MotionRow rowAt(double time, double distance, std::uint32_t lmds = 1, bool isBound = false) {
  MotionRow row;
  row.time = time;
  row.distance = distance;
  row.lmds = lmds;
  row.isDistanceBound = isBound;
  return row;
}

bool isNear(const QPointF& point, double x, double y) {
  return std::abs(point.x() - x) < 1e-9 && std::abs(point.y() - y) < 1e-9;
}

double lowest(const std::vector<QPolygonF>& lines) {
  double y = -kInfinity;
  for (const QPolygonF& line : lines)
    for (const QPointF& point : line)
      y = std::max(y, point.y());
  return y;
}

}  // namespace

class TimelineTrackTest : public QObject {
  Q_OBJECT

 private slots:
  void eachRowOfAShortRecordingIsAPoint();
  void boundsAreLinesOfTheirOwn();
  void aLineIsBrokenWhereNothingIsWithinTheCutoff();
  void aDipOfOneTickIsNotLost();
  void minimaAreCountedOnAScaleOfTheirOwn();
  void curvesWithoutDataHaveNoName();
  void degenerateRecordingsStayInThePlot();
  void aPressGoesToItsTime();
};

void TimelineTrackTest::eachRowOfAShortRecordingIsAPoint() {
  const std::vector rows{rowAt(0.0, 0.004), rowAt(1.0, 0.002), rowAt(4.0, 0.0)};
  const TrackCurves curves = ui::trackCurves(rows, kPlot);
  QCOMPARE(curves.maxDistance, 0.004);
  QCOMPARE(curves.exact.size(), std::size_t{1});
  const QPolygonF& line = curves.exact.front();
  QCOMPARE(line.size(), 3);
  QVERIFY(isNear(line[0], 100.0, 10.0));
  QVERIFY(isNear(line[1], 200.0, 35.0));
  QVERIFY(isNear(line[2], 500.0, 60.0));
  QVERIFY(curves.atLeast.empty());
}

void TimelineTrackTest::boundsAreLinesOfTheirOwn() {
  const std::vector rows{rowAt(0.0, 0.004), rowAt(1.0, 0.004), rowAt(2.0, 0.001, 1, true), rowAt(3.0, 0.002),
                         rowAt(4.0, 0.002)};
  const TrackCurves curves = ui::trackCurves(rows, kPlot);
  QCOMPARE(curves.exact.size(), std::size_t{2});
  QCOMPARE(curves.exact[0].size(), 2);
  QCOMPARE(curves.exact[1].size(), 2);
  QCOMPARE(curves.atLeast.size(), std::size_t{1});
  QCOMPARE(curves.atLeast[0].size(), 1);
  QVERIFY(isNear(curves.atLeast[0][0], 300.0, 47.5));
}

void TimelineTrackTest::aLineIsBrokenWhereNothingIsWithinTheCutoff() {
  const std::vector rows{rowAt(0.0, 0.004), rowAt(1.0, kInfinity, 0), rowAt(2.0, kInfinity, 0),
                         rowAt(4.0, 0.001)};
  const TrackCurves curves = ui::trackCurves(rows, kPlot);
  QCOMPARE(curves.exact.size(), std::size_t{2});
  QVERIFY(isNear(curves.exact[0].last(), 100.0, 10.0));
  QVERIFY(isNear(curves.exact[1].first(), 500.0, 47.5));
  // The count goes on: none.
  QCOMPARE(curves.minima.size(), std::size_t{1});
  QVERIFY(isNear(curves.minima[0][1], 200.0, 60.0));
}

void TimelineTrackTest::aDipOfOneTickIsNotLost() {
  constexpr int kRows = 100'001, kDip = 61'803;
  std::vector<MotionRow> rows;
  for (int i = 0; i < kRows; ++i)
    rows.push_back(rowAt(1e-3 * i, i == kDip ? 0.001 : 0.01));
  const TrackCurves curves = ui::trackCurves(rows, kPlot);
  QCOMPARE(curves.exact.size(), std::size_t{1});
  const QPolygonF& line = curves.exact.front();
  QVERIFY2(line.size() <= 2 * 401, "two points for each column of pixels");
  QVERIFY(std::abs(lowest(curves.exact) - 55.0) < 1e-9);
  const auto dip = std::max_element(line.begin(), line.end(),
                                    [](const QPointF& a, const QPointF& b) { return a.y() < b.y(); });
  QVERIFY(std::abs(dip->x() - (100.0 + 400.0 * kDip / (kRows - 1))) < 1e-6);
  QVERIFY(std::is_sorted(line.begin(), line.end(),
                         [](const QPointF& a, const QPointF& b) { return a.x() < b.x(); }));
}

void TimelineTrackTest::minimaAreCountedOnAScaleOfTheirOwn() {
  const std::vector rows{rowAt(0.0, 0.004, 0), rowAt(2.0, 0.004, 12), rowAt(4.0, 0.004, 3)};
  const TrackCurves curves = ui::trackCurves(rows, kPlot);
  QCOMPARE(curves.maxMinima, 12U);
  QCOMPARE(curves.minima.size(), std::size_t{1});
  QVERIFY(isNear(curves.minima[0][0], 100.0, 60.0));
  QVERIFY(isNear(curves.minima[0][1], 300.0, 10.0));
  QVERIFY(isNear(curves.minima[0][2], 500.0, 47.5));
}

// A path whose clearance was not plotted yet had "Local minima, up to 0".
void TimelineTrackTest::curvesWithoutDataHaveNoName() {
  const auto namesOf = [](const std::vector<MotionRow>& rows) {
    QStringList names;
    for (const auto& [colour, name] : ui::trackNames(ui::trackCurves(rows, kPlot)))
      names << name;
    return names;
  };
  const QString exact = QStringLiteral("Min distance"), atLeast = QStringLiteral("Min distance, at least"),
                minima = QStringLiteral("Local minima, up to 3");
  QCOMPARE(namesOf({rowAt(0.0, kInfinity, 0), rowAt(1.0, kInfinity, 0)}), QStringList());
  QCOMPARE(namesOf({rowAt(0.0, 0.004, 0), rowAt(1.0, 0.002, 0)}), QStringList{exact});
  QCOMPARE(namesOf({rowAt(0.0, 0.004, 0, true), rowAt(1.0, 0.002, 3, true)}), (QStringList{atLeast, minima}));
  QCOMPARE(namesOf({rowAt(0.0, 0.004), rowAt(1.0, 0.002, 3, true)}), (QStringList{exact, atLeast, minima}));
}

void TimelineTrackTest::degenerateRecordingsStayInThePlot() {
  const std::vector<std::vector<MotionRow>> recordings{
      {},
      {rowAt(0.0, 0.004)},
      {rowAt(0.0, 0.0, 0), rowAt(0.0, 0.0, 0)},
      {rowAt(0.0, kInfinity, 0), rowAt(1.0, std::numeric_limits<double>::quiet_NaN(), 0)}};
  for (const std::vector<MotionRow>& rows : recordings) {
    const TrackCurves curves = ui::trackCurves(rows, kPlot);
    for (const auto* lines : {&curves.exact, &curves.atLeast, &curves.minima})
      for (const QPolygonF& line : *lines)
        for (const QPointF& point : line)
          QVERIFY(point.x() >= 100.0 && point.x() <= 500.0 && point.y() >= 10.0 && point.y() <= 60.0);
  }
}

void TimelineTrackTest::aPressGoesToItsTime() {
  const std::vector rows{rowAt(0.0, 0.004), rowAt(8.0, 0.004)};
  ui::TimelineTrack track;
  track.resize(500, track.sizeHint().height());
  track.setEnds(100, 300);
  QSignalSpy sought(&track, &ui::TimelineTrack::sought);
  QTest::mouseClick(&track, Qt::LeftButton, {}, {150, 10});
  QVERIFY2(sought.empty(), "there is no recording");
  track.showRows(rows);
  for (const int x : {150, 20, 450})
    QTest::mouseClick(&track, Qt::LeftButton, {}, {x, 10});
  QCOMPARE(sought.count(), 3);
  QCOMPARE(sought[0][0].toDouble(), 2.0);
  QCOMPARE(sought[1][0].toDouble(), 0.0);
  QCOMPARE(sought[2][0].toDouble(), 8.0);
}

NEARFIT_QT_SUITE(TimelineTrackTest, test::runQtTest<TimelineTrackTest>)
#include "timeline_track_test.moc"

// What the plots show over time, of a recording and live, and what is exported of it.
#include <QAbstractItemView>
#include <QComboBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QToolButton>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/servo/motion_recording.h"
#include "tests/app/desktop/export_driver.h"
#include "ui/model/parts_model.h"
#include "ui/panels/plots/plot_view.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// A recording of a minute, four rows a second, in which each number goes its own way.
constexpr int kPlottedRows = 241;
constexpr double kRowPeriod = 0.25;
/// From here on the distance is only a bound.
constexpr int kFirstBound = 200;

double timeOf(int row) {
  return kRowPeriod * row;
}
/// The force and the torque are read as vectors, of which the plots show the length.
MotionRow rowAt(int row) {
  const double share = static_cast<double>(row) / (kPlottedRows - 1);
  MotionRow out;
  out.time = timeOf(row);
  out.wrench.force = (2.0 + 3.0 * share) * glm::dvec3(0.6, 0.0, -0.8);
  out.wrench.torque = (0.2 - 0.1 * share) * glm::dvec3(0.0, 0.8, 0.6);
  out.distance = 4e-3 + 5e-3 * share;
  out.isDistanceBound = row >= kFirstBound;
  // Recordings have whole nanoseconds of these.
  out.tickTime = 30e-6 + 80e-9 * row;
  out.queryTime = 7e-6;
  out.proxyTime = 11e-6;
  out.lateness = 90e-6 - 100e-9 * row;
  out.energyToHand = 0.5;
  return out;
}

/// A line of the plots, as it has to be.
struct Expected {
  const char* title;  ///< Of the plot that it is in.
  const char* name;   ///< In the legend; null: it has none.
  double (*valueOf)(const MotionRow&);
  double scale;  ///< Units of the plot to the SI unit.
};
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kLines = 6;
const Expected kExpected[kLines] = {
    {"Force [N]", nullptr, [](const MotionRow& row) { return glm::length(row.wrench.force); }, 1.0},
    {"Torque [mN·m]", nullptr, [](const MotionRow& row) { return glm::length(row.wrench.torque); }, 1e3},
    {"Clearance [mm]", "exact",
     [](const MotionRow& row) { return row.isDistanceBound ? kNone : row.distance; }, 1e3},
    {"Clearance [mm]", "at least",
     [](const MotionRow& row) { return row.isDistanceBound ? row.distance : kNone; }, 1e3},
    {"Servo [µs]", "tick", [](const MotionRow& row) { return row.tickTime; }, 1e6},
    {"Servo [µs]", "lateness", [](const MotionRow& row) { return row.lateness; }, 1e6}};

/// Samples are kept as floats.
bool isNearlyEqual(double value, double expected) {
  if (std::isnan(expected)) return std::isnan(value);
  return std::abs(value - expected) <= 1e-6 * std::abs(expected);
}

struct PlotsFixture {
  PlotsFixture() {
    d.addCubes();
    MotionWriter writer(d.folder.path() / "known.csv");
    for (int i = 0; i < kPlottedRows; ++i)
      writer.write(rowAt(i));
    writer.finish();
    d.choose(panelEntry(d.widget<QDockWidget>("plotsDock")));
    QTRY_VERIFY(plots()->isVisible());
  }
  ui::PlotView* plots() { return d.widget<ui::PlotView>("plotView"); }
  QComboBox* span() { return d.widget<QComboBox>("plotSpan"); }
  QString file(const char* name) { return QString::fromStdString((d.folder.path() / name).string()); }
  void press(const char* button) { QTest::mouseClick(d.widget<QToolButton>(button), Qt::LeftButton); }
  void openRecording() {
    whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, file("known.csv")); });
    pressShortcut(d, Qt::Key_F8, Qt::ShiftModifier);
    QTRY_COMPARE(d.text("timelineName"), QStringLiteral("known.csv"));
    QTRY_COMPARE(plots()->graph(0)->dataCount(), kPlottedRows);
  }
  /// Of the plot that a line is drawn in.
  QString titleOf(QCPGraph* graph) {
    QCPLayoutInset* inset = graph->valueAxis()->axisRect()->insetLayout();
    for (int i = 0; i < inset->elementCount(); ++i) {
      if (auto* title = qobject_cast<QCPTextElement*>(inset->elementAt(i))) return title->text();
    }
    return {};
  }
  QCPGraph* line(const Expected& expected) {
    for (int i = 0; i < plots()->graphCount(); ++i) {
      QCPGraph* graph = plots()->graph(i);
      const QString name = expected.name != nullptr ? QString::fromUtf8(expected.name) : graph->name();
      if (titleOf(graph) == QString::fromUtf8(expected.title) && graph->name() == name) return graph;
    }
    throw Error("plots", std::string("there is no line for ") + expected.title);
  }
  bool isShown(double from, double to) {
    const QCPRange range = plots()->timeRange();
    return std::abs(range.lower - from) < 1e-9 && std::abs(range.upper - to) < 1e-9;
  }
  /// All plots are over one time, and have the samples of it and no more than one beside at either end.
  bool haveAllPlots(double from, double to) {
    if (!isShown(from, to)) return false;
    for (int i = 0; i < plots()->graphCount(); ++i) {
      QCPGraph* graph = plots()->graph(i);
      const QCPRange axis = graph->keyAxis()->range();
      if (std::abs(axis.lower - from) > 1e-9 || std::abs(axis.upper - to) > 1e-9) return false;
      if (graph->dataCount() == 0) return false;
      const double first = graph->data()->at(0)->key, last = graph->data()->at(graph->dataCount() - 1)->key;
      if (first < from - 1.01 * kRowPeriod || first > from + 1e-9) return false;
      if (last < to - 1e-9 || last > to + 1.01 * kRowPeriod) return false;
    }
    return true;
  }
  /// By a click on the list and one on its entry.
  void clickSpan(const QString& text) {
    QTest::mouseClick(span(), Qt::LeftButton);
    QTRY_VERIFY(span()->view()->isVisible());
    const QModelIndex entry = span()->model()->index(span()->findText(text), 0);
    QAbstractItemView* list = span()->view();
    // Entries are wider than the list.
    const QPoint at = (list->visualRect(entry) & list->viewport()->rect()).center();
    QTest::mouseMove(list->viewport(), at);
    // For a while after it opens the list takes no release, which would be that of the click that opened it.
    QTRY_VERIFY([&] {
      if (list->isVisible()) QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, at);
      return !list->isVisible();
    }());
    QCOMPARE(span()->currentText(), text);
  }
  /// The exported table: its header, and a row for each of its lines.
  std::vector<std::vector<double>> exportTable(std::string& header) {
    whenModal<QFileDialog>([this](QFileDialog* dialog) { chooseFile(dialog, file("plot.csv")); });
    press("exportPlotTable");
    std::istringstream text(readBytes(d.folder.path() / "plot.csv"));
    std::getline(text, header);
    std::vector<std::vector<double>> rows;
    for (std::string row; std::getline(text, row);) {
      rows.emplace_back();
      std::istringstream fields(row);
      for (std::string field; std::getline(fields, field, ',');)
        rows.back().push_back(field.empty() ? kNone : std::stod(field));
    }
    return rows;
  }

  DesktopDriver d;
};

/// All that the plots have of each line; less than 0 where it is broken.
std::vector<std::vector<std::pair<double, double>>> drawn(ui::PlotView& plots) {
  std::vector<std::vector<std::pair<double, double>>> all;
  for (int i = 0; i < plots.graphCount(); ++i) {
    all.emplace_back();
    for (const QCPGraphData& point : *plots.graph(i)->data())
      all.back().emplace_back(point.key, std::isnan(point.value) ? -1.0 : point.value);
  }
  return all;
}

}  // namespace

class DesktopPlotsTest : public QObject {
  Q_OBJECT

 private slots:
  void eachLineHasItsOwnColumnOfTheRecordingInItsUnit();
  void theTableHasAllColumnsInSiUnits();
  void theTableHasTheTimeThatIsShown();
  void legendsAreLeftOutWhereTheyWouldLieOverTitles();
  void theSpanIsChosenByKeys();
  void theSpanIsChosenByTheMouse();
  void theSpanFollowsTheNewestThatIsFelt();
  void whatIsFeltIsWhatThePanelSays();
  void whilePausedNothingChangesAndNothingIsLost();
};

void DesktopPlotsTest::eachLineHasItsOwnColumnOfTheRecordingInItsUnit() {
  PlotsFixture f;
  f.openRecording();
  QCOMPARE(f.plots()->graphCount(), kLines);
  QVector<QCPGraph*> seen;
  for (const Expected& expected : kExpected) {
    QCPGraph* graph = f.line(expected);
    QVERIFY2(!seen.contains(graph), expected.title);
    seen << graph;
    QCOMPARE(graph->dataCount(), kPlottedRows);
    for (int i = 0; i < kPlottedRows; ++i) {
      const QCPGraphData& point = *graph->data()->at(i);
      QVERIFY(std::abs(point.key - timeOf(i)) < 1e-9);
      const double value = expected.scale * expected.valueOf(rowAt(i));
      QVERIFY2(isNearlyEqual(point.value, value), qPrintable(QStringLiteral("%1 %2: %3 instead of %4")
                                                                 .arg(QString::fromUtf8(expected.title))
                                                                 .arg(i)
                                                                 .arg(point.value)
                                                                 .arg(value)));
      // All of it is within what its axis shows.
      QVERIFY(std::isnan(value) || graph->valueAxis()->range().contains(value));
    }
  }
}

void DesktopPlotsTest::theTableHasAllColumnsInSiUnits() {
  PlotsFixture f;
  f.openRecording();
  std::string header;
  const auto rows = f.exportTable(header);
  QCOMPARE(header, std::string("t_s,force_N,torque_Nm,clearance_m,clearance_at_least_m,tick_s,lateness_s"));
  QCOMPARE(rows.size(), std::size_t{kPlottedRows});
  for (int i = 0; i < kPlottedRows; ++i) {
    const auto& row = rows[static_cast<std::size_t>(i)];
    QCOMPARE(row.size(), std::size_t{1 + kLines});
    QVERIFY(std::abs(row[0] - timeOf(i)) < 1e-9);
    for (std::size_t column = 0; column < kLines; ++column) {
      const double value = kExpected[column].valueOf(rowAt(i));
      QVERIFY2(
          isNearlyEqual(row[1 + column], value),
          qPrintable(QStringLiteral("row %1, column %2: %3").arg(i).arg(column + 1).arg(row[1 + column])));
    }
  }
}

void DesktopPlotsTest::theTableHasTheTimeThatIsShown() {
  PlotsFixture f;
  f.openRecording();
  f.span()->setFocus();
  QTest::keyClick(f.span(), Qt::Key_Home);
  QTRY_VERIFY(f.isShown(58.0, 60.0));
  std::string header;
  const auto rows = f.exportTable(header);
  QCOMPARE(rows.size(), std::size_t{9});
  QCOMPARE(rows.front()[0], 58.0);
  QCOMPARE(rows.back()[0], 60.0);
  QVERIFY(isNearlyEqual(rows.back()[1], 5.0));
}

void DesktopPlotsTest::legendsAreLeftOutWhereTheyWouldLieOverTitles() {
  ui::PlotView view;
  view.setMinimumSize(1, 1);
  view.show();
  QVERIFY(QTest::qWaitForWindowExposed(&view));
  const auto legends = view.findChildren<QCPLegend*>();
  QCOMPARE(legends.size(), 2);
  for (const int width : {1200, 180, 1200}) {
    view.resize(width, 240);
    view.replot();
    for (const QCPLegend* legend : legends)
      QCOMPARE(legend->visible(), width > 1000);
  }
}

void DesktopPlotsTest::theSpanIsChosenByKeys() {
  PlotsFixture f;
  f.openRecording();
  QCOMPARE(f.span()->currentText(), QStringLiteral("All"));
  QVERIFY(f.haveAllPlots(0.0, 60.0));
  f.span()->setFocus();
  const std::pair<const char*, double> spans[] = {{"30 s", 30.0}, {"10 s", 10.0}, {"2 s", 2.0}};
  QTest::keyClick(f.span(), Qt::Key_Up);
  for (const auto& [text, seconds] : spans) {
    QTest::keyClick(f.span(), Qt::Key_Up);
    QTRY_COMPARE(f.span()->currentText(), QLatin1String(text));
    QTRY_VERIFY2(f.haveAllPlots(60.0 - seconds, 60.0), text);
  }
  QTest::keyClick(f.span(), Qt::Key_End);
  QTRY_VERIFY(f.haveAllPlots(0.0, 60.0));
}

void DesktopPlotsTest::theSpanIsChosenByTheMouse() {
  PlotsFixture f;
  f.openRecording();
  f.clickSpan(QStringLiteral("10 s"));
  if (QTest::currentTestFailed()) return;
  QTRY_VERIFY(f.haveAllPlots(50.0, 60.0));
  f.clickSpan(QStringLiteral("2 s"));
  if (QTest::currentTestFailed()) return;
  QTRY_VERIFY(f.haveAllPlots(58.0, 60.0));
}

void DesktopPlotsTest::theSpanFollowsTheNewestThatIsFelt() {
  PlotsFixture f;
  f.d.startWith(ui::Hand::Scripted);
  f.span()->setFocus();
  QTest::keyClick(f.span(), Qt::Key_Home);
  QCOMPARE(f.span()->currentText(), QStringLiteral("2 s"));
  const auto range = [&] { return f.plots()->timeRange(); };
  QTRY_VERIFY(range().upper > 2.3 && std::abs(range().size() - 2.0) < 1e-9);
  const double then = range().upper;
  QTRY_VERIFY(range().upper > then + 0.2);
  QVERIFY(std::abs(range().size() - 2.0) < 1e-9);
  QTest::keyClick(f.span(), Qt::Key_End);
  QTRY_VERIFY(range().lower < 0.1);
  QVERIFY(range().upper > then);
}

void DesktopPlotsTest::whatIsFeltIsWhatThePanelSays() {
  PlotsFixture f;
  HapticSettings settings = f.d.session().scene().haptics();
  settings.mode = HapticMode::Springs;
  f.d.session().setHaptics(settings);
  f.d.startWith(ui::Hand::Manual);
  // A push of 200 N/m over the 5 mm that are left to the cutoff.
  QTRY_COMPARE(f.d.text("force"), QStringLiteral("1.00 N"));
  const auto last = [&](int line) {
    const QCPGraph* graph = f.line(kExpected[line]);
    return graph->dataCount() > 0 ? (graph->data()->constEnd() - 1)->value : -1.0;
  };
  QTRY_VERIFY(std::abs(last(0) - 1.0) < 1e-3);
  QVERIFY(std::abs(last(2) - 5.0) < 1e-3);
  f.d.clickPart(1, ui::PartsModel::Name);
  f.d.type<QDoubleSpinBox>("positionZ", "-2");
  QTRY_VERIFY(std::abs(last(2) - 3.0) < 1e-3);
  QTRY_VERIFY(std::abs(last(0) - 1.4) < 1e-3);
  QVERIFY(last(4) > 0.0 && last(5) >= 0.0);
}

void DesktopPlotsTest::whilePausedNothingChangesAndNothingIsLost() {
  PlotsFixture f;
  f.d.startWith(ui::Hand::Scripted);
  const auto lastTime = [&] {
    const QCPGraph* graph = f.plots()->graph(0);
    return graph->dataCount() > 0 ? (graph->data()->constEnd() - 1)->key : 0.0;
  };
  QTRY_VERIFY(lastTime() > 0.3);
  f.press("pausePlots");
  QVERIFY(f.d.text("plotNote").contains(QStringLiteral("Paused")));
  // What was on its way when it was pressed is drawn yet.
  QTRY_VERIFY([&] {
    const int before = f.plots()->redrawCount();
    QTest::qWait(4 * ui::PlotView::kMinRedrawMs);
    return f.plots()->redrawCount() == before;
  }());
  const auto paused = drawn(*f.plots());
  const double pausedAt = lastTime();
  const QCPRange range = f.plots()->timeRange();
  const QImage picture = f.plots()->toPixmap().toImage();
  const std::uint64_t ticks = f.d.application.servo().statistics().ticks;
  QTRY_VERIFY(f.d.application.servo().statistics().ticks > ticks + 500);
  QVERIFY(drawn(*f.plots()) == paused);
  QVERIFY(f.plots()->timeRange() == range);
  QCOMPARE(f.plots()->toPixmap().toImage(), picture);
  f.press("pausePlots");
  QTRY_VERIFY(lastTime() > pausedAt + 0.4);
  QVERIFY(!f.d.text("plotNote").contains(QStringLiteral("Paused")));
  f.d.choose("stop");
  // Each tick is there, those of the pause too.
  f.span()->setFocus();
  QTest::keyClick(f.span(), Qt::Key_End);
  QTRY_VERIFY(f.plots()->timeRange().lower < 0.1);
  std::string header;
  const auto rows = f.exportTable(header);
  QCOMPARE(rows.size(), static_cast<std::size_t>(f.d.application.servo().statistics().ticks));
}

NEARFIT_QT_SUITE(DesktopPlotsTest, runDesktopTest<DesktopPlotsTest>)
#include "desktop_plots_test.moc"

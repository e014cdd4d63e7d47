#include "ui/panels/plots/plot_view.h"

#include <QtTest>
#include <cmath>

#include "tests/support/qt/qt_suite.h"

using namespace nearfit;

class PlotViewTest : public QObject {
  Q_OBJECT

 private slots:
  void numbersOfALowPlotDoNotLieOverEachOther_data();
  void numbersOfALowPlotDoNotLieOverEachOther();
  void numbersComeBackWithTheRoom();

 private:
  /// Least distance between neighbouring numbers of an axis [pixels]; infinity if there are none.
  static double leastGap(const QCPAxis& axis) {
    double least = INFINITY;
    const QVector<double> ticks = axis.tickVector();
    for (int i = 1; axis.tickLabels() && i < ticks.size(); ++i)
      least = std::min(least, std::abs(axis.coordToPixel(ticks[i]) - axis.coordToPixel(ticks[i - 1])));
    return least;
  }
  static bool areValuesApart(const ui::PlotView& view) {
    for (const QCPAxisRect* pane : view.axisRects()) {
      const QCPAxis& axis = *pane->axis(QCPAxis::atLeft);
      if (leastGap(axis) < QFontMetrics(axis.tickLabelFont()).ascent()) return false;
    }
    return true;
  }
};

void PlotViewTest::numbersOfALowPlotDoNotLieOverEachOther_data() {
  QTest::addColumn<int>("height");
  for (const int height : {140, 150, 165, 180, 220, 300})
    QTest::addRow("%d", height) << height;
}

void PlotViewTest::numbersOfALowPlotDoNotLieOverEachOther() {
  QFETCH(int, height);
  ui::PlotView view;
  view.resize(420, height);
  view.show();
  QVERIFY(QTest::qWaitForWindowExposed(&view));
  QTRY_VERIFY(view.redrawCount() > 0);
  // The picture after the first layout has them.
  QTRY_VERIFY(areValuesApart(view));
}

void PlotViewTest::numbersComeBackWithTheRoom() {
  ui::PlotView view;
  view.resize(420, 140);
  view.show();
  QVERIFY(QTest::qWaitForWindowExposed(&view));
  QTRY_VERIFY(areValuesApart(view));
  view.resize(700, 500);
  QTRY_VERIFY(view.axisRects().first()->axis(QCPAxis::atLeft)->tickLabels());
  QTRY_VERIFY(view.axisRects().first()->axis(QCPAxis::atLeft)->tickVector().size() >= 4);
  QVERIFY(areValuesApart(view));
}

NEARFIT_QT_SUITE(PlotViewTest, test::runQtTest<PlotViewTest>)
#include "plot_view_test.moc"

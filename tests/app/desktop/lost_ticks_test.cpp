// Ticks that find the window too busy are missing in what is plotted: that is told, and drawn.
#include <QLabel>
#include <QtTest>
#include <vector>

#include "app/desktop/servo_rows.h"
#include "tests/app/desktop/desktop_driver.h"
#include "ui/panels/plots/plot_panel.h"

using namespace nearfit;
using namespace nearfit::test;

class LostTicksTest : public QObject {
  Q_OBJECT

 private slots:
  void thoseThatFindTheQueueFullAreCountedOnce();
  void thePlotsSayHowManyAreMissingUntilANewRun();

 private:
  static MotionRow rowAt(double time) {
    MotionRow row;
    row.time = time;
    return row;
  }
};

void LostTicksTest::thoseThatFindTheQueueFullAreCountedOnce() {
  desktop::ServoRows rows;
  std::vector<std::pair<std::size_t, quint64>> told;
  connect(&rows, &desktop::ServoRows::ticked, this,
          [&](const std::vector<MotionRow>& ticks, quint64 lost) { told.emplace_back(ticks.size(), lost); });
  std::size_t taken = 0;
  for (int i = 0; i < 20'000; ++i)
    taken += rows.queue()->push(rowAt(1e-3 * i)) ? 1 : 0;
  QVERIFY(taken < 20'000);
  rows.take();
  rows.queue()->push(rowAt(30.0));
  rows.take();
  const std::vector<std::pair<std::size_t, quint64>> expected{{taken, 20'000 - taken}, {1, 0}};
  QVERIFY(told == expected);
}

void LostTicksTest::thePlotsSayHowManyAreMissingUntilANewRun() {
  ui::PlotPanel panel;
  const auto note = [&] { return panel.findChild<QLabel*>(QStringLiteral("plotNote"))->text(); };
  panel.add({rowAt(1.0), rowAt(1.001)});
  QCOMPARE(note(), QString());
  panel.add({rowAt(1.002)}, 12);
  panel.add({rowAt(1.015)}, 3);
  QVERIFY2(note().contains(QStringLiteral("15 ticks are missing")), qPrintable(note()));
  panel.showRecording({rowAt(0.0), rowAt(1.0)});
  QCOMPARE(note(), QStringLiteral("Recording"));
  panel.showLive();
  QVERIFY(note().contains(QStringLiteral("15 ticks are missing")));
  panel.add({rowAt(0.0)});
  QCOMPARE(note(), QString());
}

NEARFIT_QT_SUITE(LostTicksTest, runDesktopTest<LostTicksTest>)
#include "lost_ticks_test.moc"

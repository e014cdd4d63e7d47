#include "ui/shell/title_and_status.h"

#include <QLabel>
#include <QStatusBar>
#include <QtTest>
#include <memory>

#include "core/session/session.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/model/hand_state.h"
#include "ui/model/shown_poses.h"

using namespace nearfit;

class TitleAndStatusTest : public QObject {
  Q_OBJECT

 private slots:
  void aMinDistanceThatIsOnlyABoundIsSaidToBeOne();
};

void TitleAndStatusTest::aMinDistanceThatIsOnlyABoundIsSaidToBeOne() {
  Session session;
  ui::ShownPoses poses(session);
  ui::HandState hand(session, poses);
  QStatusBar bar;
  const ui::StatusReadout readout(hand, &bar);
  const auto* distance = bar.findChild<QLabel*>(QStringLiteral("statusDistance"));
  QVERIFY(distance != nullptr);
  const auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->distance = 0.00026;
  emit hand.snapshotDrawn(*snapshot);
  QCOMPARE(distance->text(), QStringLiteral("Min distance 0.26 mm"));
  snapshot->isDistanceBound = true;
  emit hand.snapshotDrawn(*snapshot);
  QCOMPARE(distance->text(), QStringLiteral("Min distance at least 0.26 mm"));
}

NEARFIT_QT_SUITE(TitleAndStatusTest, test::runQtTest<TitleAndStatusTest>)
#include "title_and_status_test.moc"

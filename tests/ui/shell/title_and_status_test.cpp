#include "ui/shell/title_and_status.h"

#include <QAction>
#include <QApplication>
#include <QEventLoop>
#include <QHelpEvent>
#include <QLabel>
#include <QMainWindow>
#include <QStatusBar>
#include <QTimer>
#include <QToolTip>
#include <QtTest>
#include <memory>
#include <utility>

#include "core/session/session.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/model/hand_state.h"
#include "ui/model/shown_poses.h"

using namespace nearfit;

class TitleAndStatusTest : public QObject {
  Q_OBJECT

 private slots:
  void aMinDistanceThatIsOnlyABoundIsSaidToBeOne();
  void aCountThatIsNotOfAllMinimaSaysWhy();
  void numbersStayWhereTheyAre();
  void aNoteEndsWithTheStateThatItIsAbout();
  void aNoteEndsWhenTheNextCommandStarts();
  void aCommandThatRunsADialogKeepsItsOwnNote();
  void aNoteThatIsTooLongIsElidedAndItsToolTipIsAll();
  void aLongNoteTakesTheRoomOfNumbersThatAreNotThere();
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

void TitleAndStatusTest::aCountThatIsNotOfAllMinimaSaysWhy() {
  Session session;
  ui::ShownPoses poses(session);
  ui::HandState hand(session, poses);
  QStatusBar bar;
  const ui::StatusReadout readout(hand, &bar);
  const auto* minima = bar.findChild<QLabel*>(QStringLiteral("statusMinima"));
  QVERIFY(minima != nullptr);
  const auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->lmdCount = 12;
  snapshot->isTruncated = true;
  emit hand.snapshotDrawn(*snapshot);
  QCOMPARE(minima->text(), QStringLiteral("Minima 12+"));
  QCOMPARE(minima->toolTip(), QStringLiteral("There may be more: the search stopped at its limit."));
  emit hand.snapshotCleared();
  QCOMPARE(minima->toolTip(), QString());
}

void TitleAndStatusTest::numbersStayWhereTheyAre() {
  Session session;
  ui::ShownPoses poses(session);
  ui::HandState hand(session, poses);
  QStatusBar bar;
  const ui::StatusReadout readout(hand, &bar);
  bar.resize(1200, 24);
  bar.show();
  QVERIFY(QTest::qWaitForWindowExposed(&bar));
  const auto snapshot = std::make_unique<ServoSnapshot>();
  const auto* minima = bar.findChild<QLabel*>(QStringLiteral("statusMinima"));
  const auto placeOfMinima = [&](double distance, std::uint32_t count, bool isBound) {
    snapshot->distance = distance;
    snapshot->lmdCount = count;
    snapshot->isDistanceBound = isBound;
    emit hand.snapshotDrawn(*snapshot);
    QTest::qWait(10);
    return minima->mapTo(&bar, QPoint());
  };
  const QPoint before = placeOfMinima(0.005, 1, false);
  QVERIFY(minima->isVisible());
  for (const auto& [distance, count] : {std::pair{2.6e-4, 7U}, {0.0123, 4321U}, {0.75, 12U}, {9.87e-5, 1U}})
    QCOMPARE(placeOfMinima(distance, count, false), before);
  // A longer text makes room for itself once.
  const QPoint after = placeOfMinima(0.005, 1, true);
  QVERIFY(after.x() < before.x());
  QCOMPARE(placeOfMinima(0.005, 1, false), after);
}

/// "Saved test.nearfit" stayed after New.
void TitleAndStatusTest::aNoteEndsWithTheStateThatItIsAbout() {
  Session session;
  ui::NoteBar bar(session);
  bar.note(QStringLiteral("Saved test.nearfit"));
  // A command may note before it changes the scene.
  session.reset();
  QCOMPARE(bar.currentMessage(), QStringLiteral("Saved test.nearfit"));
  QTest::qWait(20);
  QCOMPARE(bar.currentMessage(), QStringLiteral("Saved test.nearfit"));
  session.reset();
  QCOMPARE(bar.currentMessage(), QString());
}

/// "bolt: Kept to point of plate" stayed while the next tool ran: a tool changes nothing until it is done.
void TitleAndStatusTest::aNoteEndsWhenTheNextCommandStarts() {
  Session session;
  QMainWindow window;
  ui::NoteBar bar(session, &window);
  QAction keep(&window), measure(&window);
  // A command notes before the bar hears of it.
  connect(&keep, &QAction::triggered, &bar, [&bar] { bar.note(QStringLiteral("Kept to point of plate")); });
  bar.endAtCommandsOf(window);
  keep.trigger();
  QCOMPARE(bar.currentMessage(), QStringLiteral("Kept to point of plate"));
  QTest::qWait(20);
  QCOMPARE(bar.currentMessage(), QStringLiteral("Kept to point of plate"));
  measure.trigger();
  QCOMPARE(bar.currentMessage(), QString());
  // A second time it is a note again.
  keep.trigger();
  QTest::qWait(20);
  keep.trigger();
  QCOMPARE(bar.currentMessage(), QStringLiteral("Kept to point of plate"));
}

/// "Nothing to refine" was gone at once.
void TitleAndStatusTest::aCommandThatRunsADialogKeepsItsOwnNote() {
  Session session;
  QMainWindow window;
  ui::NoteBar bar(session, &window);
  QAction refine(&window), measure(&window);
  connect(&refine, &QAction::triggered, &bar, [&bar] {
    QEventLoop dialog;
    QTimer::singleShot(0, &dialog, [&bar] { bar.note(QStringLiteral("Nothing to refine")); });
    QTimer::singleShot(20, &dialog, &QEventLoop::quit);
    dialog.exec();
  });
  bar.endAtCommandsOf(window);
  refine.trigger();
  QTest::qWait(20);
  QCOMPARE(bar.currentMessage(), QStringLiteral("Nothing to refine"));
  measure.trigger();
  QCOMPARE(bar.currentMessage(), QString());
}

void TitleAndStatusTest::aNoteThatIsTooLongIsElidedAndItsToolTipIsAll() {
  Session session;
  ui::NoteBar bar(session);
  bar.addPermanentWidget(new QLabel(QStringLiteral("Servo off"), &bar));
  bar.resize(300, 24);
  bar.show();
  QVERIFY(QTest::qWaitForWindowExposed(&bar));
  const QString text = QStringLiteral("bolt is kept on axis of plate, ").repeated(4);
  bar.note(text);
  const QString shown = bar.shownText();
  QVERIFY2(shown.endsWith(QChar(0x2026)) && text.startsWith(shown.left(4)), qPrintable(shown));
  QVERIFY(bar.fontMetrics().horizontalAdvance(shown) < 300);
  QHelpEvent event(QEvent::ToolTip, QPoint(20, 12), bar.mapToGlobal(QPoint(20, 12)));
  QApplication::sendEvent(&bar, &event);
  QTRY_VERIFY(QToolTip::isVisible());
  QCOMPARE(QToolTip::text(), text);
  bar.note(QStringLiteral("Short"));
  QCOMPARE(bar.shownText(), QStringLiteral("Short"));
}

/// It had 420 of 1388 pixels, beside four dashes.
void TitleAndStatusTest::aLongNoteTakesTheRoomOfNumbersThatAreNotThere() {
  Session session;
  ui::ShownPoses poses(session);
  ui::HandState hand(session, poses);
  ui::NoteBar bar(session);
  const ui::StatusReadout readout(hand, &bar);
  const auto* rate = bar.findChild<QLabel*>(QStringLiteral("statusRate"));
  bar.resize(900, 24);
  bar.show();
  QVERIFY(QTest::qWaitForWindowExposed(&bar));
  QTRY_VERIFY(rate->isVisible());
  bar.note(QStringLiteral("Short"));
  QVERIFY(rate->isVisible());
  // As wide as fits into the bar, but not beside the numbers.
  QString text = QStringLiteral("bolt");
  while (bar.fontMetrics().horizontalAdvance(text) < 800)
    text += QStringLiteral(" plate");
  bar.note(text);
  QTRY_VERIFY(!rate->isVisible());
  QTRY_COMPARE(bar.shownText(), text);
  bar.clearMessage();
  QTRY_VERIFY(rate->isVisible());
  // Numbers stay.
  const auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->distance = 0.005;
  emit hand.snapshotDrawn(*snapshot);
  bar.note(text);
  QTest::qWait(20);
  QVERIFY(bar.findChild<QLabel*>(QStringLiteral("statusDistance"))->isVisible());
  QVERIFY(bar.shownText() != text);
}

NEARFIT_QT_SUITE(TitleAndStatusTest, test::runQtTest<TitleAndStatusTest>)
#include "title_and_status_test.moc"

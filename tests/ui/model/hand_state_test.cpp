#include "ui/model/hand_state.h"

#include <QSignalSpy>
#include <QTemporaryDir>
#include <QtTest>
#include <memory>

#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/model/move_guard.h"
#include "ui/model/shown_poses.h"
#include "ui/widgets/paths.h"

using namespace nearfit;
using ui::Hand;

namespace {

RigidTransform placeAt(double x) {
  return {{1.0, 0.0, 0.0, 0.0}, {x, 0.0, 0.0}};
}

}  // namespace

class HandStateTest : public QObject {
  Q_OBJECT

 private slots:
  void init();
  void theMovingPartIsInHandWhileTheServoRuns();
  void handAndPartBeginWhereThePartIs();
  void thePartIsShownWhereTheServoHasIt();
  void onlyAManualHandIsAheadOfThePart();
  void aStateThatChangesNothingIsToldAsSuch();
  void theLastSnapshotIsClearedBeforeTheStopIsTold();
  void theLastSnapshotIsKeptAsPastUntilTheSceneChanges();
  void aPastSnapshotOutlivesASaveButNotANewStart();
  void aPastSnapshotEndsWhereThePartIsShownElsewhere();
  void nothingIsKeptOfAPartThatIsGone();
  void whatTheViewDrawsIsOnlyToldWhileTheServoRuns();
  void partsInOtherHandsMayNotBeMoved();
  void thePartInTheManualHandMovesAlone();

 private:
  /// Tells that the servo runs.
  void run(Hand hand) {
    ui::ServoStatus status;
    status.isRunning = true;
    status.hand = hand;
    hand_->showStatus(status);
  }
  void stop() { hand_->showStatus({}); }
  void feelAt(double x) {
    const auto snapshot = std::make_unique<ServoSnapshot>();
    snapshot->moving = moving_;
    snapshot->proxy = placeAt(x);
    hand_->showSnapshot(*snapshot);
  }

  std::unique_ptr<Session> session_;
  std::unique_ptr<ui::ShownPoses> poses_;
  std::unique_ptr<ui::HandState> hand_;
  PartId moving_{}, other_{};
};

void HandStateTest::init() {
  hand_.reset();
  poses_.reset();
  session_ = std::make_unique<Session>();
  poses_ = std::make_unique<ui::ShownPoses>(*session_);
  hand_ = std::make_unique<ui::HandState>(*session_, *poses_);
  const PartGeometryPtr cube = test::freshGeometryOf(test::boxMesh(glm::dvec3(0.02)));
  moving_ = session_->addPart(cube, "moving", placeAt(1.0));
  other_ = session_->addPart(cube, "other", placeAt(2.0));
  session_->setMovingPart(moving_);
}

void HandStateTest::theMovingPartIsInHandWhileTheServoRuns() {
  QVERIFY(!hand_->part() && !hand_->holds(moving_));
  run(Hand::Manual);
  QVERIFY(hand_->part() == moving_);
  QVERIFY(hand_->holds(moving_) && !hand_->holds(other_) && !hand_->holds(std::nullopt));
  QVERIFY(hand_->isHeldBy(Hand::Manual) && !hand_->isHeldBy(Hand::Device));
  stop();
  QVERIFY(!hand_->part() && !hand_->isHeldBy(Hand::Manual));
  ui::ServoStatus opening;
  opening.isOpening = true;
  opening.hand = Hand::Device;
  hand_->showStatus(opening);
  QVERIFY(!hand_->part() && !hand_->isHeldBy(Hand::Device));
}

void HandStateTest::handAndPartBeginWhereThePartIs() {
  run(Hand::Manual);
  QCOMPARE(hand_->partPose().translation.x, 1.0);
  QCOMPARE(hand_->handPose().translation.x, 1.0);
  hand_->setHandPose(placeAt(1.5));
  feelAt(1.25);
  stop();
  session_->movePart(moving_, placeAt(3.0));
  run(Hand::Manual);
  QCOMPARE(hand_->partPose().translation.x, 3.0);
  QCOMPARE(hand_->handPose().translation.x, 3.0);
}

void HandStateTest::thePartIsShownWhereTheServoHasIt() {
  run(Hand::Device);
  feelAt(1.25);
  QCOMPARE(poses_->poseOfMoving().translation.x, 1.25);
  // A drag shows it elsewhere; the servo still has it there.
  poses_->show(ui::ShownPoses::Source::Drag, {{moving_, placeAt(4.0)}});
  QCOMPARE(poses_->poseOfMoving().translation.x, 4.0);
  QCOMPARE(hand_->partPose().translation.x, 1.25);
  poses_->show(ui::ShownPoses::Source::Drag, {});
  stop();
  QCOMPARE(poses_->poseOfMoving().translation.x, 1.0);
}

void HandStateTest::onlyAManualHandIsAheadOfThePart() {
  run(Hand::Manual);
  hand_->setHandPose(placeAt(1.5));
  feelAt(1.25);
  QCOMPARE(hand_->partPose().translation.x, 1.25);
  QCOMPARE(hand_->handPose().translation.x, 1.5);
  stop();
  run(Hand::Device);
  feelAt(1.25);
  QCOMPARE(hand_->handPose().translation.x, 1.25);
}

void HandStateTest::aStateThatChangesNothingIsToldAsSuch() {
  QSignalSpy states(hand_.get(), &ui::HandState::statusChanged);
  QSignalSpy changes(hand_.get(), &ui::HandState::changed);
  run(Hand::Manual);
  hand_->setHandPose(placeAt(1.5));
  run(Hand::Manual);
  QCOMPARE(states.count(), 2);
  QCOMPARE(changes.count(), 1);
  // The hand is where it was.
  QCOMPARE(hand_->handPose().translation.x, 1.5);
  stop();
  QCOMPARE(changes.count(), 2);
}

void HandStateTest::theLastSnapshotIsClearedBeforeTheStopIsTold() {
  run(Hand::Manual);
  QString told;
  connect(hand_.get(), &ui::HandState::statusChanged, this, [&] { told += 's'; });
  connect(hand_.get(), &ui::HandState::snapshotCleared, this, [&] { told += 'x'; });
  connect(hand_.get(), &ui::HandState::changed, this, [&] { told += 'c'; });
  stop();
  QCOMPARE(told, QStringLiteral("sxc"));
}

/// Panel, status bar and view each had a rule of their own for what stays after Stop.
void HandStateTest::theLastSnapshotIsKeptAsPastUntilTheSceneChanges() {
  run(Hand::Manual);
  feelAt(1.25);
  feelAt(1.5);
  QString told;
  double kept = 0.0;
  connect(hand_.get(), &ui::HandState::snapshotKept, this, [&](const ServoSnapshot& snapshot) {
    told += 'k';
    kept = snapshot.proxy.translation.x;
  });
  connect(hand_.get(), &ui::HandState::snapshotCleared, this, [&] { told += 'x'; });
  connect(hand_.get(), &ui::HandState::changed, this, [&] { told += 'c'; });
  // The pose is put into the session before the servo reports its end.
  session_->movePart(moving_, placeAt(1.5));
  stop();
  QCOMPARE(told, QStringLiteral("kc"));
  QCOMPARE(kept, 1.5);
  session_->setVisible(other_, false);
  QCOMPARE(told, QStringLiteral("kcx"));
  session_->setVisible(other_, true);
  QCOMPARE(told, QStringLiteral("kcx"));
}

void HandStateTest::aPastSnapshotOutlivesASaveButNotANewStart() {
  QSignalSpy cleared(hand_.get(), &ui::HandState::snapshotCleared);
  run(Hand::Manual);
  feelAt(1.25);
  stop();
  cleared.clear();
  const QTemporaryDir folder;
  session_->save(ui::toPath(folder.filePath(QStringLiteral("scene.nearfit"))));
  QCOMPARE(cleared.count(), 0);
  run(Hand::Manual);
  QCOMPARE(cleared.count(), 1);
}

void HandStateTest::aPastSnapshotEndsWhereThePartIsShownElsewhere() {
  QSignalSpy cleared(hand_.get(), &ui::HandState::snapshotCleared);
  run(Hand::Manual);
  feelAt(1.25);
  stop();
  cleared.clear();
  poses_->show(ui::ShownPoses::Source::Drag, {{moving_, placeAt(4.0)}});
  QCOMPARE(cleared.count(), 1);
}

void HandStateTest::nothingIsKeptOfAPartThatIsGone() {
  int kept = 0;
  connect(hand_.get(), &ui::HandState::snapshotKept, this, [&] { ++kept; });
  run(Hand::Manual);
  feelAt(1.25);
  session_->setMovingPart(other_);
  stop();
  run(Hand::Manual);
  feelAt(1.25);
  session_->reset();
  stop();
  QCOMPARE(kept, 0);
}

/// The view draws recordings too.
void HandStateTest::whatTheViewDrawsIsOnlyToldWhileTheServoRuns() {
  int drawn = 0;
  connect(hand_.get(), &ui::HandState::snapshotDrawn, this, [&] { ++drawn; });
  const auto snapshot = std::make_unique<ServoSnapshot>();
  hand_->noteDrawn(*snapshot);
  QCOMPARE(drawn, 0);
  run(Hand::Manual);
  hand_->noteDrawn(*snapshot);
  QCOMPARE(drawn, 1);
}

void HandStateTest::partsInOtherHandsMayNotBeMoved() {
  const ui::MoveGuard guard(*session_, *hand_);
  QSignalSpy changes(&guard, &ui::MoveGuard::changed);
  for (const Hand hand : {Hand::Scripted, Hand::Device}) {
    run(hand);
    QVERIFY(!guard.refusalOf(std::vector{moving_}).isEmpty());
    QVERIFY(guard.refusalOf(std::vector{other_}).isEmpty());
    stop();
    QVERIFY(guard.refusalOf(std::vector{moving_}).isEmpty());
  }
  QCOMPARE(changes.count(), 4);
}

void HandStateTest::thePartInTheManualHandMovesAlone() {
  const ui::MoveGuard guard(*session_, *hand_);
  QVERIFY(guard.refusalOf({moving_, other_}).isEmpty());
  run(Hand::Manual);
  QVERIFY(guard.refusalOf(std::vector{moving_}).isEmpty());
  QVERIFY(!guard.refusalOf({moving_, other_}).isEmpty());
}

NEARFIT_QT_SUITE(HandStateTest, test::runQtTest<HandStateTest>)
#include "hand_state_test.moc"

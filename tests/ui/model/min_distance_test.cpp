#include "ui/model/min_distance.h"

#include <QtTest>
#include <cmath>
#include <memory>

#include "tests/support/qt/qt_suite.h"

using namespace nearfit;

namespace {

/// A part 0.2 mm from one that it overlaps, and 9.4 mm from another.
std::unique_ptr<ServoSnapshot> overlappedSnapshot() {
  auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->distance = 2e-4;
  snapshot->lmdCount = snapshot->storedLmds = 2;
  snapshot->lmds[0].lmd.distance = 2e-4;
  snapshot->lmds[0].other = PartId{1};
  snapshot->lmds[1].lmd.distance = 0.0094;
  snapshot->lmds[1].other = PartId{2};
  snapshot->overlappingCount = 1;
  snapshot->overlapping[0] = PartId{1};
  return snapshot;
}

QString shownOf(const ServoSnapshot& snapshot) {
  return ui::formatMinDistance(ui::minDistanceOf(snapshot));
}

}  // namespace

class MinDistanceTest : public QObject {
  Q_OBJECT

 private slots:
  void partsThatAreOverlappedAreLeftOutAndItSaysSo();
  void aMissingMinimumLeavesABound();
  void aBoundOfThePartThatIsOverlappedIsNoneToOthers();
  void whereOverlapIsNotKnownNoDistanceOfSurfacesIsShown();
};

void MinDistanceTest::partsThatAreOverlappedAreLeftOutAndItSaysSo() {
  const auto snapshot = overlappedSnapshot();
  QCOMPARE(shownOf(*snapshot), QStringLiteral("9.40 mm to others"));
  snapshot->storedLmds = snapshot->lmdCount = 1;
  QCOMPARE(shownOf(*snapshot), QStringLiteral("– (overlapping)"));
  snapshot->overlappingCount = ServoSnapshot::kMaxOverlapping + 1;
  QVERIFY(std::isnan(ui::minDistanceOf(*snapshot).distance));
  QCOMPARE(shownOf(*snapshot), QStringLiteral("– (overlapping)"));
  snapshot->overlappingCount = 0;
  QCOMPARE(shownOf(*snapshot), QStringLiteral("0.20 mm"));
}

void MinDistanceTest::aMissingMinimumLeavesABound() {
  const auto snapshot = overlappedSnapshot();
  snapshot->lmdCount = 3;
  QCOMPARE(shownOf(*snapshot), QStringLiteral("at least 0.20 mm to others"));
  snapshot->lmdCount = 2;
  snapshot->isDistanceBound = true;
  snapshot->distance = 0.005;
  QCOMPARE(shownOf(*snapshot), QStringLiteral("at least 5.00 mm to others"));
  snapshot->overlappingCount = 0;
  QCOMPARE(shownOf(*snapshot), QStringLiteral("at least 5.00 mm"));
}

/// A nut through its only bolt was shown "at least 0.39 mm to others".
void MinDistanceTest::aBoundOfThePartThatIsOverlappedIsNoneToOthers() {
  const auto snapshot = overlappedSnapshot();
  snapshot->storedLmds = 1;
  snapshot->lmdCount = 4000;
  snapshot->isTruncated = snapshot->isDistanceBound = true;
  QCOMPARE(shownOf(*snapshot), QStringLiteral("– (overlapping)"));
  snapshot->storedLmds = snapshot->lmdCount = 0;
  QCOMPARE(shownOf(*snapshot), QStringLiteral("– (overlapping)"));
}

/// Springs let parts pass through each other.
void MinDistanceTest::whereOverlapIsNotKnownNoDistanceOfSurfacesIsShown() {
  const auto snapshot = overlappedSnapshot();
  snapshot->overlappingCount = 0;
  snapshot->isOverlapUnknown = true;
  const ui::MinDistance shown = ui::minDistanceOf(*snapshot);
  QCOMPARE(shown.distance, 0.0);
  QVERIFY(shown.isBound && !shown.isOfRest);
}

NEARFIT_QT_SUITE(MinDistanceTest, test::runQtTest<MinDistanceTest>)
#include "min_distance_test.moc"

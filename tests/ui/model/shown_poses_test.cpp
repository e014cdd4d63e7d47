#include "ui/model/shown_poses.h"

#include <QtTest>
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/qt/qt_suite.h"

using namespace nearfit;

using Source = ui::ShownPoses::Source;
using Parts = std::vector<PartId>;

namespace {

/// A pose that is told from others by its place.
RigidTransform at(double x) {
  return {{1.0, 0.0, 0.0, 0.0}, {x, 0.0, 0.0}};
}

}  // namespace

class ShownPosesTest : public QObject {
  Q_OBJECT

 private slots:
  void init();
  void theFirstSourceThatHasAPartDecides();
  void aPreviewIsShownButThePartIsNotThere();
  void othersStayWhereTheSessionHasThem();
  void theSessionsPoseIsTheNewest();
  void itTellsOfPartsThatAreShownElsewhereAndOnlyOfThose();
  void anotherSceneBeginsWithItsOwnPoses();
  void aPartThatIsNoLongerTheMovingOneIsLedNoMore();
  void theViewHearsOfAChangeAfterwards();

 private:
  double placeOf(PartId id) { return poses_->poseOf(*session_->scene().find(id)).translation.x; }
  double shownPlaceOf(PartId id) { return poses_->shownPoseOf(*session_->scene().find(id)).translation.x; }

  std::unique_ptr<Session> session_;
  std::unique_ptr<ui::ShownPoses> poses_;
  PartId a_{}, b_{};
  Parts told_;
  int times_ = 0;
};

void ShownPosesTest::init() {
  poses_.reset();
  session_ = std::make_unique<Session>();
  poses_ = std::make_unique<ui::ShownPoses>(*session_);
  const PartGeometryPtr cube = test::freshGeometryOf(test::boxMesh(glm::dvec3(0.02)));
  a_ = session_->addPart(cube, "a", at(1.0));
  b_ = session_->addPart(cube, "b", at(2.0));
  session_->setMovingPart(a_);
  told_.clear();
  times_ = 0;
  connect(poses_.get(), &ui::ShownPoses::changed, this, [this](const Parts& parts) {
    told_ = parts;
    std::ranges::sort(told_);
    ++times_;
  });
}

void ShownPosesTest::theFirstSourceThatHasAPartDecides() {
  const std::pair<Source, double> inOrder[] = {
      {Source::Drag, 3.0}, {Source::Replay, 4.0}, {Source::Hand, 5.0}};
  QCOMPARE(placeOf(a_), 1.0);
  // Whichever order they come in.
  for (const auto& [source, x] : inOrder) {
    poses_->show(source, {{a_, at(x)}});
    QCOMPARE(placeOf(a_), 3.0);
    QCOMPARE(shownPlaceOf(a_), 3.0);
  }
  poses_->show(Source::Drag, {});
  QCOMPARE(placeOf(a_), 4.0);
  poses_->show(Source::Replay, {});
  QCOMPARE(placeOf(a_), 5.0);
  poses_->show(Source::Replay, {{a_, at(4.0)}});
  QCOMPARE(placeOf(a_), 4.0);
  poses_->show(Source::Replay, {});
  poses_->show(Source::Hand, {});
  QCOMPARE(placeOf(a_), 1.0);
}

void ShownPosesTest::aPreviewIsShownButThePartIsNotThere() {
  poses_->show(Source::Preview, {{a_, at(6.0)}});
  QCOMPARE(shownPlaceOf(a_), 6.0);
  QCOMPARE(placeOf(a_), 1.0);
  poses_->show(Source::Drag, {{a_, at(3.0)}});
  QCOMPARE(shownPlaceOf(a_), 6.0);
  QCOMPARE(placeOf(a_), 3.0);
  poses_->show(Source::Preview, {});
  QCOMPARE(shownPlaceOf(a_), 3.0);
}

void ShownPosesTest::othersStayWhereTheSessionHasThem() {
  poses_->show(Source::Hand, {{a_, at(5.0)}});
  poses_->show(Source::Drag, {{b_, at(3.0)}});
  QCOMPARE(placeOf(a_), 5.0);
  QCOMPARE(placeOf(b_), 3.0);
  QVERIFY(poses_->isDragged(b_) && !poses_->isDragged(a_));
  poses_->show(Source::Drag, {{a_, at(3.5)}});
  QCOMPARE(placeOf(a_), 3.5);
  QCOMPARE(placeOf(b_), 2.0);
  QVERIFY(!poses_->isDragged(b_) && poses_->isDragged(a_));
}

void ShownPosesTest::theSessionsPoseIsTheNewest() {
  session_->movePart(b_, at(2.5));
  QCOMPARE(placeOf(b_), 2.5);
  session_->undo();
  QCOMPARE(placeOf(b_), 2.0);
  // A drag hides what the session has, until it ends.
  poses_->show(Source::Drag, {{b_, at(3.0)}});
  session_->movePart(b_, at(2.5));
  QCOMPARE(placeOf(b_), 3.0);
  poses_->show(Source::Drag, {});
  QCOMPARE(placeOf(b_), 2.5);
}

void ShownPosesTest::itTellsOfPartsThatAreShownElsewhereAndOnlyOfThose() {
  poses_->show(Source::Drag, {{a_, at(3.0)}, {b_, at(3.0)}});
  QVERIFY(told_ == (Parts{a_, b_}));
  poses_->show(Source::Drag, {{a_, at(3.0)}, {b_, at(3.5)}});
  QVERIFY(told_ == Parts{b_});
  poses_->show(Source::Drag, {{a_, at(3.0)}});
  QVERIFY(told_ == Parts{b_});
  QCOMPARE(times_, 3);
  // A servo at rest tells the same pose sixty times a second.
  poses_->show(Source::Drag, {{a_, at(3.0)}});
  poses_->show(Source::Hand, {});
  session_->renamePart(b_, "c");
  session_->movePart(b_, at(2.5));
  QCOMPARE(times_, 3);
  poses_->show(Source::Drag, {});
  QVERIFY(told_ == Parts{a_});
}

void ShownPosesTest::anotherSceneBeginsWithItsOwnPoses() {
  const Scene same = session_->scene();
  for (const Source source : {Source::Preview, Source::Drag, Source::Replay, Source::Hand})
    poses_->show(source, {{a_, at(3.0)}});
  session_->movePart(b_, at(2.5));
  QCOMPARE(placeOf(a_), 3.0);
  session_->reset(same);
  QCOMPARE(placeOf(a_), 1.0);
  QCOMPARE(shownPlaceOf(a_), 1.0);
  QVERIFY(!poses_->isDragged(a_));
}

void ShownPosesTest::aPartThatIsNoLongerTheMovingOneIsLedNoMore() {
  for (const Source source : {Source::Replay, Source::Hand}) {
    session_->setMovingPart(a_);
    poses_->show(source, {{a_, at(3.0)}});
    session_->setMovingPart(b_);
    QCOMPARE(placeOf(a_), 1.0);
    QCOMPARE(placeOf(b_), 2.0);
    QVERIFY(told_ == Parts{a_});
  }
  session_->setMovingPart(a_);
  poses_->show(Source::Hand, {{a_, at(3.0)}});
  session_->deletePart(a_);
  session_->undo();
  QCOMPARE(placeOf(a_), 1.0);
}

/// A view that turns to a scene that has been opened must not fit the pose that the hand had in the last one.
void ShownPosesTest::theViewHearsOfAChangeAfterwards() {
  poses_.reset();
  double shown = 0.0;
  const Subscription view = session_->onChange(SceneEvents::Stage::View, [&] { shown = shownPlaceOf(a_); });
  poses_ = std::make_unique<ui::ShownPoses>(*session_);
  poses_->show(Source::Hand, {{a_, at(3.0)}});
  const Scene same = session_->scene();
  session_->renamePart(b_, "c");
  QCOMPARE(shown, 3.0);
  session_->reset(same);
  QCOMPARE(shown, 1.0);
}

NEARFIT_QT_SUITE(ShownPosesTest, test::runQtTest<ShownPosesTest>)
#include "shown_poses_test.moc"

#include "ui/model/selection.h"

#include <QSignalSpy>
#include <QtTest>

#include "core/session/session.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/qt/qt_suite.h"

using namespace nearfit;

using Parts = std::vector<PartId>;

class SelectionTest : public QObject {
  Q_OBJECT

 private slots:
  void init();
  void theLastOneSelectedIsTheCurrentOne();
  void togglingTakesOutAndTheOneBeforeIsCurrent();
  void aPartSelectedAgainBecomesTheCurrentOne();
  void partsThatLeaveTheSceneLeaveIt();
  void partsOfAnotherSceneAreOthersThoughTheirIdsAreTheSame();
  void whoeverHearsOfTheSceneAfterwardsFindsNoPartThatIsGone();
  void whatTheSceneDoesNotHaveIsNotSelected();
  void allOfThemAreThoseThatAreShown();
  void itIsToldOnlyOfWhatChanges();
  void aGroupStaysSelectedWhileAllOfItIs();

 private:
  std::unique_ptr<Session> session_;
  std::unique_ptr<ui::Selection> selection_;
  Parts ids_;
};

void SelectionTest::init() {
  selection_.reset();
  session_ = std::make_unique<Session>();
  selection_ = std::make_unique<ui::Selection>(*session_);
  const PartGeometryPtr cube = test::freshGeometryOf(test::boxMesh(glm::dvec3(0.02)));
  ids_ = {session_->addPart(cube, "a"), session_->addPart(cube, "b"), session_->addPart(cube, "c")};
}

void SelectionTest::theLastOneSelectedIsTheCurrentOne() {
  QVERIFY(!selection_->current() && selection_->isEmpty());
  selection_->select(ids_[2]);
  selection_->add(ids_[0]);
  QVERIFY(selection_->parts() == (Parts{ids_[2], ids_[0]}));
  QVERIFY(selection_->current() == ids_[0]);
  QVERIFY(selection_->contains(ids_[2]) && !selection_->contains(ids_[1]));
}

void SelectionTest::togglingTakesOutAndTheOneBeforeIsCurrent() {
  selection_->set({ids_[0], ids_[1]});
  selection_->toggle(ids_[2]);
  QVERIFY(selection_->current() == ids_[2]);
  selection_->toggle(ids_[2]);
  QVERIFY(selection_->parts() == (Parts{ids_[0], ids_[1]}));
}

void SelectionTest::aPartSelectedAgainBecomesTheCurrentOne() {
  selection_->set({ids_[0], ids_[1]});
  selection_->add(ids_[0]);
  QVERIFY(selection_->parts() == (Parts{ids_[1], ids_[0]}));
}

void SelectionTest::partsThatLeaveTheSceneLeaveIt() {
  selection_->set(ids_);
  session_->deletePart(ids_[2]);
  QVERIFY(selection_->parts() == (Parts{ids_[0], ids_[1]}));
  session_->undo();
  QVERIFY(selection_->parts() == (Parts{ids_[0], ids_[1]}));
  session_->reset();
  QVERIFY(selection_->isEmpty());
}

void SelectionTest::partsOfAnotherSceneAreOthersThoughTheirIdsAreTheSame() {
  const Scene same = session_->scene();
  selection_->set({ids_[0], ids_[1]});
  session_->reset(same);
  QVERIFY(session_->scene().find(ids_[0]) != nullptr);
  QVERIFY(selection_->isEmpty());
  selection_->select(ids_[0]);
  session_->restore(same, {});
  QVERIFY(selection_->isEmpty());
}

void SelectionTest::whoeverHearsOfTheSceneAfterwardsFindsNoPartThatIsGone() {
  selection_.reset();
  bool wasThere = true;
  // The stage decides, not who came first.
  const Subscription changes =
      session_->onChange(SceneEvents::Stage::View, [&] { wasThere = selection_->contains(ids_[1]); });
  selection_ = std::make_unique<ui::Selection>(*session_);
  selection_->set(ids_);
  session_->deletePart(ids_[1]);
  QVERIFY(!wasThere);
}

void SelectionTest::whatTheSceneDoesNotHaveIsNotSelected() {
  selection_->set({ids_[0], PartId{99}});
  QVERIFY(selection_->parts() == Parts{ids_[0]});
}

void SelectionTest::allOfThemAreThoseThatAreShown() {
  session_->setVisible(ids_[1], false);
  selection_->selectAllVisible();
  QVERIFY(selection_->parts() == (Parts{ids_[0], ids_[2]}));
}

void SelectionTest::itIsToldOnlyOfWhatChanges() {
  const QSignalSpy changes(selection_.get(), &ui::Selection::changed);
  selection_->select(ids_[0]);
  selection_->set({ids_[0]});
  selection_->add(ids_[0]);
  session_->renamePart(ids_[0], "d");
  QCOMPARE(changes.count(), 1);
}

void SelectionTest::aGroupStaysSelectedWhileAllOfItIs() {
  const GroupId group = session_->group({{ids_[0], ids_[1]}, {}}), empty = session_->group({});
  selection_->set({ids_[0], ids_[1]}, {group, empty, group});
  QVERIFY(selection_->groups() == (std::vector{group, empty}));
  selection_->add(ids_[2]);
  QVERIFY(selection_->groups() == (std::vector{group, empty}));
  selection_->toggle(ids_[0]);
  QVERIFY(selection_->groups() == std::vector{empty});
  selection_->set({ids_[0], ids_[1]}, {group});
  session_->regroup({{ids_[2]}, {}}, group);
  QVERIFY(selection_->groups().empty() && selection_->parts().size() == 2);
  selection_->set({}, {empty});
  QVERIFY(!selection_->isEmpty() && !selection_->current());
  session_->ungroup({empty});
  QVERIFY(selection_->isEmpty());
}

NEARFIT_QT_SUITE(SelectionTest, test::runQtTest<SelectionTest>)
#include "selection_test.moc"

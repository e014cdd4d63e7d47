#include "ui/view3d/glyphs/hand_ghost.h"

#include <QtTest>

#include <glm/gtc/quaternion.hpp>
#include <vtkMapper.h>
#include <vtkPlaneCollection.h>

#include "tests/support/mesh_generators.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/model/hand_lead.h"

using namespace nearfit;

namespace {

/// A box of 20 mm with its centre at z = 35 mm, and a proxy at the identity.
ServoSnapshot snapshotOfBox() {
  ServoSnapshot snapshot;
  snapshot.centre = {0.0, 0.0, 0.035};
  return snapshot;
}

constexpr double kSize = 0.0346;  ///< The box's diagonal [m].

}  // namespace

class HandGhostTest : public QObject {
  Q_OBJECT

 private slots:
  void leadIsTakenAtTheCentreOfMass();
  void leadTellsTheTurn();
  void isDrawnWhereTheHandIs();
  void isNotDrawnWherePartAndHandLookTheSame();
  void canBeSwitchedOff();
  void isCutAsItsPartIs();

 private:
  std::shared_ptr<const ui::PartShape> box_ = std::make_shared<const ui::PartShape>(
      ui::makePartShape(test::boxMesh(glm::dvec3(0.02), glm::dvec3(0.0, 0.0, 0.035))));
  vtkNew<vtkRenderer> parts_, overlay_;
};

void HandGhostTest::leadIsTakenAtTheCentreOfMass() {
  ServoSnapshot snapshot = snapshotOfBox();
  // Half a turn about x through the part's origin takes the centre to z = -35 mm.
  snapshot.handle.rotation = glm::dquat(0.0, 1.0, 0.0, 0.0);
  const ui::HandLead lead = ui::handLeadOf(snapshot);
  QVERIFY(glm::distance(lead.handCentre, glm::dvec3(0.0, 0.0, -0.035)) < 1e-12);
  QVERIFY(std::abs(lead.distance - 0.07) < 1e-12);
}

void HandGhostTest::leadTellsTheTurn() {
  QCOMPARE(ui::formatLead({{}, 0.0031, 0.0}), QStringLiteral("3.10 mm"));
  // 0.02 rad are 1.146 degrees.
  QCOMPARE(ui::formatLead({{}, 0.0031, 0.02}), QStringLiteral("3.10 mm, 1.1°"));
}

void HandGhostTest::isDrawnWhereTheHandIs() {
  ui::HandGhost ghost(*parts_.Get(), *overlay_.Get());
  ghost.setShape(box_);
  ServoSnapshot snapshot = snapshotOfBox();
  snapshot.handle.translation = {0.001, 0.0, -0.003};
  ghost.show(snapshot, kSize);
  double bounds[6];
  QVERIFY(ghost.visibleBounds(bounds));
  QVERIFY(std::abs(bounds[0] + 0.009) < 1e-9 && std::abs(bounds[1] - 0.011) < 1e-9);
  QVERIFY(std::abs(bounds[4] - 0.022) < 1e-9 && std::abs(bounds[5] - 0.042) < 1e-9);
  ghost.clear();
  QVERIFY(!ghost.visibleBounds(bounds));
}

void HandGhostTest::isNotDrawnWherePartAndHandLookTheSame() {
  ui::HandGhost ghost(*parts_.Get(), *overlay_.Get());
  ghost.setShape(box_);
  ServoSnapshot snapshot = snapshotOfBox();
  double bounds[6];
  ghost.show(snapshot, kSize);
  QVERIFY(!ghost.visibleBounds(bounds));
  // A tenth of a millimetre on a part of 35 mm.
  snapshot.handle.translation.z = -0.0001;
  ghost.show(snapshot, kSize);
  QVERIFY(!ghost.visibleBounds(bounds));
  // Turned on the spot by three degrees.
  const glm::dquat turn = glm::angleAxis(0.05, glm::dvec3(0, 0, 1));
  snapshot.handle = {turn, snapshot.centre - turn * snapshot.centre};
  ghost.show(snapshot, kSize);
  QVERIFY(ghost.visibleBounds(bounds));
}

void HandGhostTest::canBeSwitchedOff() {
  ui::HandGhost ghost(*parts_.Get(), *overlay_.Get());
  ghost.setShape(box_);
  ServoSnapshot snapshot = snapshotOfBox();
  snapshot.handle.translation.z = -0.003;
  ghost.setVisible(false);
  ghost.show(snapshot, kSize);
  double bounds[6];
  QVERIFY(!ghost.visibleBounds(bounds));
  ghost.setVisible(true);
  QVERIFY(ghost.visibleBounds(bounds));
}

void HandGhostTest::isCutAsItsPartIs() {
  vtkNew<vtkRenderer> parts, overlay;
  ui::HandGhost ghost(*parts.Get(), *overlay.Get());
  const auto planes = [&parts] {
    QVector<vtkIdType> counts;
    vtkCollectionSimpleIterator it;
    vtkActorCollection* actors = parts->GetActors();
    actors->InitTraversal(it);
    while (vtkActor* actor = actors->GetNextActor(it)) {
      vtkPlaneCollection* cut = actor->GetMapper()->GetClippingPlanes();
      counts << (cut == nullptr ? vtkIdType{0} : vtkIdType{cut->GetNumberOfItems()});
    }
    return counts;
  };
  vtkNew<vtkPlane> plane;
  // Before there is a shape, and for the next one too.
  ghost.setCut(plane);
  ghost.setShape(box_);
  QCOMPARE(planes(), (QVector<vtkIdType>{1, 1}));
  ghost.setShape(std::make_shared<const ui::PartShape>(ui::makePartShape(test::boxMesh(glm::dvec3(0.01)))));
  QCOMPARE(planes(), (QVector<vtkIdType>{1, 1}));
  ghost.setCut(nullptr);
  QCOMPARE(planes(), (QVector<vtkIdType>{0, 0}));
}

NEARFIT_QT_SUITE(HandGhostTest, test::runQtTest<HandGhostTest>)
#include "hand_ghost_test.moc"

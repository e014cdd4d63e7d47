#include "ui/model/clearance_model.h"

#include <QtTest>

#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/qt/qt_suite.h"

using namespace nearfit;
using ui::ClearanceModel;

class ClearanceModelTest : public QObject {
  Q_OBJECT

 private slots:
  void aBoundIsSaidToBeOneInEachText();
  void aBoundBelowTheThresholdMayBeTooNearUnlessItsPointsAre();

 private:
  /// Text of a cell for parts `distance` apart by a bound, or exactly, whose nearest points known are
  /// `pointsApart` apart [m].
  static QString textOf(ClearanceModel::Column column, double distance, bool isBound, double pointsApart,
                        int role = Qt::DisplayRole);
};

QString ClearanceModelTest::textOf(ClearanceModel::Column column, double distance, bool isBound,
                                   double pointsApart, int role) {
  Scene scene;
  PartClearance clearance;
  clearance.other = scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(0.02))), "wall"));
  clearance.distance = distance;
  clearance.isDistanceBound = isBound;
  clearance.otherPoint.x = pointsApart;
  ClearanceModel model;
  model.setThreshold(0.001);
  model.show({clearance}, scene);
  return model.data(model.index(0, column), role).toString();
}

/// 0.26 mm was shown as the distance of parts 0.508 mm apart.
void ClearanceModelTest::aBoundIsSaidToBeOneInEachText() {
  constexpr double kBound = 0.00026, kTrue = 0.000508;
  const QString atLeast = QStringLiteral("at least 0.26 mm");
  QCOMPARE(textOf(ClearanceModel::Distance, kBound, true, kTrue), atLeast);
  QVERIFY(textOf(ClearanceModel::Other, kBound, true, kTrue, Qt::ToolTipRole).contains(atLeast));
  QCOMPARE(textOf(ClearanceModel::Distance, kBound, false, kBound), QStringLiteral("0.26 mm"));
  PartClearance clearance;
  clearance.distance = kBound;
  clearance.isDistanceBound = true;
  QCOMPARE(ClearanceModel::valueOf(clearance), atLeast);
}

void ClearanceModelTest::aBoundBelowTheThresholdMayBeTooNearUnlessItsPointsAre() {
  const QString tooNear = QStringLiteral("too near");
  QCOMPARE(textOf(ClearanceModel::Verdict, 0.0005, true, 0.002), QStringLiteral("may be too near"));
  QCOMPARE(textOf(ClearanceModel::Verdict, 0.0005, true, 0.0008), tooNear);
  QCOMPARE(textOf(ClearanceModel::Verdict, 0.0005, false, 0.0005), tooNear);
  QCOMPARE(textOf(ClearanceModel::Verdict, 0.0015, true, 0.002), QStringLiteral("clear"));
}

NEARFIT_QT_SUITE(ClearanceModelTest, test::runQtTest<ClearanceModelTest>)
#include "clearance_model_test.moc"

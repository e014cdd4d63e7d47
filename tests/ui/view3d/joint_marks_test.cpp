#include "ui/view3d/joint_marks.h"

#include <QtTest>
#include <array>
#include <cmath>

#include <vtkActorCollection.h>
#include <vtkProperty.h>

#include "tests/support/qt/qt_suite.h"
#include "ui/widgets/theme.h"

using namespace nearfit;

class JointMarksTest : public QObject {
  Q_OBJECT

 private slots:
  void anAxisIsAsLongAsItReaches();
  void aPlaneIsASquareAcrossItsNormal();
  void aPointIsInTheMiddleOfItsCross();
  void whatHasLeftItsJointIsInTheColourOfWarnings();
  void withoutMarksNothingIsDrawn();

 private:
  using Bounds = std::array<double, 6>;
  Bounds bounds() {
    Bounds box{};
    renderer_->ComputeVisiblePropBounds(box.data());
    return box;
  }
  static bool isNear(const Bounds& box, const Bounds& expected) {
    for (std::size_t i = 0; i < box.size(); ++i) {
      if (std::abs(box[i] - expected[i]) > 1e-9) return false;
    }
    return true;
  }
  /// True if something of this colour is drawn.
  bool shows(const QColor& colour) {
    vtkActorCollection& actors = *renderer_->GetActors();
    actors.InitTraversal();
    while (vtkActor* actor = actors.GetNextActor()) {
      const double* shown = actor->GetProperty()->GetColor();
      const bool isOfIt = std::abs(shown[0] - colour.redF()) < 1e-6 &&
                          std::abs(shown[1] - colour.greenF()) < 1e-6 &&
                          std::abs(shown[2] - colour.blueF()) < 1e-6;
      if (actor->GetVisibility() != 0 && isOfIt) return true;
    }
    return false;
  }

  vtkNew<vtkRenderer> renderer_;
  ui::JointMarks marks_{*renderer_.Get()};
};

void JointMarksTest::anAxisIsAsLongAsItReaches() {
  marks_.show({{JointKind::OnAxis, {0.1, 0.2, 0.3}, {0, 0, 1}, 0.05, {}}});
  QVERIFY(isNear(bounds(), {0.1, 0.1, 0.2, 0.2, 0.25, 0.35}));
}

void JointMarksTest::aPlaneIsASquareAcrossItsNormal() {
  marks_.show({{JointKind::InPlane, {0.1, 0.2, 0.3}, {0, 1, 0}, 0.05, {}}});
  QVERIFY(isNear(bounds(), {0.05, 0.15, 0.2, 0.2, 0.25, 0.35}));
}

void JointMarksTest::aPointIsInTheMiddleOfItsCross() {
  marks_.show({{JointKind::ToPoint, {0.1, 0.2, 0.3}, {0, 0, 1}, 0.05, {}}});
  QVERIFY(isNear(bounds(), {0.05, 0.15, 0.15, 0.25, 0.25, 0.35}));
}

void JointMarksTest::whatHasLeftItsJointIsInTheColourOfWarnings() {
  ui::JointMark mark{JointKind::ToPoint, {0, 0, 0}, {0, 0, 1}, 0.01, {}};
  marks_.show({mark});
  QVERIFY(shows(ui::themed(ui::colours::kJoint)) && !shows(ui::themed(ui::colours::kWarning)));
  mark.strayed = glm::dvec3(0.2, 0.0, 0.0);
  marks_.show({mark});
  QVERIFY(!shows(ui::themed(ui::colours::kJoint)) && shows(ui::themed(ui::colours::kWarning)));
  // A line leads to what should be there.
  QVERIFY(isNear(bounds(), {-0.01, 0.2, -0.01, 0.01, -0.01, 0.01}));
}

void JointMarksTest::withoutMarksNothingIsDrawn() {
  marks_.show({{JointKind::InPlane, {0, 0, 0}, {0, 1, 0}, 0.05, {}}});
  marks_.show({});
  QVERIFY(bounds()[0] > bounds()[1]);
}

NEARFIT_QT_SUITE(JointMarksTest, test::runQtTest<JointMarksTest>)
#include "joint_marks_test.moc"

#include "ui/view3d/parts/detail_choice.h"

#include <QtTest>
#include <array>
#include <cmath>

#include <vtkPointData.h>

#include "tests/support/mesh_generators.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/view3d/parts/part_shape.h"

using namespace nearfit;
using ui::DetailLevel;

class DetailChoiceTest : public QObject {
  Q_OBJECT

 private slots:
  void littleIsDrawnAsItIs();
  void smallPartsAreCoarseWhereItIsNotSeen();
  void theLargestIsCoarsenedFirst();
  void whatIsNotSeenCostsNothing();
  void coarsestOfAllWhereNothingElseFits();
  void draftsAreNearTheirSurface();
  void aThousandPartsFitAtOnce();
  void smallMeshesHaveNoDrafts();

 private:
  const std::array<DetailLevel, 3> large_{{{10'000, 0.0}, {1'000, 0.01}, {100, 0.1}}};
  const std::array<DetailLevel, 3> small_{{{2'000, 0.0}, {500, 0.01}, {50, 0.1}}};
};

void DetailChoiceTest::littleIsDrawnAsItIs() {
  const std::array parts{ui::DetailCandidate{large_, 1.0}, ui::DetailCandidate{small_, 1.0}};
  const ui::DetailChoice choice = chooseDetail(parts, {12'000});
  QCOMPARE(choice.levels, (std::vector<std::uint8_t>{0, 0}));
  QCOMPARE(choice.triangles, std::size_t{12'000});
  QVERIFY(choice.isExact);
}

void DetailChoiceTest::smallPartsAreCoarseWhereItIsNotSeen() {
  // A cell of 0.01 m is one pixel of the first, ten of the second.
  const std::array parts{ui::DetailCandidate{large_, 100.0}, ui::DetailCandidate{small_, 1000.0}};
  const ui::DetailChoice choice = chooseDetail(parts, {11'999, 2.0});
  QCOMPARE(choice.levels, (std::vector<std::uint8_t>{1, 0}));
  QCOMPARE(choice.triangles, std::size_t{3'000});
  QVERIFY(!choice.isExact);
}

void DetailChoiceTest::theLargestIsCoarsenedFirst() {
  const std::array parts{ui::DetailCandidate{small_, 1e6}, ui::DetailCandidate{large_, 1e6}};
  const ui::DetailChoice choice = chooseDetail(parts, {3'000, 2.0});
  QCOMPARE(choice.levels, (std::vector<std::uint8_t>{0, 1}));
  QCOMPARE(choice.triangles, std::size_t{3'000});
}

void DetailChoiceTest::whatIsNotSeenCostsNothing() {
  const std::array parts{ui::DetailCandidate{large_, 1e6, false}, ui::DetailCandidate{small_, 1e6}};
  const ui::DetailChoice choice = chooseDetail(parts, {2'000});
  QCOMPARE(choice.levels[1], std::uint8_t{0});
  QCOMPARE(choice.triangles, std::size_t{2'000});
  QVERIFY(choice.isExact);
}

void DetailChoiceTest::coarsestOfAllWhereNothingElseFits() {
  const std::array parts{ui::DetailCandidate{large_, 1e6}, ui::DetailCandidate{small_, 1e6}};
  const ui::DetailChoice choice = chooseDetail(parts, {1});
  QCOMPARE(choice.levels, (std::vector<std::uint8_t>{2, 2}));
  QCOMPARE(choice.triangles, std::size_t{150});
}

void DetailChoiceTest::draftsAreNearTheirSurface() {
  constexpr double kRadius = 1.0;
  const ui::PartShape shape = ui::makePartShape(test::icosphereMesh(kRadius, 6));
  QVERIFY(shape.drafts.size() >= 2);
  QCOMPARE(shape.levels.size(), shape.drafts.size() + 1);
  for (std::size_t i = 0; i < shape.drafts.size(); ++i) {
    vtkPolyData* draft = shape.drafts[i];
    QVERIFY(2 * shape.levels[i + 1].triangles <= shape.levels[i].triangles);
    QVERIFY(draft->GetPointData()->GetNormals() != nullptr);
    for (vtkIdType p = 0; p < draft->GetNumberOfPoints(); ++p) {
      const double* x = draft->GetPoint(p);
      const double off = std::abs(std::hypot(x[0], x[1], x[2]) - kRadius);
      QVERIFY2(off <= shape.levels[i + 1].cell, qPrintable(QString::number(off)));
    }
  }
}

/// The coarsest of a thousand parts of ten thousand triangles are what a slow machine turns smoothly.
void DetailChoiceTest::aThousandPartsFitAtOnce() {
  const ui::PartShape shape = ui::makePartShape(test::icosphereMesh(1.0, 5));
  QVERIFY2(shape.levels.back().triangles <= 150, qPrintable(QString::number(shape.levels.back().triangles)));
}

void DetailChoiceTest::smallMeshesHaveNoDrafts() {
  QVERIFY(ui::makePartShape(test::boxMesh(glm::dvec3(1.0))).drafts.empty());
}

NEARFIT_QT_SUITE(DetailChoiceTest, test::runQtTest<DetailChoiceTest, QCoreApplication>)
#include "detail_choice_test.moc"

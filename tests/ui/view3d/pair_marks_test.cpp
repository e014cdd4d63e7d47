#include "ui/view3d/pair_marks.h"

#include <QtTest>

#include "tests/support/qt/qt_patience.h"
#include "tests/support/qt/qt_suite.h"
#include "tests/ui/view3d/glyphs/segment_view.h"

using namespace nearfit;

namespace {

/// Two parts that meet in a square of 20 mm across z at z = 10 mm; 4 mm along x free the first one.
PairFinding clash() {
  PairFinding finding;
  finding.verdict = PairVerdict::Clash;
  finding.clash.emplace();
  const double a = 0.01, z = 0.01;
  finding.clash->curves = {{{a, a, z}, {-a, a, z}, {-a, -a, z}, {a, -a, z}, {a, a, z}}};
  finding.clash->freeing = FreeingTranslation{0.004, {1, 0, 0}};
  return finding;
}

}  // namespace

class PairMarksTest : public QObject {
  Q_OBJECT

 private slots:
  void theArrowBeginsWherePartsMeet();
  void theMarkedBoxHoldsAllThatIsDrawn();
  void curvesAndArrowAreSeenUntilTheyAreCleared();
};

void PairMarksTest::theArrowBeginsWherePartsMeet() {
  const ui::FreeingArrow arrow = ui::freeingArrow(clash());
  QCOMPARE(arrow.from, glm::dvec3(0.0, 0.0, 0.01));
  QCOMPARE(arrow.to, glm::dvec3(0.004, 0.0, 0.01));
  // A part inside another one meets it nowhere.
  PairFinding contained = clash();
  contained.clash->curves.clear();
  contained.partPoint = {0.1, 0.2, 0.3};
  QCOMPARE(ui::freeingArrow(contained).from, contained.partPoint);
}

void PairMarksTest::theMarkedBoxHoldsAllThatIsDrawn() {
  PairFinding finding = clash();
  finding.clash->freeing->length = 0.05;
  const Aabb box = ui::markedBox(finding);
  QCOMPARE(box.lower, glm::dvec3(-0.01, -0.01, 0.01));
  QCOMPARE(box.upper, glm::dvec3(0.05, 0.01, 0.01));
  PairFinding near;
  near.partPoint = {0.0, 0.0, 0.001};
  near.otherPoint = {0.0, 0.002, 0.0};
  QCOMPARE(ui::markedBox(near).lower, glm::dvec3(0.0));
  QCOMPARE(ui::markedBox(near).upper, glm::dvec3(0.0, 0.002, 0.001));
}

void PairMarksTest::curvesAndArrowAreSeenUntilTheyAreCleared() {
  test::SegmentView shown;
  shown.show();
  if (QTest::currentTestFailed()) return;
  ui::Viewport& view = shown.view;
  const auto picture = [&view] {
    view.completePicture();
    return view.grabFramebuffer();
  };
  const QImage before = picture();
  ui::PairMarks marks(view);
  QVERIFY(!marks.isShown());
  marks.show(clash(), QStringLiteral("depth 4.00 mm"));
  QVERIFY(marks.isShown());
  QVERIFY(picture() != before);
  QVERIFY(view.findChild<QWidget*>(QStringLiteral("pairLabel")) != nullptr);
  marks.clear();
  QVERIFY(!marks.isShown());
  QCOMPARE(picture(), before);
}

NEARFIT_QT_SUITE(PairMarksTest, test::runQtTest<PairMarksTest>)
#include "pair_marks_test.moc"

#include "ui/view3d/glyphs/pair_segment.h"

#include <QtTest>

#include "tests/support/qt/qt_patience.h"
#include "tests/support/qt/qt_suite.h"
#include "tests/ui/view3d/glyphs/segment_view.h"

using namespace nearfit;

class PairSegmentTest : public QObject {
  Q_OBJECT

 private slots:
  void endsAreDotsWithinWhiteRims();
};

// The rims were balls, which bulged over the smaller ones in them.
void PairSegmentTest::endsAreDotsWithinWhiteRims() {
  test::SegmentView shown;
  shown.show();
  if (QTest::currentTestFailed()) return;
  ui::Viewport& view = shown.view;
  const QImage picture = view.grabFramebuffer();
  const auto isLike = [](const QColor& seen, const QColor& wanted) {
    return std::abs(seen.red() - wanted.red()) + std::abs(seen.green() - wanted.green()) +
               std::abs(seen.blue() - wanted.blue()) <
           60;
  };
  for (const glm::dvec3& end : {shown.from, shown.to}) {
    const glm::dvec2 pixel = view.projection().pixelOf(end).value();
    const QPoint dot = QPoint(qRound(pixel.x), qRound(pixel.y)) * view.devicePixelRatioF();
    const QColor middle = picture.pixelColor(dot), inside = picture.pixelColor(dot + QPoint(0, -3)),
                 rim = picture.pixelColor(dot + QPoint(0, -6)),
                 beside = picture.pixelColor(dot + QPoint(0, -11));
    QVERIFY2(isLike(middle, shown.colour), qPrintable(middle.name()));
    QVERIFY2(isLike(inside, shown.colour), qPrintable(inside.name()));
    QVERIFY2(isLike(rim, Qt::white), qPrintable(rim.name()));
    QVERIFY2(!isLike(beside, Qt::white) && !isLike(beside, shown.colour), qPrintable(beside.name()));
    // A dot is round: the corner of its square shows what lies behind.
    const QColor corner = picture.pixelColor(dot + QPoint(7, -7));
    QVERIFY2(!isLike(corner, Qt::white), qPrintable(corner.name()));
  }
}

NEARFIT_QT_SUITE(PairSegmentTest, test::runQtTest<PairSegmentTest>)
#include "pair_segment_test.moc"

#include "ui/pair_segment.h"

#include <QtTest>
#include <memory>

#include "core/session.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/qt_patience.h"
#include "ui/selection.h"
#include "ui/viewport.h"

using namespace nearfit;

class PairSegmentTest : public QObject {
  Q_OBJECT

 private slots:
  void endsAreDotsWithinWhiteRims();
};

// The rims were balls, which bulged over the smaller ones in them.
void PairSegmentTest::endsAreDotsWithinWhiteRims() {
  Session session;
  ui::Selection selection(session);
  ui::Viewport view(std::make_shared<ui::PartShapeCache>(), selection);
  Scene scene;
  scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(0.1))), "box"));
  session.reset(scene);
  view.resize(400, 400);
  view.setScene(session.scene());
  view.show();
  QVERIFY(QTest::qWaitForWindowExposed(&view));
  QTRY_VERIFY(view.pictureCount() > 0);
  view.setView(ui::StandardView::Front);
  const QColor colour(200, 30, 160);
  ui::PairSegment segment(view.overlay(), colour);
  const glm::dvec3 from(-0.03, -0.06, 0.0), to(0.03, -0.06, 0.0);
  segment.show(from, to);
  view.completePicture();
  const QImage picture = view.grabFramebuffer();
  const auto isLike = [](const QColor& seen, const QColor& wanted) {
    return std::abs(seen.red() - wanted.red()) + std::abs(seen.green() - wanted.green()) +
               std::abs(seen.blue() - wanted.blue()) <
           60;
  };
  for (const glm::dvec3& end : {from, to}) {
    const glm::dvec2 pixel = view.projection().pixelOf(end).value();
    const QPoint dot = QPoint(qRound(pixel.x), qRound(pixel.y)) * view.devicePixelRatioF();
    const QColor middle = picture.pixelColor(dot), inside = picture.pixelColor(dot + QPoint(0, -3)),
                 rim = picture.pixelColor(dot + QPoint(0, -6)),
                 beside = picture.pixelColor(dot + QPoint(0, -11));
    QVERIFY2(isLike(middle, colour), qPrintable(middle.name()));
    QVERIFY2(isLike(inside, colour), qPrintable(inside.name()));
    QVERIFY2(isLike(rim, Qt::white), qPrintable(rim.name()));
    QVERIFY2(!isLike(beside, Qt::white) && !isLike(beside, colour), qPrintable(beside.name()));
    // A dot is round: the corner of its square shows what lies behind.
    const QColor corner = picture.pixelColor(dot + QPoint(7, -7));
    QVERIFY2(!isLike(corner, Qt::white), qPrintable(corner.name()));
  }
}

QTEST_MAIN(PairSegmentTest)
#include "pair_segment_test.moc"

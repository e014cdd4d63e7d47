#include "ui/pixel_sizes.h"

#include <QApplication>
#include <QtTest>
#include <memory>

#include "core/session.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/qt_patience.h"
#include "ui/pair_segment.h"
#include "ui/selection.h"
#include "ui/viewport.h"

using namespace nearfit;

/// On a screen of scale 2.
class PixelSizesTest : public QObject {
  Q_OBJECT

 private slots:
  void sizesAreThoseOfTheScreen();
  void linesAreAsWideOnAFineScreen();
};

void PixelSizesTest::sizesAreThoseOfTheScreen() {
  QCOMPARE(ui::devicePixels(3.0F), 6.0F);
}

void PixelSizesTest::linesAreAsWideOnAFineScreen() {
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
  segment.show({-0.03, -0.06, 0.0}, {0.03, -0.06, 0.0});
  view.completePicture();
  const QImage picture = view.grabFramebuffer();
  QCOMPARE(picture.width(), 800);
  const auto widthAt = [&](const glm::dvec3& place) {
    const glm::dvec2 pixel = 2.0 * view.projection().pixelOf(place).value();
    int coloured = 0;
    for (int y = qRound(pixel.y) - 40; y < qRound(pixel.y) + 40; ++y) {
      const QColor seen = picture.pixelColor(qRound(pixel.x), y);
      coloured += seen.red() > 150 && seen.green() < 110 && seen.blue() > 110 ? 1 : 0;
    }
    return coloured;
  };
  // Twice the 3.5 of the line and the 10 of its dots.
  QVERIFY2(std::abs(widthAt({0.0, -0.06, 0.0}) - 7) <= 2, "line");
  QVERIFY2(std::abs(widthAt({0.03, -0.06, 0.0}) - 20) <= 3, "dot");
}

int main(int argc, char* argv[]) {
  qputenv("QT_SCALE_FACTOR", "2");
  QApplication application(argc, argv);
  PixelSizesTest test;
  return QTest::qExec(&test, argc, argv);
}
#include "pixel_sizes_test.moc"

#include "ui/view3d/vtk/pixel_sizes.h"

#include <QApplication>
#include <QtTest>

#include "tests/support/qt/qt_patience.h"
#include "tests/support/qt/qt_suite.h"
#include "tests/ui/view3d/glyphs/segment_view.h"

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
  test::SegmentView shown;
  shown.show();
  if (QTest::currentTestFailed()) return;
  ui::Viewport& view = shown.view;
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

NEARFIT_QT_SUITE(PixelSizesTest, [](int argc, char** argv) {
  qputenv("QT_SCALE_FACTOR", "2");
  return test::runQtTest<PixelSizesTest>(argc, argv);
})
#include "pixel_sizes_test.moc"

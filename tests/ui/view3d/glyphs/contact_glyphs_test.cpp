#include "ui/view3d/glyphs/contact_glyphs.h"

#include <QtTest>
#include <array>

#include "tests/support/qt/qt_suite.h"

using namespace nearfit;

class ContactGlyphsTest : public QObject {
  Q_OBJECT

 private slots:
  void standAtTheirPoints();
  void greaterForceMakesALongerArrow();
  void nothingIsDrawnWithoutContactOrWhenSwitchedOff();

 private:
  using Bounds = std::array<double, 6>;
  static SnapshotContact contact(double force) {
    return {glm::dvec3(0.1, 0.2, 0.3), glm::dvec3(0.0, 0.0, 1.0), force, PartId{1}};
  }
  /// Of what is visible; no less than zero in size when there is something.
  Bounds bounds() {
    Bounds box{};
    renderer_->ComputeVisiblePropBounds(box.data());
    return box;
  }
  bool isEmpty() { return bounds()[0] > bounds()[1]; }

  static constexpr double kSize = 0.05;
  vtkNew<vtkRenderer> renderer_;
  ui::ContactGlyphs glyphs_{*renderer_.Get()};
};

void ContactGlyphsTest::standAtTheirPoints() {
  const std::array contacts{contact(2.0)};
  glyphs_.show(contacts, kSize);
  const Bounds box = bounds();
  QVERIFY(std::abs(0.5 * (box[0] + box[1]) - 0.1) < 1e-6 && std::abs(0.5 * (box[2] + box[3]) - 0.2) < 1e-6);
  QVERIFY(box[4] < 0.3 && box[5] > 0.3);
  // Small beside the part: at two newtons less than a fifth of it.
  QVERIFY(box[5] - 0.3 < 0.2 * kSize);
}

void ContactGlyphsTest::greaterForceMakesALongerArrow() {
  double before = 0.0;
  for (const double force : {0.0, 2.0, 5.0, 10.0}) {
    const std::array contacts{contact(force)};
    glyphs_.show(contacts, kSize);
    QVERIFY(bounds()[5] > before);
    before = bounds()[5];
  }
  // Beyond what a device bears it grows no more.
  const std::array contacts{contact(1e6)};
  glyphs_.show(contacts, kSize);
  QVERIFY(std::abs(bounds()[5] - before) < 1e-9);
}

void ContactGlyphsTest::nothingIsDrawnWithoutContactOrWhenSwitchedOff() {
  glyphs_.clear();
  QVERIFY(isEmpty());
  const std::array contacts{contact(2.0), contact(3.0)};
  glyphs_.show(contacts, kSize);
  QVERIFY(!isEmpty());
  glyphs_.setVisible(false);
  QVERIFY(isEmpty());
  glyphs_.setVisible(true);
  QVERIFY(!isEmpty());
  glyphs_.clear();
  QVERIFY(isEmpty());
}

NEARFIT_QT_SUITE(ContactGlyphsTest, test::runQtTest<ContactGlyphsTest>)
#include "contact_glyphs_test.moc"

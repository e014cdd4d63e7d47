#include "ui/tools/placing/feature_picker.h"

#include <QtTest>
#include <numbers>

#include "tests/support/qt/qt_suite.h"

using namespace nearfit;

class FeaturePickerTest : public QObject {
  Q_OBJECT

 private slots:
  void eachKindOfAxisIsNamed();
  void featuresOfExactSurfacesSaySo();
  void diametersHaveTheFiguresOfMeasuredDistances();
};

void FeaturePickerTest::eachKindOfAxisIsNamed() {
  AlignFeature axis{FeatureShape::Axis, {}, {0.0, 0.0, 1.0}};
  QCOMPARE(ui::describeFeature(axis), QStringLiteral("Straight edge"));
  axis.radius = 0.006;
  QCOMPARE(ui::describeFeature(axis), QStringLiteral("Axis of a cylinder ⌀ 12.000 mm"));
  axis.halfAngle = 5.0 * std::numbers::pi / 180.0;
  QCOMPARE(ui::describeFeature(axis), QStringLiteral("Axis of a cone, half angle 5.0°"));
  axis.halfAngle = 0.0;
  axis.flats = 6;
  QCOMPARE(ui::describeFeature(axis), QStringLiteral("Axis of a prism with 6 flats"));
}

void FeaturePickerTest::featuresOfExactSurfacesSaySo() {
  AlignFeature feature{FeatureShape::Axis, {}, {0.0, 0.0, 1.0}, 0.006};
  feature.surface = SurfaceKind::Cylinder;
  feature.isExact = true;
  QCOMPARE(ui::describeFeature(feature), QStringLiteral("Exact axis of a cylinder ⌀ 12.000 mm"));
  feature.shape = FeatureShape::Point;
  feature.surface = SurfaceKind::Sphere;
  QCOMPARE(ui::describeFeature(feature), QStringLiteral("Exact centre of a sphere ⌀ 12.000 mm"));
  feature.shape = FeatureShape::Circle;
  feature.surface = SurfaceKind::Torus;
  feature.minorRadius = 0.001;
  QCOMPARE(ui::describeFeature(feature), QStringLiteral("Exact torus ⌀ 12.000 mm, tube ⌀ 2.0000 mm"));
  feature.surface = SurfaceKind::Other;
  QCOMPARE(ui::describeFeature(feature), QStringLiteral("Exact circle ⌀ 12.000 mm"));
}

void FeaturePickerTest::diametersHaveTheFiguresOfMeasuredDistances() {
  AlignFeature circle{FeatureShape::Circle, {}, {0.0, 0.0, 1.0}, 0.006172};
  QCOMPARE(ui::describeFeature(circle), QStringLiteral("Circle ⌀ 12.344 mm"));
  QCOMPARE(ui::describeFeatureWithin(circle), QStringLiteral("circle ⌀ 12.344 mm"));
  circle.isExact = true;
  QCOMPARE(ui::describeFeature(circle), QStringLiteral("Exact circle ⌀ 12.344 mm"));
  circle.radius = 0.1234565;
  QCOMPARE(ui::describeFeature(circle), QStringLiteral("Exact circle ⌀ 246.913 mm"));
}

NEARFIT_QT_SUITE(FeaturePickerTest, test::runQtTest<FeaturePickerTest>)
#include "feature_picker_test.moc"

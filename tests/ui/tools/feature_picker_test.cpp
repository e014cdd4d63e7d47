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
};

void FeaturePickerTest::eachKindOfAxisIsNamed() {
  AlignFeature axis{FeatureShape::Axis, {}, {0.0, 0.0, 1.0}};
  QCOMPARE(ui::describeFeature(axis), QStringLiteral("Straight edge"));
  axis.radius = 0.006;
  QCOMPARE(ui::describeFeature(axis), QStringLiteral("Axis of a cylinder ⌀ 12.0 mm"));
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
  QCOMPARE(ui::describeFeature(feature), QStringLiteral("Axis of a cylinder ⌀ 12.0 mm, exact"));
  feature.shape = FeatureShape::Point;
  feature.surface = SurfaceKind::Sphere;
  QCOMPARE(ui::describeFeature(feature), QStringLiteral("Centre of a sphere ⌀ 12.0 mm, exact"));
  feature.shape = FeatureShape::Circle;
  feature.surface = SurfaceKind::Torus;
  feature.minorRadius = 0.001;
  QCOMPARE(ui::describeFeature(feature), QStringLiteral("Torus ⌀ 12.0 mm, tube ⌀ 2.00 mm, exact"));
  feature.surface = SurfaceKind::Other;
  QCOMPARE(ui::describeFeature(feature), QStringLiteral("Circle ⌀ 12.0 mm, exact"));
}

NEARFIT_QT_SUITE(FeaturePickerTest, test::runQtTest<FeaturePickerTest>)
#include "feature_picker_test.moc"

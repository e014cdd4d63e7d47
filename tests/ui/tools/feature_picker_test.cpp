#include "ui/tools/placing/feature_picker.h"

#include <QtTest>
#include <numbers>

#include "tests/support/qt/qt_suite.h"

using namespace nearfit;

class FeaturePickerTest : public QObject {
  Q_OBJECT

 private slots:
  void eachKindOfAxisIsNamed();
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

NEARFIT_QT_SUITE(FeaturePickerTest, test::runQtTest<FeaturePickerTest>)
#include "feature_picker_test.moc"

#include "ui/panels/feel/feel_panel.h"

#include <QAction>
#include <QLabel>
#include <QToolButton>
#include <QtTest>
#include <memory>

#include "core/scene/scene.h"
#include "tests/support/qt/qt_suite.h"
#include "tests/support/temporary_folder.h"
#include "ui/model/preset_store.h"

using namespace nearfit;

class FeelPanelTest : public QObject {
  Q_OBJECT

 private slots:
  void aMinDistanceThatIsOnlyABoundIsSaidToBeOne();
  void aLimitIsTheDevicesOnlyIfThereIsOne();
};

void FeelPanelTest::aMinDistanceThatIsOnlyABoundIsSaidToBeOne() {
  const test::TemporaryFolder folder;
  ui::PresetStore presets(folder.path() / "presets.json");
  QAction clutch;
  ui::FeelPanel panel({new QToolButton, &clutch, presets});
  const auto* distance = panel.findChild<QLabel*>(QStringLiteral("distance"));
  QVERIFY(distance != nullptr);
  const auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->distance = 0.00026;
  panel.showSnapshot(*snapshot, Scene());
  QCOMPARE(distance->text(), QStringLiteral("0.26 mm"));
  snapshot->isDistanceBound = true;
  panel.showSnapshot(*snapshot, Scene());
  QCOMPARE(distance->text(), QStringLiteral("at least 0.26 mm"));
  // Numbers that are past are of the same snapshot.
  panel.clearSnapshot();
  panel.keepSnapshot(*snapshot);
  QCOMPARE(distance->text(), QStringLiteral("at least 0.26 mm"));
}

void FeelPanelTest::aLimitIsTheDevicesOnlyIfThereIsOne() {
  const test::TemporaryFolder folder;
  ui::PresetStore presets(folder.path() / "presets.json");
  QAction clutch;
  ui::FeelPanel panel({new QToolButton, &clutch, presets});
  const auto* clamped = panel.findChild<QLabel*>(QStringLiteral("clamped"));
  ui::ServoStatus status;
  status.isRunning = true;
  status.hand = ui::Hand::Manual;
  status.device.maxForce = 10.0;
  status.device.maxTorque = 0.5;
  panel.showStatus(status);
  const auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->isClamped = true;
  snapshot->unclampedWrench.force = {0.0, 0.0, 12.0};
  panel.showSnapshot(*snapshot, Scene());
  QCOMPARE(clamped->text(), QStringLiteral("Limited to 10 N."));
  snapshot->unclampedWrench = {{0.0, 0.0, 1.0}, {0.7, 0.0, 0.0}};
  panel.showSnapshot(*snapshot, Scene());
  QCOMPARE(clamped->text(), QStringLiteral("Limited to 0.5 N·m."));
  status.hand = ui::Hand::Device;
  panel.showStatus(status);
  panel.showSnapshot(*snapshot, Scene());
  QCOMPARE(clamped->text(), QStringLiteral("Limited to the device's maximum."));
}

NEARFIT_QT_SUITE(FeelPanelTest, test::runQtTest<FeelPanelTest>)
#include "feel_panel_test.moc"

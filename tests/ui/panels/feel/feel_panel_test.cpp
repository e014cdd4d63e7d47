#include "ui/panels/feel/feel_panel.h"

#include <QAction>
#include <QLabel>
#include <QLayout>
#include <QScrollArea>
#include <QToolButton>
#include <QtTest>
#include <memory>

#include "core/scene/group.h"
#include "core/scene/scene.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/qt/qt_suite.h"
#include "tests/support/temporary_folder.h"
#include "ui/model/preset_store.h"

using namespace nearfit;

class FeelPanelTest : public QObject {
  Q_OBJECT

 private slots:
  void aMinDistanceThatIsOnlyABoundIsSaidToBeOne();
  void aCountThatIsNotOfAllMinimaSaysWhy();
  void aLimitIsTheDevicesOnlyIfThereIsOne();
  void theNoteOnALimitShiftsNothing();
  void longTextsDoNotWidenThePanelBeyondItsDock();
  void overlapsOfAGroupAreOfTheGroup();
  void overlapsWithSpringsAreNotSaidToBeUnfelt();
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

void FeelPanelTest::aCountThatIsNotOfAllMinimaSaysWhy() {
  const test::TemporaryFolder folder;
  ui::PresetStore presets(folder.path() / "presets.json");
  QAction clutch;
  ui::FeelPanel panel({new QToolButton, &clutch, presets});
  const auto* minima = panel.findChild<QLabel*>(QStringLiteral("minima"));
  QVERIFY(minima != nullptr);
  const auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->lmdCount = 12;
  snapshot->isTruncated = true;
  panel.showSnapshot(*snapshot, Scene());
  QCOMPARE(minima->text(), QStringLiteral("12+"));
  QCOMPARE(minima->toolTip(), QStringLiteral("There may be more: the search stopped at its limit."));
  snapshot->isTruncated = false;
  panel.showSnapshot(*snapshot, Scene());
  QCOMPARE(minima->text(), QStringLiteral("12"));
  QCOMPARE(minima->toolTip(), QString());
  snapshot->isTruncated = true;
  panel.showSnapshot(*snapshot, Scene());
  panel.clearSnapshot();
  QCOMPARE(minima->toolTip(), QString());
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

/// The numbers below the note moved down when it came, and up again when it went.
void FeelPanelTest::theNoteOnALimitShiftsNothing() {
  const test::TemporaryFolder folder;
  ui::PresetStore presets(folder.path() / "presets.json");
  QAction clutch;
  ui::FeelPanel panel({new QToolButton, &clutch, presets});
  const auto* felt = panel.findChild<QWidget*>(QStringLiteral("feltNumbers"));
  const auto* clamped = panel.findChild<QLabel*>(QStringLiteral("clamped"));
  QVERIFY(felt != nullptr && clamped != nullptr);
  // Wide enough for the longest text in one line.
  const auto height = [felt] { return felt->layout()->totalHeightForWidth(600); };
  ui::ServoStatus status;
  status.isRunning = true;
  status.hand = ui::Hand::Manual;
  status.device.maxForce = 10.0;
  panel.showStatus(status);
  const auto snapshot = std::make_unique<ServoSnapshot>();
  panel.showSnapshot(*snapshot, Scene());
  const int without = height();
  QVERIFY(without > 0);
  for (int again = 0; again < 2; ++again) {
    snapshot->isClamped = true;
    snapshot->unclampedWrench.force = {0.0, 0.0, 12.0};
    panel.showSnapshot(*snapshot, Scene());
    QVERIFY(!clamped->text().isEmpty());
    QCOMPARE(height(), without);
    snapshot->isClamped = false;
    panel.showSnapshot(*snapshot, Scene());
    QVERIFY(clamped->text().isEmpty());
    QCOMPARE(height(), without);
  }
}

void FeelPanelTest::longTextsDoNotWidenThePanelBeyondItsDock() {
  const test::TemporaryFolder folder;
  ui::PresetStore presets(folder.path() / "presets.json");
  QAction clutch;
  ui::FeelPanel panel({new QToolButton, &clutch, presets});
  const auto* scroll = panel.findChild<QScrollArea*>(QStringLiteral("feelScroll"));
  QVERIFY(scroll != nullptr);
  panel.resize(panel.minimumSizeHint().width(), 900);
  panel.show();
  QVERIFY(QTest::qWaitForWindowExposed(&panel));
  Scene scene;
  const auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->distance = 1e-9;
  snapshot->isDistanceBound = true;
  // One minimum is missing, so that the distance to the others is a bound.
  snapshot->lmds[0].other = PartId{9};
  snapshot->lmds[0].lmd.distance = 1e-3;
  snapshot->storedLmds = 1;
  snapshot->lmdCount = 2;
  snapshot->overlappingCount = 2;
  panel.showSnapshot(*snapshot, scene);
  const auto* distance = panel.findChild<QLabel*>(QStringLiteral("distance"));
  QVERIFY2(distance->text().startsWith(QStringLiteral("at least")) &&
               distance->text().endsWith(QStringLiteral("to others")),
           qPrintable(distance->text()));
  QTRY_VERIFY(distance->height() >= distance->heightForWidth(distance->width()));
  QTRY_VERIFY2(
      scroll->widget()->width() <= scroll->viewport()->width(),
      qPrintable(QStringLiteral("%1 in %2").arg(scroll->widget()->width()).arg(scroll->viewport()->width())));
  QVERIFY(distance->mapTo(scroll->viewport(), QPoint(distance->width(), 0)).x() <=
          scroll->viewport()->width());
}

void FeelPanelTest::overlapsOfAGroupAreOfTheGroup() {
  const test::TemporaryFolder folder;
  ui::PresetStore presets(folder.path() / "presets.json");
  QAction clutch;
  ui::FeelPanel panel({new QToolButton, &clutch, presets});
  const auto* notice = panel.findChild<QLabel*>(QStringLiteral("noticeText"));
  QVERIFY(notice != nullptr);
  Scene scene;
  const auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->overlappingCount = 2;
  panel.showSnapshot(*snapshot, scene);
  QVERIFY2(notice->text().endsWith(QStringLiteral("apart from it.")), qPrintable(notice->text()));
  const GroupId group = scene.addGroup({{}, "Pair", {}, false});
  Part part = test::partOf(test::geometryOf(test::boxMesh({0.01, 0.01, 0.01})), "pin");
  part.group = group;
  scene.add(part);
  scene.setMovingGroup(group);
  panel.showSnapshot(*snapshot, scene);
  QVERIFY2(notice->text().endsWith(QStringLiteral("apart from the group.")), qPrintable(notice->text()));
}

void FeelPanelTest::overlapsWithSpringsAreNotSaidToBeUnfelt() {
  const test::TemporaryFolder folder;
  ui::PresetStore presets(folder.path() / "presets.json");
  QAction clutch;
  ui::FeelPanel panel({new QToolButton, &clutch, presets});
  const auto* notice = panel.findChild<QLabel*>(QStringLiteral("noticeText"));
  Scene scene;
  const PartId plate = scene.add(test::partOf(test::geometryOf(test::boxMesh({0.01, 0.01, 0.01})), "plate"));
  const auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->mode = HapticMode::Springs;
  snapshot->overlappingCount = 1;
  snapshot->overlapping[0] = plate;
  panel.showSnapshot(*snapshot, scene);
  QCOMPARE(notice->text(), QStringLiteral("Overlaps plate. Springs do not keep parts apart."));
}

NEARFIT_QT_SUITE(FeelPanelTest, test::runQtTest<FeelPanelTest>)
#include "feel_panel_test.moc"

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QStatusBar>

#include "tests/app/desktop/view_pointer.h"
#include "ui/model/parts_model.h"

using namespace nearfit;
using namespace nearfit::test;

class DesktopAlignTest : public QObject {
  Q_OBJECT

 private slots:
  /// Kept from one window to the next.
  void cleanup() { QSettings().remove(QStringLiteral("placing/solid")); }
  void hoverTellsWhatWouldBePicked();
  void anOutlineIsPickedFromBothSides();
  void alignsTwoFacesByTwoClicksAsOneStepOfUndo();
  void flipsAndLeavesADistance();
  void solidPartsStopAtContactOnTheWay();
  void escapeLeavesEverythingAsItWas();
  void theGizmoStandsAsideMeanwhile();
  void aPartThatLeavesTheSceneEndsIt();
  void anotherSceneEndsItThoughItsPartsAreTheSame();
  void lockedPartsRefuseToMove();
  void dragsStillOrbitWhileAligning();
  void makingPartsSolidMeanwhileEndsNothing();
  void alignsACornerWithACorner();
  void alignsTheAxesOfTwoCylinders();
  void dropsToContactAsOneStepOfUndo();
  void dropsTowardsAFace();
  void pushesUntilHeld();
  void saysWhenNothingIsInTheWayOrPartsOverlap();
  void lockedPartsDoNotDrop();
  void selectedPartsGoTogetherAsOneStep();
  void aSeeThroughPartIsTheTargetWhereOnlyThePartThatMovesIsBehindIt();
  void endedByItsButtonsItGivesTheKeysToTheView();

 private:
  static void click(DesktopDriver& d, const glm::dvec3& point) { ViewPointer(d).click(point); }
  static void hover(DesktopDriver& d, const glm::dvec3& point) { ViewPointer(d).hover(point); }
  static void begin(DesktopDriver& d) {
    d.addCubes();
    d.choose("viewFront");
    QTest::qWait(50);
    pressShortcut(d, Qt::Key_A);
    QVERIFY(d.action("align")->isChecked());
    QVERIFY(d.widget<QWidget>("alignBar")->isVisible());
  }
  /// On the faces that look at the viewer of the front view.
  static constexpr double kFixedFront = -0.02, kMovingFront = -0.01;
  /// The pointer stands on pixels: exactly on an outline it may be beside the part.
  static constexpr double kInside = 3e-4, kTop = 0.045 - kInside;
};

void DesktopAlignTest::hoverTellsWhatWouldBePicked() {
  DesktopDriver d;
  begin(d);
  QCOMPARE(d.text("alignHint"), QStringLiteral("Locked parts don't move; selected parts move together"));
  hover(d, {0.003, kMovingFront, 0.036});
  QTRY_COMPARE(d.text("alignHint"), QStringLiteral("Flat face of moving"));
  hover(d, {0.0, kMovingFront, kTop});
  QTRY_COMPARE(d.text("alignHint"), QStringLiteral("Straight edge of moving"));
  hover(d, {0.01 - kInside, kMovingFront, kTop});
  QTRY_COMPARE(d.text("alignHint"), QStringLiteral("Point of moving"));
  d.widget<QComboBox>("alignFilter")->setCurrentIndex(1);
  hover(d, {0.0, kMovingFront, 0.0449});
  QTRY_COMPARE(d.text("alignHint"), QStringLiteral("Flat face of moving"));
}

void DesktopAlignTest::anOutlineIsPickedFromBothSides() {
  DesktopDriver d;
  begin(d);
  const auto hint = [&] { return d.text("alignHint"); };
  // Where nothing is picked.
  const QString nothing = hint();
  const double pixel = ViewPointer(d).view().projection().metresPerPixel({0.0, kMovingFront, 0.045});
  const auto above = [&](double pixels) { return glm::dvec3(0.0, kMovingFront, 0.045 + pixels * pixel); };
  for (const double pixels : {-5.0, -2.0, 2.0, 5.0}) {
    hover(d, above(pixels));
    QTRY_COMPARE(hint(), QStringLiteral("Straight edge of moving"));
    hover(d, above(20.0));
    QTRY_COMPARE(hint(), nothing);
  }
  // Beside a corner, both ways.
  hover(d, {0.01 + 2.0 * pixel, kMovingFront, 0.045 + 2.0 * pixel});
  QTRY_COMPARE(hint(), QStringLiteral("Point of moving"));
  // No face is picked where there is none.
  d.widget<QComboBox>("alignFilter")->setCurrentIndex(1);
  hover(d, above(2.0));
  QTRY_COMPARE(hint(), nothing);
  d.widget<QComboBox>("alignFilter")->setCurrentIndex(0);
  // In front of another part its outline counts, and not only where nothing is.
  d.choose("viewTop");
  QTest::qWait(50);
  const glm::dvec3 overFixed(0.0, kMovingFront, 0.045);
  const double topPixel = ViewPointer(d).view().projection().metresPerPixel(overFixed);
  hover(d, overFixed - glm::dvec3(0.0, 3.0 * topPixel, 0.0));
  QTRY_COMPARE(hint(), QStringLiteral("Straight edge of moving"));
  hover(d, overFixed - glm::dvec3(0.0, 20.0 * topPixel, 0.0));
  QTRY_COMPARE(hint(), QStringLiteral("Flat face of fixed"));
}

void DesktopAlignTest::alignsTwoFacesByTwoClicksAsOneStepOfUndo() {
  DesktopDriver d;
  begin(d);
  const RigidTransform before = d.part("moving").worldFromPart;
  click(d, {0.003, kMovingFront, 0.036});
  QVERIFY(d.text("alignPrompt").contains(QStringLiteral("Click the target")));
  click(d, {-0.01, kFixedFront, 0.005});
  QVERIFY(d.widget<QPushButton>("alignApply")->isEnabled());
  keepPictures(d.window(), QStringLiteral("align"));
  // A preview is no change.
  QCOMPARE(d.part("moving").worldFromPart.translation, before.translation);
  pressInView(d, Qt::Key_Return);
  const RigidTransform after = d.part("moving").worldFromPart;
  // Face to face: its front looks back, in the plane of the other's.
  QVERIFY(glm::distance(after.applyToVector({0, -1, 0}), glm::dvec3(0, 1, 0)) < 1e-12);
  QVERIFY(std::abs(after.applyToPoint({0.0, kMovingFront, 0.035}).y - kFixedFront) < 1e-12);
  QVERIFY(!d.action("align")->isChecked());
  QVERIFY(!d.widget<QWidget>("alignBar")->isVisible());
  QVERIFY(d.action("undo")->text().contains(QStringLiteral("Align moving")));
  d.choose("undo");
  QCOMPARE(d.part("moving").worldFromPart.translation, before.translation);
  QCOMPARE(d.part("moving").worldFromPart.rotation, before.rotation);
}

void DesktopAlignTest::flipsAndLeavesADistance() {
  DesktopDriver d;
  begin(d);
  click(d, {0.003, kMovingFront, 0.036});
  click(d, {-0.01, kFixedFront, 0.005});
  QTest::mouseClick(d.widget<QCheckBox>("alignFlip"), Qt::LeftButton, {}, QPoint(8, 8));
  QVERIFY(d.widget<QCheckBox>("alignFlip")->isChecked());
  d.type<QDoubleSpinBox>("alignOffset", "1/2 cm");
  QTest::mouseClick(d.widget<QPushButton>("alignApply"), Qt::LeftButton);
  const RigidTransform after = d.part("moving").worldFromPart;
  QVERIFY(glm::distance(after.applyToVector({0, -1, 0}), glm::dvec3(0, -1, 0)) < 1e-12);
  QVERIFY(glm::distance(after.translation, glm::dvec3(0.0, kFixedFront - 0.005 - kMovingFront, 0.0)) < 1e-12);
}

// Whatever "solid" said, it went through.
void DesktopAlignTest::solidPartsStopAtContactOnTheWay() {
  DesktopDriver d;
  d.choose("solid");
  QVERIFY(d.action("solid")->isChecked());
  begin(d);
  // Top corner on top corner would put the one cube into the other.
  click(d, {-0.01 + kInside, kMovingFront, kTop});
  click(d, {-0.02 + kInside, kFixedFront, 0.02 - kInside});
  pressInView(d, Qt::Key_Return);
  QTRY_COMPARE(QString::fromStdString(d.session().undoText()), QStringLiteral("Align moving"));
  const RigidTransform after = d.part("moving").worldFromPart;
  const double margin = d.session().scene().haptics().proxy.margin;
  QVERIFY2(after.translation.z > -0.005 && after.translation.z < -0.005 + 2.0 * margin,
           qPrintable(QString::number(after.translation.z)));
  QVERIFY(d.window().statusBar()->currentMessage().contains(QStringLiteral("Stopped by fixed")));
  d.choose("undo");
  QCOMPARE(d.part("moving").worldFromPart.translation, glm::dvec3(0.0));
}

// It stayed where the part was, and took clicks that were meant for faces under it.
void DesktopAlignTest::theGizmoStandsAsideMeanwhile() {
  DesktopDriver d;
  begin(d);
  auto& gizmo = *d.widget<ui::GizmoOverlay>("gizmo");
  d.clickPart(1, ui::PartsModel::Name);
  QVERIFY(!gizmo.isVisible());
  click(d, {0.003, kMovingFront, 0.036});
  click(d, {-0.01, kFixedFront, 0.005});
  QVERIFY(!gizmo.isVisible());
  pressInView(d, Qt::Key_Return);
  QTRY_VERIFY(gizmo.isVisible());
  d.choose("align");
  QVERIFY(!gizmo.isVisible());
  pressInView(d, Qt::Key_Escape);
  QVERIFY(gizmo.isVisible());
}

void DesktopAlignTest::escapeLeavesEverythingAsItWas() {
  DesktopDriver d;
  begin(d);
  const RigidTransform before = d.part("moving").worldFromPart;
  const std::string undo = d.session().undoText();
  click(d, {0.003, kMovingFront, 0.036});
  click(d, {-0.01, kFixedFront, 0.005});
  pressInView(d, Qt::Key_Escape);
  QVERIFY(!d.action("align")->isChecked());
  QVERIFY(!d.widget<QWidget>("alignBar")->isVisible());
  QCOMPARE(d.part("moving").worldFromPart.translation, before.translation);
  QCOMPARE(d.session().undoText(), undo);
}

void DesktopAlignTest::aPartThatLeavesTheSceneEndsIt() {
  DesktopDriver d;
  begin(d);
  click(d, {0.003, kMovingFront, 0.036});
  // Back to before it was added.
  while (d.session().canUndo())
    d.choose("undo");
  QVERIFY(d.session().scene().parts().empty());
  QVERIFY(!d.action("align")->isChecked());
  QVERIFY(!d.widget<QWidget>("alignBar")->isVisible());
}

/// A part picked before another scene was opened used to be aligned in the new scene.
void DesktopAlignTest::anotherSceneEndsItThoughItsPartsAreTheSame() {
  DesktopDriver d;
  begin(d);
  click(d, {0.003, kMovingFront, 0.036});
  click(d, {-0.01, kFixedFront, 0.005});
  QVERIFY(d.action("align")->isChecked());
  const Scene same = d.session().scene();
  d.session().reset(same);
  QVERIFY(!d.action("align")->isChecked());
  QVERIFY(!d.widget<QWidget>("alignBar")->isVisible());
}

void DesktopAlignTest::lockedPartsRefuseToMove() {
  DesktopDriver d;
  begin(d);
  d.session().setLocked(d.partId("fixed"), true);
  hover(d, {-0.01, kFixedFront, 0.005});
  QTRY_VERIFY2(d.text("alignHint").contains(QStringLiteral("fixed is locked")),
               qPrintable(d.text("alignHint")));
  click(d, {-0.01, kFixedFront, 0.005});
  QVERIFY(d.text("alignPrompt").contains(QStringLiteral("part to move")));
  // It may stay and be aligned with.
  click(d, {0.003, kMovingFront, 0.036});
  click(d, {-0.01, kFixedFront, 0.005});
  QVERIFY(d.widget<QPushButton>("alignApply")->isEnabled());
}

void DesktopAlignTest::dragsStillOrbitWhileAligning() {
  DesktopDriver d;
  begin(d);
  const glm::dvec3 before = d.window().viewport().projection().away();
  ViewPointer pointer(d);
  pointer.drag(pointer.seen({0.003, kMovingFront, 0.036}), QPoint(80, 0));
  QVERIFY(glm::distance(d.window().viewport().projection().away(), before) > 0.05);
  QVERIFY(d.text("alignPrompt").contains(QStringLiteral("part to move")));
  QVERIFY(d.action("align")->isChecked());
}

// The parts were prepared for contact, and whatever was busy ended the tool.
void DesktopAlignTest::makingPartsSolidMeanwhileEndsNothing() {
  DesktopDriver d;
  begin(d);
  click(d, {0.003, kMovingFront, 0.036});
  click(d, {-0.01, kFixedFront, 0.005});
  const QString prompt = d.text("alignPrompt");
  int busy = 0;
  connect(&d.window().document(), &ui::Document::busyChanged, this, [&] { ++busy; });
  pressShortcut(d, Qt::Key_S, Qt::ShiftModifier);
  QVERIFY(d.action("solid")->isChecked());
  QTRY_VERIFY2(busy > 1 && !d.window().document().isBusy(), "it begins and ends");
  QVERIFY(d.action("align")->isChecked() && d.action("align")->isEnabled());
  QVERIFY(d.widget<QWidget>("alignBar")->isVisible());
  QCOMPARE(d.text("alignPrompt"), prompt);
  // Whole: what was picked counts, and contact stops it.
  d.window().viewport().setFocus();
  pressInView(d, Qt::Key_Return);
  QTRY_COMPARE(QString::fromStdString(d.session().undoText()), QStringLiteral("Align moving"));
}

void DesktopAlignTest::alignsACornerWithACorner() {
  DesktopDriver d;
  begin(d);
  click(d, {-0.01 + kInside, kMovingFront, kTop});
  click(d, {-0.02 + kInside, kFixedFront, 0.02 - kInside});
  pressInView(d, Qt::Key_Return);
  const glm::dvec3 corner = d.part("moving").worldFromPart.applyToPoint({-0.01, kMovingFront, 0.045});
  QVERIFY(glm::distance(corner, glm::dvec3(-0.02, kFixedFront, 0.02)) < 1e-15);
}

void DesktopAlignTest::alignsTheAxesOfTwoCylinders() {
  DesktopDriver d;
  d.add({writeOff(d.folder.path() / "bush.off", cylinderMesh(0.02, 0.04, 64)),
         writeOff(d.folder.path() / "pin.off", cylinderMesh(0.005, 0.05, 64))});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2});
  const RigidTransform aside{glm::angleAxis(0.3, glm::dvec3(0, 1, 0)), {0.06, 0.01, 0.02}};
  d.session().movePart(d.partId("pin"), aside);
  d.choose("viewFront");
  QTest::qWait(50);
  pressShortcut(d, Qt::Key_A);
  auto* filter = d.widget<QComboBox>("alignFilter");
  filter->setCurrentIndex(filter->findText(QStringLiteral("Axes and edges")));
  // In the middle of each, on the side of the viewer.
  const glm::dvec3 onPin = aside.applyToPoint({0.0, -0.005, 0.002});
  hover(d, onPin);
  QTRY_VERIFY2(d.text("alignHint").startsWith(QStringLiteral("Axis of a cylinder ⌀ 10.000")),
               qPrintable(d.text("alignHint")));
  click(d, onPin);
  click(d, {0.0, -0.02, 0.002});
  pressInView(d, Qt::Key_Return);
  QTRY_VERIFY(d.action("undo")->text().contains(QStringLiteral("Align pin")));
  const RigidTransform pose = d.part("pin").worldFromPart;
  for (const double along : {-0.02, 0.02}) {
    const glm::dvec3 point = pose.applyToPoint({0.0, 0.0, along});
    QVERIFY2(std::hypot(point.x, point.y) < 1e-9, qPrintable(QString::number(std::hypot(point.x, point.y))));
  }
}

void DesktopAlignTest::dropsToContactAsOneStepOfUndo() {
  DesktopDriver d;
  d.addCubes();
  d.clickPart(1, ui::PartsModel::Name);
  const RigidTransform before = d.part("moving").worldFromPart;
  d.choose("dropDown");
  // 5 mm above the other, less what is left.
  QTRY_VERIFY(d.part("moving").worldFromPart.translation.z < 0.0);
  const double travel = -d.part("moving").worldFromPart.translation.z;
  QVERIFY(travel < 0.005 && travel > 0.005 - 2e-6);
  QVERIFY(d.window().statusBar()->currentMessage().contains(QStringLiteral("touches fixed")));
  QVERIFY(d.action("undo")->text().contains(QStringLiteral("Drop moving")));
  d.choose("undo");
  QCOMPARE(d.part("moving").worldFromPart.translation, before.translation);
}

void DesktopAlignTest::dropsTowardsAFace() {
  DesktopDriver d;
  d.addCubes();
  // In front of the fixed cube, seen from above.
  d.session().movePart(d.partId("moving"), {{1, 0, 0, 0}, {0.0, -0.06, -0.035}});
  d.clickPart(1, ui::PartsModel::Name);
  d.choose("viewIso");
  QTest::qWait(50);
  d.choose("dropToFace");
  // A face of its own is refused.
  click(d, {0.0, -0.06, 0.01});
  QCOMPARE(d.part("moving").worldFromPart.translation.y, -0.06);
  // The upper face: straight down, and past the cube.
  click(d, {0.0, 0.0, 0.02});
  QTRY_VERIFY(d.window().statusBar()->currentMessage().contains(QStringLiteral("Nothing in that direction")));
  d.choose("dropBack");
  QTRY_VERIFY(d.part("moving").worldFromPart.translation.y > -0.0301);
  QVERIFY(d.part("moving").worldFromPart.translation.y < -0.03);
}

void DesktopAlignTest::pushesUntilHeld() {
  DesktopDriver d;
  d.addCubes();
  d.clickPart(1, ui::PartsModel::Name);
  d.choose("pushDown");
  QTRY_VERIFY(d.part("moving").worldFromPart.translation.z < -0.0045);
  QVERIFY(d.part("moving").worldFromPart.translation.z > -0.005);
  QVERIFY(d.action("undo")->text().contains(QStringLiteral("Push moving")));
}

void DesktopAlignTest::saysWhenNothingIsInTheWayOrPartsOverlap() {
  DesktopDriver d;
  d.addCubes();
  d.clickPart(1, ui::PartsModel::Name);
  const std::string undo = d.session().undoText();
  d.choose("dropUp");
  QTRY_VERIFY(
      d.window().statusBar()->currentMessage().contains(QStringLiteral("Nothing in that direction; moving")));
  QCOMPARE(d.session().undoText(), undo);
  d.session().movePart(d.partId("moving"), {{1, 0, 0, 0}, {0.0, 0.0, -0.01}});
  d.choose("dropDown");
  QTRY_VERIFY(d.window().statusBar()->currentMessage().contains(QStringLiteral("overlaps fixed")));
  QCOMPARE(d.part("moving").worldFromPart.translation.z, -0.01);
}

void DesktopAlignTest::lockedPartsDoNotDrop() {
  DesktopDriver d;
  d.addCubes();
  d.session().setMovingPart({});
  d.clickPart(1, ui::PartsModel::Name);
  QVERIFY(d.action("dropDown")->isEnabled());
  d.session().setLocked(d.partId("moving"), true);
  QVERIFY(!d.action("dropDown")->isEnabled());
  QVERIFY(!d.action("pushDown")->isEnabled());
}

void DesktopAlignTest::selectedPartsGoTogetherAsOneStep() {
  DesktopDriver d;
  d.addCubes();
  const PartId copy = d.session().duplicatePart(d.partId("moving"));
  d.session().movePart(copy, {{1, 0, 0, 0}, {0.0, 0.0, 0.03}});
  const auto height = [&](PartId id) { return d.session().scene().find(id)->worldFromPart.translation.z; };
  d.clickPart(1, ui::PartsModel::Name);
  QTest::mouseClick(
      d.partsView()->viewport(), Qt::LeftButton, Qt::ControlModifier,
      d.partsView()->visualRect(d.partsView()->model()->index(2, ui::PartsModel::Name)).center());
  d.choose("dropDown");
  QTRY_VERIFY(height(copy) < 0.03);
  // The lower one touches; the other one keeps its distance from it.
  QVERIFY(std::abs(height(d.partId("moving")) + 0.005) < 2e-6);
  QVERIFY(std::abs(height(copy) - height(d.partId("moving")) - 0.03) < 1e-15);
  d.choose("undo");
  QCOMPARE(height(d.partId("moving")), 0.0);
  QCOMPARE(height(copy), 0.03);
}

void DesktopAlignTest::aSeeThroughPartIsTheTargetWhereOnlyThePartThatMovesIsBehindIt() {
  DesktopDriver d;
  begin(d);
  d.session().movePart(d.partId("moving"), {{1, 0, 0, 0}, {0.0, 0.06, -0.035}});
  const glm::dvec3 onMoving{0.003, 0.05, 0.001};
  hover(d, onMoving);
  QTRY_COMPARE(d.text("alignHint"), QStringLiteral("Flat face of moving"));
  click(d, onMoving);
  QVERIFY(d.text("alignPrompt").contains(QStringLiteral("Click the target")));
  hover(d, onMoving);
  QTRY_COMPARE(d.text("alignHint"), QStringLiteral("Flat face of fixed"));
}

/// The bar gave the keys to the status bar, as the measuring bar did.
void DesktopAlignTest::endedByItsButtonsItGivesTheKeysToTheView() {
  DesktopDriver d;
  begin(d);
  const auto press = [&d](const char* name) {
    auto* button = d.widget<QPushButton>(name);
    button->setFocus();
    QVERIFY(button->hasFocus());
    QTest::mouseClick(button, Qt::LeftButton);
    QVERIFY(!d.widget<QWidget>("alignBar")->isVisible());
    QVERIFY(d.window().viewport().hasFocus());
  };
  press("alignCancel");
  pressShortcut(d, Qt::Key_A);
  click(d, {0.003, kMovingFront, 0.036});
  click(d, {-0.01, kFixedFront, 0.005});
  QTest::mouseClick(d.widget<QCheckBox>("alignKeep"), Qt::LeftButton, {}, QPoint(8, 8));
  QVERIFY(d.widget<QCheckBox>("alignKeep")->isChecked());
  press("alignApply");
  QCOMPARE(d.session().scene().joints().size(), std::size_t{1});
}

NEARFIT_QT_SUITE(DesktopAlignTest, runDesktopTest<DesktopAlignTest>)
#include "desktop_align_test.moc"

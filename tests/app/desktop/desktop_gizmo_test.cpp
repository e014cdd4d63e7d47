#include <QImage>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/math/rotation_vector.h"
#include "tests/app/desktop/view_driver.h"
#include "tests/exact/pose_certifier.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/widgets/number_field.h"

using namespace nearfit;
using test::DesktopDriver;

namespace {

/// What is made first of what a Bench consists of.
struct Cubes {
  DesktopDriver driver;
};

/// The two cubes, the moving one selected, and a mouse over the view.
struct Bench : Cubes, test::ViewDriver {
  Bench() : ViewDriver(Cubes::driver) {
    driver.addCubes();
    select("moving");
    look("viewFront");
    QTRY_VERIFY(overlay().picture() || driver.action("gizmoNone")->isChecked());
  }
  void select(const char* name) { driver.window().selection().select(driver.partId(name)); }
  RigidTransform pose(const char* name = "moving") { return driver.part(name).worldFromPart; }
  std::size_t steps() { return driver.session().historyIndex(); }
};

double angleBetween(const RigidTransform& a, const RigidTransform& b) {
  return glm::length(rotationVector(b.rotation * glm::conjugate(a.rotation)));
}

}  // namespace

class DesktopGizmoTest : public QObject {
  Q_OBJECT

 private slots:
  void init();
  void anArrowMovesAlongItsAxisInOneStepOfUndo();
  void aSquareMovesInItsPlane();
  void eachSquareMovesAcrossItsAxisWithThePointer();
  void aRingTurnsAboutTheCentreOfMass();
  void theSelectedPartIsGrabbedItself();
  void besideItAViewIsOrbited();
  void theMiddleButtonWithCtrlOrbitsOverThePart();
  void withoutAGizmoNothingIsDragged();
  void typedDigitsAreTheAmountOfADrag();
  void escapeRestoresExactly();
  void anotherButtonRestoresToo();
  void aClickOnAHandleIsNoStep();
  void theHandleUnderThePointerLightsUpWithoutAPicture();
  void stepsAreTakenWithTheSwitchAndControlTurnsItRound();
  void keysChooseTheGizmoAndItsAxes();
  void thePivotIsMovedAndPutBack();
  void thePivotOfSeveralIsTheirBoxesMiddleAndStaysTheirs();
  void theGizmoFollowsUndoAndNumbers();
  void lockedAndHiddenPartsHaveNoGizmo();
  void theNumbersFollowADrag();
  void aSceneThatChangesUnderADragEndsIt();
  void whatIsChosenIsRemembered();
  void theManualHandIsLedByTheGizmo();
  void aShiftedDragFromAHandleLeadsTheHandToo();
  void aPartThatAnotherHandHoldsHasNoGizmo();
  void solidPartsStayOutsideByExactPredicates();
  void aSolidDragThatStillSettlesIsUndoneWhole();
  void numbersStopAtContactTooWhereItIsSolid();
  void severalPartsAreMovedAsOneInOneStep();
  void aLockedPartAmongThemKeepsAllWhereTheyAre();
};

void DesktopGizmoTest::init() {
  QSettings().clear();
}

void DesktopGizmoTest::anArrowMovesAlongItsAxisInOneStepOfUndo() {
  Bench b;
  const RigidTransform before = b.pose();
  const std::size_t steps = b.steps();
  b.drag(b.handle(GizmoGrip::MoveX), {60, -25});
  const glm::dvec3 way = b.pose().translation - before.translation;
  const double pixel = b.view().projection().metresPerPixel(b.pose().translation + glm::dvec3(0, 0, 0.035));
  QVERIFY2(std::abs(way.x - 60.0 * pixel) < 1.5 * pixel, qPrintable(QString::number(way.x / pixel)));
  QCOMPARE(way.y, 0.0);
  QCOMPARE(way.z, 0.0);
  QCOMPARE(b.steps(), steps + 1);
  QCOMPARE(b.driver.session().undoText(), std::string("Move moving"));
  b.driver.choose("undo");
  QCOMPARE(b.pose().translation, before.translation);
}

void DesktopGizmoTest::aSquareMovesInItsPlane() {
  Bench b;
  b.look("viewIso");
  const RigidTransform before = b.pose();
  b.drag(b.handle(GizmoGrip::PlaneZ), {40, 30});
  const glm::dvec3 way = b.pose().translation - before.translation;
  QCOMPARE(way.z, 0.0);
  QVERIFY(std::abs(way.x) > 1e-4 && std::abs(way.y) > 1e-4);
}

void DesktopGizmoTest::eachSquareMovesAcrossItsAxisWithThePointer() {
  const std::pair<GizmoGrip, int> squares[] = {
      {GizmoGrip::PlaneX, 0}, {GizmoGrip::PlaneY, 1}, {GizmoGrip::PlaneZ, 2}};
  for (const auto& [square, axis] : squares) {
    Bench b;
    b.look("viewIso");
    const glm::dvec3 before = b.pose().translation;
    const QPoint from = b.handle(square), way(28, -17);
    b.drag(from, way);
    const glm::dvec3 gone = b.pose().translation - before;
    QCOMPARE(gone[axis], 0.0);
    QVERIFY(std::abs(gone[(axis + 1) % 3]) > 1e-4 && std::abs(gone[(axis + 2) % 3]) > 1e-4);
    // What was grabbed is under the pointer still; the handle is taken at a whole pixel beside its middle.
    const QPoint shown = b.handle(square) - from;
    QVERIFY2((shown - way).manhattanLength() <= 4,
             qPrintable(QStringLiteral("%1: %2, %3").arg(axis).arg(shown.x()).arg(shown.y())));
  }
}

void DesktopGizmoTest::aRingTurnsAboutTheCentreOfMass() {
  Bench b;
  b.driver.choose("gizmoTurn");
  b.look("viewIso");
  const RigidTransform before = b.pose();
  const glm::dvec3 centre = b.driver.part("moving").geometry->mass.centre;
  b.drag(b.handle(GizmoGrip::TurnZ), {40, -10});
  QVERIFY(angleBetween(before, b.pose()) > 0.1);
  const glm::dvec3 axis = rotationVector(b.pose().rotation * glm::conjugate(before.rotation));
  QVERIFY(std::abs(std::abs(glm::normalize(axis).z) - 1.0) < 1e-9);
  QVERIFY(glm::distance(before.applyToPoint(centre), b.pose().applyToPoint(centre)) < 1e-12);
  QCOMPARE(b.driver.session().undoText(), std::string("Turn moving"));
}

void DesktopGizmoTest::theSelectedPartIsGrabbedItself() {
  Bench b;
  const RigidTransform before = b.pose();
  // A place of its face that no handle covers; it goes with the pointer.
  const glm::dvec3 grabbed = before.applyToPoint({-0.008, -0.01, 0.027});
  const QPoint from = b.seen(grabbed);
  b.drag(from, {-70, 44});
  const glm::dvec3 way = b.pose().translation - before.translation;
  QVERIFY((b.seen(grabbed + way) - from - QPoint(-70, 44)).manhattanLength() <= 2);
  QVERIFY(std::abs(way.y) < 1e-12);
}

void DesktopGizmoTest::besideItAViewIsOrbited() {
  Bench b;
  const RigidTransform before = b.pose();
  const glm::dvec3 away = b.view().projection().away();
  b.drag({20, b.view().height() - 40}, {80, 20});
  QCOMPARE(b.pose().translation, before.translation);
  QVERIFY(glm::distance(away, b.view().projection().away()) > 0.05);
  // So it is on a part that is not selected.
  const glm::dvec3 then = b.view().projection().away();
  b.drag(b.seen({0.0, 0.0, -0.012}), {60, 0});
  QVERIFY(glm::distance(then, b.view().projection().away()) > 0.05);
  QCOMPARE(b.pose("fixed").translation, glm::dvec3(0.0));
}

void DesktopGizmoTest::theMiddleButtonWithCtrlOrbitsOverThePart() {
  Bench b;
  const RigidTransform before = b.pose();
  const glm::dvec3 away = b.view().projection().away();
  const QPoint onPart = b.seen(before.translation);
  b.drag(onPart, {80, 20}, Qt::ControlModifier, Qt::MiddleButton);
  QCOMPARE(b.pose().translation, before.translation);
  QVERIFY(glm::distance(away, b.view().projection().away()) > 0.05);
  // Without Ctrl the view goes along, and looks the same way.
  const glm::dvec3 then = b.view().projection().away();
  b.drag(onPart, {30, 10}, {}, Qt::MiddleButton);
  QVERIFY(glm::distance(then, b.view().projection().away()) < 1e-12);
}

void DesktopGizmoTest::withoutAGizmoNothingIsDragged() {
  Bench b;
  b.driver.choose("gizmoNone");
  QVERIFY(!b.overlay().isVisible());
  const RigidTransform before = b.pose();
  const glm::dvec3 away = b.view().projection().away();
  b.drag(b.seen(before.applyToPoint({0.0, 0.0, 0.035})), {80, 20});
  QCOMPARE(b.pose().translation, before.translation);
  QVERIFY(glm::distance(away, b.view().projection().away()) > 0.05);
}

/// They switched to a standard view.
void DesktopGizmoTest::typedDigitsAreTheAmountOfADrag() {
  Bench b;
  const glm::dvec3 sight = b.view().projection().away();
  const std::size_t steps = b.steps();
  const QPoint from = b.handle(GizmoGrip::MoveX);
  b.press(from);
  b.moveTo(from + QPoint(60, 0));
  for (const Qt::Key key : {Qt::Key_1, Qt::Key_2, Qt::Key_3, Qt::Key_Backspace, Qt::Key_Comma, Qt::Key_5})
    pressInView(b.driver, key);
  QVERIFY2(b.readout().startsWith(QStringLiteral("X 12,5")), qPrintable(b.readout()));
  QVERIFY2(b.readout().contains(QStringLiteral("mm")), qPrintable(b.readout()));
  QVERIFY(glm::distance(b.view().projection().away(), sight) < 1e-12);
  // The pointer no longer decides.
  b.moveTo(from + QPoint(90, 0));
  pressInView(b.driver, Qt::Key_Return);
  QVERIFY(!b.driver.widget<QWidget>("dragReadout")->isVisible());
  QCOMPARE(b.steps(), steps + 1);
  QVERIFY(glm::distance(b.pose().translation, glm::dvec3(0.0125, 0.0, 0.0)) < 1e-12);
  b.moveTo(from + QPoint(20, 0));
  b.release(from + QPoint(20, 0));
  QCOMPARE(b.steps(), steps + 1);
  // A minus changes the sign, and the button applies too.
  const QPoint arrow = b.handle(GizmoGrip::MoveZ);
  b.press(arrow);
  b.moveTo(arrow + QPoint(0, -30));
  for (const Qt::Key key : {Qt::Key_2, Qt::Key_Minus})
    pressInView(b.driver, key);
  b.release(arrow + QPoint(0, -30));
  QVERIFY(glm::distance(b.pose().translation, glm::dvec3(0.0125, 0.0, -0.002)) < 1e-12);
  // Escape gives the drag up.
  const QPoint again = b.handle(GizmoGrip::MoveX);
  b.press(again);
  b.moveTo(again + QPoint(30, 0));
  pressInView(b.driver, Qt::Key_7);
  pressInView(b.driver, Qt::Key_Escape);
  b.release(again);
  QCOMPARE(b.steps(), steps + 2);
  // Without a drag they are what they were.
  pressShortcut(b.driver, Qt::Key_3);
  QTRY_VERIFY(glm::distance(b.view().projection().away(), glm::dvec3(0.0, 0.0, -1.0)) < 1e-9);
}

void DesktopGizmoTest::escapeRestoresExactly() {
  Bench b;
  const RigidTransform before = b.pose();
  const std::size_t steps = b.steps();
  const QPoint from = b.handle(GizmoGrip::MoveZ);
  b.view().setFocus();
  b.press(from);
  b.moveTo(from + QPoint(3, -70));
  QTRY_VERIFY(b.driver.widget<QWidget>("dragReadout")->isVisible());
  const QImage away = b.driver.picture();
  pressInView(b.driver, Qt::Key_Escape);
  QVERIFY(!b.driver.widget<QWidget>("dragReadout")->isVisible());
  // Still pressed: neither the part nor the view moves any more.
  const glm::dvec3 sight = b.view().projection().away();
  b.moveTo(from + QPoint(50, -120));
  b.release(from + QPoint(50, -120));
  QCOMPARE(b.view().projection().away(), sight);
  QCOMPARE(b.pose().translation, before.translation);
  QCOMPARE(b.pose().rotation, before.rotation);
  QCOMPARE(b.steps(), steps);
  QVERIFY(b.driver.picture() != away);
}

void DesktopGizmoTest::anotherButtonRestoresToo() {
  Bench b;
  const RigidTransform before = b.pose();
  const QPoint from = b.handle(GizmoGrip::MoveX);
  b.press(from);
  b.moveTo(from + QPoint(40, 0));
  b.send(QEvent::MouseButtonPress, from + QPoint(40, 0), {}, Qt::RightButton);
  b.send(QEvent::MouseButtonRelease, from + QPoint(40, 0), {}, Qt::RightButton);
  b.release(from + QPoint(40, 0));
  QCOMPARE(b.pose().translation, before.translation);
}

void DesktopGizmoTest::aClickOnAHandleIsNoStep() {
  Bench b;
  const std::size_t steps = b.steps();
  const QPoint at = b.handle(GizmoGrip::MoveFree);
  b.press(at);
  b.release(at);
  QCOMPARE(b.steps(), steps);
  // It goes through to the part: which is selected still.
  QCOMPARE(b.driver.window().selection().current(), std::optional(b.driver.partId("moving")));
}

void DesktopGizmoTest::theHandleUnderThePointerLightsUpWithoutAPicture() {
  Bench b;
  QTRY_VERIFY(b.overlay().isVisible());
  const QPoint arrow = b.handle(GizmoGrip::MoveX);
  b.moveTo({5, 5});
  QTest::qWait(100);
  const int pictures = b.view().pictureCount();
  const QImage dark = b.overlay().grab().toImage();
  b.moveTo(arrow);
  QCOMPARE(b.overlay().picture()->hot, GizmoGrip::MoveX);
  QVERIFY(b.overlay().grab().toImage() != dark);
  QTest::qWait(100);
  QCOMPARE(b.view().pictureCount(), pictures);
  b.moveTo({5, 5});
  QCOMPARE(b.overlay().picture()->hot, GizmoGrip::None);
}

void DesktopGizmoTest::stepsAreTakenWithTheSwitchAndControlTurnsItRound() {
  Bench b;
  b.driver.type<ui::NumberField>("snapLength", "2.5");
  b.driver.choose("snap");
  const RigidTransform before = b.pose();
  const QPoint from = b.handle(GizmoGrip::MoveX);
  b.press(from);
  b.moveTo(from + QPoint(47, 0));
  const auto way = [&] {
    return b.view().poses().poseOf(b.driver.part("moving")).translation.x - before.translation.x;
  };
  const double snapped = way();
  QVERIFY(snapped > 0.002);
  QVERIFY(std::abs(std::remainder(snapped, 0.0025)) < 1e-12);
  // While Ctrl is held: exactly where the pointer is.
  b.moveTo(from + QPoint(48, 0), Qt::ControlModifier);
  QVERIFY(std::abs(std::remainder(way(), 0.0025)) > 1e-6);
  b.moveTo(from + QPoint(47, 0));
  QCOMPARE(way(), snapped);
  b.release(from + QPoint(47, 0));
  QVERIFY(std::abs(b.pose().translation.x - before.translation.x - snapped) < 1e-15);
  // The other way round.
  b.driver.choose("snap");
  b.drag(b.handle(GizmoGrip::MoveZ), {0, -53}, Qt::ControlModifier);
  QVERIFY(std::abs(std::remainder(b.pose().translation.z - before.translation.z, 0.0025)) < 1e-12);
}

void DesktopGizmoTest::keysChooseTheGizmoAndItsAxes() {
  Bench b;
  b.view().setFocus();
  const auto has = [&](GizmoGrip handle) {
    return b.overlay().picture() && b.overlay().picture()->layout.has(handle);
  };
  pressInView(b.driver, Qt::Key_E);
  QVERIFY(has(GizmoGrip::TurnZ) && !has(GizmoGrip::MoveX));
  pressInView(b.driver, Qt::Key_R);
  QVERIFY(has(GizmoGrip::TurnZ) && has(GizmoGrip::MoveX));
  pressInView(b.driver, Qt::Key_W);
  QVERIFY(!has(GizmoGrip::TurnZ) && has(GizmoGrip::MoveX));
  pressInView(b.driver, Qt::Key_Q);
  QVERIFY(!b.overlay().isVisible());
  pressInView(b.driver, Qt::Key_W);

  // Turned by 30 degrees, its own axes are not the world's.
  const glm::dquat turned = glm::angleAxis(0.5235987755982988, glm::dvec3(0, 1, 0));
  b.driver.session().movePart(b.driver.partId("moving"), {turned, b.pose().translation});
  const RigidTransform before = b.pose();
  pressInView(b.driver, Qt::Key_X);
  QVERIFY(b.driver.action("localAxes")->isChecked());
  b.drag(b.handle(GizmoGrip::MoveX), {60, 30});
  const glm::dvec3 way = glm::normalize(b.pose().translation - before.translation);
  QVERIFY(glm::distance(way, turned * glm::dvec3(1, 0, 0)) < 1e-9);
}

void DesktopGizmoTest::thePivotIsMovedAndPutBack() {
  Bench b;
  const RigidTransform before = b.pose();
  const glm::dvec3 centre = b.driver.part("moving").geometry->mass.centre;
  const std::size_t steps = b.steps();
  b.driver.choose("movePivot");
  const QPoint at = b.handle(GizmoGrip::MoveFree);
  b.drag(b.handle(GizmoGrip::MoveX), {50, 0});
  QCOMPARE(b.pose().translation, before.translation);
  // It is a step like any other, and the gizmo goes with it.
  QCOMPARE(b.steps(), steps + 1);
  QCOMPARE(b.driver.session().undoText(), std::string("Move the pivot of moving"));
  QVERIFY((b.handle(GizmoGrip::MoveFree) - at - QPoint(50, 0)).manhattanLength() <= 2);
  b.driver.choose("undo");
  QCOMPARE(b.handle(GizmoGrip::MoveFree), at);
  b.driver.choose("redo");
  QVERIFY((b.handle(GizmoGrip::MoveFree) - at - QPoint(50, 0)).manhattanLength() <= 2);
  // Escape takes a drag of it back, and that is no step.
  b.press(b.handle(GizmoGrip::MoveX));
  b.moveTo(b.handle(GizmoGrip::MoveX) + QPoint(30, 0));
  pressInView(b.driver, Qt::Key_Escape);
  b.release(at);
  QCOMPARE(b.steps(), steps + 1);
  QVERIFY((b.handle(GizmoGrip::MoveFree) - at - QPoint(50, 0)).manhattanLength() <= 2);
  b.driver.choose("movePivot");
  b.driver.choose("gizmoTurn");
  // Seen from the front, the ring about y is round: half a turn puts the part to the other side of the pivot.
  b.drag(b.handle(GizmoGrip::TurnY), {-20, 35});
  QVERIFY(angleBetween(before, b.pose()) > 0.1);
  QVERIFY(glm::distance(before.applyToPoint(centre), b.pose().applyToPoint(centre)) > 1e-3);
  // It has gone with the part, and can be put back.
  b.driver.choose("pivotAtMass");
  const RigidTransform then = b.pose();
  b.drag(b.handle(GizmoGrip::TurnY), {-20, 35});
  QVERIFY(angleBetween(then, b.pose()) > 0.1);
  QVERIFY(glm::distance(then.applyToPoint(centre), b.pose().applyToPoint(centre)) < 1e-12);
}

void DesktopGizmoTest::thePivotOfSeveralIsTheirBoxesMiddleAndStaysTheirs() {
  Bench b;
  const PartId fixed = b.driver.partId("fixed"), moving = b.driver.partId("moving");
  b.driver.choose("selectAll");
  b.driver.choose("pivotAtBox");
  QCOMPARE(b.driver.session().undoText(), std::string("Move the pivot of 2 parts"));
  // The cubes are from -20 to 20 and from 25 to 45 mm high: their middle is 12.5 mm up; the masses' is lower.
  const auto isAtHeight = [&](double z) {
    return (b.handle(GizmoGrip::MoveFree) - b.seen({0.0, 0.0, z})).manhattanLength() <= 1;
  };
  QVERIFY(isAtHeight(0.0125));
  b.select("moving");
  QVERIFY(isAtHeight(0.0125));
  b.driver.choose("pivotAtMass");
  QVERIFY(isAtHeight(0.035));
  // Now one of them has another.
  b.driver.window().selection().set({fixed, moving});
  QVERIFY(isAtHeight(0.035 / 9.0));
}

void DesktopGizmoTest::theGizmoFollowsUndoAndNumbers() {
  Bench b;
  const QPoint at = b.handle(GizmoGrip::MoveFree);
  b.drag(b.handle(GizmoGrip::MoveX), {60, 0});
  QVERIFY((b.handle(GizmoGrip::MoveFree) - at - QPoint(60, 0)).manhattanLength() <= 2);
  b.driver.choose("undo");
  QCOMPARE(b.handle(GizmoGrip::MoveFree), at);
  b.driver.session().movePart(b.driver.partId("moving"), {b.pose().rotation, {0.01, 0.0, 0.0}});
  QVERIFY(b.handle(GizmoGrip::MoveFree).x() > at.x() + 5);
}

void DesktopGizmoTest::lockedAndHiddenPartsHaveNoGizmo() {
  Bench b;
  const PartId fixed = b.driver.partId("fixed");
  b.select("fixed");
  QVERIFY(b.overlay().picture().has_value());
  b.driver.session().setLocked(fixed, true);
  QVERIFY(!b.overlay().isVisible());
  b.drag(b.seen({0.0, -0.02, 0.01}), {60, 0});
  QCOMPARE(b.pose("fixed").translation, glm::dvec3(0.0));
  b.driver.session().setLocked(fixed, false);
  QVERIFY(b.overlay().isVisible());
  b.driver.session().setVisible(fixed, false);
  QVERIFY(!b.overlay().isVisible());
}

void DesktopGizmoTest::theNumbersFollowADrag() {
  Bench b;
  auto* x = b.driver.widget<ui::NumberField>("positionX");
  const QPoint from = b.handle(GizmoGrip::MoveX);
  b.press(from);
  b.moveTo(from + QPoint(60, 0));
  QVERIFY(x->value() > 1.0);
  QVERIFY2(b.readout().startsWith(QString::fromUtf8("X\u00a0+")) && b.readout().endsWith("mm"),
           qPrintable(b.readout()));
  pressInView(b.driver, Qt::Key_Escape);
  QCOMPARE(x->value(), 0.0);
  b.release(from);
}

void DesktopGizmoTest::aSceneThatChangesUnderADragEndsIt() {
  Bench b;
  const QPoint from = b.handle(GizmoGrip::MoveX);
  b.press(from);
  b.moveTo(from + QPoint(60, 0));
  b.driver.session().deletePart(b.driver.partId("moving"));
  b.moveTo(from + QPoint(80, 0));
  b.release(from + QPoint(80, 0));
  QVERIFY(!b.overlay().isVisible());
  QCOMPARE(b.driver.session().scene().parts().size(), std::size_t{1});
}

void DesktopGizmoTest::whatIsChosenIsRemembered() {
  {
    Bench b;
    b.driver.choose("gizmoTurn");
    b.driver.choose("snap");
    b.driver.choose("solid");
    b.driver.type<ui::NumberField>("snapAngle", "7.5");
    b.driver.type<ui::NumberField>("snapLength", "1/8 in");
  }
  Bench b;
  QVERIFY(b.driver.action("gizmoTurn")->isChecked());
  QVERIFY(b.driver.action("snap")->isChecked());
  QVERIFY(b.driver.action("solid")->isChecked());
  QCOMPARE(b.driver.widget<ui::NumberField>("snapAngle")->value(), 7.5);
  QCOMPARE(b.driver.widget<ui::NumberField>("snapLength")->value(), 3.175);
}

void DesktopGizmoTest::theManualHandIsLedByTheGizmo() {
  Bench b;
  const RigidTransform before = b.pose();
  const std::size_t steps = b.steps();
  b.driver.startWith(ui::Hand::Manual);
  QTRY_VERIFY(b.driver.action("stop")->isEnabled());
  QTRY_VERIFY(b.overlay().picture().has_value());
  // Down into the fixed cube: it stops a margin above, however far the pointer goes.
  const QPoint from = b.handle(GizmoGrip::MoveZ);
  b.drag(from, {0, 200});
  auto* z = b.driver.widget<ui::NumberField>("positionZ");
  QTRY_VERIFY2(std::abs(z->value() + 4.9) < 0.02, qPrintable(QString::number(z->value())));
  QCOMPARE(b.steps(), steps);
  b.driver.choose("stop");
  QTRY_VERIFY(b.pose().translation.z < before.translation.z - 4e-3);
  QCOMPARE(b.steps(), steps + 1);
  QTRY_VERIFY(b.overlay().isVisible());
}

/// The handle lit up by the pointer took the moves, and the hand stayed.
void DesktopGizmoTest::aShiftedDragFromAHandleLeadsTheHandToo() {
  Bench b;
  b.driver.startWith(ui::Hand::Manual);
  // The hand can be dragged from the first tick that is shown.
  QTRY_COMPARE(b.driver.text("statusMinima"), QStringLiteral("Minima 1"));
  QTRY_VERIFY(b.overlay().picture().has_value());
  const QPoint from = b.handle(GizmoGrip::MoveZ);
  b.moveTo(from);
  QCOMPARE(b.overlay().picture()->hot, GizmoGrip::MoveZ);
  // To the right: the arrow under the pointer would go up or down only.
  b.drag(from, {60, 0}, Qt::ShiftModifier);
  auto* x = b.driver.widget<ui::NumberField>("positionX");
  QTRY_VERIFY2(x->value() > 1.0, qPrintable(QString::number(x->value())));
  b.driver.choose("stop");
}

void DesktopGizmoTest::aPartThatAnotherHandHoldsHasNoGizmo() {
  Bench b;
  b.driver.startWith(ui::Hand::Scripted);
  QTRY_VERIFY(b.driver.action("stop")->isEnabled());
  QTRY_VERIFY(!b.overlay().isVisible());
  b.select("fixed");
  QVERIFY(b.overlay().isVisible());
  b.driver.choose("stop");
}

void DesktopGizmoTest::solidPartsStayOutsideByExactPredicates() {
  Bench b;
  b.driver.choose("solid");
  const std::size_t steps = b.steps();
  const RigidTransform before = b.pose();
  const test::PoseCertifier certifier(b.driver.part("fixed").geometry->mesh,
                                      b.driver.part("moving").geometry->mesh);
  const RigidTransform worldFromFixed = b.pose("fixed");
  const PartId moving = b.driver.partId("moving");
  int dragged = 0;
  const ui::ShownPoses& poses = b.view().poses();
  QObject::connect(&poses, &ui::ShownPoses::changed, &b.view(), [&] {
    if (!poses.isDragged(moving)) return;
    ++dragged;
    QVERIFY(!certifier.doMeet(worldFromFixed.inverse() * poses.poseOf(b.driver.part("moving"))));
  });
  // Down into the fixed cube, and across it.
  const QPoint from = b.seen(before.applyToPoint({-0.008, -0.01, 0.027}));
  b.press(from);
  for (int i = 1; i <= 30; ++i)
    b.moveTo(from + QPoint(i, 5 * i));
  QTRY_VERIFY2(b.readout().contains("fixed"), qPrintable(b.readout()));
  b.release(from + QPoint(30, 150));
  QTRY_COMPARE(b.steps(), steps + 1);
  QVERIFY(dragged > 1);
  QVERIFY(!certifier.doMeet(worldFromFixed.inverse() * b.pose()));
  const double margin = b.driver.session().scene().haptics().proxy.margin;
  const double gap = b.pose().translation.z - before.translation.z + 0.005;
  QVERIFY2(std::abs(gap - margin) < 0.1 * margin, qPrintable(QString::number(gap / margin)));
  QVERIFY(b.pose().translation.x - before.translation.x > 1e-3);
  b.driver.choose("undo");
  QCOMPARE(b.pose().translation, before.translation);
  QCOMPARE(b.pose().rotation, before.rotation);
}

void DesktopGizmoTest::aSolidDragThatStillSettlesIsUndoneWhole() {
  Bench b;
  b.driver.choose("solid");
  const RigidTransform before = b.pose();
  b.drag(b.handle(GizmoGrip::MoveZ), {0, 150});
  b.driver.choose("undo");
  QTest::qWait(50);
  QCOMPARE(b.pose().translation, before.translation);
  QVERIFY(!b.view().poses().isDragged(b.driver.partId("moving")));
}

void DesktopGizmoTest::numbersStopAtContactTooWhereItIsSolid() {
  Bench b;
  b.driver.choose("solid");
  const std::size_t steps = b.steps();
  b.driver.type<ui::NumberField>("positionZ", "-20");
  QTRY_COMPARE(b.steps(), steps + 1);
  const double margin = b.driver.session().scene().haptics().proxy.margin;
  QVERIFY(std::abs(b.pose().translation.z + 0.005 - margin) < 0.1 * margin);
  // Where nothing is in the way it is there to the last bit.
  b.driver.type<ui::NumberField>("positionZ", "30");
  QTRY_VERIFY(qFuzzyCompare(b.pose().translation.z, 0.03));
  QCOMPARE(b.steps(), steps + 2);
}

void DesktopGizmoTest::severalPartsAreMovedAsOneInOneStep() {
  for (const bool isSolid : {false, true}) {
    Bench b;
    if (b.driver.action("solid")->isChecked() != isSolid) b.driver.choose("solid");
    b.driver.window().selection().set({b.driver.partId("fixed"), b.driver.partId("moving")});
    const std::size_t steps = b.steps();
    b.drag(b.handle(GizmoGrip::MoveX), {70, 0});
    QTRY_COMPARE(b.steps(), steps + 1);
    QVERIFY(b.pose().translation.x > 1e-3);
    QVERIFY(glm::distance(b.pose("fixed").translation, b.pose().translation) < 1e-12);
    // Turned about what both weigh together, they keep their places to each other.
    b.driver.choose("gizmoTurn");
    const RigidTransform before = b.pose("fixed").inverse() * b.pose();
    b.drag(b.handle(GizmoGrip::TurnY), {-20, 35});
    QTRY_COMPARE(b.steps(), steps + 2);
    const RigidTransform after = b.pose("fixed").inverse() * b.pose();
    QVERIFY(angleBetween(b.pose("fixed"), {}) > 0.05);
    QVERIFY(glm::distance(before.translation, after.translation) < 1e-12);
    b.driver.choose("undo");
    b.driver.choose("undo");
    QCOMPARE(b.pose("fixed").translation, glm::dvec3(0.0));
    QCOMPARE(b.pose().translation, glm::dvec3(0.0));
    b.driver.choose("gizmoMove");
  }
}

void DesktopGizmoTest::aLockedPartAmongThemKeepsAllWhereTheyAre() {
  Bench b;
  b.driver.session().setLocked(b.driver.partId("fixed"), true);
  b.driver.window().selection().set({b.driver.partId("fixed"), b.driver.partId("moving")});
  QVERIFY(!b.overlay().isVisible());
  b.drag(b.seen({-0.008, -0.01, 0.027}), {60, 0});
  QCOMPARE(b.pose().translation, glm::dvec3(0.0));
}

NEARFIT_QT_SUITE(DesktopGizmoTest, test::runDesktopTest<DesktopGizmoTest>)
#include "desktop_gizmo_test.moc"

// Drags in steps: turns by rings, of parts and of the section's plane, and shifts along more than one axis.
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/math/rotation_vector.h"
#include "tests/app/desktop/section_driver.h"
#include "ui/widgets/number_field.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// The two cubes, the moving one selected.
struct SnappingBench {
  explicit SnappingBench(const char* look = "viewIso") : mouse(d) {
    d.addCubes();
    d.window().selection().select(d.partId("moving"));
    mouse.look(look);
    QTRY_VERIFY(mouse.overlay().picture().has_value());
  }
  RigidTransform pose() { return d.part("moving").worldFromPart; }
  /// Along the ring from where it is grabbed, for a seventh of what is seen of it.
  std::vector<QPoint> wayAlong(GizmoGrip ring) {
    for (const GizmoFigure& figure : mouse.overlay().picture().value().layout.figures()) {
      const std::size_t first = figure.points.size() / 3, count = figure.points.size() / 7;
      if (figure.handle != ring || mouse.handle(ring) != pixel(figure.points[first])) continue;
      std::vector<QPoint> way;
      for (std::size_t i = first; i <= first + count; ++i)
        way.push_back(pixel(figure.points[i]));
      return way;
    }
    throw Error("ring", "it is not to be seen");
  }
  /// About which axis, and how far, a drag along the ring turns the part; it is undone then.
  glm::dvec3 turnBy(GizmoGrip ring, Qt::KeyboardModifiers keys = {}) {
    const std::vector<QPoint> way = wayAlong(ring);
    mouse.press(way.front(), keys);
    for (const QPoint& at : way)
      mouse.moveTo(at, keys);
    mouse.release(way.back(), keys);
    const glm::dvec3 turn = rotationVector(pose().rotation);
    if (glm::length(turn) > 0.0) d.choose("undo");
    return turn;
  }
  static QPoint pixel(const glm::dvec2& p) {
    return {static_cast<int>(std::lround(p.x)), static_cast<int>(std::lround(p.y))};
  }

  DesktopDriver d;
  ViewPointer mouse;
};

/// How far a number is from a multiple of the step.
double offStep(double value, double step) {
  return std::abs(std::remainder(value, step));
}

}  // namespace

class DesktopSnappingTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void ringsTurnInStepsOfTheAngle_data();
  void ringsTurnInStepsOfTheAngle();
  void aSquareGoesInStepsAlongBothOfItsAxes();
  void stepsAreAlongTheAxesOfAPartThatIsTurned();
  void withCtrlTheSectionIsTiltedInFifteens();
};

void DesktopSnappingTest::ringsTurnInStepsOfTheAngle_data() {
  QTest::addColumn<int>("ring");
  QTest::addColumn<int>("axis");
  QTest::addColumn<double>("angle");
  QTest::newRow("x, the usual angle") << int(GizmoGrip::TurnX) << 0 << 15.0;
  QTest::newRow("y, the usual angle") << int(GizmoGrip::TurnY) << 1 << 15.0;
  QTest::newRow("z, the usual angle") << int(GizmoGrip::TurnZ) << 2 << 15.0;
  QTest::newRow("z, one that is typed") << int(GizmoGrip::TurnZ) << 2 << 7.0;
}

void DesktopSnappingTest::ringsTurnInStepsOfTheAngle() {
  QFETCH(int, ring);
  QFETCH(int, axis);
  QFETCH(double, angle);
  const auto handle = static_cast<GizmoGrip>(ring);
  const double step = angle * kDegree;
  SnappingBench b;
  b.d.choose("gizmoTurn");
  if (angle != 15.0) b.d.type<ui::NumberField>("snapAngle", qPrintable(QString::number(angle)));
  const glm::dvec3 free = b.turnBy(handle);
  QVERIFY2(offStep(free[axis], step) > 0.2 * kDegree, qPrintable(QString::number(free[axis] / kDegree)));
  QVERIFY(std::abs(free[axis]) > 0.6 * step);
  const auto isSnapped = [&](const glm::dvec3& turn) {
    // The step that is nearest to where the pointer is.
    return offStep(turn[axis], step) < 1e-9 && std::abs(turn[axis] - free[axis]) < 0.5 * step + 1e-9 &&
           std::abs(glm::length(turn) - std::abs(turn[axis])) < 1e-9;
  };
  const glm::dvec3 held = b.turnBy(handle, Qt::ControlModifier);
  QVERIFY2(isSnapped(held), qPrintable(QString::number(held[axis] / kDegree)));
  b.d.choose("snap");
  const glm::dvec3 switched = b.turnBy(handle);
  QVERIFY2(isSnapped(switched), qPrintable(QString::number(switched[axis] / kDegree)));
  // With the switch, Ctrl is free.
  QVERIFY(glm::distance(b.turnBy(handle, Qt::ControlModifier), free) < 1e-9);
}

void DesktopSnappingTest::aSquareGoesInStepsAlongBothOfItsAxes() {
  SnappingBench b;
  b.d.type<ui::NumberField>("snapLength", "2.5");
  const glm::dvec3 before = b.pose().translation;
  const QPoint square = b.mouse.handle(GizmoGrip::PlaneZ);
  b.mouse.drag(square, {70, 5});
  const glm::dvec3 free = b.pose().translation - before;
  b.d.choose("undo");
  b.mouse.drag(b.mouse.handle(GizmoGrip::PlaneZ), {70, 5}, Qt::ControlModifier);
  const glm::dvec3 way = b.pose().translation - before;
  for (const int axis : {0, 1}) {
    QVERIFY(offStep(free[axis], 0.0025) > 1e-6);
    QVERIFY(offStep(way[axis], 0.0025) < 1e-12 && std::abs(way[axis]) > 0.002);
    QVERIFY(std::abs(way[axis] - free[axis]) <= 0.00125 + 1e-12);
  }
  QCOMPARE(way.z, 0.0);
}

void DesktopSnappingTest::stepsAreAlongTheAxesOfAPartThatIsTurned() {
  SnappingBench b("viewFront");
  const glm::dquat turned = glm::angleAxis(30.0 * kDegree, glm::dvec3(0, 1, 0));
  b.d.session().movePart(b.d.partId("moving"), {turned, {0.0, 0.0, 0.0}});
  b.d.type<ui::NumberField>("snapLength", "2.5");
  b.d.choose("snap");
  b.d.choose("localAxes");
  b.mouse.drag(b.mouse.handle(GizmoGrip::MoveX), {71, 33});
  const glm::dvec3 way = b.pose().translation;
  QVERIFY(glm::length(way) > 0.002 && offStep(glm::length(way), 0.0025) < 1e-12);
  QVERIFY(glm::distance(glm::normalize(way), turned * glm::dvec3(1, 0, 0)) < 1e-9);
}

namespace {

/// How far the section's plane is tilted about X, by three points of it that are seen [rad].
double tiltOf(SectionDriver& cut) {
  std::vector<glm::dvec3> seen;
  for (const glm::dvec3& place : {glm::dvec3(0.008, 0, 0.005), {-0.008, 0, 0.005}, {0.0, 0, -0.005}}) {
    const auto picked = cut.picked(place);
    if (!picked || picked->cut == nullptr) throw Error("section", "it cuts nothing there");
    seen.push_back(picked->point);
  }
  const glm::dvec3 normal = glm::normalize(glm::cross(seen[1] - seen[0], seen[2] - seen[0]));
  if (std::abs(normal.x) > 1e-4) throw Error("section", "it is tilted about another axis");
  return std::atan(normal.z / normal.y);
}

}  // namespace

void DesktopSnappingTest::withCtrlTheSectionIsTiltedInFifteens() {
  constexpr double kStep = 15.0 * kDegree;
  const auto tilt = [](QPoint way, Qt::KeyboardModifiers keys, double& angle) {
    SectionDriver cut("viewIso");
    cut.begin("sectionY");
    QTRY_VERIFY(cut.handle().picture());
    QVERIFY(std::abs(tiltOf(cut)) < 1e-4);
    cut.pointer.drag(cut.handleAt(GizmoGrip::TurnX), way, keys);
    angle = tiltOf(cut);
  };
  // How far a drag turns depends on the size of the view: take the first that ends well beside a step.
  double free = 0.0, snapped = 0.0;
  QPoint way;
  for (const QPoint& candidate : {QPoint(24, 36), QPoint(22, 33)}) {
    way = candidate;
    tilt(way, {}, free);
    if (offStep(free, kStep) > 2.0 * kDegree) break;
  }
  QVERIFY2(offStep(free, kStep) > 2.0 * kDegree, qPrintable(QString::number(free / kDegree)));
  QVERIFY(std::abs(free) > 8.0 * kDegree);
  tilt(way, Qt::ControlModifier, snapped);
  QVERIFY2(offStep(snapped, kStep) < 1e-3, qPrintable(QString::number(snapped / kDegree)));
  QVERIFY(std::abs(snapped - free) < 0.5 * kStep + 1e-3);
  QVERIFY(std::abs(snapped) > 10.0 * kDegree);
}

NEARFIT_QT_SUITE(DesktopSnappingTest, runDesktopTest<DesktopSnappingTest>)
#include "desktop_snapping_test.moc"

#include "ui/view3d/hand_drag.h"

#include <QApplication>
#include <QWheelEvent>
#include <QWidget>
#include <QtTest>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <vtkCamera.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>

#include "tests/support/qt/qt_suite.h"

using nearfit::ui::HandDrag;

namespace {

/// A view and what is dragged over it, with VTK's own projection as the judge of where a point is seen.
struct DragBench {
  DragBench() : drag(view, *camera.Get()) {
    view.resize(800, 600);
    camera->SetPosition(0.3, -0.5, 0.2);
    camera->SetFocalPoint(0.01, 0.02, 0.03);
    camera->SetViewUp(0.0, 0.0, 1.0);
    camera->SetClippingRange(0.01, 10.0);
    camera->SetViewAngle(24.0);
    drag.setPoint(point);
    QObject::connect(&drag, &HandDrag::dragged, [this](const glm::dvec3& shift, const glm::dquat& turn) {
      point += shift;
      turned = turn * turned;
      ++count;
    });
  }
  QPointF seen(const glm::dvec3& at) {
    double p[4] = {at.x, at.y, at.z, 1.0};
    camera->GetCompositeProjectionTransformMatrix(800.0 / 600.0, -1.0, 1.0)->MultiplyPoint(p, p);
    return {400.0 * (1.0 + p[0] / p[3]), 300.0 * (1.0 - p[1] / p[3])};
  }
  void dragBy(QPoint way, Qt::MouseButton button, Qt::KeyboardModifiers keys = Qt::ShiftModifier) {
    const QPoint from(200, 300);
    send(QEvent::MouseButtonPress, from, button, keys);
    send(QEvent::MouseMove, from + way / 2, button, keys);
    send(QEvent::MouseMove, from + way, button, keys);
    send(QEvent::MouseButtonRelease, from + way, button, keys);
  }
  void send(QEvent::Type type, QPoint at, Qt::MouseButton button, Qt::KeyboardModifiers keys) {
    QMouseEvent event(type, at, button, button, keys);
    QApplication::sendEvent(&view, &event);
  }

  QWidget view;
  vtkNew<vtkCamera> camera;
  HandDrag drag;
  glm::dvec3 point{0.02, 0.01, 0.05};
  glm::dquat turned{1.0, 0.0, 0.0, 0.0};
  int count = 0;
};

}  // namespace

class HandDragTest : public QObject {
  Q_OBJECT

 private slots:
  void thePointFollowsThePointer();
  void inParallelProjectionToo();
  void aRightDragTurnsTheNearSideWithThePointer();
  void theWheelMovesItAwayWhereItIsSeen();
  void withoutShiftOrWithoutAHandTheMouseIsTheViews();
};

void HandDragTest::thePointFollowsThePointer() {
  DragBench b;
  const QPointF before = b.seen(b.point);
  b.dragBy({100, -60}, Qt::LeftButton);
  const QPointF way = b.seen(b.point) - before;
  QVERIFY(std::abs(way.x() - 100.0) < 1e-6);
  QVERIFY(std::abs(way.y() + 60.0) < 1e-6);
  QCOMPARE(b.turned.w, 1.0);
}

void HandDragTest::inParallelProjectionToo() {
  DragBench b;
  b.camera->ParallelProjectionOn();
  b.camera->SetParallelScale(0.1);
  const QPointF before = b.seen(b.point);
  b.dragBy({-30, 90}, Qt::LeftButton);
  const QPointF way = b.seen(b.point) - before;
  QVERIFY(std::abs(way.x() + 30.0) < 1e-6);
  QVERIFY(std::abs(way.y() - 90.0) < 1e-6);
}

void HandDragTest::aRightDragTurnsTheNearSideWithThePointer() {
  for (const QPoint way : {QPoint(20, 0), QPoint(0, 20)}) {
    DragBench b;
    const glm::dvec3 towardsEye = glm::normalize(glm::dvec3(0.3, -0.5, 0.2) - b.point);
    const glm::dvec3 near = 1e-3 * towardsEye;
    const QPointF before = b.seen(b.point + near);
    b.dragBy(way, Qt::RightButton);
    const QPointF moved = b.seen(b.point + b.turned * near) - before;
    QVERIFY(way.x() > 0 ? moved.x() > 1e-3 : moved.y() > 1e-3);
    // 20 of 600 pixels: a thirtieth of half a turn.
    QVERIFY(std::abs(2.0 * std::acos(b.turned.w) - 3.14159265358979323846 / 30.0) < 1e-9);
    QCOMPARE(b.point, (glm::dvec3{0.02, 0.01, 0.05}));
  }
}

void HandDragTest::theWheelMovesItAwayWhereItIsSeen() {
  DragBench b;
  const glm::dvec3 eye(0.3, -0.5, 0.2);
  const double before = glm::length(b.point - eye);
  QWheelEvent event(QPointF(5, 5), QPointF(5, 5), {}, QPoint(0, 120), Qt::NoButton, Qt::ShiftModifier,
                    Qt::NoScrollPhase, false);
  QApplication::sendEvent(&b.view, &event);
  QVERIFY(glm::length(b.point - eye) > before + 1e-3);
}

void HandDragTest::withoutShiftOrWithoutAHandTheMouseIsTheViews() {
  DragBench b;
  b.dragBy({50, 50}, Qt::LeftButton, Qt::NoModifier);
  b.dragBy({50, 50}, Qt::MiddleButton);
  QCOMPARE(b.count, 0);
  b.drag.setPoint({});
  b.dragBy({50, 50}, Qt::LeftButton);
  QCOMPARE(b.count, 0);
}

NEARFIT_QT_SUITE(HandDragTest, nearfit::test::runQtTest<HandDragTest>)
#include "hand_drag_test.moc"

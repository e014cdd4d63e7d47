#include "core/placing/gizmo_drag.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/placing/gizmo_layout.h"
#include "tests/core/placing/projection_oracle.h"

namespace nearfit::gizmo_drag_test {
namespace {

using test::TestView;

constexpr double kPi = std::numbers::pi;

/// Turned against the world, and beside its origin.
GizmoFrame turnedFrame() {
  return {{0.03, -0.02, 0.05},
          glm::mat3_cast(glm::angleAxis(0.7, glm::normalize(glm::dvec3(1.0, 2.0, -0.5))))};
}

double distance(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::distance(a, b);
}

TEST(GizmoDrag, AnArrowFollowsThePointerAlongItsAxis) {
  for (const bool isParallel : {false, true}) {
    const TestView view = test::aslant(isParallel);
    const GizmoFrame frame = turnedFrame();
    for (const GizmoGrip arrow : kArrows) {
      const glm::dvec3 axis = frame.axes[axisOf(arrow)];
      GizmoDrag drag(view.projection(), frame, arrow, view.pixelOf(frame.pivot + 0.04 * axis));
      for (const double way : {0.01, 0.2, -0.15, 0.003}) {
        drag.moveTo(view.projection(), view.pixelOf(frame.pivot + (0.04 + way) * axis));
        EXPECT_LT(distance(drag.shift(), way * axis), 1e-10) << isParallel << axisOf(arrow);
        EXPECT_EQ(drag.angle(), 0.0);
      }
    }
  }
}

TEST(GizmoDrag, AnAmountReplacesThePointersWayAndDoesNotSnap) {
  const TestView view = test::aslant();
  const GizmoFrame frame = turnedFrame();
  const SnapSteps steps{0.01, 0.25};
  GizmoDrag arrow(view.projection(), frame, GizmoGrip::MoveY, view.pixelOf(frame.pivot));
  arrow.moveTo(view.projection(), view.pixelOf(frame.pivot - 0.05 * frame.axes[1]));
  arrow.setAmount(0.0123);
  EXPECT_LT(distance(arrow.shift(steps), 0.0123 * frame.axes[1]), 1e-15) << "along the axis, as it points";
  GizmoDrag ring(view.projection(), frame, GizmoGrip::TurnZ,
                 view.pixelOf(frame.pivot + 0.05 * frame.axes[0]));
  ring.setAmount(-7.0);
  EXPECT_EQ(ring.angle(steps), -7.0);
  EXPECT_NEAR(ring.angleIn(ring.motion()), -7.0, 1e-12) << "beyond a whole turn";
  GizmoDrag square(view.projection(), frame, GizmoGrip::PlaneX, view.pixelOf(frame.pivot));
  square.setAmount(0.02);
  EXPECT_EQ(square.shift(), glm::dvec3(0.0)) << "no way yet";
  const glm::dvec3 way = glm::normalize(frame.axes[1] + 0.5 * frame.axes[2]);
  square.moveTo(view.projection(), view.pixelOf(frame.pivot + 0.05 * way));
  EXPECT_LT(distance(square.shift(), 0.02 * way), 1e-10);
  square.setAmount(std::nullopt);
  EXPECT_LT(distance(square.shift(), 0.05 * way), 1e-10);
}

TEST(GizmoDrag, WhatThePointerGoesAcrossAnArrowMovesNothing) {
  const TestView view = test::aslant();
  const GizmoFrame frame = turnedFrame();
  const glm::dvec2 from = view.pixelOf(frame.pivot), to = view.pixelOf(frame.pivot + 0.05 * frame.axes[0]);
  const glm::dvec2 along = glm::normalize(to - from), across(-along.y, along.x);
  GizmoDrag drag(view.projection(), frame, GizmoGrip::MoveX, to + 4.0 * across);
  drag.moveTo(view.projection(), to - 90.0 * across);
  EXPECT_LT(glm::length(drag.shift()), 1e-12);
}

TEST(GizmoDrag, AnAxisAlongTheSightStandsStill) {
  for (const bool isParallel : {false, true}) {
    const TestView view = test::along({0, 0, -1}, {0, 1, 0}, isParallel);
    GizmoDrag drag(view.projection(), {}, GizmoGrip::MoveZ, {450.0, 300.0});
    for (int i = 0; i < 300; ++i) {
      drag.moveTo(view.projection(), {450.0 + i, 300.0 - 2.0 * i});
      EXPECT_EQ(drag.shift(), glm::dvec3(0.0));
    }
  }
}

TEST(GizmoDrag, BeyondThePointWhereAnAxisVanishesNothingTurnsRound) {
  // Seen from close by, nearly along it: the axis vanishes within the view.
  const TestView view = test::along({0.05, 0.1, -1.0});
  const glm::dvec2 pivot = view.pixelOf(glm::dvec3(0.0));
  const glm::dvec2 towards = glm::normalize(view.pixelOf({0, 0, -0.2}) - pivot);
  GizmoDrag drag(view.projection(), {}, GizmoGrip::MoveZ, pivot);
  double last = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    drag.moveTo(view.projection(), pivot + double(i) * towards);
    EXPECT_LE(drag.shift().z, last) << i;
    EXPECT_GT(drag.shift().z, -60.0) << i;
    last = drag.shift().z;
  }
  EXPECT_LT(last, -1.0);
  // Towards the eye it comes no farther than there.
  drag.moveTo(view.projection(), pivot - 5000.0 * towards);
  EXPECT_LT(drag.shift().z, 1.1);
}

TEST(GizmoDrag, ASquareKeepsWhatWasGrabbedUnderThePointer) {
  for (const bool isParallel : {false, true}) {
    const TestView view = test::aslant(isParallel);
    const GizmoFrame frame = turnedFrame();
    for (const GizmoGrip plane : kPlanes) {
      const glm::dvec3 a = frame.axes[(axisOf(plane) + 1) % 3], b = frame.axes[(axisOf(plane) + 2) % 3];
      const glm::dvec3 grabbed = frame.pivot + 0.02 * a + 0.02 * b;
      GizmoDrag drag(view.projection(), frame, plane, view.pixelOf(grabbed));
      const glm::dvec3 way = 0.05 * a - 0.03 * b;
      drag.moveTo(view.projection(), view.pixelOf(grabbed + way));
      EXPECT_LT(distance(drag.shift(), way), 1e-10) << isParallel << axisOf(plane);
    }
  }
}

TEST(GizmoDrag, APlaneOnEdgeFollowsWhatTheViewShowsOfIt) {
  // The plane across z, seen from the side.
  const TestView view = test::along({0, 1, 0});
  const double pixel = view.projection().metresPerPixel(glm::dvec3(0.0));
  GizmoDrag drag(view.projection(), {}, GizmoGrip::PlaneZ, {470.0, 300.0});
  for (int i = 1; i < 200; ++i) {
    drag.moveTo(view.projection(), {470.0 + i, 300.0 + (i % 7 - 3)});
    EXPECT_LT(distance(drag.shift(), {i * pixel, 0.0, 0.0}), 1e-12);
  }
}

TEST(GizmoDrag, NearlyOnEdgeNoPixelIsAJump) {
  for (const double tilt : {0.0, 0.02, 0.1, 0.149, 0.151, 0.2}) {
    const TestView view = test::along({0.0, std::cos(tilt), -std::sin(tilt)});
    const double pixel = view.projection().metresPerPixel(glm::dvec3(0.0));
    GizmoDrag drag(view.projection(), {}, GizmoGrip::PlaneZ, {450.0, 320.0});
    glm::dvec3 last(0.0);
    for (int i = 0; i < 40; ++i) {
      drag.moveTo(view.projection(), {450.0 + i, 320.0 + (i % 2 == 0 ? i : -i) / 10.0});
      EXPECT_LT(distance(drag.shift(), last), 90.0 * pixel) << tilt << ' ' << i;
      EXPECT_EQ(drag.shift().z, 0.0);
      last = drag.shift();
    }
  }
}

TEST(GizmoDrag, AboveThePlanesHorizonItStaysWhereItWas) {
  const TestView view = test::along({0.0, 1.0, -0.18});
  GizmoDrag drag(view.projection(), {}, GizmoGrip::PlaneZ, {450.0, 300.0});
  for (double y = 300.0; y > -400.0; y -= 1.0) {
    drag.moveTo(view.projection(), {450.0, y});
    EXPECT_GE(drag.shift().y, -1e-12);
    EXPECT_TRUE(std::isfinite(drag.shift().y));
  }
  const glm::dvec3 reached = drag.shift();
  drag.moveTo(view.projection(), {450.0, -900.0});
  EXPECT_EQ(drag.shift(), reached);
}

TEST(GizmoDrag, AFreeMoveKeepsTheGrabbedPointUnderThePointer) {
  for (const bool isParallel : {false, true}) {
    const TestView view = test::aslant(isParallel);
    const glm::dvec3 grabbed(0.1, -0.1, 0.12);
    GizmoDrag drag(view.projection(), turnedFrame(), GizmoGrip::MoveFree, view.pixelOf(grabbed), grabbed);
    const glm::dvec2 to = view.pixelOf(grabbed) + glm::dvec2(130.0, -75.0);
    drag.moveTo(view.projection(), to);
    EXPECT_LT(glm::distance(view.pixelOf(grabbed + drag.shift()), to), 1e-8);
    EXPECT_NEAR(glm::dot(drag.shift(), view.projection().away()), 0.0, 1e-12);
  }
}

/// A point of a ring about an axis, at an angle from where it comes nearest to the viewer.
glm::dvec3 onRing(const GizmoFrame& frame, const glm::dvec3& axis, const glm::dvec3& sight, double angle) {
  const glm::dvec3 nearest = glm::normalize(glm::dot(axis, sight) * axis - sight);
  return frame.pivot + 0.05 * (glm::angleAxis(angle, axis) * nearest);
}

TEST(GizmoDrag, ARingTurnsByTheAngleThatThePointerGoes) {
  for (const bool isParallel : {false, true}) {
    const TestView view = test::aslant(isParallel);
    const GizmoFrame frame = turnedFrame();
    const glm::dvec3 sight = view.projection().sightOf(frame.pivot);
    for (const GizmoGrip ring : kRings) {
      const glm::dvec3 axis = frame.axes[axisOf(ring)];
      GizmoDrag drag(view.projection(), frame, ring, view.pixelOf(onRing(frame, axis, sight, 0.2)));
      // Two rounds and a half, and back by one.
      for (double angle = 0.0; angle < 5.0 * kPi; angle += 0.3)
        drag.moveTo(view.projection(), view.pixelOf(onRing(frame, axis, sight, 0.2 + angle)));
      for (double angle = 5.0 * kPi; angle > 3.0 * kPi; angle -= 0.3)
        drag.moveTo(view.projection(), view.pixelOf(onRing(frame, axis, sight, 0.2 + angle)));
      drag.moveTo(view.projection(), view.pixelOf(onRing(frame, axis, sight, 0.2 + 3.0 * kPi)));
      EXPECT_NEAR(drag.angle(), 3.0 * kPi, 1e-9) << isParallel << axisOf(ring);
      EXPECT_EQ(drag.shift(), glm::dvec3(0.0));
      const RigidTransform motion = drag.motion();
      EXPECT_LT(distance(motion.applyToPoint(frame.pivot), frame.pivot), 1e-12);
      EXPECT_LT(distance(motion.applyToPoint(onRing(frame, axis, sight, 0.1)),
                         onRing(frame, axis, sight, 0.1 + 3.0 * kPi)),
                1e-9);
    }
  }
}

TEST(GizmoDrag, WhatHasComeLessFarIsToldInTheRoundOfThePointer) {
  const TestView view = test::along({0, 0, -1}, {0, 1, 0});
  const glm::dvec2 middle = view.pixelOf(glm::dvec3(0.0));
  GizmoDrag drag(view.projection(), {}, GizmoGrip::TurnZ, middle + glm::dvec2(80.0, 0.0));
  for (double angle = 0.0; angle < 7.0; angle += 0.25)
    drag.moveTo(view.projection(), middle + 80.0 * glm::dvec2(std::cos(angle), -std::sin(angle)));
  EXPECT_NEAR(drag.angle(), 6.75, 1e-6);
  EXPECT_NEAR(drag.angleIn(drag.motion()), drag.angle(), 1e-9);
  EXPECT_NEAR(drag.angleIn({glm::angleAxis(6.5, glm::dvec3(0, 0, 1)), {}}), 6.5, 1e-9);
  EXPECT_NEAR(drag.angleIn({glm::angleAxis(6.2, glm::dvec3(0, 0, 1)), {}}), 6.2, 1e-9);
  GizmoDrag arrow(view.projection(), {}, GizmoGrip::MoveX, middle);
  EXPECT_EQ(arrow.shiftIn({{1, 0, 0, 0}, {0.1, 0.2, 0.3}}), (glm::dvec3{0.1, 0.2, 0.3}));
}

TEST(GizmoDrag, TheOuterRingTurnsAnticlockwiseOnTheScreen) {
  const TestView view = test::aslant();
  const GizmoFrame frame = turnedFrame();
  const glm::dvec2 middle = view.pixelOf(frame.pivot);
  GizmoDrag drag(view.projection(), frame, GizmoGrip::TurnView, middle + glm::dvec2(98.0, 0.0));
  drag.moveTo(view.projection(), middle + glm::dvec2(0.0, -98.0));
  // Perspective skews the circle a little where it is not in the middle of the view.
  EXPECT_NEAR(drag.angle(), 0.5 * kPi, 0.01);
  const glm::dvec3 beside = frame.pivot + 0.01 * view.projection().right();
  EXPECT_LT(view.pixelOf(drag.motion().applyToPoint(beside)).y, middle.y - 5.0);
}

TEST(GizmoDrag, ARingOnEdgeRollsUnderThePointer) {
  const TestView view = test::along({0, 1, 0});
  const glm::dvec2 middle = view.pixelOf(glm::dvec3(0.0));
  GizmoDrag drag(view.projection(), {}, GizmoGrip::TurnZ, middle + glm::dvec2(30.0, 0.0));
  double last = 0.0;
  for (int i = 1; i <= 200; ++i) {
    drag.moveTo(view.projection(), middle + glm::dvec2(30.0 + i, i % 3));
    EXPECT_NEAR(drag.angle() - last, 1.0 / GizmoLayout::kRingRadius, 1e-9);
    last = drag.angle();
  }
  // What is near goes with the pointer: to the right.
  const RigidTransform motion = {glm::angleAxis(0.1, drag.turnAxis()), {}};
  EXPECT_GT(view.pixelOf(motion.applyToPoint({0.0, -0.05, 0.0})).x, middle.x + 1.0);
}

TEST(GizmoDrag, ThroughTheMiddleOfARingNothingIsUndefined) {
  const TestView view = test::along({0, 0, -1}, {0, 1, 0});
  const glm::dvec2 middle = view.pixelOf(glm::dvec3(0.0));
  GizmoDrag drag(view.projection(), {}, GizmoGrip::TurnZ, middle + glm::dvec2(80.0, 0.0));
  for (int i = 80; i >= -80; --i)
    drag.moveTo(view.projection(), middle + glm::dvec2(i, 0.0));
  EXPECT_NEAR(std::abs(drag.angle()), kPi, 1e-9);
}

TEST(GizmoDrag, StepsCountFromWhereTheDragBegan) {
  const TestView view = test::aslant();
  const GizmoFrame frame = turnedFrame();
  const SnapSteps steps{0.01, kPi / 12.0};
  const glm::dvec3 x = frame.axes[0], y = frame.axes[1];
  GizmoDrag arrow(view.projection(), frame, GizmoGrip::MoveX, view.pixelOf(frame.pivot + 0.0333 * x));
  arrow.moveTo(view.projection(), view.pixelOf(frame.pivot + (0.0333 + 0.0261) * x));
  EXPECT_LT(distance(arrow.shift(steps), 0.03 * x), 1e-12);
  EXPECT_LT(distance(arrow.shift(), 0.0261 * x), 1e-10);

  GizmoDrag square(view.projection(), frame, GizmoGrip::PlaneZ, view.pixelOf(frame.pivot));
  square.moveTo(view.projection(), view.pixelOf(frame.pivot + 0.0261 * x - 0.0149 * y));
  EXPECT_LT(distance(square.shift(steps), 0.03 * x - 0.01 * y), 1e-12);

  const glm::dvec3 sight = view.projection().sightOf(frame.pivot);
  GizmoDrag ring(view.projection(), frame, GizmoGrip::TurnY, view.pixelOf(onRing(frame, y, sight, 0.0)));
  ring.moveTo(view.projection(), view.pixelOf(onRing(frame, y, sight, 0.7)));
  EXPECT_NEAR(ring.angle(steps), kPi / 4.0, 1e-12);
}

TEST(GizmoDrag, APointerThatIsNoNumberMovesNothing) {
  const TestView view = test::aslant();
  for (const GizmoGrip handle : {GizmoGrip::MoveX, GizmoGrip::PlaneY, GizmoGrip::TurnZ}) {
    GizmoDrag drag(view.projection(), {}, handle, {440.0, 310.0});
    drag.moveTo(view.projection(), {std::nan(""), 300.0});
    EXPECT_EQ(drag.shift(), glm::dvec3(0.0));
    EXPECT_EQ(drag.angle(), 0.0);
  }
}

}  // namespace
}  // namespace nearfit::gizmo_drag_test

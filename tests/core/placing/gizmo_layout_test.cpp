#include "core/placing/gizmo_layout.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/placing/gizmo_drag.h"
#include "tests/core/placing/projection_oracle.h"

namespace nearfit::gizmo_layout_test {
namespace {

using test::TestView;

GizmoLayout layoutOf(const TestView& view, GizmoMode mode, const GizmoFrame& frame = {}) {
  return GizmoLayout(view.projection(), frame, mode);
}

/// A view from far away, so that lengths on the screen are those of a parallel projection.
TestView farAlong(const glm::dvec3& away, const glm::dvec3& up) {
  TestView view = test::along(away, up);
  view.camera.eye *= 400.0;
  view.camera.viewAngle = 1e-3;
  return view;
}

double reachOf(const GizmoLayout& layout, const glm::dvec2& from) {
  double reach = 0.0;
  for (const GizmoFigure& figure : layout.figures()) {
    for (const glm::dvec2& point : figure.points)
      reach = std::max(reach, glm::distance(point, from));
  }
  return reach;
}

TEST(GizmoLayout, IsOfTheSameSizeWhereverItStands) {
  for (const double depth : {0.01, 1.0, 300.0}) {
    TestView view = farAlong({0, 0, -1}, {0, 1, 0});
    view.camera.eye = {0.0, 0.0, depth};
    for (const double angle : {1e-3, 1.0}) {
      view.camera.viewAngle = angle;
      const glm::dvec2 middle = view.pixelOf(glm::dvec3(0.0));
      EXPECT_NEAR(reachOf(layoutOf(view, GizmoMode::Move), middle), GizmoLayout::kArrowLength, 1e-6);
      EXPECT_NEAR(reachOf(layoutOf(view, GizmoMode::Turn), middle), GizmoLayout::kViewRingRadius, 1e-6);
    }
  }
}

TEST(GizmoLayout, WhatIsDrawnOfAnArrowIsWhatGrabsIt) {
  const TestView view = test::aslant();
  const GizmoLayout layout = layoutOf(view, GizmoMode::Move);
  const double scale = view.projection().metresPerPixel(glm::dvec3(0.0));
  for (const GizmoGrip arrow : kArrows) {
    glm::dvec3 axis(0.0);
    axis[axisOf(arrow)] = 1.0;
    // A square may stand before the middle of the one that points away.
    const bool pointsAway = arrow == GizmoGrip::MoveY;
    for (const double reach : {20.0, pointsAway ? 22.0 : 60.0, 85.0, 90.0})
      EXPECT_EQ(layout.pick(view.pixelOf(scale * reach * axis)), arrow) << reach;
    EXPECT_NE(layout.pick(view.pixelOf(scale * 110.0 * axis)), arrow);
    EXPECT_NE(layout.pick(view.pixelOf(-scale * 60.0 * axis)), arrow);
  }
  EXPECT_EQ(layout.pick(view.pixelOf(glm::dvec3(0.0)) + glm::dvec2(3.0, -2.0)), GizmoGrip::MoveFree);
  EXPECT_EQ(layout.pick(view.pixelOf(glm::dvec3(0.0)) + glm::dvec2(200.0, 0.0)), GizmoGrip::None);
}

TEST(GizmoLayout, SquaresStandInTheQuarterTowardsTheViewer) {
  const TestView view = test::aslant();
  const GizmoLayout layout = layoutOf(view, GizmoMode::Move);
  const double step = 38.0 * view.projection().metresPerPixel(glm::dvec3(0.0));
  // The eye is at positive x, negative y and positive z.
  EXPECT_EQ(layout.pick(view.pixelOf({step, -step, 0.0})), GizmoGrip::PlaneZ);
  EXPECT_EQ(layout.pick(view.pixelOf({step, 0.0, step})), GizmoGrip::PlaneY);
  EXPECT_EQ(layout.pick(view.pixelOf({0.0, -step, step})), GizmoGrip::PlaneX);
}

TEST(GizmoLayout, ARingIsGrabbedOnItsNearSideOnly) {
  const TestView view = farAlong({0.0, 0.6, -0.8}, {0, 0, 1});
  const GizmoLayout layout = layoutOf(view, GizmoMode::Turn);
  const double radius = GizmoLayout::kRingRadius * view.projection().metresPerPixel(glm::dvec3(0.0));
  EXPECT_EQ(layout.pick(view.pixelOf(radius * glm::normalize(glm::dvec3(0.5, -1.0, 0.0)))), GizmoGrip::TurnZ);
  EXPECT_EQ(layout.pick(view.pixelOf(radius * glm::normalize(glm::dvec3(0.5, 1.0, 0.0)))), GizmoGrip::None);
  EXPECT_EQ(layout.pick(view.pixelOf(radius * glm::normalize(glm::dvec3(0.0, -1.0, 2.0)))), GizmoGrip::TurnX);
  EXPECT_EQ(layout.pick(view.pixelOf(glm::dvec3(0.0)) + glm::dvec2(-98.0, 0.0)), GizmoGrip::TurnView);
}

TEST(GizmoLayout, ARingThatIsSeenAsACircleIsGrabbedAllRound) {
  const TestView view = farAlong({0, 0, -1}, {0, 1, 0});
  const GizmoLayout layout = layoutOf(view, GizmoMode::Turn);
  const glm::dvec2 middle = view.pixelOf(glm::dvec3(0.0));
  for (double angle = 0.3; angle < 6.5; angle += 0.7) {
    const glm::dvec2 arm(std::cos(angle), std::sin(angle));
    EXPECT_EQ(layout.pick(middle + GizmoLayout::kRingRadius * arm), GizmoGrip::TurnZ) << angle;
  }
}

TEST(GizmoLayout, AnAxisAlongTheSightAndAPlaneOnEdgeAreNotThere) {
  const TestView view = farAlong({0, 0, -1}, {0, 1, 0});
  const GizmoLayout layout = layoutOf(view, GizmoMode::MoveAndTurn);
  EXPECT_FALSE(layout.has(GizmoGrip::MoveZ));
  EXPECT_FALSE(layout.has(GizmoGrip::PlaneX));
  EXPECT_FALSE(layout.has(GizmoGrip::PlaneY));
  EXPECT_TRUE(layout.has(GizmoGrip::MoveX));
  EXPECT_TRUE(layout.has(GizmoGrip::PlaneZ));
  // Rings on edge are lines that can be rolled.
  EXPECT_EQ(layout.pick(view.pixelOf(glm::dvec3(0.0)) + glm::dvec2(0.0, 55.0)), GizmoGrip::TurnX);
}

TEST(GizmoLayout, BehindTheEyeThereIsNoGizmo) {
  const TestView view = test::aslant();
  const GizmoFrame frame{view.camera.eye - view.camera.away, glm::dmat3(1.0)};
  const GizmoLayout layout = layoutOf(view, GizmoMode::MoveAndTurn, frame);
  EXPECT_TRUE(layout.figures().empty());
  EXPECT_EQ(layout.pick({450.0, 300.0}), GizmoGrip::None);
  EXPECT_TRUE(layoutOf(view, GizmoMode::Hidden).figures().empty());
}

TEST(GizmoGuide, TheSectorOfATurnReachesFromWhereItWasGrabbedByTheAngle) {
  const TestView view = farAlong({0, 0, -1}, {0, 1, 0});
  const glm::dvec2 middle = view.pixelOf(glm::dvec3(0.0));
  const GizmoDrag drag(view.projection(), {}, GizmoGrip::TurnZ, middle + glm::dvec2(80.0, 0.0));
  const GizmoGuide guide = gizmoGuide(view.projection(), drag, glm::dvec3(0.0), 0.5);
  ASSERT_GT(guide.sector.size(), 3U);
  EXPECT_LT(glm::distance(guide.sector.front(), middle + glm::dvec2(80.0, 0.0)), 0.01);
  const glm::dvec2 end = middle + 80.0 * glm::dvec2(std::cos(0.5), -std::sin(0.5));
  EXPECT_LT(glm::distance(guide.sector[guide.sector.size() - 2], end), 0.01);
  EXPECT_LT(glm::distance(guide.sector.back(), middle), 1e-9);
  EXPECT_TRUE(guide.line.empty() && guide.way.empty());
}

TEST(GizmoGuide, TheLineOfAnArrowRunsThroughTheWholeView) {
  const TestView view = test::aslant();
  const GizmoDrag drag(view.projection(), {}, GizmoGrip::MoveX, view.pixelOf({0.02, 0.0, 0.0}));
  const GizmoGuide guide = gizmoGuide(view.projection(), drag, {0.05, 0.0, 0.0}, 0.0);
  ASSERT_EQ(guide.line.size(), 2U);
  EXPECT_LT(distanceToLine(guide.line, view.pixelOf({0.1, 0.0, 0.0})), 1e-6);
  EXPECT_LT(distanceToLine(guide.line, view.pixelOf({-0.2, 0.0, 0.0})), 1e-6);
  ASSERT_EQ(guide.way.size(), 2U);
  EXPECT_LT(glm::distance(guide.way[1], view.pixelOf({0.05, 0.0, 0.0})), 1e-6);
}

TEST(ScreenShapes, TheHullOfASquareAndItsMiddleIsTheSquare) {
  const auto hull = convexHull({{0, 0}, {1, 1}, {2, 2}, {0, 2}, {2, 0}, {1, 0}});
  EXPECT_EQ(hull.size(), 4U);
  EXPECT_TRUE(isInside(hull, {1.0, 0.5}));
  EXPECT_FALSE(isInside(hull, {2.5, 1.0}));
  EXPECT_NEAR(distanceToLine(hull, {-3.0, -4.0}), 5.0, 1e-12);
}

TEST(GizmoLayout, APlaneIsShiftedByOneArrowAndTiltedByTwoRings) {
  const TestView view = farAlong({1, 1, -1}, {0, 0, 1});
  const GizmoMode modes[] = {GizmoMode::AcrossX, GizmoMode::AcrossY, GizmoMode::AcrossZ};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const GizmoLayout layout = layoutOf(view, modes[axis]);
    for (std::size_t other = 0; other < 3; ++other) {
      EXPECT_EQ(layout.has(kArrows[other]), other == axis);
      // Turned about its own normal a plane stays what it is.
      EXPECT_EQ(layout.has(kRings[other]), other != axis);
      EXPECT_FALSE(layout.has(kPlanes[other]));
    }
    EXPECT_FALSE(layout.has(GizmoGrip::MoveFree) || layout.has(GizmoGrip::TurnView));
  }
  // Seen from its tip an arrow would say nothing of the way.
  EXPECT_FALSE(layoutOf(farAlong({0, 0, -1}, {0, 1, 0}), GizmoMode::AcrossZ).has(GizmoGrip::MoveZ));
}

}  // namespace
}  // namespace nearfit::gizmo_layout_test

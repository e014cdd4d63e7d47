#include "core/placing/solid_move.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/exact/pose_certifier.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::solid_move_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const glm::dquat kNoTurn(1.0, 0.0, 0.0, 0.0);

RigidTransform at(const glm::dvec3& translation) {
  return {kNoTurn, translation};
}

RigidTransform turnedAbout(const glm::dvec3& pivot, const glm::dvec3& axis, double angle) {
  const glm::dquat turn = glm::angleAxis(angle, glm::normalize(axis));
  return {turn, pivot - turn * pivot};
}

/// A scene, and a witness for each pair of a moved and a fixed part.
struct Bench {
  PartId add(TriangleMesh mesh, const RigidTransform& worldFromPart, const char* name = "part") {
    return scene.add(test::partOf(test::solidGeometryOf(std::move(mesh)), name, worldFromPart));
  }
  double margin() const { return scene.haptics().proxy.margin; }

  /// Whether a part at a pose meets another at its place, by exact predicates.
  bool doMeet(PartId part, const RigidTransform& worldFromPart, PartId other) const {
    const Part &a = *scene.find(other), &b = *scene.find(part);
    return test::PoseCertifier(a.geometry->mesh, b.geometry->mesh)
        .doMeet(a.worldFromPart.inverse() * worldFromPart);
  }
  double lowestX(PartId part, const RigidTransform& pose) const { return extreme(part, pose, -1.0); }
  double highestX(PartId part, const RigidTransform& pose) const { return extreme(part, pose, 1.0); }

  Scene scene;

 private:
  double extreme(PartId part, const RigidTransform& pose, double sign) const {
    double most = -1e9;
    for (const glm::dvec3& v : scene.find(part)->geometry->mesh.vertices())
      most = std::max(most, sign * pose.applyToPoint(v).x);
    return sign * most;
  }
};

/// A cube of 20 mm, and a wall whose face is at x = 50 mm.
struct CubeAndWall : Bench {
  PartId cube = add(test::boxMesh(glm::dvec3(0.02)), at({0.001, 0.002, 0.003}), "cube");
  PartId wall = add(test::boxMesh({0.02, 0.3, 0.3}), at({0.06, 0.0, 0.0}), "wall");
};

SolidMove::Progress settle(SolidMove& move, const RigidTransform& motion) {
  return move.advance(motion, SolidMove::kMaxTicks);
}

TEST(SolidMove, WhereNothingIsInTheWayPartsArriveToTheLastBit) {
  CubeAndWall b;
  const PartId ball = b.add(test::icosphereMesh(0.01, 1), at({0.0, 0.05, 0.0}), "ball");
  const RigidTransform motion = at({-0.1, 0.0213, 0.07}) * turnedAbout({0.0, 0.02, 0.0}, {1, 2, 3}, 0.4);
  const PartId parts[] = {b.cube, ball};
  for (const std::size_t count : {1, 2}) {
    SolidMove move(b.scene, std::span(parts, count));
    const SolidMove::Progress progress = settle(move, motion);
    EXPECT_TRUE(progress.hasArrived && progress.isSettled);
    for (std::size_t i = 0; i < count; ++i) {
      const RigidTransform wanted = motion * b.scene.find(parts[i])->worldFromPart;
      EXPECT_EQ(move.poses()[i].translation, wanted.translation);
      EXPECT_EQ(move.poses()[i].rotation, wanted.rotation);
    }
    EXPECT_THAT(move.touching(), IsEmpty());
  }
}

TEST(SolidMove, APartStopsAMarginBeforeTheWallAndSlidesAlongIt) {
  CubeAndWall b;
  SolidMove move(b.scene, {{b.cube}});
  for (int i = 1; i <= 40; ++i) {
    move.advance(at({0.004 * i, 0.002 * i, 0.0}), 60);
    EXPECT_FALSE(b.doMeet(b.cube, move.poses()[0], b.wall)) << i;
  }
  const SolidMove::Progress progress = settle(move, at({0.16, 0.08, 0.0}));
  EXPECT_TRUE(progress.isSettled);
  EXPECT_FALSE(progress.hasArrived);
  EXPECT_NEAR(b.highestX(b.cube, move.poses()[0]), 0.05 - b.margin(), 0.05 * b.margin());
  EXPECT_NEAR(move.poses()[0].translation.y, 0.082, b.margin());
  EXPECT_THAT(move.touching(), ElementsAre(b.wall));
}

TEST(SolidMove, OneLeapToBehindTheWallEndsBeforeIt) {
  CubeAndWall b;
  const RigidTransform reached = movedSolidly(b.scene, {{b.cube}}, at({0.3, 0.0, 0.0})).front();
  EXPECT_NEAR(b.highestX(b.cube, reached), 0.05 - b.margin(), 0.05 * b.margin());
  EXPECT_FALSE(b.doMeet(b.cube, reached, b.wall));
}

TEST(SolidMove, AShiftAgainstACornerDoesNotTurnThePart) {
  Bench b;
  const PartId cube = b.add(test::boxMesh(glm::dvec3(0.02)), {}, "cube");
  // In the way of a corner of the cube alone.
  b.add(test::boxMesh({0.02, 0.02, 0.02}), at({0.04, 0.0185, 0.0185}), "post");
  SolidMove move(b.scene, {{cube}});
  settle(move, at({0.1, 0.0, 0.0}));
  const RigidTransform& reached = move.poses()[0];
  EXPECT_LT(glm::length(glm::dvec3(reached.rotation.x, reached.rotation.y, reached.rotation.z)), 1e-6);
  EXPECT_NEAR(reached.translation.x, 0.02 - b.margin(), 0.1 * b.margin());
}

TEST(SolidMove, ATurnStopsAtContact) {
  Bench b;
  const PartId bar = b.add(test::boxMesh({0.1, 0.01, 0.01}), {}, "bar");
  const PartId post = b.add(test::cylinderMesh(0.01, 0.2, 24), at({0.0, 0.04, 0.0}), "post");
  SolidMove move(b.scene, {{bar}});
  for (int i = 1; i <= 30; ++i) {
    move.advance(turnedAbout(glm::dvec3(0.0), {0, 0, 1}, 0.1 * i), 60);
    EXPECT_FALSE(b.doMeet(bar, move.poses()[0], post)) << i;
  }
  EXPECT_THAT(move.touching(), ElementsAre(post));
}

TEST(SolidMove, PartsThatOverlapAreLetGoUntilTheyAreApart) {
  Bench b;
  const PartId cube = b.add(test::boxMesh(glm::dvec3(0.02)), {}, "cube");
  const PartId wall = b.add(test::boxMesh({0.02, 0.3, 0.3}), at({0.015, 0.0, 0.0}), "wall");
  ASSERT_TRUE(b.doMeet(cube, {}, wall));
  SolidMove move(b.scene, {{cube}});
  EXPECT_TRUE(settle(move, at({0.0, 0.01, 0.0})).hasArrived);
  EXPECT_THAT(move.overlapping(), ElementsAre(wall));
  EXPECT_TRUE(settle(move, at({-0.05, 0.01, 0.0})).hasArrived);
  EXPECT_THAT(move.overlapping(), IsEmpty());
  // Once apart it is solid.
  EXPECT_FALSE(settle(move, at({0.02, 0.01, 0.0})).hasArrived);
  EXPECT_NEAR(b.highestX(cube, move.poses()[0]), 0.005 - b.margin(), 0.05 * b.margin());
}

TEST(SolidMove, SeveralPartsStopAsOneBody) {
  CubeAndWall b;
  // Ahead of the cube, not touching it.
  const PartId ball = b.add(test::icosphereMesh(0.008, 2), at({0.03, 0.001, 0.002}), "ball");
  const RigidTransform before =
      b.scene.find(b.cube)->worldFromPart.inverse() * b.scene.find(ball)->worldFromPart;
  SolidMove move(b.scene, {{b.cube, ball}});
  settle(move, at({0.1, 0.03, 0.0}));
  EXPECT_THAT(move.touching(), ElementsAre(b.wall));
  EXPECT_FALSE(b.doMeet(ball, move.poses()[1], b.wall));
  EXPECT_NEAR(b.highestX(ball, move.poses()[1]), 0.05 - b.margin(), 0.05 * b.margin());
  const RigidTransform after = move.poses()[0].inverse() * move.poses()[1];
  EXPECT_LT(glm::distance(before.translation, after.translation), 1e-12);
  EXPECT_NEAR(move.poses()[1].translation.y, 0.031, b.margin());
}

TEST(SolidMove, AnOpenSurfaceHoldsFromEitherSide) {
  for (const double side : {1.0, -1.0}) {
    Bench b;
    const PartId cube = b.add(test::boxMesh(glm::dvec3(0.02)), at({0.0, 0.0, 0.05 * side}), "cube");
    const PartId sheet = b.add(test::squareMesh(0.2, 4), {}, "sheet");
    SolidMove move(b.scene, {{cube}});
    settle(move, at({0.0, 0.01, -0.1 * side}));
    EXPECT_NEAR(move.poses()[0].translation.z, side * (0.01 + b.margin()), 0.1 * b.margin());
    EXPECT_FALSE(b.doMeet(cube, move.poses()[0], sheet));
  }
}

TEST(SolidMove, WhatIsHiddenIsNotInTheWay) {
  for (const bool isWallHidden : {true, false}) {
    CubeAndWall b;
    Part part = *b.scene.find(isWallHidden ? b.wall : b.cube);
    part.isVisible = false;
    b.scene.replace(part);
    SolidMove move(b.scene, {{b.cube}});
    EXPECT_TRUE(settle(move, at({0.06, 0.0, 0.0})).hasArrived);
  }
}

TEST(SolidMove, AMotionBackToTheStartEndsThere) {
  CubeAndWall b;
  SolidMove move(b.scene, {{b.cube}});
  settle(move, at({0.1, 0.03, 0.0}));
  EXPECT_TRUE(settle(move, {}).hasArrived);
  EXPECT_EQ(move.poses()[0].translation, b.scene.find(b.cube)->worldFromPart.translation);
}

TEST(SolidMove, NoPoseOfAWildDragMeetsAnything) {
  Bench b;
  const PartId star = b.add(test::starMesh(3, 0.02, 2, 0.3), at({0.09, 0.0, 0.0}), "star");
  const PartId ring = b.add(test::torusMesh(0.05, 0.012, 24, 12), {}, "ring");
  const PartId box = b.add(test::boxMesh(glm::dvec3(0.03)), at({0.0, 0.0, 0.06}), "box");
  SolidMove move(b.scene, {{star}});
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> shift(-0.15, 0.05), angle(-1.5, 1.5);
  int blocked = 0;
  for (int i = 0; i < 100; ++i) {
    const RigidTransform wanted = at({shift(random), shift(random) + 0.05, shift(random) + 0.05}) *
                                  turnedAbout({0.09, 0.0, 0.0}, {1, 0.3 * i, 2}, angle(random));
    const SolidMove::Progress progress = move.advance(wanted, 25);
    EXPECT_FALSE(b.doMeet(star, move.poses()[0], ring)) << i;
    EXPECT_FALSE(b.doMeet(star, move.poses()[0], box)) << i;
    blocked += progress.hasArrived ? 0 : 1;
  }
  EXPECT_GT(blocked, 10);
}

TEST(SolidMove, WhatStartsNearerThanTheMarginArrivesAlongWhatItStandsOn) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> exponent(-8.0, -4.0), way(-0.03, 0.03);
  for (int i = 0; i < 60; ++i) {
    CubeAndWall b;
    // The cube's right face stands by the wall, as after a drop.
    const double gap = std::pow(10.0, exponent(random));
    Part part = *b.scene.find(b.cube);
    part.worldFromPart = at({0.04 - gap, 0.002, 0.003});
    b.scene.replace(part);
    SolidMove move(b.scene, {{b.cube}});
    const RigidTransform along = at({0.0, way(random), way(random)});
    const SolidMove::Progress progress = settle(move, along);
    EXPECT_TRUE(progress.hasArrived) << gap;
    EXPECT_EQ(move.poses()[0].translation, (along * part.worldFromPart).translation) << gap;
    EXPECT_THAT(move.touching(), IsEmpty()) << gap;
    EXPECT_FALSE(b.doMeet(b.cube, move.poses()[0], b.wall)) << gap;
  }
}

TEST(SolidMove, WhatStartsNearerThanTheMarginAndIsPressedOnEndsAsNear) {
  for (const double gap : {1e-6, 2e-5}) {
    CubeAndWall b;
    Part part = *b.scene.find(b.cube);
    part.worldFromPart = at({0.04 - gap, 0.002, 0.003});
    b.scene.replace(part);
    SolidMove move(b.scene, {{b.cube}});
    const SolidMove::Progress progress = settle(move, at({0.02, 0.01, 0.0}));
    EXPECT_TRUE(progress.isSettled);
    EXPECT_FALSE(progress.hasArrived);
    EXPECT_NEAR(b.highestX(b.cube, move.poses()[0]), 0.05 - gap, 0.05 * gap);
    EXPECT_NEAR(move.poses()[0].translation.y, 0.012, 1e-6);
    EXPECT_THAT(move.touching(), ElementsAre(b.wall));
    EXPECT_FALSE(b.doMeet(b.cube, move.poses()[0], b.wall));
  }
}

TEST(SolidMove, APartThatIsNotThereIsRefused) {
  CubeAndWall b;
  EXPECT_THROW(SolidMove(b.scene, {{PartId{77}}}), UsageError);
}

TEST(SolidMove, AWayThatIsNotWantedAnyMoreIsCancelled) {
  CubeAndWall b;
  EXPECT_THROW(movedSolidly(b.scene, {{b.cube}}, at({0.3, 0.0, 0.0}), [](double) { return false; }),
               Cancelled);
}

TEST(SolidMove, APartThatIsMovedByItselfStaysOnItsAxis) {
  Bench bench;
  const PartId block = bench.add(test::boxMesh({0.1, 0.1, 0.1}), at(glm::dvec3(0.0)), "block");
  const PartId wall = bench.add(test::boxMesh({0.1, 1.0, 1.0}), at({0.5, 0.0, 0.0}), "wall");
  Joint joint;
  joint.part = block;
  joint.onPart.direction = joint.onBase.direction = {1.0, 0.0, 0.0};
  bench.scene.addJoint(joint);
  const PartId moved[] = {block};
  // Aside and along: along is left.
  const RigidTransform free = movedSolidly(bench.scene, moved, at({0.2, 0.3, 0.1})).front();
  EXPECT_LT(glm::distance(free.translation, {0.2, 0.0, 0.0}), 1e-9);
  const RigidTransform held = movedSolidly(bench.scene, moved, at({0.9, 0.3, 0.1})).front();
  EXPECT_LT(glm::length(glm::dvec2(held.translation.y, held.translation.z)), 1e-9);
  EXPECT_NEAR(bench.highestX(block, held), 0.45 - bench.margin(), 0.05 * bench.margin());
  EXPECT_FALSE(bench.doMeet(block, held, wall));
  SolidMove move(bench.scene, moved);
  SolidMove::Progress progress;
  for (int i = 0; i < SolidMove::kMaxTicks && !progress.isSettled; ++i)
    progress = move.advance(at({0.2, 0.3, 0.1}), 1);
  EXPECT_TRUE(progress.hasArrived) << "where the joint puts it";
}

TEST(SolidMove, PartsThatAreMovedTogetherLeaveTheirJointsAlone) {
  Bench bench;
  const PartId block = bench.add(test::boxMesh({0.1, 0.1, 0.1}), at(glm::dvec3(0.0)), "block");
  const PartId other = bench.add(test::boxMesh({0.1, 0.1, 0.1}), at({0.3, 0.0, 0.0}), "other");
  Joint joint;
  joint.part = block;
  bench.scene.addJoint(joint);
  const PartId moved[] = {block, other};
  const auto poses = movedSolidly(bench.scene, moved, at({0.0, 0.2, 0.0}));
  EXPECT_EQ(poses[0].translation, glm::dvec3(0.0, 0.2, 0.0));
}

}  // namespace
}  // namespace nearfit::solid_move_test

#include "core/placing/drop.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/proximity/overlap/interference.h"
#include "core/proximity/surface/surface_distance.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::drop_test {
namespace {

using test::boxMesh;
using test::partOf;

constexpr double kPi = std::numbers::pi;
const glm::dvec3 kDown(0.0, 0.0, -1.0);

double uniform(std::mt19937_64& random) {
  return 2.0 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1.0;
}
glm::dvec3 randomDirection(std::mt19937_64& random) {
  for (;;) {
    const glm::dvec3 v{uniform(random), uniform(random), uniform(random)};
    if (glm::length(v) > 0.1 && glm::length(v) <= 1.0) return glm::normalize(v);
  }
}
glm::dquat randomRotation(std::mt19937_64& random) {
  const double angle = kPi * uniform(random);
  return glm::angleAxis(angle, randomDirection(random));
}

/// A fixed and a moving part, and the way between them.
struct Pair {
  Pair(TriangleMesh fixedMesh, const RigidTransform& worldFromFixed, TriangleMesh movingMesh,
       const RigidTransform& worldFromMoving) {
    fixed = scene.add(partOf(test::geometryOf(std::move(fixedMesh)), "fixed", worldFromFixed));
    moving = scene.add(partOf(test::geometryOf(std::move(movingMesh)), "moving", worldFromMoving));
  }
  DropResult drop(const glm::dvec3& direction, double gap = 0.0) const {
    const PartId moved[] = {moving};
    return dropParts(scene, moved, {direction, gap});
  }
  RigidTransform fixedFromMoving(const glm::dvec3& shift) const {
    RigidTransform pose = scene.find(moving)->worldFromPart;
    pose.translation += shift;
    return (scene.find(fixed)->worldFromPart.inverse() * pose).normalized();
  }
  bool meets(const glm::dvec3& shift) const {
    const PartGeometry &a = *scene.find(fixed)->geometry, &b = *scene.find(moving)->geometry;
    return findInterference(a.tree(), b.tree(), fixedFromMoving(shift)).kind != InterferenceKind::Disjoint;
  }
  double distance(const glm::dvec3& shift) {
    return leastSurfaceDistance(scene.find(fixed)->geometry->tree(), scene.find(moving)->geometry->tree(),
                                fixedFromMoving(shift), std::numeric_limits<double>::infinity(), scratch,
                                std::numeric_limits<std::uint64_t>::max())
        .distance;
  }

  Scene scene;
  PartId fixed, moving;
  LmdScratch scratch;
};

/// Another way to the same contact: as far as the distance allows, again and again.
double advancedConservatively(Pair& pair, const glm::dvec3& direction, double closeEnough, double farthest) {
  double travel = 0.0;
  for (int i = 0; i < 100000 && travel < farthest; ++i) {
    const double distance = pair.distance(travel * direction);
    if (distance < closeEnough) return travel;
    travel += distance;
  }
  return std::numeric_limits<double>::infinity();
}

void expectContact(const Pair& pair, const DropResult& result, const glm::dvec3& direction, double expected) {
  ASSERT_EQ(result.outcome, DropResult::Outcome::Contact);
  EXPECT_EQ(result.against, pair.fixed);
  EXPECT_EQ(result.moved, pair.moving);
  EXPECT_NEAR(result.travel + result.gap, expected, 1e-12 * (1.0 + expected));
  EXPECT_NEAR(glm::distance(result.shift, result.travel * direction), 0.0, 1e-15 * (1.0 + expected));
  EXPECT_FALSE(pair.meets(result.shift));
  // Anything beyond contact is in the other.
  EXPECT_TRUE(pair.meets((result.travel + result.gap + 1e-9) * direction));
}

TEST(Drop, BoxFallsOnBox) {
  const Pair pair(boxMesh(glm::dvec3(0.04)), {}, boxMesh(glm::dvec3(0.02)),
                  {{1, 0, 0, 0}, {0.005, 0.002, 0.1}});
  const DropResult result = pair.drop(kDown);
  expectContact(pair, result, kDown, 0.1 - 0.02 - 0.01);
  EXPECT_LE(result.gap, 1e-6);
  EXPECT_GT(result.gap, 0.0);
  EXPECT_NEAR(glm::distance(result.normal, glm::dvec3(0, 0, 1)), 0.0, 1e-12);
}

TEST(Drop, WhatHasBeenDroppedStaysExactlyWhereItIs) {
  // What rounding left of the way was a travel, and so a step of undo, each time.
  std::mt19937_64 random(7);
  for (int i = 0; i < 40; ++i) {
    Pair pair(boxMesh({0.3, 0.2, 0.04}), {randomRotation(random), 0.5 * randomDirection(random)},
              boxMesh({0.03, 0.02, 0.01}), {randomRotation(random), 2.0 * randomDirection(random)});
    const glm::dvec3 way = pair.scene.find(pair.fixed)->worldFromPart.translation -
                           pair.scene.find(pair.moving)->worldFromPart.translation;
    const DropResult first = pair.drop(way);
    ASSERT_EQ(first.outcome, DropResult::Outcome::Contact);
    ASSERT_GT(first.travel, 0.1);
    Part dropped = *pair.scene.find(pair.moving);
    dropped.worldFromPart.translation += first.shift;
    pair.scene.replace(dropped);
    const DropResult second = pair.drop(way);
    ASSERT_EQ(second.outcome, DropResult::Outcome::Contact);
    EXPECT_EQ(second.travel, 0.0) << "case " << i;
    EXPECT_EQ(second.shift, glm::dvec3(0.0)) << "case " << i;
  }
}

TEST(Drop, TheGapIsLeftOfTheWay) {
  const Pair pair(boxMesh(glm::dvec3(0.04)), {}, boxMesh(glm::dvec3(0.02)), {{1, 0, 0, 0}, {0.0, 0.0, 0.1}});
  const DropResult result = pair.drop(3.0 * kDown, 0.001);
  EXPECT_NEAR(result.gap, 0.001, 1e-15);
  EXPECT_NEAR(result.travel, 0.069, 1e-14);
}

TEST(Drop, TiltedBoxLandsOnItsLowestCorner) {
  const glm::dquat tilt = glm::angleAxis(0.3, glm::normalize(glm::dvec3(1.0, 2.0, 0.5)));
  const Pair pair(boxMesh(glm::dvec3(0.4, 0.4, 0.02)), {}, boxMesh(glm::dvec3(0.02, 0.03, 0.04)),
                  {tilt, {0.0, 0.0, 0.2}});
  double lowest = 1.0;
  for (const double x : {-0.01, 0.01}) {
    for (const double y : {-0.015, 0.015}) {
      for (const double z : {-0.02, 0.02})
        lowest = std::min(lowest, (tilt * glm::dvec3(x, y, z)).z);
    }
  }
  expectContact(pair, pair.drop(kDown), kDown, 0.2 + lowest - 0.01);
}

TEST(Drop, EdgeMeetsEdge) {
  // Two bars crossed, each standing on an edge: 45 degrees about its axis.
  const glm::dquat onEdgeX = glm::angleAxis(kPi / 4.0, glm::dvec3(1, 0, 0));
  const glm::dquat onEdgeY = glm::angleAxis(kPi / 4.0, glm::dvec3(0, 1, 0));
  const Pair pair(boxMesh({0.2, 0.02, 0.02}), {onEdgeX, {0, 0, 0}}, boxMesh({0.02, 0.2, 0.02}),
                  {onEdgeY, {0.003, 0.002, 0.1}});
  const double half = 0.01 * std::sqrt(2.0);
  const DropResult result = pair.drop(kDown);
  expectContact(pair, result, kDown, 0.1 - 2.0 * half);
  EXPECT_NEAR(result.normal.z, 1.0, 1e-12);
}

TEST(Drop, SphereOfFacetsLandsOnItsPoleAndCylinderInTheBore) {
  const Pair ball(boxMesh(glm::dvec3(0.1)), {}, test::uvSphereMesh(0.02, 24, 12),
                  {{1, 0, 0, 0}, {0.013, 0.01, 0.3}});
  expectContact(ball, ball.drop(kDown), kDown, 0.3 - 0.05 - 0.02);
  // A pin above a tube that is wider goes through it; one that is wider stops on it.
  const Pair through(test::tubeMesh(0.02, 0.04, 0.05, 64), {}, test::cylinderMesh(0.0195, 0.02, 64),
                     {{1, 0, 0, 0}, {0, 0, 0.2}});
  EXPECT_EQ(through.drop(kDown).outcome, DropResult::Outcome::NothingMet);
  const Pair onto(test::tubeMesh(0.02, 0.04, 0.05, 64), {}, test::cylinderMesh(0.0205, 0.02, 64),
                  {{1, 0, 0, 0}, {0, 0, 0.2}});
  expectContact(onto, onto.drop(kDown), kDown, 0.2 - 0.025 - 0.01);
}

TEST(Drop, TorusOnTorusTouchesAtTheTopOfTheTube) {
  // Coaxial and of equal facets: the uppermost ring of one on the lowest of the other.
  const Pair pair(test::torusMesh(0.05, 0.01, 32, 16), {}, test::torusMesh(0.05, 0.01, 32, 16),
                  {{1, 0, 0, 0}, {0, 0, 0.1}});
  expectContact(pair, pair.drop(kDown), kDown, 0.08);
}

TEST(Drop, GrazingPassesWhatItDoesNotTouchAndStopsAtWhatItDoes) {
  const auto pairAt = [](double x) {
    return Pair(boxMesh(glm::dvec3(0.04)), {}, boxMesh(glm::dvec3(0.02)), {{1, 0, 0, 0}, {x, 0.0, 0.1}});
  };
  EXPECT_EQ(pairAt(0.03 + 1e-9).drop(kDown).outcome, DropResult::Outcome::NothingMet);
  const Pair stopped = pairAt(0.03 - 1e-9);
  expectContact(stopped, stopped.drop(kDown), kDown, 0.07);
  EXPECT_EQ(pairAt(0.0).drop(-kDown).outcome, DropResult::Outcome::NothingMet);
}

TEST(Drop, SlidesAlongAFloorThatItLiesOn) {
  // Down first, then sideways: the floor a gap below is not in the way, the wall is.
  Scene scene;
  scene.add(partOf(test::geometryOf(boxMesh({1.0, 1.0, 0.1}, {0, 0, -0.05})), "floor"));
  const PartId wall = scene.add(partOf(test::geometryOf(boxMesh({0.1, 1.0, 0.2}, {0.45, 0, 0.101})), "wall"));
  const PartId moving = scene.add(
      partOf(test::geometryOf(boxMesh(glm::dvec3(0.02))), "moving", {{1, 0, 0, 0}, {0.0, 0.0, 0.08}}));
  const PartId moved[] = {moving};
  const DropResult down = dropParts(scene, moved, {kDown, 0.0});
  ASSERT_EQ(down.outcome, DropResult::Outcome::Contact);
  Part part = *scene.find(moving);
  part.worldFromPart.translation += down.shift;
  scene.replace(part);
  const DropResult along = dropParts(scene, moved, {{1, 0, 0}, 0.0});
  ASSERT_EQ(along.outcome, DropResult::Outcome::Contact);
  EXPECT_EQ(along.against, wall);
  EXPECT_NEAR(along.travel + along.gap, 0.39, 1e-12);
  // Once more: it is there already.
  const DropResult again = dropParts(scene, moved, {kDown, 0.0});
  EXPECT_LT(again.travel, 2e-6);
}

TEST(Drop, StartingOverlappedIsSaidAndNothingMoves) {
  const Pair pair(boxMesh(glm::dvec3(0.04)), {}, boxMesh(glm::dvec3(0.02)), {{1, 0, 0, 0}, {0, 0, 0.025}});
  const DropResult result = pair.drop(kDown);
  EXPECT_EQ(result.outcome, DropResult::Outcome::Overlapping);
  EXPECT_EQ(result.against, pair.fixed);
  EXPECT_EQ(result.shift, glm::dvec3(0.0));
  // Wholly inside, no surfaces meet.
  const Pair inside(boxMesh(glm::dvec3(0.04)), {}, boxMesh(glm::dvec3(0.02)), {});
  EXPECT_EQ(inside.drop(kDown).outcome, DropResult::Outcome::Overlapping);
}

TEST(Drop, HiddenPartsAreNotInTheWayAndLockedOnesDoNotMove) {
  Pair pair(boxMesh(glm::dvec3(0.04)), {}, boxMesh(glm::dvec3(0.02)), {{1, 0, 0, 0}, {0, 0, 0.1}});
  Part fixed = *pair.scene.find(pair.fixed);
  fixed.isVisible = false;
  pair.scene.replace(fixed);
  EXPECT_EQ(pair.drop(kDown).outcome, DropResult::Outcome::NothingMet);
  Part moving = *pair.scene.find(pair.moving);
  moving.isLocked = true;
  pair.scene.replace(moving);
  EXPECT_THROW(pair.drop(kDown), UsageError);
  EXPECT_THROW(pair.drop(glm::dvec3(0.0)), UsageError);
  EXPECT_THROW(pair.drop(kDown, -1.0), UsageError);
}

TEST(Drop, SeveralPartsGoTogetherAndDoNotHinderEachOther) {
  Scene scene;
  const PartId floor = scene.add(partOf(test::geometryOf(boxMesh({1.0, 1.0, 0.1}, {0, 0, -0.05})), "floor"));
  const auto cube = test::geometryOf(boxMesh(glm::dvec3(0.02)));
  const PartId moved[] = {scene.add(partOf(cube, "low", {{1, 0, 0, 0}, {0, 0, 0.05}})),
                          scene.add(partOf(cube, "high", {{1, 0, 0, 0}, {0, 0, 0.08}}))};
  const DropResult result = dropParts(scene, moved, {kDown, 0.0});
  ASSERT_EQ(result.outcome, DropResult::Outcome::Contact);
  EXPECT_EQ(result.moved, moved[0]);
  EXPECT_EQ(result.against, floor);
  EXPECT_NEAR(result.travel + result.gap, 0.04, 1e-12);
}

TEST(Drop, RandomBodiesStopWhereConservativeAdvancementDoes) {
  std::mt19937_64 random(3);
  int contacts = 0;
  for (int i = 0; i < 60; ++i) {
    const TriangleMesh meshes[] = {test::starMesh(random(), 0.05, 2, 0.4),
                                   test::torusMesh(0.05, 0.015, 24, 12), boxMesh({0.03, 0.06, 0.09}),
                                   test::cylinderMesh(0.03, 0.05, 24)};
    const glm::dvec3 direction = randomDirection(random);
    const glm::dvec3 aside = 0.05 * randomDirection(random);
    const glm::dvec3 origin = 100.0 * uniform(random) * randomDirection(random);
    Pair pair(meshes[random() % 4], {randomRotation(random), origin}, meshes[random() % 4],
              {randomRotation(random), origin + aside - 0.3 * direction});
    const DropResult result = pair.drop(direction);
    const double expected = advancedConservatively(pair, direction, 1e-8, 0.7);
    if (!std::isfinite(expected)) {
      EXPECT_EQ(result.outcome, DropResult::Outcome::NothingMet) << i;
      continue;
    }
    ++contacts;
    ASSERT_EQ(result.outcome, DropResult::Outcome::Contact) << i;
    const double contact = result.travel + result.gap;
    // It stops where 10 nm are left: how far that is on the way depends on the angle.
    EXPECT_GE(contact, expected - 1e-12) << i;
    EXPECT_LE(contact - expected, 1e-6) << i;
    EXPECT_FALSE(pair.meets(result.shift)) << i;
    EXPECT_TRUE(pair.meets((contact + 1e-9) * direction)) << i;
    EXPECT_LT(glm::dot(result.normal, direction), 0.0) << i;
  }
  EXPECT_GT(contacts, 30);
}

TEST(Drop, CanBeCancelled) {
  const Pair pair(test::icosphereMesh(0.05, 4), {}, test::icosphereMesh(0.05, 4),
                  {{1, 0, 0, 0}, {0, 0, 0.3}});
  const PartId moved[] = {pair.moving};
  EXPECT_THROW(dropParts(pair.scene, moved, {kDown, 0.0}, [](double) { return false; }), Cancelled);
  double last = 0.0;
  dropParts(pair.scene, moved, {kDown, 0.0}, [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  });
  EXPECT_EQ(last, 1.0);
}

TEST(Drop, APartGoesAlongWhatItsJointsAllowOfTheDirection) {
  Pair pair(boxMesh({4.0, 4.0, 1.0}, {0.0, 0.0, -0.5}), {}, boxMesh({0.2, 0.2, 0.2}),
            {{1, 0, 0, 0}, {0.0, 0.0, 1.0}});
  Joint joint;
  joint.part = pair.moving;
  pair.scene.addJoint(joint);
  const DropResult drop = pair.drop({3.0, 0.0, -1.0});
  EXPECT_EQ(drop.outcome, DropResult::Outcome::Contact);
  EXPECT_NEAR(drop.shift.x, 0.0, 1e-12);
  EXPECT_NEAR(drop.shift.z, -0.9, 1e-5);
  EXPECT_THROW(pair.drop({1.0, 0.0, 0.0}), UsageError) << "the axis holds it";
}

}  // namespace
}  // namespace nearfit::drop_test

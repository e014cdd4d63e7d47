#include "core/haptics/workspace_mapper.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/math/rotation_vector.h"
#include "tests/support/random_values.h"

namespace nearfit::workspace_mapper_test {
namespace {

using std::numbers::pi;
using test::RandomValues;

void expectSame(const RigidTransform& a, const RigidTransform& b) {
  EXPECT_EQ(a.rotation, b.rotation);
  EXPECT_EQ(a.translation, b.translation);
}

double turnDistance(const glm::dquat& a, const glm::dquat& b) {
  return glm::length(rotationVector(a * glm::conjugate(b)));
}

void expectNear(const RigidTransform& a, const RigidTransform& b, double tolerance) {
  EXPECT_NEAR(glm::distance(a.translation, b.translation), 0.0, tolerance);
  EXPECT_NEAR(turnDistance(a.rotation, b.rotation), 0.0, tolerance);
}

RigidTransform turnedAbout(const glm::dvec3& axis, double angle) {
  return {glm::angleAxis(angle, axis), {}};
}

const WorkspaceMapping kPlain;
const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

TEST(WorkspaceMapper, PlainMappingIsTheDevicesPoseBitForBit) {
  RandomValues random(1);
  WorkspaceMapper mapper;
  mapper.engage(random.pose());
  for (int i = 0; i < 1000; ++i) {
    const RigidTransform device = random.pose();
    expectSame(mapper.map(device, false, kPlain), device);
  }
}

TEST(WorkspaceMapper, WithoutEngagingItBeginsAtTheDevicesPose) {
  RandomValues random(2);
  const RigidTransform device = random.pose();
  WorkspaceMapper mapper;
  expectSame(mapper.map(device, false, kPlain), device);
  WorkspaceMapping scaled;
  scaled.scale = 3.0;
  WorkspaceMapper other;
  expectNear(other.map(device, false, scaled), device, 1e-15);
}

TEST(WorkspaceMapper, DeviceWithItsOwnFrameBeginsAtThePart) {
  RandomValues random(3);
  const RigidTransform device = random.pose(), part = random.pose();
  WorkspaceMapper mapper;
  mapper.engageAt(device, part);
  expectNear(mapper.map(device, false, kPlain), part, 1e-15);
  const glm::dvec3 shift(0.01, 0.02, 0.03), turn(0.1, -0.2, 0.3);
  const RigidTransform moved{rotationOf(turn) * device.rotation, device.translation + shift};
  expectNear(mapper.map(moved, false, kPlain), {rotationOf(turn) * part.rotation, part.translation + shift},
             1e-14);
}

TEST(WorkspaceMapper, PartTurnsAboutThePivot) {
  RandomValues random(10);
  const RigidTransform device = random.pose(), part = random.pose();
  const glm::dvec3 pivot(2.0, -1.0, 0.5), shift(0.01, 0.02, 0.03);
  WorkspaceMapping mapping;
  mapping.scale = 2.0;
  WorkspaceMapper mapper;
  mapper.engageAt(device, part, pivot);
  expectNear(mapper.map(device, false, mapping), part, 1e-14);
  const glm::dquat turn = rotationOf({0.5, -0.2, 0.3});
  const RigidTransform moved{turn * device.rotation, device.translation + shift};
  const RigidTransform handle = mapper.map(moved, false, mapping);
  EXPECT_NEAR(turnDistance(handle.rotation, turn * part.rotation), 0.0, 1e-14);
  EXPECT_NEAR(glm::distance(handle.applyToPoint(pivot), part.applyToPoint(pivot) + 2.0 * shift), 0.0, 1e-14);
}

TEST(WorkspaceMapper, ScaleMagnifiesTranslationOnlyFromWhereItBegan) {
  WorkspaceMapping mapping;
  mapping.scale = 4.0;
  const RigidTransform start{{1, 0, 0, 0}, {1, 2, 3}};
  WorkspaceMapper mapper;
  mapper.engage(start);
  const RigidTransform device{rotationOf({0, 0.5, 0}), {1.01, 2, 2.98}};
  expectNear(mapper.map(device, false, mapping), {device.rotation, {1.04, 2, 2.92}}, 1e-14);
}

TEST(WorkspaceMapper, OffsetTurnsBothTranslationAndRotation) {
  // The device's x is the world's y, its y the world's -x.
  WorkspaceMapping mapping;
  mapping.orientationOffset = glm::angleAxis(pi / 2.0, kZ);
  WorkspaceMapper mapper;
  mapper.engageAt({}, {{1, 0, 0, 0}, {5, 5, 5}});
  const RigidTransform device{glm::angleAxis(0.3, kX), {0.1, 0, 0}};
  expectNear(mapper.map(device, false, mapping), {glm::angleAxis(0.3, kY), {5, 5.1, 5}}, 1e-14);
}

TEST(WorkspaceMapper, ClutchHoldsTheHandleAndGoesOnWithoutAJump) {
  RandomValues random(4);
  WorkspaceMapper mapper;
  const RigidTransform start = random.pose();
  mapper.engage(start);
  const RigidTransform held = mapper.map(start, false, kPlain);
  RigidTransform device;
  for (int i = 0; i < 20; ++i) {
    device = random.pose();
    expectSame(mapper.map(device, true, kPlain), held);
  }
  expectNear(mapper.map(device, false, kPlain), held, 1e-15);
  const RigidTransform moved{glm::angleAxis(0.2, kX) * device.rotation, device.translation + kY};
  expectNear(mapper.map(moved, false, kPlain),
             {glm::angleAxis(0.2, kX) * held.rotation, held.translation + kY}, 1e-14);
}

TEST(WorkspaceMapper, ClutchFromTheFirstTickHoldsWhereItWasEngaged) {
  RandomValues random(5);
  const RigidTransform part = random.pose();
  WorkspaceMapper mapper;
  mapper.engageAt(random.pose(), part);
  expectSame(mapper.map(random.pose(), true, kPlain), part);
}

TEST(WorkspaceMapper, LockedTranslationStaysWhereItWasLocked) {
  WorkspaceMapper mapper;
  mapper.engage({});
  mapper.map({{1, 0, 0, 0}, {1, 1, 1}}, false, kPlain);
  WorkspaceMapping plane;
  plane.translationLocks = {false, false, true};
  const glm::dvec3 in = mapper.map({{1, 0, 0, 0}, {2, 3, 4}}, false, plane).translation;
  EXPECT_NEAR(glm::distance(in, {2, 3, 1}), 0.0, 1e-14);
  // Released: it goes on from where it is.
  const glm::dvec3 out = mapper.map({{1, 0, 0, 0}, {2, 3, 5}}, false, kPlain).translation;
  EXPECT_NEAR(glm::distance(out, {2, 3, 2}), 0.0, 1e-14);
}

TEST(WorkspaceMapper, LocksAreOfWorldAxesNotTheDevices) {
  WorkspaceMapping mapping;
  mapping.orientationOffset = glm::angleAxis(pi / 2.0, kZ);  // Device x is world y.
  mapping.translationLocks = {true, false, true};
  mapping.rotationLocks = {true, false, true};
  WorkspaceMapper mapper;
  mapper.engage({});
  expectNear(mapper.map({glm::angleAxis(0.4, kX), {0.1, 0, 0}}, false, mapping),
             {glm::angleAxis(0.4, kY), {0, 0.1, 0}}, 1e-14);
  expectNear(mapper.map({glm::angleAxis(0.4, kY), {0, 0.1, 0}}, false, mapping), {}, 1e-14);
}

TEST(WorkspaceMapper, AllRotationsLockedKeepTheOrientation) {
  RandomValues random(6);
  WorkspaceMapping mapping;
  mapping.rotationLocks = {true, true, true};
  const RigidTransform start = random.pose();
  WorkspaceMapper mapper;
  mapper.engage(start);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform device = random.pose();
    const RigidTransform handle = mapper.map(device, false, mapping);
    EXPECT_NEAR(turnDistance(handle.rotation, start.rotation), 0.0, 1e-14);
    EXPECT_NEAR(glm::distance(handle.translation, device.translation), 0.0, 1e-15);
  }
}

TEST(WorkspaceMapper, OneFreeAxisTurnsThroughManyRevolutions) {
  WorkspaceMapping mapping;
  mapping.rotationLocks = {true, true, false};
  WorkspaceMapper mapper;
  mapper.engage({});
  for (int i = 0; i <= 1000; ++i) {
    // A hand that wobbles while it winds a nut: only the winding counts.
    const double angle = 0.02 * i;
    const glm::dquat wobble = rotationOf({0.1 * std::sin(3.0 * angle), 0.1 * std::cos(2.0 * angle), 0.0});
    const RigidTransform handle = mapper.map({wobble * glm::angleAxis(angle, kZ), {}}, false, mapping);
    EXPECT_NEAR(std::hypot(handle.rotation.x, handle.rotation.y), 0.0, 1e-13);
    // A wobble without twist about z shifts the angle by no more than a fraction of its own square.
    EXPECT_LT(turnDistance(handle.rotation, glm::angleAxis(angle, kZ)), 0.02);
  }
}

TEST(WorkspaceMapper, OneLockedAxisLeavesTiltAsItIsAndTakesTheTwistOut) {
  WorkspaceMapping mapping;
  mapping.rotationLocks = {false, false, true};
  WorkspaceMapper mapper;
  mapper.engage({});
  const RigidTransform tilted{rotationOf({0.4, -0.3, 0.0}), {}};
  expectNear(mapper.map(tilted, false, mapping), tilted, 1e-14);
  const RigidTransform twisted{tilted.rotation * glm::angleAxis(1.0, kZ), {}};
  expectNear(mapper.map(twisted, false, mapping), tilted, 1e-14);
  expectNear(mapper.map(turnedAbout(kZ, 0.5), false, mapping), {}, 1e-14);
}

TEST(WorkspaceMapper, OneLockedAxisFollowsAFullRevolutionAboutAnother) {
  WorkspaceMapping mapping;
  mapping.rotationLocks = {false, false, true};
  WorkspaceMapper mapper;
  mapper.engage({});
  for (int i = 0; i <= 200; ++i) {
    const RigidTransform device = turnedAbout(kX, 0.05 * i);
    expectNear(mapper.map(device, false, mapping), device, 1e-12);
  }
}

TEST(WorkspaceMapper, ChangesOfTheMappingNeverMoveTheHandleOfADeviceAtRest) {
  RandomValues random(7);
  WorkspaceMapper mapper;
  const RigidTransform start = random.pose();
  mapper.engageAt(start, random.pose(), random.vector(0.5));
  RigidTransform device = start;
  RigidTransform last = mapper.map(device, false, kPlain);
  for (int i = 0; i < 2000; ++i) {
    WorkspaceMapping mapping;
    mapping.scale = random.in(0.1, 10.0);
    mapping.orientationOffset = rotationOf(random.vector(3.0));
    for (bool& lock : mapping.translationLocks)
      lock = random.flip(0.3);
    for (bool& lock : mapping.rotationLocks)
      lock = random.flip(0.3);
    const bool isClutched = random.flip(0.2);
    const RigidTransform handle = mapper.map(device, isClutched, mapping);
    expectNear(handle, last, 1e-13);
    device = {rotationOf(random.vector(1.0)) * device.rotation, random.vector(0.5)};
    last = mapper.map(device, isClutched, mapping);
    EXPECT_NEAR(glm::length(last.rotation), 1.0, 1e-14);
  }
}

TEST(WorkspaceMapper, SmallMotionsOfTheDeviceAreSmallOnesOfTheHandleUnderAnyLocks) {
  for (int locks = 0; locks < 8; ++locks) {
    RandomValues random(static_cast<unsigned>(100 + locks));
    WorkspaceMapping mapping;
    mapping.rotationLocks = {(locks & 1) != 0, (locks & 2) != 0, (locks & 4) != 0};
    WorkspaceMapper mapper;
    RigidTransform device = random.pose();
    mapper.engage(device);
    RigidTransform last = mapper.map(device, false, mapping);
    glm::dvec3 spin = random.vector(0.02);
    for (int i = 0; i < 20'000; ++i) {
      if (i % 100 == 0) spin = random.vector(0.02);
      device.rotation = glm::normalize(rotationOf(spin) * device.rotation);
      const RigidTransform handle = mapper.map(device, false, mapping);
      // Within a quarter turn of the index a twist changes no faster than 1 / cos(45 degrees) of the turn,
      // and what is left after it no faster than one more.
      ASSERT_LE(turnDistance(handle.rotation, last.rotation), 2.5 * glm::length(spin)) << locks << " " << i;
      last = handle;
    }
  }
}

TEST(WorkspaceMapper, JumpOfHalfATurnAcrossALockedAxisLeavesTheHandleUpright) {
  WorkspaceMapping mapping;
  mapping.rotationLocks = {true, true, false};
  WorkspaceMapper mapper;
  mapper.engage({});
  const RigidTransform handle = mapper.map(turnedAbout(kX, pi), false, mapping);
  EXPECT_TRUE(handle.isFinite());
  EXPECT_NEAR(std::hypot(handle.rotation.x, handle.rotation.y), 0.0, 1e-14);
  const RigidTransform next{glm::angleAxis(0.1, kZ) * glm::angleAxis(pi, kX), {}};
  EXPECT_NEAR(turnDistance(mapper.map(next, false, mapping).rotation, handle.rotation), 0.1, 1e-14);
}

TEST(WorkspaceMapper, PoseThatIsNotFiniteIsPassedOnAndLeavesNoTrace) {
  RandomValues random(8);
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
  WorkspaceMapping mapping;
  mapping.scale = 2.0;
  WorkspaceMapper mapper, undisturbed;
  const RigidTransform start = random.pose();
  mapper.engage(start);
  undisturbed.engage(start);
  for (int i = 0; i < 50; ++i) {
    RigidTransform broken = random.pose();
    broken.translation[i % 3] = bad[i % 2];
    EXPECT_FALSE(mapper.map(broken, i % 5 == 0, mapping).isFinite());
    const RigidTransform device = random.pose();
    expectSame(mapper.map(device, i % 5 == 0, mapping), undisturbed.map(device, i % 5 == 0, mapping));
  }
}

TEST(WorkspaceMapper, SenselessMappingIsShownAndForgotten) {
  WorkspaceMapping senseless;
  senseless.scale = std::numeric_limits<double>::quiet_NaN();
  WorkspaceMapper mapper;
  mapper.engage({});
  EXPECT_FALSE(mapper.map({}, false, senseless).isFinite());
  expectNear(mapper.map({{1, 0, 0, 0}, {0.1, 0, 0}}, false, kPlain), {{1, 0, 0, 0}, {0.1, 0, 0}}, 1e-15);
}

}  // namespace
}  // namespace nearfit::workspace_mapper_test

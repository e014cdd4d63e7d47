#include "core/placing/push.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/proximity/overlap/interference.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::push_test {
namespace {

using test::boxMesh;
using test::partOf;
using test::solidGeometryOf;

const glm::dvec3 kDown(0.0, 0.0, -1.0);

bool meets(const Scene& scene, PartId a, PartId b, const RigidTransform& worldFromB) {
  const Part &fixed = *scene.find(a), &moving = *scene.find(b);
  return findInterference(fixed.geometry->tree(), moving.geometry->tree(),
                          (fixed.worldFromPart.inverse() * worldFromB).normalized())
             .kind != InterferenceKind::Disjoint;
}

TEST(Push, BoxOnAFloorIsHeldWhereItTouches) {
  Scene scene;
  const PartId floor = scene.add(partOf(solidGeometryOf(boxMesh({0.2, 0.2, 0.02})), "floor"));
  const PartId box =
      scene.add(partOf(solidGeometryOf(boxMesh(glm::dvec3(0.02))), "box", {{1, 0, 0, 0}, {0.01, 0.0, 0.1}}));
  const PartId moved[] = {box};
  const PushResult result = pushParts(scene, moved, kDown);
  ASSERT_EQ(result.outcome, PushResult::Outcome::Held);
  EXPECT_EQ(result.against, std::vector{floor});
  const double margin = scene.haptics().proxy.margin;
  EXPECT_NEAR(result.poses[0].translation.z, 0.02, 1.1 * margin);
  EXPECT_NEAR(result.poses[0].translation.x, 0.01, 1e-4);
  EXPECT_FALSE(meets(scene, floor, box, result.poses[0]));
}

TEST(Push, BoxSlidesDownASlopeToTheStopWithoutTurning) {
  // A drop would stop at the first touch of the slope.
  const glm::dquat slope = glm::angleAxis(std::numbers::pi / 6.0, glm::dvec3(0, 1, 0));
  Scene scene;
  const PartId ramp = scene.add(partOf(solidGeometryOf(boxMesh({0.2, 0.1, 0.02})), "ramp", {slope, {}}));
  // Square to the ramp's end, which is at the lower side: +x.
  const glm::dvec3 end = slope * glm::dvec3(0.11, 0.0, 0.02);
  const PartId stop = scene.add(partOf(solidGeometryOf(boxMesh({0.02, 0.1, 0.1})), "stop", {slope, end}));
  const PartId box =
      scene.add(partOf(solidGeometryOf(boxMesh(glm::dvec3(0.02))), "box", {slope, {-0.02, 0.0, 0.15}}));
  const PartId moved[] = {box};
  const PushResult result = pushParts(scene, moved, kDown);
  ASSERT_EQ(result.outcome, PushResult::Outcome::Held);
  const glm::dvec3 inRamp = glm::conjugate(slope) * result.poses[0].translation;
  const double margin = scene.haptics().proxy.margin;
  EXPECT_NEAR(inRamp.x, 0.09, 3.0 * margin);
  EXPECT_NEAR(inRamp.z, 0.02, 3.0 * margin);
  EXPECT_NEAR(std::abs(glm::dot(result.poses[0].rotation, slope)), 1.0, 1e-9);
  EXPECT_FALSE(meets(scene, ramp, box, result.poses[0]));
  EXPECT_FALSE(meets(scene, stop, box, result.poses[0]));
}

TEST(Push, WhatBarsTheWayIsNamedFirst) {
  // On the floor, and pushed along it to the wall: the floor came first, as it does in the scene.
  Scene scene;
  scene.add(partOf(solidGeometryOf(boxMesh({0.4, 0.2, 0.02})), "floor"));
  const PartId wall = scene.add(
      partOf(solidGeometryOf(boxMesh({0.02, 0.2, 0.1})), "wall", {{1, 0, 0, 0}, {0.15, 0.0, 0.07}}));
  const PartId box =
      scene.add(partOf(solidGeometryOf(boxMesh(glm::dvec3(0.02))), "box", {{1, 0, 0, 0}, {0.0, 0.0, 0.1}}));
  const PartId moved[] = {box};
  const PushResult down = pushParts(scene, moved, kDown);
  ASSERT_EQ(down.outcome, PushResult::Outcome::Held);
  Part lying = *scene.find(box);
  lying.worldFromPart = down.poses[0];
  scene.replace(lying);
  const PushResult right = pushParts(scene, moved, {1.0, 0.0, 0.0});
  ASSERT_EQ(right.outcome, PushResult::Outcome::Held);
  ASSERT_FALSE(right.against.empty());
  EXPECT_EQ(right.against.front(), wall);
}

TEST(Push, WhatNothingHoldsStaysWhereItIs) {
  const glm::dquat slope = glm::angleAxis(std::numbers::pi / 6.0, glm::dvec3(0, 1, 0));
  Scene scene;
  scene.add(partOf(solidGeometryOf(boxMesh({0.1, 0.1, 0.02})), "ramp", {slope, {}}));
  const RigidTransform start{slope, {-0.02, 0.0, 0.1}};
  const PartId box = scene.add(partOf(solidGeometryOf(boxMesh(glm::dvec3(0.02))), "box", start));
  const PartId moved[] = {box};
  const PushResult past = pushParts(scene, moved, kDown);
  EXPECT_EQ(past.outcome, PushResult::Outcome::SlippedPast);
  EXPECT_EQ(past.poses[0].translation, start.translation);
  EXPECT_EQ(pushParts(scene, moved, -kDown).outcome, PushResult::Outcome::NothingMet);
  EXPECT_THROW(pushParts(scene, moved, kDown, [](double) { return false; }), Cancelled);
}

TEST(Push, StartingOverlappedIsSaid) {
  Scene scene;
  const PartId floor = scene.add(partOf(solidGeometryOf(boxMesh(glm::dvec3(0.1))), "floor"));
  const PartId box = scene.add(partOf(solidGeometryOf(boxMesh(glm::dvec3(0.02))), "box"));
  const PartId moved[] = {box};
  const PushResult result = pushParts(scene, moved, kDown);
  EXPECT_EQ(result.outcome, PushResult::Outcome::Overlapping);
  EXPECT_EQ(result.against, std::vector{floor});
}

TEST(Push, APartOnAnAxisIsPushedAlongIt) {
  Scene scene;
  const PartId floor = scene.add(partOf(solidGeometryOf(boxMesh({0.2, 0.2, 0.02})), "floor"));
  const PartId box =
      scene.add(partOf(solidGeometryOf(boxMesh(glm::dvec3(0.02))), "box", {{1, 0, 0, 0}, {0.01, 0.0, 0.1}}));
  Joint joint;
  joint.part = box;
  joint.onBase.point.x = 0.01;
  scene.addJoint(joint);
  const PartId moved[] = {box};
  const PushResult result = pushParts(scene, moved, {2.0, 1.0, -1.0});
  ASSERT_EQ(result.outcome, PushResult::Outcome::Held);
  EXPECT_EQ(result.against, std::vector{floor});
  EXPECT_NEAR(result.poses[0].translation.x, 0.01, 1e-9);
  EXPECT_NEAR(result.poses[0].translation.y, 0.0, 1e-9);
  EXPECT_NEAR(result.poses[0].translation.z, 0.02, 1.1 * scene.haptics().proxy.margin);
  EXPECT_THROW(pushParts(scene, moved, {1.0, 0.0, 0.0}), UsageError);
}

}  // namespace
}  // namespace nearfit::push_test

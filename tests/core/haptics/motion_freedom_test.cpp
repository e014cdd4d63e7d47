#include "core/haptics/motion_freedom.h"

#include <gtest/gtest.h>

#include "core/haptics/workspace_mapper.h"

namespace nearfit::motion_freedom_test {
namespace {

TEST(MotionFreedom, EachIsFoundAgainInItsLocks) {
  for (int i = 0; i < kMotionFreedoms - 1; ++i) {
    const auto freedom = static_cast<MotionFreedom>(i);
    WorkspaceMapping mapping;
    mapping.scale = 2.5;
    const WorkspaceMapping locked = withFreedom(mapping, freedom);
    EXPECT_EQ(freedomOf(locked), freedom) << i;
    EXPECT_EQ(locked.scale, 2.5);
  }
}

TEST(MotionFreedom, OtherLeavesTheLocksThatThereAre) {
  WorkspaceMapping mapping;
  mapping.translationLocks = {true, false, false};
  EXPECT_EQ(freedomOf(mapping), MotionFreedom::Other);
  EXPECT_EQ(withFreedom(mapping, MotionFreedom::Other), mapping);
}

/// Where the mapper takes a hand that goes everywhere and turns about everything.
RigidTransform ledWith(MotionFreedom freedom) {
  const RigidTransform start;
  const glm::dquat turn = glm::angleAxis(0.3, glm::normalize(glm::dvec3(1, 2, 3)));
  WorkspaceMapper mapper;
  mapper.engage(start);
  return mapper.map({turn, {0.1, 0.2, 0.3}}, false, withFreedom({}, freedom));
}

TEST(MotionFreedom, InAPlaneTheHandStaysInItAndTurnsAboutItsNormal) {
  const RigidTransform led = ledWith(MotionFreedom::PlaneXy);
  EXPECT_EQ(led.translation, glm::dvec3(0.1, 0.2, 0.0));
  EXPECT_NEAR(led.rotation.x, 0.0, 1e-15);
  EXPECT_NEAR(led.rotation.y, 0.0, 1e-15);
  EXPECT_GT(led.rotation.z, 0.05);
}

TEST(MotionFreedom, AlongAnAxisItOnlySlides) {
  const RigidTransform led = ledWith(MotionFreedom::AlongY);
  EXPECT_EQ(led.translation, glm::dvec3(0.0, 0.2, 0.0));
  EXPECT_NEAR(led.rotation.w, 1.0, 1e-15);
}

}  // namespace
}  // namespace nearfit::motion_freedom_test

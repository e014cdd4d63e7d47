#include "tests/stress/stress_scene.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/exact/pose_certifier.h"

namespace nearfit::stress::stress_scene_test {
namespace {

TEST(StressScene, EachGeneratedOneBeginsFreeAndOnItsSide) {
  for (const StressEntry& entry : stressScenes({})) {
    const StressScene scene = entry.make();
    const ServoScene& servo = *scene.scene;
    for (const ServoScene::Body& body : servo.bodies) {
      const test::PoseCertifier certifier(body.geometry->mesh, servo.moving.geometry->mesh);
      EXPECT_FALSE(certifier.doMeet(body.worldFromPart.inverse() * servo.moving.worldFromPart)) << entry.name;
    }
    EXPECT_TRUE(!scene.isKept || scene.isKept(servo.moving.worldFromPart)) << entry.name;
  }
}

TEST(StressScene, RingsPulledApartAreNoMoreLinked) {
  for (const glm::dvec3 offset : {glm::dvec3(0.0), glm::dvec3(30.0, -20.0, 10.0)}) {
    const StressScene scene = linkedRings(0.1, 1e-4, {}, offset);
    const RigidTransform start = scene.scene->moving.worldFromPart;
    const auto shifted = [&](double x) {
      return scene.isKept({start.rotation, start.translation + glm::dvec3(x, 0.0, 0.0)});
    };
    EXPECT_TRUE(shifted(0.01));
    EXPECT_FALSE(shifted(0.05));
    EXPECT_FALSE(shifted(-0.08)) << "linked, but the other way round";
    // A half turn about the other ring's axis takes it there as it was linked.
    const RigidTransform middle{{1.0, 0.0, 0.0, 0.0}, offset}, half{{0.0, 0.0, 0.0, 1.0}, glm::dvec3(0.0)};
    EXPECT_TRUE(scene.isKept(middle * half * middle.inverse() * start));
  }
}

TEST(StressScene, ABallBesideItsBoxIsNotOnItsSide) {
  const std::vector<StressEntry> all = stressScenes({});
  for (const char* name : {"thin-wall", "sheet-box"}) {
    const StressScene scene = chosenScenes(all, {name}).front().make();
    RigidTransform pose = scene.scene->moving.worldFromPart;
    pose.translation = pose.translation.x > 0.0 ? glm::dvec3(0.0) : glm::dvec3(0.2, 0.0, 0.0);
    EXPECT_FALSE(scene.isKept(pose)) << name;
  }
  EXPECT_THROW(chosenScenes(all, {"no-such"}), UsageError);
}

}  // namespace
}  // namespace nearfit::stress::stress_scene_test

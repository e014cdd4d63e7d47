#include "core/placing/keep.h"

#include <cmath>
#include <memory>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/placing/jointed_motion.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::keep_test {
namespace {

Part cubeAt(const std::string& name, const RigidTransform& worldFromPart) {
  Part part;
  part.name = name;
  part.worldFromPart = worldFromPart;
  part.geometry =
      std::make_shared<PartGeometry>(PartGeometry{"", "", 1.0, test::boxMesh(glm::dvec3(0.02)), {}, {}});
  return part;
}

/// A base that stands askew, and a part elsewhere.
struct KeepBench {
  RigidTransform worldFromBase{glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3))), {0.1, -0.2, 0.3}};
  RigidTransform worldFromPart{glm::angleAxis(-0.4, glm::normalize(glm::dvec3(3, 1, -2))), {-0.1, 0.1, 0}};
  Scene scene;
  PartId base = scene.add(cubeAt("base", worldFromBase)), part = scene.add(cubeAt("part", worldFromPart));

  Joint joint(JointKind kind, const AlignFeature& onPart, const AlignFeature& onBase,
              double gap = 0.0) const {
    return jointBetween(kind, {part, onPart, worldFromPart}, {base, onBase, worldFromBase}, gap);
  }
};

const AlignFeature kAxisX{FeatureShape::Axis, {0.0, 0.01, 0.0}, {1, 0, 0}};
const AlignFeature kAxisZ{FeatureShape::Circle, {0.01, 0.0, 0.0}, {0, 0, 1}, 0.005};
const AlignFeature kTop{FeatureShape::Plane, {0.0, 0.0, 0.01}, {0, 0, 1}};
const AlignFeature kSide{FeatureShape::Plane, {0.01, 0.0, 0.0}, {1, 0, 0}};
const AlignFeature kCorner{FeatureShape::Point, {0.01, 0.01, 0.01}};

TEST(Keep, OnlyFeaturesOfOneKindAreKept) {
  using enum FeatureShape;
  EXPECT_EQ(jointKindOf(Axis, Circle), JointKind::OnAxis);
  EXPECT_EQ(jointKindOf(Circle, Circle), JointKind::OnAxis);
  EXPECT_EQ(jointKindOf(Plane, Plane), JointKind::InPlane);
  EXPECT_EQ(jointKindOf(Point, Point), JointKind::ToPoint);
  for (const FeatureShape shape : {Axis, Circle, Point})
    EXPECT_EQ(jointKindOf(Plane, shape), std::nullopt);
  EXPECT_EQ(jointKindOf(Axis, Point), std::nullopt);
}

TEST(Keep, OnAnAxisThePartsAxisLiesOnThatOfTheBase) {
  const KeepBench bench;
  const Joint joint = bench.joint(JointKind::OnAxis, kAxisX, kAxisZ);
  const RigidTransform pose = keptPose(bench.scene, joint, bench.worldFromPart).value();
  for (const double along : {-0.3, 0.0, 0.4}) {
    const glm::dvec3 point = pose.applyToPoint(kAxisX.point + along * kAxisX.direction);
    const glm::dvec3 inBase = bench.worldFromBase.inverse().applyToPoint(point);
    EXPECT_NEAR(std::hypot(inBase.x - 0.01, inBase.y), 0.0, 1e-12);
  }
}

TEST(Keep, InAPlaneTheFacesLookAtEachOtherAcrossTheGap) {
  const KeepBench bench;
  // Turned so that they look at each other already.
  KeepBench facing = bench;
  facing.worldFromPart.rotation = bench.worldFromBase.rotation * glm::angleAxis(3.0, glm::dvec3(1, 0, 0));
  const Joint joint = facing.joint(JointKind::InPlane, kTop, kTop, 0.004);
  const RigidTransform pose = keptPose(bench.scene, joint, facing.worldFromPart).value();
  const RigidTransform baseFromPart = bench.worldFromBase.inverse() * pose;
  EXPECT_NEAR(glm::distance(baseFromPart.applyToVector({0, 0, 1}), glm::dvec3(0, 0, -1)), 0.0, 1e-12);
  EXPECT_NEAR(baseFromPart.applyToPoint(kTop.point).z, 0.014, 1e-12);
}

TEST(Keep, FacesThatLookTheSameWayAreKeptSo) {
  KeepBench bench;
  bench.worldFromPart.rotation = bench.worldFromBase.rotation * glm::angleAxis(0.1, glm::dvec3(1, 0, 0));
  const Joint joint = bench.joint(JointKind::InPlane, kTop, kTop);
  const RigidTransform pose = keptPose(bench.scene, joint, bench.worldFromPart).value();
  const RigidTransform baseFromPart = bench.worldFromBase.inverse() * pose;
  EXPECT_NEAR(glm::distance(baseFromPart.applyToVector({0, 0, 1}), glm::dvec3(0, 0, 1)), 0.0, 1e-12);
  EXPECT_NEAR(baseFromPart.applyToPoint(kTop.point).z, 0.01, 1e-12);
}

TEST(Keep, AtAPointThePartOnlyShifts) {
  const KeepBench bench;
  const Joint joint = bench.joint(JointKind::ToPoint, kCorner, kCorner);
  const RigidTransform pose = keptPose(bench.scene, joint, bench.worldFromPart).value();
  EXPECT_EQ(pose.rotation, bench.worldFromPart.rotation);
  const glm::dvec3 corner = bench.worldFromBase.applyToPoint(kCorner.point);
  EXPECT_NEAR(glm::distance(pose.applyToPoint(kCorner.point), corner), 0.0, 1e-12);
}

TEST(Keep, JointsThatContradictEachOtherGiveNoPose) {
  KeepBench bench;
  bench.scene.addJoint(bench.joint(JointKind::ToPoint, kCorner, kCorner));
  const AlignFeature other{FeatureShape::Point, {-0.01, -0.01, -0.01}};
  // The distance between the two points differs: 20 mm along each axis, and none.
  EXPECT_EQ(keptPose(bench.scene, bench.joint(JointKind::ToPoint, other, kCorner), bench.worldFromPart),
            std::nullopt);
  EXPECT_TRUE(keptPose(bench.scene, bench.joint(JointKind::ToPoint, other, other), bench.worldFromPart));
}

TEST(Keep, AJointIsViolatedOffItAndNotWhileItIsTurnedOff) {
  const KeepBench bench;
  Joint joint = bench.joint(JointKind::OnAxis, kAxisX, kAxisZ);
  RigidTransform pose = keptPose(bench.scene, joint, bench.worldFromPart).value();
  EXPECT_FALSE(isViolated(joint, bench.worldFromBase, pose));
  const glm::dvec3 across = bench.worldFromBase.applyToVector({1, 0, 0});
  pose.translation += 1e-6 * across;
  EXPECT_FALSE(isViolated(joint, bench.worldFromBase, pose)) << "within the misfit of picked features";
  pose.translation += 1e-4 * across;
  EXPECT_TRUE(isViolated(joint, bench.worldFromBase, pose));
  joint.isOn = false;
  EXPECT_FALSE(isViolated(joint, bench.worldFromBase, pose));
}

/// The part with its x axis on the z axis of the base.
struct AxisBench : KeepBench {
  AxisBench() {
    const Joint onAxis = joint(JointKind::OnAxis, kAxisX, kAxisZ);
    Part kept = scene.get(part);
    kept.worldFromPart = keptPose(scene, onAxis, worldFromPart).value();
    scene.replace(kept);
    scene.addJoint(onAxis);
    worldFromPart = kept.worldFromPart;
  }
  glm::dvec3 axis() const { return worldFromBase.applyToVector({0, 0, 1}); }
};

TEST(JointedMotion, WithoutJointsEveryMotionIsAsWanted) {
  const KeepBench bench;
  const JointedMotion motion(bench.scene, {bench.part});
  EXPECT_TRUE(motion.isFree());
  const RigidTransform wanted{glm::angleAxis(1.0, glm::dvec3(0, 1, 0)), {1, 2, 3}};
  EXPECT_EQ(motion.nearest(wanted).rotation, wanted.rotation);
  EXPECT_EQ(motion.nearest(wanted).translation, wanted.translation);
  EXPECT_FALSE(motion.areApart(wanted, {}));
}

TEST(JointedMotion, AShiftKeepsOnlyWhatIsAlongTheAxis) {
  const AxisBench bench;
  const JointedMotion motion(bench.scene, {bench.part});
  ASSERT_FALSE(motion.isFree());
  const glm::dvec3 across = bench.worldFromBase.applyToVector({0, 1, 0});
  const RigidTransform wanted{{1, 0, 0, 0}, 0.03 * bench.axis() + 0.05 * across};
  const RigidTransform reached = motion.nearest(wanted);
  EXPECT_NEAR(glm::distance(reached.translation, 0.03 * bench.axis()), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(reached.rotation.w), 1.0, 1e-12);
  EXPECT_TRUE(motion.areApart(wanted, reached));
  EXPECT_FALSE(motion.areApart(reached, motion.nearest(reached)));
}

TEST(JointedMotion, AShiftAcrossTheAxisIsNone) {
  const AxisBench bench;
  const glm::dvec3 across = bench.worldFromBase.applyToVector({0.6, 0.8, 0});
  const JointedMotion motion(bench.scene, {bench.part});
  const RigidTransform reached = motion.nearest({{1, 0, 0, 0}, 0.05 * across});
  EXPECT_EQ(reached.rotation, glm::dquat(1, 0, 0, 0));
  EXPECT_EQ(reached.translation, glm::dvec3(0.0));
}

TEST(JointedMotion, TheBaseTakesItsPartsAlong) {
  const AxisBench bench;
  const JointedMotion motion(bench.scene, {bench.base, bench.part});
  EXPECT_TRUE(motion.isFree());
}

TEST(JointedMotion, PartsMovedTogetherStayOnTheJointsOfAll) {
  AxisBench bench;
  // Another part beside it with its upper face in the plane of a side of the base: along y and z of the base.
  const PartId third = bench.scene.add(cubeAt("third", bench.worldFromBase));
  bench.scene.addJoint(jointBetween(JointKind::InPlane, {third, kSide, bench.worldFromBase},
                                    {bench.base, kSide, bench.worldFromBase}));
  const JointedMotion motion(bench.scene, {bench.part, third});
  const glm::dvec3 x = bench.worldFromBase.applyToVector({1, 0, 0});
  const glm::dvec3 y = bench.worldFromBase.applyToVector({0, 1, 0});
  const RigidTransform reached = motion.nearest({{1, 0, 0, 0}, 0.02 * bench.axis() + 0.01 * x + 0.03 * y});
  EXPECT_NEAR(glm::distance(reached.translation, 0.02 * bench.axis()), 0.0, 1e-9);
}

}  // namespace
}  // namespace nearfit::keep_test

#include "core/scene/moving_body.h"

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::moving_body_test {
namespace {

using ::testing::HasSubstr;

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

RigidTransform somewhere(std::mt19937_64& random) {
  std::uniform_real_distribution<> in(-1.0, 1.0);
  const glm::dvec3 axis = glm::normalize(glm::dvec3(in(random), in(random), 1.1));
  return {glm::angleAxis(std::numbers::pi * in(random), axis), {in(random), in(random), in(random)}};
}

/// Two boxes in a group, the second aside and turned, and a floor.
class MovingBodyOfTwo : public testing::Test {
 protected:
  MovingBodyOfTwo() {
    floor_ = scene_.add(test::partOf(test::solidGeometryOf(test::boxMesh({2, 2, 0.1})), "Floor"));
    group_ = scene_.addGroup({{}, "Pair", {}, false});
    Part part = test::partOf(test::solidGeometryOf(firstMesh()), "First", at({0.0, 0.0, 0.5}));
    part.group = group_;
    first_ = scene_.add(part);
    part = test::partOf(test::solidGeometryOf(secondMesh()), "Second",
                        scene_.get(first_).worldFromPart * firstFromSecond());
    part.group = group_;
    second_ = scene_.add(part);
    scene_.setMovingGroup(group_);
  }
  static TriangleMesh firstMesh() { return test::boxMesh({0.1, 0.2, 0.3}); }
  static TriangleMesh secondMesh() { return test::subdivided(test::boxMesh({0.2, 0.1, 0.1}), 2); }
  static RigidTransform firstFromSecond() {
    return {glm::angleAxis(0.5, glm::dvec3(0, 0, 1)), {0.3, 0.05, -0.1}};
  }
  template <class Change>
  void change(PartId id, Change&& change) {
    Part part = scene_.get(id);
    change(part);
    scene_.replace(part);
  }

  Scene scene_;
  GroupId group_{};
  PartId floor_{}, first_{}, second_{};
};

TEST_F(MovingBodyOfTwo, HasTheMassOfBothMeshesInOne) {
  for (const PartId id : {first_, second_})
    change(id, [](Part& part) { part.density = 2500.0; });
  const MassProperties whole =
      massProperties(test::joined(firstMesh(), test::transformed(secondMesh(), 1.0, firstFromSecond())));
  const MovingMass mass = massOfMoving(scene_);
  EXPECT_NEAR(mass.mass, 2500.0 * whole.volume, 1e-12 * mass.mass);
  EXPECT_NEAR(mass.properties.volume, whole.volume, 1e-15);
  EXPECT_NEAR(glm::distance(mass.properties.centre, whole.centre), 0.0, 1e-12);
  EXPECT_EQ(mass.properties.basis, MassBasis::VolumeIntegrals);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(glm::distance(mass.properties.inertia[i], whole.inertia[i]), 0.0, 1e-15);
  EXPECT_EQ(movingBody(scene_).mass, mass.mass);
}

TEST_F(MovingBodyOfTwo, WeighsItsPartsByTheirDensities) {
  change(first_, [](Part& part) { part.density = 3000.0; });
  change(second_, [](Part& part) {
    part.density = 1000.0;
    part.geometry = test::solidGeometryOf(firstMesh());
    part.worldFromPart = at({0.4, 0.0, 0.5});
  });
  const MovingMass mass = massOfMoving(scene_);
  const double volume = 0.1 * 0.2 * 0.3;
  EXPECT_NEAR(mass.mass, 4000.0 * volume, 1e-9);
  EXPECT_NEAR(glm::distance(mass.properties.centre, glm::dvec3(0.1, 0.0, 0.0)), 0.0, 1e-12);
  // About z: of each box by itself, and of 3 at 0.1 m and 1 at 0.3 m from the centre.
  const double own = volume * (0.1 * 0.1 + 0.2 * 0.2) / 12.0;
  const double expected = (3000.0 * (own + volume * 0.01) + 1000.0 * (own + volume * 0.09)) / 2000.0;
  EXPECT_NEAR(mass.properties.inertia[2][2], expected, 1e-15);
}

TEST_F(MovingBodyOfTwo, ItsMeshIsThatOfBothAndSharesNoVertices) {
  const MovingBody body = movingBody(scene_);
  EXPECT_EQ(body.id, first_);
  EXPECT_TRUE(body.isVisible);
  EXPECT_EQ(body.geometry->mesh.vertices().size(),
            firstMesh().vertices().size() + secondMesh().vertices().size());
  EXPECT_EQ(body.geometry->mesh.topology().components, 2U);
  ASSERT_EQ(body.members.size(), 2U);
  // Flats are merged as for each part alone: a box has 8 corners and 12 triangles, however finely it is cut.
  EXPECT_EQ(body.members[0].id, first_);
  EXPECT_EQ(body.members[0].vertexEnd, 8U);
  EXPECT_EQ(body.members[0].triangleEnd, 12U);
  EXPECT_EQ(body.members[1].id, second_);
  EXPECT_EQ(body.members[1].vertexEnd, 16U);
  EXPECT_EQ(body.members[1].triangleEnd, 24U);
  EXPECT_EQ(body.geometry->tree().mesh().triangles().size(), 24U);
}

TEST_F(MovingBodyOfTwo, PartsThatTouchStayApart) {
  change(second_, [this](Part& part) {
    part.geometry = scene_.get(first_).geometry;
    part.worldFromPart = at({0.1, 0.0, 0.5});
  });
  const MovingBody body = movingBody(scene_);
  EXPECT_EQ(body.geometry->mesh.topology().components, 2U);
  EXPECT_TRUE(body.geometry->mesh.topology().isClosed());
  EXPECT_EQ(body.geometry->tree().mesh().topology().components, 2U);
}

TEST_F(MovingBodyOfTwo, IsMadeOnceAndKeptWhereverTheGroupIs) {
  const auto hierarchy = movingBody(scene_).geometry->hierarchy;
  std::mt19937_64 random(3);
  int same = 0;
  constexpr int kMoves = 50;
  for (int i = 0; i < kMoves; ++i) {
    for (const auto& [id, pose] : movedPoses(scene_, somewhere(random)))
      change(id, [&](Part& part) { part.worldFromPart = pose; });
    if (movingBody(scene_).geometry->hierarchy == hierarchy) ++same;
  }
  // A number may lie so near to the edge of a step that rounding takes it over; rarely.
  EXPECT_GT(same, kMoves / 2);
  change(second_, [](Part& part) { part.worldFromPart.translation.x += 1e-6; });
  EXPECT_NE(movingBody(scene_).geometry->hierarchy, hierarchy) << "another arrangement is another body";
}

TEST_F(MovingBodyOfTwo, IsReadyOnceItIsPrepared) {
  EXPECT_FALSE(isReadyToFeel(scene_));
  prepareHierarchies(scene_.geometries());
  EXPECT_FALSE(isReadyToFeel(scene_)) << "the group itself is still to be built";
  const Scene copy = scene_;
  prepareToFeel(copy);
  EXPECT_TRUE(isReadyToFeel(scene_)) << "copies share it";
  change(second_, [](Part& part) { part.worldFromPart.translation.x += 0.1; });
  EXPECT_FALSE(isReadyToFeel(scene_)) << "another arrangement";
}

TEST_F(MovingBodyOfTwo, HiddenPartsAreNotFelt) {
  change(second_, [](Part& part) { part.isVisible = false; });
  MovingBody body = movingBody(scene_);
  EXPECT_EQ(body.geometry, scene_.get(first_).geometry) << "the part that leads, as it is";
  EXPECT_TRUE(body.members.empty());
  EXPECT_EQ(body.mass, massOf(scene_.get(first_)));
  change(second_, [](Part& part) { part.isVisible = true; });
  change(first_, [](Part& part) { part.isVisible = false; });
  body = movingBody(scene_);
  EXPECT_EQ(body.id, first_) << "it leads, hidden or not";
  ASSERT_EQ(body.members.size(), 1U);
  EXPECT_EQ(body.members[0].id, second_);
  EXPECT_TRUE(body.isVisible);
  change(second_, [](Part& part) { part.isVisible = false; });
  EXPECT_FALSE(movingBody(scene_).isVisible);
}

TEST_F(MovingBodyOfTwo, ItsPartsMoveRigidlyAlong) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 100; ++i) {
    const RigidTransform pose = somewhere(random);
    const MovingPoses poses = movedPoses(scene_, pose);
    ASSERT_EQ(poses.size(), 2U);
    EXPECT_EQ(poses.at(first_).translation, pose.translation);
    EXPECT_EQ(poses.at(first_).rotation, pose.rotation);
    const glm::dvec3 p(0.1, -0.2, 0.3);
    const glm::dvec3 expected = pose.applyToPoint(firstFromSecond().applyToPoint(p));
    EXPECT_NEAR(glm::distance(poses.at(second_).applyToPoint(p), expected), 0.0, 1e-13);
  }
  const MovingPoses still = movedPoses(scene_, scene_.get(first_).worldFromPart);
  EXPECT_EQ(still.at(second_).translation, scene_.get(second_).worldFromPart.translation);
  EXPECT_EQ(still.at(second_).rotation, scene_.get(second_).worldFromPart.rotation);
}

TEST_F(MovingBodyOfTwo, ItsSizeIsThatOfTheBoxAroundAll) {
  change(second_, [](Part& part) {
    part.geometry = test::solidGeometryOf(firstMesh());
    part.worldFromPart = at({0.4, 0.0, 0.5});
  });
  EXPECT_NEAR(sizeOfMoving(scene_), glm::length(glm::dvec3(0.5, 0.2, 0.3)), 1e-12);
  EXPECT_EQ(sizeOfMoving(Scene()), 0.0);
}

TEST_F(MovingBodyOfTwo, OnlyJointsToTheOutsideHoldIt) {
  Joint joint;
  joint.kind = JointKind::ToPoint;
  joint.part = second_;
  joint.base = first_;
  scene_.addJoint(joint);
  EXPECT_TRUE(jointsOfMoving(scene_).isEmpty()) << "within the group it moves along";
  joint.base = floor_;
  joint.onPart.point = {0.01, 0.02, 0.03};
  joint.onBase.point = scene_.get(second_).worldFromPart.applyToPoint(joint.onPart.point);
  scene_.addJoint(joint);
  const JointSet joints = jointsOfMoving(scene_);
  EXPECT_EQ(joints.size(), 1U);
  EXPECT_NEAR(joints.residual(scene_.get(first_).worldFromPart).distance, 0.0, 1e-11);
  // Turned about the point, the group is still on it.
  const glm::dvec3 pin = joint.onBase.point;
  const glm::dquat turn = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3)));
  const RigidTransform about{turn, pin - turn * pin};
  EXPECT_NEAR(joints.residual(about * scene_.get(first_).worldFromPart).distance, 0.0, 1e-11);
  EXPECT_GT(joints.residual(at({0.0, 0.0, 0.6})).distance, 0.09);
}

TEST_F(MovingBodyOfTwo, TooManyJointsAreRefusedWithAWord) {
  Joint joint;
  joint.base = floor_;
  for (const PartId id : {first_, first_, second_, second_}) {
    joint.part = id;
    scene_.addJoint(joint);
  }
  try {
    jointsOfMoving(scene_);
    FAIL() << "four joints were taken";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("group \"Pair\""));
    EXPECT_THAT(error.what(), HasSubstr("4 joints keep its parts on others"));
  }
}

TEST(MovingBody, NothingInHandIsAnError) {
  EXPECT_THROW(movingBody(Scene()), UsageError);
  EXPECT_TRUE(movedPoses(Scene(), {}).empty());
  EXPECT_TRUE(jointsOfMoving(Scene()).isEmpty());
}

}  // namespace
}  // namespace nearfit::moving_body_test

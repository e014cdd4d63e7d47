// A group in hand: the servo moves it as one mesh.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/math/rotation_vector.h"
#include "core/scene/moving_body.h"
#include "core/servo/proxy.h"
#include "core/servo/scene_tracker.h"
#include "core/servo/servo_tick.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/lmd_oracle.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::group_in_hand_test {
namespace {

constexpr double kMargin = 1e-3;

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

/// Its sides are powers of two, so that sums of masses are exact in any order.
TriangleMesh block() {
  return test::boxMesh({0.125, 0.125, 0.0625});
}
const glm::dvec3 kApart(0.25, 0.0, 0.03125);

Scene floorOnly() {
  Scene scene;
  scene.add(test::partOf(test::solidGeometryOf(test::boxMesh({4, 4, 1}, {0, 0, -0.5})), "Floor"));
  scene.add(test::partOf(test::solidGeometryOf(test::boxMesh({0.05, 4, 0.4}, {0.5, 0, 0.2})), "Wall"));
  return scene;
}

/// Two blocks in one group.
Scene withGroup(const RigidTransform& pose) {
  Scene scene = floorOnly();
  const GroupId group = scene.addGroup({{}, "Blocks", {}, false});
  const PartGeometryPtr geometry = test::solidGeometryOf(block());
  for (const glm::dvec3& place : {glm::dvec3(0.0), kApart}) {
    Part part = test::partOf(geometry, "Block", pose * at(place));
    part.group = group;
    scene.add(part);
  }
  scene.setMovingGroup(group);
  return scene;
}

/// The same blocks as one mesh.
Scene withOneMesh(const RigidTransform& pose) {
  Scene scene = floorOnly();
  const TriangleMesh both = test::joined(block(), test::transformed(block(), 1.0, at(kApart)));
  scene.setMovingPart(scene.add(test::partOf(test::solidGeometryOf(both), "Blocks", pose)));
  return scene;
}

/// A proxy in a scene, tracked before each tick as the thread beside the servo does it.
struct Walk {
  explicit Walk(const Scene& of) : scene(makeServoScene(of)) {
    tracker.setScene(scene);
    proxy.place(scene->moving.worldFromPart);
  }
  const RigidTransform& lead(const RigidTransform& hand) {
    const SearchReach reach{20.0 * kMargin, kContactReach * kMargin};
    const ProxyAccount& last = proxy.account();
    tracker.update({proxy.pose(), std::nullopt, last.isWaiting, last.isStarved}, 1.0);
    if (tracker.isDue(reach)) tracker.refresh(reach, tracked);
    proxy.follow(tracked, hand, {kMargin, 0.0});
    return proxy.pose();
  }

  std::shared_ptr<const ServoScene> scene;
  SceneTracker tracker;
  TrackedScene tracked;
  Proxy proxy;
};

TEST(GroupInHand, MovesAsTheSingleMeshOfAllItsParts) {
  const RigidTransform start = at({0.0, 0.0, 0.25});
  Walk group(withGroup(start)), single(withOneMesh(start));
  EXPECT_EQ(group.scene->bodies.size(), 2U) << "its own parts are not among what it touches";
  double lowest = 1.0;
  for (int i = 0; i < 600; ++i) {
    // Down into the floor, a little tilted, and along it against the wall.
    const double down = std::min(1.0, i / 200.0), along = std::max(0.0, (i - 250) / 350.0);
    const RigidTransform hand{glm::angleAxis(0.05 * down, glm::dvec3(0, 1, 0)),
                              {0.3 * along, 0.0, 0.25 - 0.3 * down}};
    const RigidTransform a = group.lead(hand), b = single.lead(hand);
    ASSERT_NEAR(glm::distance(a.translation, b.translation), 0.0, 1e-12) << i;
    ASSERT_NEAR(glm::length(turnBetween(a.rotation, b.rotation)), 0.0, 1e-12) << i;
    lowest = std::min(lowest, a.translation.z);
  }
  EXPECT_LT(lowest, 0.1) << "it came down";
  EXPECT_GT(lowest, 0.0) << "and never into the floor";
  EXPECT_FALSE(group.proxy.contacts().empty());
}

TEST(GroupInHand, ItsMinimaAreThoseOfItsPartsAndSayWhose) {
  // Two jagged stones in a group, over a third.
  const TriangleMesh first = test::starMesh(1, 0.1, 1, 0.3), second = test::starMesh(2, 0.07, 1, 0.3),
                     other = test::starMesh(3, 0.15, 1, 0.3);
  const RigidTransform firstFromSecond{glm::angleAxis(0.5, glm::normalize(glm::dvec3(1, 1, 3))),
                                       {0.24, 0.03, -0.02}};
  Scene scene;
  const PartId rock = scene.add(test::partOf(test::solidGeometryOf(other), "Rock"));
  const GroupId group = scene.addGroup({{}, "Stones", {}, false});
  Part part = test::partOf(test::solidGeometryOf(first), "First");
  part.group = group;
  const PartId firstId = scene.add(part);
  part = test::partOf(test::solidGeometryOf(second), "Second", firstFromSecond);
  part.group = group;
  const PartId secondId = scene.add(part);
  scene.setMovingGroup(group);
  const auto servo = makeServoScene(scene);
  const NormalConeTree& tree = servo->moving.geometry->tree();
  const NormalConeTree& ofRock = scene.get(rock).geometry->tree();
  const test::OracleBody rockOracle(other), oracles[] = {test::OracleBody(first), test::OracleBody(second)};

  constexpr double kCutoff = 0.12, kMarginal = 1e-8, kAgreement = 1e-9;
  std::mt19937_64 random(7);
  std::size_t certain = 0;
  std::set<PartId> seen;
  for (std::size_t i = 0; i < 24; ++i) {
    RigidTransform rockFromFirst = test::randomRotation(random);
    // Beside the rock, so that each stone is near it now and then.
    rockFromFirst.translation = {0.05 * static_cast<double>(i % 5) - 0.2, 0.03, 0.27};
    const std::vector<Lmd> found = test::allLmds(ofRock, tree, rockFromFirst, kCutoff);
    std::vector<bool> isExpected(found.size(), false);
    for (const bool isFirst : {true, false}) {
      const RigidTransform pose = isFirst ? rockFromFirst : rockFromFirst * firstFromSecond;
      for (const test::OracleMinimum& minimum :
           test::bruteForceMinima(rockOracle, oracles[isFirst ? 0 : 1], pose, kCutoff, kMarginal)) {
        std::size_t times = 0;
        for (std::size_t k = 0; k < found.size(); ++k) {
          if (glm::distance(found[k].partPoint, minimum.partPoint) > kAgreement ||
              glm::distance(found[k].scenePoint, minimum.scenePoint) > kAgreement)
            continue;
          ++times;
          isExpected[k] = true;
          const PartId member = servo->memberAt(found[k].partFeature, found[k].partIndex);
          EXPECT_EQ(member, isFirst ? firstId : secondId);
          seen.insert(member);
        }
        if (minimum.slack <= kMarginal) continue;
        ++certain;
        EXPECT_EQ(times, 1U) << "pose " << i << ", distance " << minimum.distance;
      }
    }
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_TRUE(isExpected[k] || found[k].isRegion || found[k].isMarginal) << "pose " << i;
  }
  EXPECT_GT(certain, 20U);
  EXPECT_EQ(seen.size(), 2U) << "both stones had minima";
}

TEST(GroupInHand, ATickSaysWhichPartTouchesAndWhichIsNear) {
  const Scene scene = withGroup(at({0.0, 0.0, 0.25}));
  const PartId low = scene.parts()[2]->id, high = scene.parts()[3]->id;
  SceneTracker tracker;
  TrackedScene tracked;
  ServoTick tick;
  ServoParameters parameters;
  parameters.haptics.springs.cutoff = 0.1;
  parameters.haptics.proxy.margin = kMargin;
  const auto snapshot = std::make_unique<ServoSnapshot>();
  tracker.setScene(makeServoScene(scene));
  const SearchReach reach = searchReach(parameters.haptics);
  for (int i = 0; i < 400; ++i) {
    if (i > 0) tracker.update({snapshot->proxy, std::nullopt, snapshot->isWaiting, false}, 1.0);
    if (i == 0 || tracker.isDue(reach)) tracker.refresh(reach, tracked);
    // The first block hangs lower and comes to lie on the floor, pressed by a margin: more would tilt both.
    const RigidTransform hand = at({0.0, 0.0, std::max(0.03125, 0.25 - 0.001 * i)});
    tick.run(tracked, parameters, {.pose = hand}, 1e-3, *snapshot);
    ++snapshot->tick;
  }
  EXPECT_EQ(snapshot->moving, low);
  ASSERT_GT(snapshot->storedContacts, 0U);
  for (std::uint32_t i = 0; i < snapshot->storedContacts; ++i)
    EXPECT_EQ(snapshot->contacts[i].part, low);
  std::set<PartId> near;
  for (std::uint32_t i = 0; i < snapshot->storedLmds; ++i)
    near.insert(snapshot->lmds[i].part);
  EXPECT_TRUE(near.contains(low));
  EXPECT_TRUE(near.contains(high));
}

}  // namespace
}  // namespace nearfit::group_in_hand_test

#include "core/servo/scene_tracker.h"

#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/query/lmd_query.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/tick_observation.h"
#include "tests/support/trial_share.h"

namespace nearfit::scene_tracker_test {
namespace {

constexpr double kCutoff = 0.15;

using Sets = std::map<std::uint32_t, std::vector<glm::dvec3>>;

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

/// Several stars that stand about, two of them the same mesh, and one to be moved.
std::shared_ptr<ServoScene> starsAbout() {
  const PartGeometryPtr a = test::geometryOf(test::starMesh(71, 1.0, 2, 0.2));
  const PartGeometryPtr b = test::geometryOf(test::starMesh(72, 0.5, 2, 0.2));
  auto scene = std::make_shared<ServoScene>();
  scene->moving = {PartId{1}, test::geometryOf(test::starMesh(73, 0.4, 2, 0.2)), at({0.0, 0.0, 1.6})};
  scene->bodies = {{PartId{2}, a, at({0.0, 0.0, 0.0})},
                   {PartId{3}, b, at({1.5, 0.0, 1.0})},
                   {PartId{4}, a, at({0.0, 2.4, 1.2})},
                   {PartId{5}, b, at({50.0, 0.0, 0.0})}};
  return scene;
}

RigidTransform bodyFromPart(const ServoScene& scene, std::uint32_t body, const RigidTransform& pose) {
  return (scene.bodies[body].worldFromPart.inverse() * pose).normalized();
}

/// Points of the sets of all bodies, none skipped, by cold queries.
Sets coldSets(const ServoScene& scene, const RigidTransform& pose) {
  Sets sets;
  for (std::uint32_t body = 0; body < scene.bodies.size(); ++body) {
    const auto lmds = test::allLmds(scene.bodies[body].geometry->tree(), scene.moving.geometry->tree(),
                                    bodyFromPart(scene, body, pose), kCutoff);
    for (const Lmd& lmd : lmds)
      sets[body].push_back(lmd.scenePoint);
  }
  return sets;
}

/// The same as a tick finds them; counts the bodies whose list did not cover the pose.
Sets trackedSets(const TrackedScene& tracked, const RigidTransform& pose, std::size_t& late) {
  static LmdScratch scratch;
  static std::vector<Lmd> out(4096);
  Sets sets;
  tracked.visitNear(pose, kCutoff, [&](std::uint32_t body, const TrackedScene::Near* known) {
    const CandidateList* list = known != nullptr ? known->list.get() : nullptr;
    const RigidTransform relative = bodyFromPart(*tracked.scene, body, pose);
    std::optional<LmdResult> result;
    if (list != nullptr) result = list->query(relative, kCutoff, scratch, out);
    if (!result) {
      ++late;
      result = findLmds(tracked.scene->bodies[body].geometry->tree(), tracked.scene->moving.geometry->tree(),
                        relative, kCutoff, scratch, out);
    }
    for (std::size_t i = 0; i < result->count; ++i)
      sets[body].push_back(out[i].scenePoint);
  });
  return sets;
}

TEST(SceneTracker, NoMinimumOfAnyBodyIsMissedAlongAPathAndItsTeleports) {
  const std::shared_ptr<ServoScene> scene = starsAbout();
  SceneTracker tracker;
  tracker.setScene(scene);
  TrackedScene tracked;
  std::size_t late = 0, minima = 0, refreshes = 0, bodies = 0;
  constexpr int kTicks = 600 / static_cast<int>(test::kTrialShare);
  for (int tick = 0; tick < kTicks; ++tick) {
    const auto jumps = tick / 150;
    const double t = 0.004 * tick + static_cast<double>(jumps);
    const RigidTransform pose{glm::angleAxis(0.8 * t, glm::normalize(glm::dvec3(1, 1, 0))),
                              {0.9 * std::sin(t), 0.7 * std::sin(1.7 * t), 1.35 + 0.1 * std::cos(2.0 * t)}};
    if (tick == 0 || tracker.isDue({kCutoff})) {
      tracker.refresh({kCutoff}, tracked);
      ++refreshes;
    }
    const Sets expected = coldSets(*scene, pose);
    EXPECT_EQ(trackedSets(tracked, pose, late), expected) << tick;
    for (const auto& [body, points] : expected)
      minima += points.size();
    bodies += expected.size();
    tracker.update(test::partAt(pose), 1.0);
  }
  EXPECT_GT(minima, static_cast<std::size_t>(kTicks));
  EXPECT_GT(bodies, static_cast<std::size_t>(kTicks) / 2);
  EXPECT_LT(late, static_cast<std::size_t>(kTicks) / 4);
  EXPECT_LT(refreshes, static_cast<std::size_t>(kTicks) / 2);
}

TEST(SceneTracker, ABodyThatIsMovedOrAddedIsFeltFromTheNextTrackedSceneOn) {
  std::shared_ptr<ServoScene> scene = starsAbout();
  SceneTracker tracker;
  tracker.setScene(scene);
  const RigidTransform pose = at({0.0, 0.0, 1.5});
  tracker.update(test::partAt(pose), 1.0);
  TrackedScene tracked;
  tracker.refresh({kCutoff}, tracked);
  auto next = std::make_shared<ServoScene>(*scene);
  next->bodies[3].worldFromPart = at({0.0, 0.9, 1.6});
  next->bodies.push_back({PartId{9}, next->bodies[1].geometry, at({-0.9, 0.0, 1.6})});
  next->bodies.erase(next->bodies.begin());
  tracker.setScene(next);
  tracker.refresh({kCutoff}, tracked);
  std::size_t late = 0;
  const Sets expected = coldSets(*next, pose);
  EXPECT_GE(expected.size(), 2U);
  EXPECT_EQ(trackedSets(tracked, pose, late), expected);
  EXPECT_EQ(late, 0U);
}

TEST(SceneTracker, BodiesFarAwayAreNotLookedAtInATick) {
  auto scene = std::make_shared<ServoScene>();
  const PartGeometryPtr ball = test::geometryOf(test::icosphereMesh(0.4, 2));
  scene->moving = {PartId{1}, ball, at({0.0, 0.0, 0.0})};
  constexpr std::uint32_t kBodies = 10000;
  for (std::uint32_t i = 0; i < kBodies; ++i) {
    const std::uint32_t row = i / 100, column = i % 100;
    scene->bodies.push_back({PartId{10 + i}, ball, at({1.0 + column, static_cast<double>(row), 0.0})});
  }
  SceneTracker tracker;
  tracker.setScene(scene);
  const RigidTransform pose = at({0.1, 0.0, 0.0});
  tracker.update(test::partAt(pose), 1.0);
  TrackedScene tracked;
  tracker.refresh({kCutoff}, tracked);
  std::size_t visited = 0;
  tracked.visitNear(pose, kCutoff, [&](std::uint32_t, const TrackedScene::Near*) { ++visited; });
  EXPECT_GE(visited, 1U);
  EXPECT_LE(visited, 4U) << "the ball beside, and at most its own neighbours";
  // A tick that finds itself elsewhere looks no farther than the tree of boxes leads it.
  visited = 0;
  tracked.visitNear(at({50.5, 50.5, 0.0}), kCutoff,
                    [&](std::uint32_t, const TrackedScene::Near*) { ++visited; });
  EXPECT_GE(visited, 4U);
  EXPECT_LE(visited, 16U);
}

TEST(SceneTracker, WithNothingAnywhereNearThereIsNothingToDoForLong) {
  auto scene = std::make_shared<ServoScene>();
  scene->moving = {PartId{1}, test::geometryOf(test::icosphereMesh(0.4, 2)), at({0.0, 0.0, 0.0})};
  scene->bodies = {{PartId{2}, test::geometryOf(test::boxMesh({1, 1, 1})), at({100.0, 0.0, 0.0})}};
  SceneTracker tracker;
  tracker.setScene(scene);
  TrackedScene tracked;
  std::size_t refreshes = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    tracker.update(test::partAt(at({1e-3 * tick, 0.0, 0.0})), 1.0);
    if (!tracker.isDue({kCutoff})) continue;
    tracker.refresh({kCutoff}, tracked);
    EXPECT_TRUE(tracked.near.empty());
    ++refreshes;
  }
  EXPECT_LE(refreshes, 20U);
}

TEST(SceneTracker, AnotherCutoffIsSearchedAnew) {
  SceneTracker tracker;
  tracker.setScene(starsAbout());
  tracker.update(test::partAt(at({0.0, 0.0, 1.5})), 1.0);
  TrackedScene tracked;
  tracker.refresh({kCutoff}, tracked);
  EXPECT_FALSE(tracker.isDue({kCutoff}));
  EXPECT_TRUE(tracker.isDue({2.0 * kCutoff}));
  EXPECT_GT(tracked.spent(at({0.0, 0.0, 1.5}), 2.0 * kCutoff), 1.0);
}

TEST(SceneTracker, ABodyWhosePoseIsNoPoseStaysForTheTickToRefuse) {
  std::shared_ptr<ServoScene> scene = starsAbout();
  scene->bodies[3].worldFromPart.translation.x = std::numeric_limits<double>::quiet_NaN();
  SceneTracker tracker;
  tracker.setScene(scene);
  tracker.update(test::partAt(at({0.0, 0.0, 1.5})), 1.0);
  TrackedScene tracked;
  tracker.refresh({kCutoff}, tracked);
  std::vector<std::uint32_t> visited;
  tracked.visitNear(at({0.0, 0.0, 1.5}), kCutoff,
                    [&](std::uint32_t body, const TrackedScene::Near*) { visited.push_back(body); });
  EXPECT_NE(std::find(visited.begin(), visited.end(), 3U), visited.end());
}

}  // namespace
}  // namespace nearfit::scene_tracker_test

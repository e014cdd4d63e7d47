// A part that is near more pairs of features than a tick may search for goes on only with lists: an engaged
// nut once stood still on its bolt for what these tests hold, each by itself. Here a rod in a tube, ringed
// alike, which is turned.
#include <cmath>
#include <optional>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/servo/contact_finder.h"
#include "core/servo/proxy.h"
#include "core/servo/scene_tracker.h"
#include "tests/support/part_geometries.h"
#include "tests/support/ringed_pair.h"
#include "tests/support/tick_observation.h"

namespace nearfit::starved_part_test {
namespace {

constexpr double kMargin = 0.008;
constexpr double kReach = kContactReach * kMargin;

RigidTransform turnedBy(double angle) {
  return {glm::angleAxis(angle, glm::dvec3(0.0, 0.0, 1.0)), glm::dvec3(0.0)};
}

double angleOf(const RigidTransform& pose) {
  return 2.0 * std::atan2(pose.rotation.z, pose.rotation.w);
}

class StarvedRod : public testing::Test {
 protected:
  StarvedRod() {
    const test::RingedPair pair{.detail = 4};
    auto scene = std::make_shared<ServoScene>();
    scene->setMoving({PartId{1}, test::solidGeometryOf(pair.rod()), {}});
    scene->bodies.push_back({PartId{2}, test::solidGeometryOf(pair.tube()), {}});
    scene->prepareSurfaces();
    scene_ = scene;
    tracker_.setScene(scene);
  }

  /// Ticks at which the part is seen turning by so much each.
  void observe(int ticks, double rate) {
    for (int i = 0; i < ticks; ++i)
      tracker_.update(test::partAt(turnedBy(seen_ += rate)), 1.0);
  }
  TrackedScene refreshed() {
    TrackedScene tracked;
    tracker_.refresh(reach_, tracked);
    return tracked;
  }
  static bool holds(const TrackedScene& tracked, const RigidTransform& pose) {
    const CandidateList* list = tracked.near.at(0).contacts.get();
    return list != nullptr && list->spent(pose) <= 1.0;
  }

  SearchReach reach_{kReach, kReach};
  std::shared_ptr<const ServoScene> scene_;
  SceneTracker tracker_;
  double seen_ = 0.0;
};

TEST_F(StarvedRod, NoTickMaySearchForThePairsThatAreNearIt) {
  const NormalConeTree &tube = scene_->bodies[0].geometry->tree(), &rod = scene_->moving.geometry->tree();
  LmdScratch scratch(1);
  std::vector<LeafPair> pairs(1U << 16);
  const NearbyPairs nearby =
      findNearbyPairs({tube, rod, {}, kReach}, {kReach, contactTurn(kReach, scene_->metric.radius)}, {},
                      scratch, pairs, std::uint64_t{1} << 30U);
  EXPECT_TRUE(nearby.isComplete);
  EXPECT_GT(nearby.work, 2 * ContactFinder::kMaxSearchWork);
}

// Where it was free, nothing was said, and nothing was searched for.
TEST_F(StarvedRod, AFreeStepThatListsDoNotCoverIsToldToBeStarved) {
  const TrackedScene tracked = refreshed();
  Proxy proxy;
  proxy.place({});
  const ProxySettings settings{kMargin, 0.0};
  // Looking around takes several ticks.
  for (int i = 0; i < 20; ++i)
    proxy.follow(tracked, {}, settings);
  ASSERT_FALSE(proxy.account().isWaiting);
  // Among thousands of pairs it sees no farther than 1.5 margins.
  ASSERT_GT(proxy.distance(), 1.49 * kMargin) << "nothing is near";
  ASSERT_FALSE(holds(tracked, turnedBy(0.5)));
  for (int i = 0; i < 60; ++i)
    proxy.follow(tracked, turnedBy(0.5), settings);
  EXPECT_LT(angleOf(proxy.pose()), 0.4);
  EXPECT_TRUE(proxy.account().isStarved);
  // With lists renewed around it, it goes on, each time it is told.
  TrackedScene renewed = tracked;
  for (int i = 0; i < 240; ++i) {
    tracker_.update({proxy.pose(), turnedBy(0.5), false, proxy.account().isStarved}, 1.0);
    if (tracker_.isDue(reach_)) renewed = refreshed();
    proxy.follow(renewed, turnedBy(0.5), settings);
  }
  EXPECT_NEAR(angleOf(proxy.pose()), 0.5, 1e-3);
}

// For the way of a fast part there were too many pairs to list. Where there was no list, none was ever due.
TEST_F(StarvedRod, WhereThereWasNoListOneIsDueOnceItStarves) {
  reach_ = {5.0 * kReach, 5.0 * kReach};
  observe(40, 0.3);
  ASSERT_FALSE(refreshed().near.at(0).contacts);
  // It stands, and is looked at again until nothing is due any more.
  observe(40, 0.0);
  for (int i = 0; i < 8 && tracker_.isDue(reach_); ++i)
    refreshed();
  ASSERT_FALSE(tracker_.isDue(reach_));
  tracker_.update({turnedBy(seen_), std::nullopt, false, true}, 1.0);
  TrackedScene tracked;
  for (int i = 0; i < 20 && tracker_.isDue(reach_); ++i)
    tracked = refreshed();
  ASSERT_EQ(tracked.near.size(), 1U);
  EXPECT_TRUE(holds(tracked, turnedBy(seen_)));
}

// A part that waited was foretold to stand: each list held where it stood, and no way on.
TEST_F(StarvedRod, ListsOfOneThatWaitsHoldTheWayThatItsHandGoes) {
  constexpr double kRate = 0.02;
  constexpr int kLead = 3, kTicks = 40;
  for (const bool isHandSeen : {false, true}) {
    tracker_ = {};
    tracker_.setScene(scene_);
    for (int i = 0; i < kTicks; ++i) {
      std::optional<RigidTransform> hand;
      if (isHandSeen) hand = turnedBy(kRate * i);
      tracker_.update({{}, hand, false, i == kTicks - 1}, 1.0);
      tracker_.setLead(kLead);
    }
    const TrackedScene tracked = refreshed();
    EXPECT_EQ(holds(tracked, turnedBy(kRate * kLead)), isHandSeen);
  }
}

// A nut that was loose on its bolt had few contacts, but the searches for them took as long as where it was pressed: their
// lists ended before the next ones were there.
TEST_F(StarvedRod, WhereSearchesTakeLongListsServeLongAndFollowEachOther) {
  constexpr double kRate = 0.002, kLead = 20.0;
  const auto go = [&] {
    tracker_.update(test::partAt(turnedBy(seen_ += kRate)), 1.0);
    tracker_.setLead(kLead);
  };
  const auto isHeld = [&](const TrackedScene& tracked, int ticks) {
    return holds(tracked, turnedBy(seen_ + ticks * kRate));
  };
  for (int i = 0; i < 60; ++i)
    go();
  const TrackedScene first = refreshed();
  ASSERT_TRUE(first.near.at(0).contacts);
  EXPECT_EQ(first.near[0].contacts->cutoff(), kReach);
  EXPECT_GT(first.near[0].contacts->searchWork(), std::uint64_t{1} << 15U);
  go();
  const TrackedScene second = refreshed();
  ASSERT_TRUE(second.near.at(0).contacts);
  EXPECT_LT(second.near[0].contacts->cutoff(), kReach) << "it serves along the way";
  int end = 0;
  while (isHeld(second, end))
    ++end;
  EXPECT_GT(end, 2 * static_cast<int>(kLead));
  // It is renewed early enough to be used to its end.
  int due = 0;
  while (!tracker_.isDue(reach_)) {
    go();
    ASSERT_LT(++due, end);
  }
  const int left = end - due;
  EXPECT_GT(left, static_cast<int>(kLead));
  const TrackedScene third = refreshed();
  for (int ticks = static_cast<int>(kLead); ticks < left + static_cast<int>(kLead); ++ticks)
    EXPECT_TRUE(isHeld(third, ticks)) << ticks << " ticks on";
  EXPECT_FALSE(isHeld(third, 0)) << "the way that it has passed by then";
}

/// A mesh without one of its triangles, which bounds nothing.
TriangleMesh opened(const TriangleMesh& mesh) {
  return {{mesh.vertices().begin(), mesh.vertices().end()},
          {mesh.triangles().begin(), mesh.triangles().end() - 1}};
}

// The upper half of a real pump stood still among the open sheets of its bearing, without a force, and could not be
// pulled off: neither a tick nor the search ahead was allowed the work of finding what is near.
TEST(StarvedOpenRod, GetsAListWhateverThatTakesAndGoesOn) {
  const test::RingedPair pair{.detail = 4};
  auto scene = std::make_shared<ServoScene>();
  scene->setMoving({PartId{1}, test::geometryOf(opened(pair.rod())), {}});
  scene->bodies.push_back({PartId{2}, test::geometryOf(opened(pair.tube())), {}});
  scene->prepareSurfaces();
  ASSERT_TRUE(scene->bodies[0].surface);
  // No pair is within twice that, and to find that out takes 18,000 pairs of nodes.
  constexpr double kSmallReach = 0.008, kSmallMargin = kSmallReach / kContactReach;
  const SearchReach reach{kSmallReach, kSmallReach};
  SceneTracker tracker;
  tracker.setScene(scene);
  TrackedScene tracked;
  tracker.update({{}, std::nullopt, false, false}, 1.0);
  tracker.refresh(reach, tracked);
  ASSERT_EQ(tracked.near.size(), 1U);
  ASSERT_FALSE(tracked.near[0].triangles) << "too much for each refresh";
  Proxy proxy;
  proxy.place({});
  const ProxySettings settings{kSmallMargin, 0.0};
  for (int i = 0; i < 400; ++i) {
    tracker.update({proxy.pose(), turnedBy(0.5), false, proxy.account().isStarved}, 1.0);
    if (tracker.isDue(reach)) {
      TrackedScene renewed;
      tracker.refresh(reach, renewed);
      tracked = renewed;
    }
    proxy.follow(tracked, turnedBy(0.5), settings);
  }
  EXPECT_NEAR(angleOf(proxy.pose()), 0.5, 1e-3);
}

}  // namespace
}  // namespace nearfit::starved_part_test

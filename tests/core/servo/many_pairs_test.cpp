#include "core/servo/many_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/math/rotation_vector.h"
#include "core/proximity/query/lmd_query.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/ringed_pair.h"

namespace nearfit::many_pairs_test {
namespace {

constexpr double kReach = 0.03, kNeed = 0.02, kTurn = 0.02, kCell = 0.05;
constexpr double kEnough = 0.001;
constexpr std::uint64_t kUnbounded = std::numeric_limits<std::uint64_t>::max();

/// Rod and tube, the way of the rod, and the contacts by testing every pair.
struct Ringed {
  test::RingedPair ringed;
  NormalConeTree scene{ringed.tube()}, part{ringed.rod()};
  LmdScratch scratch;
  std::vector<LeafPair> pairs = std::vector<LeafPair>(ManyPairs::kMax);

  /// The rod turns about its axis, leans on the wall, and shifts.
  static RigidTransform poseAt(int step) {
    const double t = 0.004 * step;
    return {rotationOf({0.0, 0.0, 2.0 * t}), {0.012 * std::cos(3.0 * t), 0.012 * std::sin(3.0 * t), 0.2 * t}};
  }
  std::span<const LeafPair> near(const RigidTransform& pose) {
    const NearbyPairs nearby = findNearbyPairs({scene, part, pose, kReach}, {kReach, kTurn}, {0.01, 0.01},
                                               scratch, pairs, kUnbounded);
    EXPECT_TRUE(nearby.isComplete);
    return std::span(pairs).first(nearby.count);
  }
  std::vector<ContactPair> all(const RigidTransform& pose, std::span<const LeafPair> of) const {
    std::vector<ContactPair> contacts(ManyPairs::kMax);
    contacts.resize(testContacts({scene, part, pose, kReach}, {kReach, kTurn}, of, contacts).count);
    return contacts;
  }
  ManyPairs::Asked asked(const RigidTransform& pose) const {
    return {.scene = &scene,
            .part = &part,
            .sceneFromPart = pose,
            .reach = {kReach, kTurn},
            .need = kNeed,
            .sure = kNeed,
            .held = kNeed,
            .cell = kCell};
  }
};

/// Holds pairs, with so much work at a time; returns how often it went on.
int hold(ManyPairs& many, std::span<const LeafPair> pairs, double turn, std::uint64_t work = kUnbounded) {
  many.beginHolding(pairs, turn);
  for (int calls = 1;; ++calls) {
    std::uint64_t left = work;
    if (many.goOnHolding(left)) return calls;
  }
}

struct Seen {
  ManyPairs::Found found;
  std::vector<ContactPair> contacts;
  int calls = 0;
};

/// Goes on with a look to its end, with so much work and so much room for contacts at a time.
Seen look(ManyPairs& many, const ManyPairs::Asked& asked, std::uint64_t work = kUnbounded,
          std::size_t room = 64) {
  Seen seen;
  std::vector<ContactPair> out(room);
  many.begin(asked);
  for (;;) {
    std::uint64_t left = work;
    std::size_t count = 0;
    const std::optional<ManyPairs::Found> found = many.goOn(left, out, count);
    ++seen.calls;
    seen.contacts.insert(seen.contacts.end(), out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count));
    if (!found) continue;
    seen.found = *found;
    return seen;
  }
}

double leastOf(std::span<const ContactPair> contacts) {
  double least = std::numeric_limits<double>::infinity();
  for (const ContactPair& contact : contacts)
    least = std::min(least, contact.distance);
  return least;
}

bool isSame(const ContactPair& a, const ContactPair& b) {
  return a.point == b.point && a.direction == b.direction && a.distance == b.distance;
}

TEST(ManyPairs, FindTheLeastDistanceAndANearerContactForEachThatIsLeftOut) {
  Ringed bodies;
  ManyPairs many;
  std::size_t found = 0, there = 0;
  double turn = 0.0;
  for (int step = 0; step < 24; ++step) {
    const RigidTransform pose = Ringed::poseAt(step);
    const std::span<const LeafPair> near = bodies.near(pose);
    ASSERT_GT(near.size(), 2000U);
    if (step % 3 == 0) {
      hold(many, near, turn);
      turn = 0.0;
    }
    turn += 0.008;
    const Seen seen = look(many, bodies.asked(pose));
    // Pairs that are held serve for two more steps: those near are among them.
    const std::vector<ContactPair> all = bodies.all(pose, near);
    const double least = leastOf(all);
    EXPECT_LE(seen.found.least, least + 1e-12) << step;
    EXPECT_GE(seen.found.least, least - 0.01 * kNeed) << step;
    for (const ContactPair& contact : seen.contacts) {
      EXPECT_TRUE(std::ranges::any_of(all, [&](const ContactPair& other) { return isSame(contact, other); }))
          << step;
    }
    for (const ContactPair& contact : all) {
      if (contact.distance > kNeed) continue;
      EXPECT_TRUE(std::ranges::any_of(seen.contacts,
                                      [&](const ContactPair& other) {
                                        return other.distance <= contact.distance + 0.01 * kNeed &&
                                               glm::distance(other.direction, contact.direction) < 0.3 &&
                                               glm::distance(other.point, contact.point) < 2.0 * kCell;
                                      }))
          << step << ", distance " << contact.distance;
    }
    found += step > 0 ? seen.contacts.size() : 0;
    there += step > 0 ? all.size() : 0;
  }
  EXPECT_LT(found, there / 2);
}

/// Contacts that hold the part are beyond what a look is sure of. As the part slides, they go from one feature to the next.
TEST(ManyPairs, AContactThatGoesToAnotherFeatureIsFoundThere) {
  constexpr double kSmallCell = 0.02, kTurnOfStep = 0.0008;
  // Hardly aside: contacts hold the rod all around.
  constexpr double kAside = 0.0024;
  Ringed bodies;
  ManyPairs many, careless;
  std::size_t missing = 0, carelesslyMissing = 0, there = 0;
  for (int step = 0; step < 80; ++step) {
    const double turn = kTurnOfStep * step;
    const RigidTransform pose{rotationOf({0.0, 0.0, turn}),
                              {kAside * std::cos(1.5 * turn), kAside * std::sin(1.5 * turn), 0.1 * turn}};
    const std::span<const LeafPair> near = bodies.near(pose);
    hold(many, near, kTurnOfStep);
    hold(careless, near, kTurnOfStep);
    const std::vector<ContactPair> all = bodies.all(pose, near);
    const double least = leastOf(all);
    ManyPairs::Asked asked = bodies.asked(pose);
    asked.cell = kSmallCell;
    asked.sure = 0.95 * least;
    asked.held = 1.04 * least;
    const Seen seen = look(many, asked);
    asked.held = asked.sure;
    const Seen seenCarelessly = look(careless, asked);
    const auto isMissing = [](const ContactPair& contact, const Seen& in) {
      return std::ranges::none_of(in.contacts, [&](const ContactPair& other) {
        return other.distance <= contact.distance + 0.01 * kNeed &&
               glm::distance(other.direction, contact.direction) < 0.3 &&
               glm::distance(other.point, contact.point) < 2.0 * kSmallCell;
      });
    };
    for (const ContactPair& contact : all) {
      if (contact.distance > 1.02 * least) continue;
      ++there;
      missing += isMissing(contact, seen) ? 1 : 0;
      carelesslyMissing += isMissing(contact, seenCarelessly) ? 1 : 0;
    }
  }
  EXPECT_EQ(missing, 0U);
  EXPECT_GT(carelesslyMissing, there / 50);
}

/// Work, and room for contacts, only part a look.
TEST(ManyPairs, ALookInPartsFindsTheSame) {
  Ringed bodies;
  ManyPairs whole, parts;
  for (int step = 0; step < 4; ++step) {
    const RigidTransform pose = Ringed::poseAt(step);
    const std::span<const LeafPair> near = bodies.near(pose);
    EXPECT_EQ(hold(whole, near, 0.0), 1);
    // What is left half done, for other pairs, changes nothing.
    parts.beginHolding(near.first(near.size() / 2), 0.0);
    std::uint64_t some = 60U * static_cast<std::uint64_t>(step);
    EXPECT_FALSE(parts.goOnHolding(some));
    EXPECT_GT(hold(parts, near, 0.0, 50), 10);
    ManyPairs::Asked asked = bodies.asked(pose);
    if (step > 0) {
      asked.way = PartWay{Ringed::poseAt(step - 1), pose, 0.01, bendOf(0.01, 0.8)};
      asked.bendFromPart = 1e-4;
      asked.enough = kEnough;
    }
    const Seen once = look(whole, asked, kUnbounded, ManyPairs::kMax),
               often = look(parts, asked, 50, ManyPairs::kLeastRoom);
    EXPECT_GT(often.calls, 20);
    EXPECT_EQ(once.calls, 1);
    EXPECT_EQ(once.found.least, often.found.least);
    EXPECT_EQ(once.found.leastOnWay, often.found.leastOnWay);
    ASSERT_EQ(once.contacts.size(), often.contacts.size());
    for (std::size_t i = 0; i < once.contacts.size(); ++i)
      EXPECT_TRUE(isSame(once.contacts[i], often.contacts[i]));
  }
}

TEST(ManyPairs, NoBoundOnTheWayExceedsTheDistanceThere) {
  Ringed bodies;
  ManyPairs many;
  double highest = -1.0;
  for (int step = 0; step + 1 < 8; ++step) {
    const RigidTransform from = Ringed::poseAt(step), to = Ringed::poseAt(step + 1);
    const std::span<const LeafPair> near = bodies.near(from);
    hold(many, near, 0.008);
    ManyPairs::Asked asked = bodies.asked(to);
    const double turn = 0.008, travel = glm::distance(from.translation, to.translation) + turn * 0.8;
    asked.way = PartWay{from, to, travel, bendOf(turn, 0.8)};
    asked.bendFromPart = bendOf(turn, 1.0) + 0.25 * turn * travel;
    asked.enough = kEnough;
    const Seen seen = look(many, asked);
    highest = std::max(highest, seen.found.leastOnWay);
    for (int k = 0; k <= 8; ++k) {
      const double t = k / 8.0;
      const RigidTransform pose{glm::normalize(rotationOf({0.0, 0.0, t * turn}) * from.rotation),
                                glm::mix(from.translation, to.translation, t)};
      EXPECT_LE(seen.found.leastOnWay, leastOf(bodies.all(pose, near)) + 1e-12) << step << " at " << t;
    }
  }
  EXPECT_EQ(highest, kEnough);
}

TEST(ManyPairs, AllocateNothingOnceMade) {
  Ringed bodies;
  ManyPairs many;
  std::vector<ContactPair> out(64);
  std::vector<LeafPair> near;
  for (int step = 0; step < 6; ++step) {
    const RigidTransform pose = Ringed::poseAt(10 * step);
    const std::span<const LeafPair> pairs = bodies.near(pose);
    near.assign(pairs.begin(), pairs.end());
    std::size_t count = 0;
    std::uint64_t work = kUnbounded;
    test::resetAllocationCount();
    test::startCountingAllocations();
    many.beginHolding(near, 0.08);
    EXPECT_TRUE(many.goOnHolding(work));
    many.begin(bodies.asked(pose));
    while (!many.goOn(work, out, count))
      count = 0;
    test::stopCountingAllocations();
    EXPECT_EQ(test::countedAllocations(), 0U) << step;
  }
}

}  // namespace
}  // namespace nearfit::many_pairs_test

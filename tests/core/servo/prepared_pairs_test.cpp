#include "core/servo/prepared_pairs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/math/rotation_vector.h"
#include "core/proximity/query/lmd_query.h"
#include "core/servo/tracked_scene.h"
#include "tests/support/proxy_walk.h"
#include "tests/support/ringed_pair.h"

namespace nearfit::prepared_pairs_test {
namespace {

constexpr double kMargin = 0.01;
constexpr double kContact = kContactReach * kMargin;
constexpr std::uint64_t kUnbounded = std::numeric_limits<std::uint64_t>::max();

/// A rod among the waves of its tube, which turns, leans on them and shifts.
class RodAmongWaves : public testing::Test {
 protected:
  test::RingedPair ringed_{.detail = 4};
  test::ProxyWalk walk_{{{ringed_.tube(), {}}}, ringed_.rod(), {}, {kMargin, 0.0}};
  LmdScratch scratch_;

  const ServoScene& scene() const { return walk_.scene(); }
  const ServoScene::Body& tube() const { return walk_.scene().bodies[0]; }
  static RigidTransform poseAt(double t) {
    return {rotationOf({0.0, 0.0, 2.0 * t}), {0.012 * std::cos(3.0 * t), 0.012 * std::sin(3.0 * t), 0.2 * t}};
  }
  BodyPairQuery queryAt(const RigidTransform& pose, double reach) const {
    return {tube().geometry->tree(), scene().moving.geometry->tree(), pose, reach};
  }
  ContactReach reach() const {
    const double distance = reachOfThousands(kContact);
    return {distance, contactTurn(distance, scene().metric.radius)};
  }
  /// A list for all poses within a few steps of one.
  CandidateList listAround(const RigidTransform& pose) {
    CandidateList list;
    list.build(queryAt(pose, reach().distance), {{}, {0.01, 0.01}}, scratch_, {ManyPairs::kMax, kUnbounded},
               reach().turn);
    EXPECT_TRUE(list.isUsable());
    return list;
  }
  /// All contacts at a pose, by testing each pair that a search finds.
  std::vector<ContactPair> allAt(const RigidTransform& pose) {
    std::vector<LeafPair> pairs(1U << 16);
    const BodyPairQuery query = queryAt(pose, reach().distance);
    const NearbyPairs nearby = findNearbyPairs(query, reach(), {}, scratch_, pairs, kUnbounded);
    EXPECT_TRUE(nearby.isComplete);
    std::vector<ContactPair> contacts(pairs.size());
    contacts.resize(testContacts(query, reach(), std::span(pairs).first(nearby.count), contacts).count);
    return contacts;
  }
  struct Seen {
    ManyPairs::Found found;
    std::vector<ContactPair> contacts;
  };
  Seen lookAt(ManyPairs& pairs, const RigidTransform& pose) const {
    Seen seen;
    std::vector<ContactPair> out(256);
    pairs.begin(askedAmongThousands(scene(), tube(), pose, reach().distance, kContact));
    for (;;) {
      std::uint64_t work = kUnbounded;
      std::size_t count = 0;
      const std::optional<ManyPairs::Found> found = pairs.goOn(work, out, count);
      seen.contacts.insert(seen.contacts.end(), out.begin(),
                           out.begin() + static_cast<std::ptrdiff_t>(count));
      if (!found) continue;
      seen.found = *found;
      return seen;
    }
  }
};

TEST_F(RodAmongWaves, PreparedPairsFindTheLeastDistanceAndANearerContactForEachThatIsLeftOut) {
  PairPreparer preparer;
  PreparedPairs prepared;
  std::size_t checked = 0;
  for (std::uint64_t serial = 1; serial <= 6; ++serial) {
    const double t = 0.02 * static_cast<double>(serial);
    const CandidateList list = listAround(poseAt(t));
    ASSERT_GT(list.size(), 2 * ManyPairs::kFew);
    preparer.prepare(scene(), tube(), list, poseAt(t), kContact, serial, prepared);
    EXPECT_EQ(prepared.serial(), serial);
    ManyPairs* const pairs = prepared.claim(this);
    ASSERT_NE(pairs, nullptr);
    for (const double off : {0.0, 0.002, -0.002}) {
      const RigidTransform pose = poseAt(t + off);
      ASSERT_TRUE(list.covers(pose, reach().distance));
      const Seen seen = lookAt(*pairs, pose);
      const std::vector<ContactPair> all = allAt(pose);
      const double need = pairs->need();
      double least = std::numeric_limits<double>::infinity();
      for (const ContactPair& contact : all) {
        least = std::min(least, contact.distance);
        // Of what is surely wanted; beyond the margin what is new may be left out.
        if (contact.distance > 0.98 * kMargin) continue;
        ++checked;
        EXPECT_TRUE(std::ranges::any_of(seen.contacts,
                                        [&](const ContactPair& other) {
                                          return other.distance <= contact.distance + 0.01 * need &&
                                                 glm::distance(other.direction, contact.direction) < 0.3;
                                        }))
            << t << ", distance " << contact.distance;
      }
      EXPECT_LE(seen.found.least, least + 1e-12) << t;
      if (least < 0.98 * kMargin) {
        EXPECT_GE(seen.found.least, least - 0.01 * need) << t;
      }
    }
  }
  EXPECT_GT(checked, 100U);
}

TEST_F(RodAmongWaves, PreparedPairsAreForTheFirstThatClaimsThem) {
  PairPreparer preparer;
  PreparedPairs prepared;
  const CandidateList list = listAround({});
  preparer.prepare(scene(), tube(), list, {}, kContact, 1, prepared);
  const int one = 0, other = 0;
  ManyPairs* const pairs = prepared.claim(&one);
  EXPECT_NE(pairs, nullptr);
  EXPECT_EQ(prepared.claim(&other), nullptr);
  EXPECT_EQ(prepared.claim(&one), pairs);
  preparer.prepare(scene(), tube(), list, {}, kContact, 2, prepared);
  EXPECT_NE(prepared.claim(&other), nullptr);
}

TEST_F(RodAmongWaves, APartAmongThousandsIsLedByPreparedPairs) {
  std::size_t prepared = 0, changes = 0;
  std::uint64_t last = 0;
  for (int i = 0; i < 200; ++i) {
    walk_.lead(poseAt(0.0005 * i));
    const std::vector<TrackedScene::Near>& near = walk_.tracked().near;
    if (near.empty() || !near[0].prepared) continue;
    ++prepared;
    changes += near[0].prepared->serial() != last ? 1 : 0;
    last = near[0].prepared->serial();
  }
  EXPECT_TRUE(walk_.proxy().isCrowded());
  EXPECT_GT(prepared, 50U);
  EXPECT_GT(changes, 2U);
  EXPECT_GT(walk_.proxy().distance(), 0.0);
}

}  // namespace
}  // namespace nearfit::prepared_pairs_test

// Listing pairs that may be contacts, held to a bound of work.
#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/contact_query.h"
#include "core/proximity/tracking/candidate_list.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::contact_work_test {
namespace {

constexpr ContactReach kWithin{0.1, 0.03};
constexpr std::uint64_t kNoBound = std::numeric_limits<std::uint64_t>::max();
const RigidTransform kPose{{1, 0, 0, 0}, {0.01, 0.004, 0.0}};

/// A peg in its bore, where hundreds of pairs are near.
class ContactWork : public testing::Test {
 protected:
  ContactWork() { list_.build(query_, {{}, {0.01, 0.01}}, scratch_, {}, kWithin.turn); }

  const NormalConeTree bore_{test::tubeMesh(0.5, 0.8, 1.0, 48)}, peg_{test::cylinderMesh(0.45, 2.0, 48)};
  const BodyPairQuery query_{bore_, peg_, kPose, kWithin.distance};
  LmdScratch scratch_;
  CandidateList list_;
};

/// The pairs of a listing within so much work, held against those of one without a bound.
void expectWithin(const NearbyPairs& bounded, std::span<const LeafPair> pairs, std::uint64_t maxWork,
                  const NearbyPairs& all, std::span<const LeafPair> allPairs) {
  EXPECT_LE(bounded.work, maxWork);
  EXPECT_EQ(bounded.isComplete, maxWork >= all.work) << maxWork << " of " << all.work;
  ASSERT_LE(bounded.count, all.count);
  for (std::size_t i = 0; i < bounded.count; ++i) {
    ASSERT_EQ(pairs[i].scene, allPairs[i].scene);
    ASSERT_EQ(pairs[i].part, allPairs[i].part);
  }
}

TEST_F(ContactWork, ListingEndsWithinItsWork) {
  std::vector<LeafPair> searched(1U << 16), listed(1U << 16), out(1U << 16);
  const NearbyPairs all = findNearbyPairs(query_, kWithin, {}, scratch_, searched, kNoBound);
  const auto ofList = list_.nearbyPairs(kPose, kWithin, {}, scratch_, listed);
  ASSERT_TRUE(all.isComplete && ofList && ofList->isComplete);
  ASSERT_GT(all.count, 100U);
  EXPECT_EQ(ofList->count, all.count);
  for (std::uint64_t work = 0; work <= std::max(all.work, ofList->work) + 2; ++work) {
    expectWithin(findNearbyPairs(query_, kWithin, {}, scratch_, out, work), out, work, all, searched);
    const auto bounded = list_.nearbyPairs(kPose, kWithin, {}, scratch_, out, work);
    ASSERT_TRUE(bounded);
    expectWithin(*bounded, out, work, *ofList, listed);
  }
}

TEST_F(ContactWork, FullRoomEndsAListingAtOnce) {
  std::vector<LeafPair> all(1U << 16), few(16);
  const NearbyPairs whole = findNearbyPairs(query_, kWithin, {}, scratch_, all, kNoBound);
  const NearbyPairs searched = findNearbyPairs(query_, kWithin, {}, scratch_, few, kNoBound);
  const auto listed = list_.nearbyPairs(kPose, kWithin, {}, scratch_, few);
  ASSERT_TRUE(listed);
  EXPECT_FALSE(searched.isComplete);
  EXPECT_FALSE(listed->isComplete);
  EXPECT_EQ(searched.count, few.size());
  EXPECT_EQ(listed->count, few.size());
  EXPECT_LT(searched.work, whole.work);
  EXPECT_LT(listed->work, list_.size() / kListedAtOnce);
}

}  // namespace
}  // namespace nearfit::contact_work_test

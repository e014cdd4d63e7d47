#include "tests/stress/oracle_campaign.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/stress/oracle_pairs.h"
#include "tests/support/trial_share.h"

namespace nearfit::stress::oracle_campaign_test {
namespace {

TEST(OracleCampaign, FewThousandPosesOfTwentyPairsHaveTheExactSet) {
  const std::vector<test::BodyPair> pairs = oraclePairs();
  const std::size_t each = 150 / test::kTrialShare;
  const OracleTally tally = runOracleCampaign(pairs, {.seed = 20, .first = 0, .count = each}, 1);
  for (const std::string& fault : tally.faults)
    ADD_FAILURE() << fault;
  EXPECT_EQ(tally.poses, each * pairs.size());
  // Nothing is shown by poses without minima, nor by none that calls for exact arithmetic.
  EXPECT_GT(tally.found, tally.poses);
  EXPECT_GT(tally.flagged, 0U);
  EXPECT_GT(tally.regions, 0U);
  EXPECT_GT(tally.differing, 0U);
}

// What a million poses found, all in what the sets were held against: parallel to 1e-6 rad is one region.
TEST(OracleCampaign, WhatIsOneRegionToTheToleranceIsSoToTheJudge) {
  struct Case {
    const char* pair;
    std::size_t number;
  };
  const std::vector<Case> cases{
      // Two edges in faces that count as parallel cross at 14 degrees: the way between them is tilted by more
      // than the faces are.
      {"fan", 7350},
      {"fan", 15178},
      // A corner of the part has a way to a face and, 1.5 tolerances beside it, one to the face's edge.
      {"fan", 19729},
      // An edge before a face that ends where the edge, tilted within the tolerance, would pass through it.
      {"knives", 20099},
      {"stl_multibody_inverted", 10096},
      // Edges parallel to 1e-9 rad, whose lines cross far beyond them.
      {"obj_wallhole", 38955}};
  const std::vector<test::BodyPair> all = oraclePairs();
  for (const Case& c : cases) {
    // Files that are not there have stand-ins of other names.
    const auto pair = std::ranges::find(all, c.pair, &test::BodyPair::name);
    if (pair == all.end()) continue;
    const OracleTally tally = runOracleCampaign({*pair}, {.seed = 1, .first = c.number, .count = 1}, 1);
    EXPECT_EQ(tally.judged, 1U);
    for (const std::string& fault : tally.faults)
      ADD_FAILURE() << fault;
  }
}

TEST(OracleCampaign, PairsAreTwentyOfDifferentNames) {
  std::set<std::string> names;
  for (const test::BodyPair& pair : oraclePairs())
    names.insert(pair.name);
  EXPECT_EQ(names.size(), 20U);
}

TEST(OracleCampaign, RangesAddUpToTheWholeWhateverTheThreads) {
  const std::vector<test::BodyPair> all = oraclePairs(), pairs(all.begin(), all.begin() + 3);
  const OracleTally whole = runOracleCampaign(pairs, {5, 0, 20}, 2);
  OracleTally parts = runOracleCampaign(pairs, {5, 0, 8}, 1);
  parts += runOracleCampaign(pairs, {5, 8, 12}, 1);
  EXPECT_EQ(whole.poses, parts.poses);
  EXPECT_EQ(whole.found, parts.found);
  EXPECT_EQ(whole.judged, parts.judged);
}

}  // namespace
}  // namespace nearfit::stress::oracle_campaign_test

// A finely meshed ball in its bowl: more pairs of features are near each other than a tick can look at. They
// were listed before their work was counted, and where they were too many the part stood still for good,
// however it was pulled.
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/overlap/interference.h"
#include "core/servo/contact_finder.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/proxy_walk.h"
#include "tests/support/trial_share.h"

namespace nearfit::crowded_lists_test {
namespace {

constexpr double kMargin = 1e-3;
constexpr std::uint32_t kSegments = 256, kRings = 64;

class BallInBowl : public testing::Test {
 protected:
  static constexpr double kGap = 1.5 * kMargin;

  test::ProxyWalk walk_{{{test::bowlMesh(1.0, 1.2, kSegments, kRings), {}}},
                        test::uvSphereMesh(1.0 - kGap, kSegments, 2 * kRings),
                        {},
                        {kMargin, 0.0}};
  std::uint64_t most_ = 0;
  std::size_t moves_ = 0;

  static RigidTransform at(const glm::dvec3& centre) { return {{1, 0, 0, 0}, centre}; }

  void expectApart(const RigidTransform& pose) const {
    const PartGeometry &bowl = *walk_.scene().bodies[0].geometry, &ball = *walk_.scene().moving.geometry;
    EXPECT_EQ(findInterference(bowl.tree(), ball.tree(), pose).kind, InterferenceKind::Disjoint);
  }

  void lead(const RigidTransform& hand, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      const RigidTransform before = walk_.pose();
      walk_.lead(hand);
      ASSERT_LE(walk_.proxy().work(), ContactFinder::kMaxWork);
      most_ = std::max(most_, walk_.proxy().work());
      if (walk_.pose().translation == before.translation) continue;
      // The check takes longer than the tick.
      if (++moves_ % test::kTrialShare == 0) expectApart(walk_.pose());
    }
  }
};

TEST_F(BallInBowl, IsMoreThanATickCanLookAt) {
  const NormalConeTree &bowl = walk_.scene().bodies[0].geometry->tree(),
                       &ball = walk_.scene().moving.geometry->tree();
  const double reach = 2.0 * kMargin;
  std::vector<LeafPair> pairs(1U << 18);
  LmdScratch scratch(1);
  const NearbyPairs all = findNearbyPairs({bowl, ball, {}, reach}, {reach, contactTurn(reach, 1.0)}, {},
                                          scratch, pairs, 1U << 24);
  ASSERT_TRUE(all.isComplete);
  EXPECT_GT(all.count, ContactFinder::kMaxWork);
  EXPECT_GT(all.work, ContactFinder::kMaxWork);
}

TEST_F(BallInBowl, GoesWhereItIsLedWithinTheWorkOfEachTick) {
  lead(at({0.0, 0.0, -0.01}), 400);
  EXPECT_GT(most_, ContactFinder::kUsualWork);
  // Down by what the gap was, but for what keeps it from the bowl.
  const double down = -walk_.pose().translation.z;
  EXPECT_GT(down, 0.25 * kGap);
  EXPECT_LT(down, kGap);
  EXPECT_LE(walk_.proxy().distance(), kGap - down + 1e-9);
  // Pressed, it comes to rest.
  moves_ = 0;
  lead(at({0.0, 0.0, -0.01}), 10);
  EXPECT_EQ(moves_, 0U);
  // Along the bowl, whose rim holds it a margin off, and out.
  lead(at({0.0, 0.01, 0.02}), 1000);
  EXPECT_GT(walk_.pose().translation.z, 0.0199);
  EXPECT_GE(walk_.proxy().distance(), 0.97 * kMargin);
}

TEST_F(BallInBowl, StandsWithoutListsAndGoesOnWhenTheyArrive) {
  walk_.lead({});
  TrackedScene bare = walk_.tracked();
  for (TrackedScene::Near& near : bare.near)
    near.contacts = nullptr;
  Proxy proxy;
  proxy.place({});
  const RigidTransform hand = at({0.0, 0.0, 0.02});
  for (int i = 0; i < 40; ++i) {
    proxy.follow(bare, hand, walk_.settings());
    ASSERT_LE(proxy.work(), ContactFinder::kMaxWork);
    EXPECT_TRUE(proxy.account().isStarved);
    EXPECT_EQ(proxy.pose().translation, glm::dvec3(0.0));
  }
  for (int i = 0; i < 40; ++i) {
    proxy.follow(walk_.tracked(), hand, walk_.settings());
    ASSERT_LE(proxy.work(), ContactFinder::kMaxWork);
  }
  EXPECT_GT(proxy.pose().translation.z, 0.0);
  expectApart(proxy.pose());
}

}  // namespace
}  // namespace nearfit::crowded_lists_test

#include "tests/stress/tick_shares.h"

#include <array>
#include <numeric>

#include <gtest/gtest.h>

namespace nearfit::stress::tick_shares_test {
namespace {

std::uint64_t sumOf(const std::vector<std::uint64_t>& shares) {
  return std::accumulate(shares.begin(), shares.end(), std::uint64_t{0});
}

TEST(TickShares, ASceneFourTimesAsDearHasHalfAsMany) {
  // 1 + 1/2 + 1/4 parts are 7 million.
  const std::vector<std::uint64_t> shares = shareTicks(std::array{1.0, 4.0, 16.0}, 7'000'000);
  EXPECT_EQ(sumOf(shares), 7'000'000U);
  EXPECT_NEAR(static_cast<double>(shares[0]), 4e6, 2.0);
  EXPECT_NEAR(static_cast<double>(shares[1]), 2e6, 2.0);
  EXPECT_NEAR(static_cast<double>(shares[2]), 1e6, 2.0);
}

TEST(TickShares, NoSceneGoesWithLessThanTheLeast) {
  // The dear scene would have a thousandth of the others', which share what it leaves.
  const std::vector<std::uint64_t> shares = shareTicks(std::array{1.0, 1e6, 1.0}, 2'000'000);
  EXPECT_EQ(sumOf(shares), 2'000'000U);
  EXPECT_EQ(shares[1], kMinTicks);
  EXPECT_NEAR(static_cast<double>(shares[0]), 950'000.0, 2.0);
  EXPECT_NEAR(static_cast<double>(shares[2]), 950'000.0, 2.0);
}

TEST(TickShares, AShortRunIsSharedEqually) {
  EXPECT_EQ(shareTicks(std::array{1.0, 1000.0, 5.0}, 100'001),
            (std::vector<std::uint64_t>{33334, 33334, 33333}));
  EXPECT_EQ(shareTicks(std::array{1.0, 9.0}, 2 * kMinTicks), (std::vector<std::uint64_t>(2, kMinTicks)));
  EXPECT_TRUE(shareTicks({}, 5).empty());
}

}  // namespace
}  // namespace nearfit::stress::tick_shares_test

#include "core/servo/shown_reach.h"

#include <limits>

#include <gtest/gtest.h>

namespace nearfit::shown_reach_test {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kTooMuch = 3 * ShownReach::kUsualWork, kNothing = 0;

/// Ticks of so many that had too much work, where that is what lies beyond a share of the cutoff.
int ticksWithTooMuch(ShownReach& reach, int ticks, double cliff) {
  int count = 0;
  for (int i = 0; i < ticks; ++i) {
    const bool isTooMuch = reach.share() > cliff;
    count += isTooMuch ? 1 : 0;
    reach.observe(isTooMuch ? kTooMuch : kNothing, kNone);
  }
  return count;
}

TEST(ShownReach, IsTheWholeCutoffWhereThereIsTime) {
  ShownReach reach;
  for (int i = 0; i < 100; ++i)
    reach.observe(ShownReach::kUsualWork, 0.1);
  EXPECT_EQ(reach.share(), 1.0);
}

// It grew by a tenth a tick until it was too much, and so every fourth tick had twenty times its work.
TEST(ShownReach, DoesNotHuntWhereAllComesAtOnce) {
  for (const double cliff : {0.9, 0.5, 0.1, 0.01}) {
    ShownReach reach;
    ticksWithTooMuch(reach, 4000, cliff);
    // By then the wait has doubled to its longest: each try of 20,000 ticks is a tick or two of too much.
    const int tries = 20000 / static_cast<int>(ShownReach::kLongestWait) + 1;
    EXPECT_LE(ticksWithTooMuch(reach, 20000, cliff), 2 * tries);
    EXPECT_LE(reach.share(), 1.2 * cliff) << "the last tick may be a try";
    EXPECT_GT(reach.share(), 0.6 * cliff) << "but as much as there is time for is shown";
  }
}

TEST(ShownReach, IsTheWholeCutoffAgainWhenWhatWasTooMuchIsGone) {
  ShownReach reach;
  ticksWithTooMuch(reach, 4000, 0.05);
  ASSERT_LE(reach.share(), 0.05);
  // The longest wait, then a tenth more a tick: 32 of them make twenty times as much.
  ticksWithTooMuch(reach, static_cast<int>(ShownReach::kLongestWait) + 40, kNone);
  EXPECT_EQ(reach.share(), 1.0);
}

TEST(ShownReach, NeverFallsShortOfWhatIsNearest) {
  ShownReach reach;
  for (int i = 0; i < 200; ++i) {
    reach.observe(kTooMuch, 0.2);
    EXPECT_GE(reach.share(), 0.2);
  }
  reach.observe(kTooMuch, 0.5);
  EXPECT_GE(reach.share(), 0.5) << "also when that moves away";
}

}  // namespace
}  // namespace nearfit::shown_reach_test

// Counters of ticks, scenes and work have 64 bits: at a thousand a second they wrap after half a billion
// years. One that is made narrower is noticed here.
#include <cstdint>
#include <type_traits>

#include <gtest/gtest.h>

#include "core/servo/minima_finder.h"
#include "core/servo/servo_snapshot.h"
#include "core/servo/shown_reach.h"
#include "core/servo/tracked_scene.h"

namespace nearfit::counters_test {
namespace {

static_assert(std::is_same_v<decltype(ServoSnapshot::tick), std::uint64_t>);
static_assert(std::is_same_v<decltype(ServoSnapshot::work), std::uint64_t>);
static_assert(std::is_same_v<decltype(TrackedScene::serial), std::uint64_t>);
static_assert(std::is_same_v<decltype(Clearance::serial), std::uint64_t>);
static_assert(std::is_same_v<decltype(MinimaFinder::Result::work), std::uint64_t>);

// The ticks that it waits are counted in 32 bits: the count and its doubling stop at the longest wait.
TEST(ShownReach, ItsWaitNeverWraps) {
  ShownReach reach;
  // Twice too much each time that it is tried: doubled forty times, 32 bits would be zero again.
  int tries = 0;
  for (int i = 0; i < 60 * static_cast<int>(ShownReach::kLongestWait); ++i) {
    const bool isTooMuch = reach.share() > 0.5;
    tries += isTooMuch ? 1 : 0;
    reach.observe(isTooMuch ? 2 * ShownReach::kUsualWork : 0, 0.1);
  }
  EXPECT_GT(tries, 40);
  EXPECT_LT(tries, 80);
}

}  // namespace
}  // namespace nearfit::counters_test

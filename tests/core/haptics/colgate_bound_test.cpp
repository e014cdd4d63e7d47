// The bound of virtual_coupling.h against simulated hands.
#include <gtest/gtest.h>

#include "core/haptics/virtual_coupling.h"
#include "tests/support/wall_encounter.h"

namespace nearfit::colgate_bound_test {
namespace {

using test::leaningOn;
using test::meetWall;
using test::wallOf;
using test::WallOutcome;
using test::WallTrial;

constexpr double kPeriod = WallTrial::kPeriod;

TEST(ColgateBound, WallJustBelowItIsStableAndJustAboveItIsNot) {
  // A mass large beside b T (1 g) is the hand for which the bound is also necessary, but for a term of b T /
  // m.
  for (const double mass : {0.05, 0.1, 0.2}) {
    const double bound = stiffnessBound(1.0, 0.0, kPeriod);
    const WallOutcome below = meetWall(leaningOn(0.9 * bound, mass));
    const WallOutcome above = meetWall(leaningOn(1.1 * bound, mass));
    EXPECT_LT(below.late, 0.7 * below.early) << mass;
    EXPECT_GT(above.late, 1.3 * above.early) << mass;
  }
}

TEST(ColgateBound, WallWithinItIsStableInHandsOfAnyMass) {
  for (const double mass : {0.001, 0.003, 0.01, 0.03, 0.1, 0.3}) {
    for (const double damping : {0.0, 0.2, 0.5}) {
      WallTrial trial = leaningOn(0.9 * stiffnessBound(1.0, damping, kPeriod), mass);
      trial.wall.damping = damping;
      trial.ticks = 20'000;
      const WallOutcome outcome = meetWall(trial);
      EXPECT_LT(outcome.late, 0.1 * outcome.early) << mass << " " << damping;
    }
  }
}

TEST(ColgateBound, AutomaticCouplingCalmsAHandThatHitsIt) {
  const CouplingState c = boundedCoupling({}, {}, {{1, 0, 0, 0}, glm::dvec3(0.01), 0.02}, kPeriod);
  WallTrial trial = wallOf(c.stiffness);
  trial.wall.damping = c.damping;
  const WallOutcome outcome = meetWall(trial);
  EXPECT_LT(outcome.late, 0.05 * outcome.early);
  EXPECT_EQ(outcome.paidTicks, 0);
}

}  // namespace
}  // namespace nearfit::colgate_bound_test

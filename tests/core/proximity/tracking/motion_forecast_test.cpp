#include "core/proximity/tracking/motion_forecast.h"

#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/lmd_comparison.h"

namespace nearfit::motion_forecast_test {
namespace {

constexpr double kCutoff = 0.1, kRadius = 0.5;
const glm::dvec3 kCentre(0.2, -0.1, 0.3);

/// The same pose as its centre's.
RigidTransform centred(const RigidTransform& pose) {
  return {pose.rotation, pose.applyToPoint(kCentre)};
}

double shareOf(const SearchPlan& plan, const RigidTransform& pose) {
  return spentShare(plan.range, centred(plan.pose), centred(pose), kRadius);
}

/// The centre goes along a curve while the part turns, both faster and faster.
RigidTransform onCurve(double tick) {
  const double t = 1e-3 * tick;
  const glm::dquat turn = glm::angleAxis(0.4 * t + 0.3 * t * t, glm::normalize(glm::dvec3(1.0, 2.0, 0.5)));
  const glm::dvec3 centre(0.1 * t, 0.05 * t * t, 0.02 * std::sin(3.0 * t));
  return {turn, centre - turn * kCentre};
}

TEST(MotionForecast, ThePlanHoldsTheWayThatASmoothMotionTakesWhileItIsToServe) {
  for (const double lead : {0.5, 1.0, 2.5}) {
    MotionForecast forecast(kCentre, kRadius);
    for (int tick = 0; tick <= 400; ++tick) {
      forecast.observe(onCurve(tick), 1.0);
      forecast.setLead(lead);
      if (tick < 50) continue;
      const SearchPlan plan = forecast.plan(kCutoff);
      for (double ahead = lead; ahead <= lead + 1.5; ahead += 0.5)
        EXPECT_LE(shareOf(plan, onCurve(tick + ahead)), 1.0) << tick << ' ' << ahead;
    }
  }
}

TEST(MotionForecast, APartAtRestHasALittleRoomEveryWay) {
  MotionForecast forecast(kCentre, kRadius);
  const RigidTransform pose{glm::angleAxis(0.3, glm::dvec3(0, 0, 1)), {1.0, 2.0, 3.0}};
  for (int tick = 0; tick < 20; ++tick)
    forecast.observe(pose, 1.0);
  const SearchPlan plan = forecast.plan(kCutoff);
  for (const glm::dvec3& way : {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, 1)}) {
    RigidTransform moved = pose;
    moved.translation += 0.01 * kCutoff * way;
    EXPECT_LE(shareOf(plan, moved), 1.0);
    moved.translation += 10.0 * kCutoff * way;
    EXPECT_GT(shareOf(plan, moved), 1.0);
  }
}

TEST(MotionForecast, APartThatIsPutElsewhereIsNotForetoldToFlyOn) {
  MotionForecast forecast(kCentre, kRadius);
  for (int tick = 0; tick < 30; ++tick)
    forecast.observe({{1, 0, 0, 0}, {1e-4 * tick, 0.0, 0.0}}, 1.0);
  const RigidTransform there{{1, 0, 0, 0}, {5.0, 1.0, 0.0}};
  forecast.observe(there, 1.0);
  const SearchPlan plan = forecast.plan(kCutoff);
  EXPECT_LT(glm::distance(centred(plan.pose).translation, centred(there).translation), 1e-2);
  EXPECT_LT(plan.range.budget.travel, kCutoff);
}

// A nut that waited for its lists was foretold to stand: each list held the place it stood at, and no way on.
TEST(MotionForecast, APartThatWaitsIsForetoldToGoOnFromWhereItIsAsItsHandDoes) {
  MotionForecast forecast(kCentre, kRadius), hand(kCentre, kRadius);
  const glm::dvec3 step(1e-3, 0.0, 5e-4);
  const RigidTransform stands{{1, 0, 0, 0}, {1.0, 2.0, 3.0}};
  for (int tick = 0; tick < 40; ++tick) {
    forecast.observe(stands, 1.0);
    hand.observe({{1, 0, 0, 0}, static_cast<double>(tick) * step}, 1.0);
    forecast.setLead(2.0);
  }
  EXPECT_GT(shareOf(forecast.plan(kCutoff), {{1, 0, 0, 0}, stands.translation + 3.0 * step}), 1.0);
  forecast.goAs(hand);
  for (const double ahead : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0}) {
    const RigidTransform then{{1, 0, 0, 0}, stands.translation + ahead * step};
    EXPECT_LE(shareOf(forecast.plan(kCutoff), then), 1.0) << ahead;
  }
  // Seen again, it goes as it does itself.
  forecast.observe(stands, 1.0);
  EXPECT_EQ(forecast.pose().translation, stands.translation);
}

TEST(MotionForecast, ASteadyOneFollowsTheMeanMotionOfAPartThatGoesInSteps) {
  MotionForecast steady = MotionForecast::steady(kCentre, kRadius);
  const glm::dvec3 step(1e-3, 0.0, 5e-4);
  RigidTransform pose{{1, 0, 0, 0}, {1.0, 2.0, 3.0}};
  // It steps in every third tick, a little aside by turns.
  for (int tick = 0; tick < 300; ++tick) {
    if (tick % 3 == 0) pose.translation += 3.0 * step + glm::dvec3(0.0, tick % 2 == 0 ? 2e-4 : -2e-4, 0.0);
    steady.observe(pose, 1.0);
  }
  EXPECT_NEAR(steady.speed(), glm::length(step), 0.15 * glm::length(step));
  const MotionStretch& way = steady.planOfTicks(kCutoff, 0.0, 40.0).range.stretch;
  EXPECT_GT(glm::dot(glm::normalize(way.shift), glm::normalize(step)), 0.999);
  EXPECT_NEAR(glm::length(way.shift), 20.0 * glm::length(step), 6.0 * glm::length(step));
  // A way that would be longer than the cutoff ends earlier.
  EXPECT_LE(glm::length(steady.planOfTicks(kCutoff, 0.0, 4000.0).range.stretch.shift), kCutoff);
  // The part that is led goes on from where it is.
  MotionForecast part(kCentre, kRadius);
  for (int tick = 0; tick < 40; ++tick)
    part.observe(pose, 1.0);
  part.moveAs(steady);
  const glm::dvec3 ahead = part.poseAfterwards(8.0).translation - pose.translation;
  EXPECT_GT(glm::dot(ahead, step), 0.0);
  EXPECT_NEAR(glm::length(ahead), 8.0 * glm::length(step), 2.0 * glm::length(step));
}

TEST(MotionForecast, APlanOfTicksBeginsWhenItIsToldAndNowIfThePartIsHeldUp) {
  const glm::dvec3 step(1e-3, 0.0, 0.0);
  MotionForecast forecast(kCentre, kRadius);
  for (int tick = 0; tick < 40; ++tick)
    forecast.observe({{1, 0, 0, 0}, static_cast<double>(tick) * step}, 1.0);
  forecast.setLead(20.0);
  EXPECT_EQ(forecast.lead(), 20.0);
  const auto middle = [&](double begin) {
    return (forecast.planOfTicks(kCutoff, begin, 10.0).pose.translation - forecast.pose().translation).x /
           step.x;
  };
  EXPECT_NEAR(middle(0.0), 5.0, 0.1);
  EXPECT_NEAR(middle(20.0), 25.0, 0.1);
  EXPECT_NEAR((forecast.poseIn(20.0).translation - forecast.pose().translation).x, 20.0 * step.x,
              0.1 * step.x);
  const MotionForecast hand = forecast;
  forecast.goAs(hand);
  EXPECT_NEAR(middle(20.0), 5.0, 0.1);
}

TEST(MotionForecast, ALeaderThatHasSeenNothingChangesNothing) {
  MotionForecast forecast(kCentre, kRadius);
  for (int tick = 0; tick < 40; ++tick)
    forecast.observe({{1, 0, 0, 0}, {1e-3 * tick, 0.0, 0.0}}, 1.0);
  const RigidTransform before = forecast.plan(kCutoff).pose;
  forecast.goAs(MotionForecast(kCentre, kRadius));
  EXPECT_EQ(forecast.plan(kCutoff).pose.translation, before.translation);
}

TEST(MotionForecast, APoseThatIsNoPoseIsNotTakenNoteOf) {
  MotionForecast forecast(kCentre, kRadius);
  forecast.observe({{1, 0, 0, 0}, {1.0, 0.0, 0.0}}, 1.0);
  forecast.observe({{1, 0, 0, 0}, {std::nan(""), 0.0, 0.0}}, 1.0);
  EXPECT_EQ(forecast.pose().translation.x, 1.0);
  EXPECT_TRUE(forecast.plan(kCutoff).pose.isFinite());
}

TEST(MotionRange, PosesOnTheStretchAndAsideOfItByTheBudgetSpendNoMoreThanIsThere) {
  std::mt19937_64 random(41);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&](double length) {
    return length * (test::randomRotation(random).rotation * glm::dvec3(1, 0, 0));
  };
  for (int i = 0; i < 500; ++i) {
    RigidTransform middle = test::randomRotation(random);
    middle.translation = vector(2.0);
    const MotionRange range{{vector(0.02), vector(0.03)}, {0.01, 0.02}};
    const RigidTransform on = poseOn(range.stretch, middle, unit(random));
    // Found again but for the curvature of the way, which the nearest time leaves out.
    EXPECT_LE(spentShare(range, middle, on, kRadius), 1.0 + 1e-9);
    RigidTransform aside = on;
    aside.translation += vector(0.005);
    EXPECT_LE(spentShare(range, middle, aside, kRadius), 1.0 + 1e-9);
    aside.translation += vector(0.2);
    EXPECT_GT(spentShare(range, middle, aside, kRadius), 1.0);
    EXPECT_NEAR(spentShare(0.5 * range, middle, middle, kRadius), 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace nearfit::motion_forecast_test

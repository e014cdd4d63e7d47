#include "tests/bench/feel_smoothness.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/servo/servo_tick.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench::feel_smoothness_test {
namespace {

TEST(WrenchChanges, AreFromEachWrenchToTheNext) {
  WrenchChanges changes;
  changes.add({{3.0, 4.0, 0.0}, {0.0, 0.0, 1.0}});
  changes.add({{3.0, 4.0, 12.0}, {0.0, 2.0, 1.0}});
  changes.add({{0.0, 0.0, 12.0}, {0.0, 2.0, 1.0}});
  EXPECT_EQ(changes.force, (std::vector{12.0, 5.0}));
  EXPECT_EQ(changes.torque, (std::vector{2.0, 0.0}));
  EXPECT_EQ(changes.size, (std::vector{5.0, 13.0, 12.0}));
}

/// A box on a floor, pressed down: the force is as smooth as the hand.
FeelScene boxOnFloor() {
  FeelScene feel;
  feel.motion.start = {glm::dquat(1.0, 0.0, 0.0, 0.0), {0.0, 0.0, 5e-4}};
  feel.scene = solidScene(test::boxMesh({1.0, 1.0, 0.1}, {0.0, 0.0, -0.05}),
                          test::boxMesh({0.02, 0.02, 0.02}, {0.0, 0.0, 0.01}), feel.motion.start);
  feel.motion.centreInPart = feel.scene->centreInPart;
  feel.motion.axis = {1.0, 0.0, 0.0};
  feel.motion.towards = {0.0, 0.0, -1.0};
  feel.motion.press = 2e-3;
  feel.motion.swing = 0.3;
  feel.motion.slide = 5e-3;
  feel.size = 1.5;
  return feel;
}

SmoothnessOptions shortRun() {
  SmoothnessOptions options;
  options.seconds = 0.4;
  options.refinement = 4;
  return options;
}

double sumOf(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values)
    sum += value;
  return sum;
}

TEST(RunSmoothness, TheForceIsStiffnessTimesTheWayBeyondContact) {
  const FeelScene feel = boxOnFloor();
  const SmoothnessOptions options = shortRun();
  const SmoothnessRun run = runSmoothness(feel, options, 1, Refinement::SamePeriod);
  EXPECT_EQ(run.inContact, 1.0);
  // Approach and motion, tick by tick: none is left out where poses are certified.
  EXPECT_GT(run.poses.size(), run.changes[0].size.size());
  const ServoParameters parameters;
  const double stiffness =
      boundedCoupling(parameters.haptics.coupling, parameters.limits, feel.scene->metric, 1e-3).stiffness;
  // The hand's lowest place is the press below the start; the part ends a margin above the floor.
  const double most = stiffness * (feel.motion.press - 5e-4 + options.margin);
  for (const double force : run.changes[0].size) {
    EXPECT_LT(force, 1.05 * most);
    EXPECT_GT(force, 0.5 * most);
  }
}

TEST(RunSmoothness, RefinementKeepsTheWayAndSplitsItsSteps) {
  const FeelScene feel = boxOnFloor();
  for (const Refinement held : {Refinement::SamePeriod, Refinement::SameSpeed}) {
    const SmoothnessRun plain = runSmoothness(feel, shortRun(), 1, held);
    const SmoothnessRun refined = runSmoothness(feel, shortRun(), 4, held);
    // But for the first fifty refined ticks, and the way that they take.
    EXPECT_EQ(plain.changes[0].force.size(), 388U);
    EXPECT_EQ(refined.changes[0].force.size(), 1550U);
    const double way = sumOf(plain.changes[0].force);
    EXPECT_NEAR(sumOf(refined.changes[0].force), way, 0.05 * way);
  }
}

/// A ball that rolls in a bowl of facets: many minima where there is one area of contact. Facets of both are off by some
/// 0.01 mm together, well within what mergeAreas() allows for (kAreaOpening): coarser ones make areas of their own.
FeelScene ballInBowl() {
  FeelScene feel;
  feel.motion.start = {glm::dquat(1.0, 0.0, 0.0, 0.0), {0.0, 0.0, -0.0494}};
  feel.scene =
      solidScene(test::bowlMesh(0.1, 0.12, 256, 64), test::icosphereMesh(0.05, 5), feel.motion.start);
  feel.motion.centreInPart = feel.scene->centreInPart;
  feel.motion.axis = {1.0, 0.0, 0.0};
  feel.motion.towards = {0.0, 0.0, -1.0};
  feel.motion.press = 2e-3;
  feel.motion.swing = 0.3;
  feel.motion.slide = 5e-3;
  feel.size = 0.3;
  return feel;
}

TEST(RunSmoothness, OneSpringForEachAreaJumpsLessThanTheSum) {
  const SmoothnessRun run = runSmoothness(ballInBowl(), shortRun(), 1, Refinement::SamePeriod);
  const std::size_t spring = 1, grouped = 3;
  ASSERT_STREQ(SmoothnessRun::kModes[grouped], "grouped");
  const auto largest = [](const std::vector<double>& values) { return *std::ranges::max_element(values); };
  EXPECT_GT(run.births[spring], 0U);
  EXPECT_LT(run.births[grouped], run.births[spring]);
  EXPECT_LT(largest(run.changes[grouped].force), largest(run.changes[spring].force));
  // No more than one spring: 200 N/m over the millimetre of the cutoff.
  EXPECT_LT(largest(run.changes[grouped].size), 0.2);
}

TEST(SmoothnessRows, RatiosAreOfThePlainToTheRefined) {
  const std::vector<FeelRow> rows = smoothnessRows("box", boxOnFloor(), shortRun());
  const auto find = [&](const std::string& run, const std::string& quantity) {
    const auto found = std::ranges::find_if(
        rows, [&](const FeelRow& row) { return row.run == run && row.quantity == quantity; });
    EXPECT_NE(found, rows.end()) << run << ", " << quantity;
    return found == rows.end() ? FeelRow() : *found;
  };
  for (const std::string mode : SmoothnessRun::kModes) {
    const FeelRow plain = find(mode + " x1", "force change [N]"),
                  fine = find(mode + " x4", "force change [N]");
    const FeelRow ratio = find(mode + " x4", "force change ratio");
    EXPECT_DOUBLE_EQ(ratio.p50 * fine.p50, plain.p50);
    EXPECT_DOUBLE_EQ(ratio.max * fine.max, plain.max);
  }
  // On a flat floor nothing but the hand's way counts.
  EXPECT_NEAR(find("proxy x4", "force change ratio").p50, 4.0, 0.2);
  EXPECT_NEAR(find("proxy x4 same speed", "force change ratio").p50, 4.0, 0.2);
}

}  // namespace
}  // namespace nearfit::bench::feel_smoothness_test

#include "tests/bench/feel_cost.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/bench/feel_motion.h"
#include "tests/bench/feel_scenes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench::feel_cost_test {
namespace {

/// A sphere pressed on another.
CostCase pressedSpheres(std::size_t ticks) {
  const TriangleMesh sphere = test::icosphereMesh(0.5, 2);
  const PreparedScene bodies({"spheres", sphere, sphere, std::nullopt, std::nullopt}, 0.05);
  SeekingPathOptions options;
  options.ticks = ticks;
  CostCase scene{"spheres",           "test", nullptr, seekingPath(bodies, options), bodies.cutoff,
                 0.01 * bodies.cutoff};
  scene.servoScene = solidScene(sphere, sphere, scene.path.front());
  return scene;
}

TEST(RunCost, TimesEachTickOfBothModesButThoseThatWarmUp) {
  CostOptions options;
  options.block = 50;
  options.warmUp = 10;
  const CostRun run = runCost(pressedSpheres(180), options);
  // Three whole blocks and one of 30 ticks.
  const std::size_t timed = 3 * 40 + 20;
  EXPECT_EQ(run.tick.size(), timed);
  EXPECT_EQ(run.springs.size(), timed);
  EXPECT_EQ(run.constraints.size(), timed);
  EXPECT_LE(run.query.size(), timed);
  EXPECT_EQ(run.query.size(), run.proxy.size());
  // Certified are those of ticks that are not timed, too.
  EXPECT_EQ(run.poses.size(), 180U);
}

TEST(RunCost, AHandThatPressesIsInContact) {
  const CostRun run = runCost(pressedSpheres(1000), {});
  const auto inContact = std::ranges::count_if(run.contacts, [](double count) { return count > 0.0; });
  EXPECT_GT(inContact, 600);
}

TEST(CostRows, HaveMicrosecondsForTimes) {
  CostRun run;
  run.tick = {1e-6, 3e-6};
  run.constraints = {4.0, 6.0};
  const std::vector<FeelRow> rows = costRows({"scene", "run", nullptr, {}, 0.0, 0.0}, run);
  const auto tick = std::ranges::find(rows, "tick [us]", &FeelRow::quantity);
  ASSERT_NE(tick, rows.end());
  EXPECT_DOUBLE_EQ(tick->mean, 2.0);
  EXPECT_DOUBLE_EQ(tick->max, 3.0);
  const auto constraints = std::ranges::find(rows, "constraints", &FeelRow::quantity);
  ASSERT_NE(constraints, rows.end());
  EXPECT_DOUBLE_EQ(constraints->mean, 5.0);
}

TEST(CostRows, NamesDoNotPartColumnsOfTheCsvFile) {
  CostRun run;
  run.proxyAt32 = run.proxyAt256 = {1e-6};
  for (const FeelRow& row : costRows({"scene", "run", nullptr, {}, 0.0, 0.0}, run)) {
    const std::string line = feelCsvLine(row);
    EXPECT_EQ(std::ranges::count(line, ','), 9) << line;
  }
}

}  // namespace
}  // namespace nearfit::bench::feel_cost_test

#include "tests/bench/tick_run.h"

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/bench/far_parts.h"
#include "tests/support/servo_fixtures.h"

namespace nearfit::bench::tick_run_test {
namespace {

/// The tip goes down over the floor to where its only minimum is.
std::vector<RigidTransform> wayDown() {
  std::vector<RigidTransform> path;
  for (int i = 0; i < 40; ++i)
    path.push_back(test::tipAt(0.1 - 0.002 * i));
  return path;
}

/// The cone over the floor, with parts of the field around both.
std::shared_ptr<const ServoScene> sceneWith(std::size_t farCount) {
  std::unique_ptr<ServoScene> scene = test::coneOverFloor();
  const FarField field{{glm::dvec3(0.0), 4.0}, 1.0, 0.5, 7};
  for (const Part& part : farParts(field, farGeometries(1.0), farCount)) {
    part.geometry->tree();
    const auto id = static_cast<PartId>(1000 + scene->bodies.size());
    scene->bodies.push_back({id, part.geometry, part.worldFromPart});
  }
  return scene;
}

TEST(DigestOf, OneBitOfAForceAMinimumOrAnIdMakesAnother) {
  const auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->wrench.force = {1.0, 2.0, 3.0};
  snapshot->storedLmds = snapshot->lmdCount = 1;
  const std::uint64_t before = digestOf(*snapshot);
  const auto expectOther = [&](auto& value, auto changed) {
    const auto old = value;
    value = changed;
    EXPECT_NE(digestOf(*snapshot), before);
    value = old;
    EXPECT_EQ(digestOf(*snapshot), before);
  };
  expectOther(snapshot->wrench.force.z, std::nextafter(3.0, 4.0));
  expectOther(snapshot->wrench.force.z, -3.0);
  expectOther(snapshot->unclampedWrench.torque.x, 1e-300);
  expectOther(snapshot->lmds[0].lmd.partPoint.y, -0.0);
  expectOther(snapshot->lmds[0].lmd.isBlocked, true);
  expectOther(snapshot->lmds[0].lmd.partIndex, 1U);
  expectOther(snapshot->lmds[0].other, PartId{9});
  expectOther(snapshot->lmds[0].lmd.isRegion, true);
  expectOther(snapshot->distance, 0.5);
}

TEST(DigestOf, TheExtentOfARegionCounts) {
  const auto snapshot = std::make_unique<ServoSnapshot>();
  snapshot->storedLmds = 1;
  Lmd& lmd = snapshot->lmds[0].lmd;
  lmd.isRegion = true;
  const std::uint64_t before = digestOf(*snapshot);
  lmd.extent.halfWidth = 1e-300;
  EXPECT_NE(digestOf(*snapshot), before);
}

TEST(DigestOf, TimesAndMinimaThatAreNotInUseDoNotCount) {
  const auto snapshot = std::make_unique<ServoSnapshot>();
  const std::uint64_t before = digestOf(*snapshot);
  snapshot->queryTime = snapshot->tickTime = 1.0;
  snapshot->lmds[0].lmd.distance = 1.0;
  EXPECT_EQ(digestOf(*snapshot), before);
}

TEST(FirstDifference, IsTheFirstTickThatDiffersOrIsMissing) {
  TickRun a, b;
  a.digests = {1, 2, 3};
  b.digests = {1, 2, 3};
  EXPECT_FALSE(firstDifference(a, b));
  b.digests[1] = 9;
  EXPECT_EQ(firstDifference(a, b), 1U);
  b.digests = {1, 2};
  EXPECT_EQ(firstDifference(a, b), 2U);
}

TEST(RunTicks, PartsFarAwayChangeNothingAndAreNotLookedAt) {
  const std::vector<TickScene> scenes{{"alone", sceneWith(0)}, {"far", sceneWith(100)}};
  RunOptions options;
  options.block = 10;
  options.warmUp = 2;
  options.rounds = 2;
  const std::vector<TickRun> runs = runTicks(scenes, wayDown(), 0.05, options);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[1].parts, 101U);
  EXPECT_FALSE(firstDifference(runs[0], runs[1]));
  for (const TickRun& run : runs) {
    EXPECT_EQ(run.digests.size(), 80U);
    EXPECT_EQ(run.tickTimes.size(), 64U);
    EXPECT_EQ(run.lateTicks, 0U);
    EXPECT_EQ(run.mostNear, 1U);
    // Within the cutoff below 0.05: at the poses 26 to 39, or from 25 as rounding has it, in both rounds.
    EXPECT_NEAR(static_cast<double>(run.ticksWithMinima), 28.0, 2.0);
  }
}

TEST(RunTicks, APartThatIsFeltIsNoticed) {
  const std::shared_ptr<const ServoScene> alone = sceneWith(0);
  auto nearer = std::make_shared<ServoScene>(*alone);
  nearer->bodies[0].worldFromPart.translation.z += 1e-12;
  const std::vector<TickScene> scenes{{"alone", alone}, {"nearer", std::move(nearer)}};
  const std::vector<TickRun> runs = runTicks(scenes, wayDown(), 0.05, {});
  const auto first = firstDifference(runs[0], runs[1]);
  ASSERT_TRUE(first);
  EXPECT_NEAR(static_cast<double>(*first), 25.5, 1.0);
}

}  // namespace
}  // namespace nearfit::bench::tick_run_test

#include "tests/bench/error_run.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/query/lmd_query.h"
#include "tests/bench/error_shapes.h"
#include "tests/bench/tracked_query.h"

namespace nearfit::bench::error_run_test {
namespace {

/// Errors that are rounding alone: of coordinates of some metres, and of sums over thousands of facets.
constexpr double kRounding = 1e-13;

std::vector<ErrorMethodEntry> exactCold() {
  return {exactErrorMethods().front()};
}

ErrorPair pairNamed(const std::string& name) {
  const std::vector<ErrorPair> all = errorPairs();
  return *std::find_if(all.begin(), all.end(), [&](const ErrorPair& pair) { return pair.name == name; });
}

/// Slope of the line of least squares through the logarithms of error and edge length.
double orderOf(const std::vector<ErrorRow>& rows, ErrorSummary ErrorRow::* error) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const ErrorRow& row : rows) {
    const double u = std::log(row.edge), v = std::log((row.*error).rms);
    x += u;
    y += v;
    xx += u * u;
    xy += u * v;
  }
  const auto n = static_cast<double>(rows.size());
  return (n * xy - x * y) / (n * xx - x * x);
}

class ErrorOfTheExactEngine : public ::testing::TestWithParam<ErrorPair> {
 protected:
  std::vector<ErrorRow> rows(std::vector<std::uint32_t> finenesses) const {
    ErrorRunOptions options;
    options.finenesses = std::move(finenesses);
    options.poses = 60;
    return runErrors(GetParam(), exactCold(), options);
  }
};

// A surface of curvature k departs from a facet of edge h by its sagitta, k h^2 / 8: that much a distance is
// wrong. Facets' normals are wrong by k h / 2, and a point is known to a facet: first order.
TEST_P(ErrorOfTheExactEngine, FallsWithTheSquareOfTheEdgeInDistanceAndWithTheEdgeInPlaceAndDirection) {
  const std::vector<ErrorRow> finer = rows({4, 8, 16, 32});
  if (GetParam().kind == PairKind::Exact) {
    for (const ErrorRow& row : finer) {
      for (const ErrorSummary& e : {row.distance, row.position, row.direction, row.force, row.torque})
        EXPECT_LT(e.max, kRounding);
    }
    return;
  }
  EXPECT_GE(orderOf(finer, &ErrorRow::distance), 1.9);
  EXPECT_GE(orderOf(finer, &ErrorRow::position), 0.9);
  if (GetParam().isSceneCurved) {
    EXPECT_GE(orderOf(finer, &ErrorRow::direction), 0.9);
  } else {
    for (const ErrorRow& row : finer)
      EXPECT_LT(row.direction.max, kRounding);  // The floor's own.
  }
}

TEST_P(ErrorOfTheExactEngine, HasNoContactMissedOrSpurious) {
  for (const ErrorRow& row : rows({8, 24})) {
    EXPECT_EQ(row.missed, 0.0);
    if (!GetParam().hasSaddles) {
      EXPECT_EQ(row.spurious, 0.0);
    }
  }
}

std::string nameOf(const ::testing::TestParamInfo<ErrorPair>& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Pairs, ErrorOfTheExactEngine, ::testing::ValuesIn(errorPairs()), nameOf);

// Two solids that bulge have one nearest pair, and so have their meshes: the sum of springs converges there.
TEST(SumOfSprings, ConvergesWithTheEdgeWhereSolidsAreConvex) {
  ErrorRunOptions options;
  options.finenesses = {4, 8, 16, 32};
  options.poses = 60;
  for (const char* name : {"sphere-sphere", "capsule-capsule", "ellipsoid-plane", "cylinder-lying"}) {
    const std::vector<ErrorRow> rows = runErrors(pairNamed(name), exactCold(), options);
    EXPECT_GE(orderOf(rows, &ErrorRow::force), 0.9) << name;
    EXPECT_GE(orderOf(rows, &ErrorRow::torque), 0.9) << name;
    for (const ErrorRow& row : rows)
      EXPECT_EQ(row.extra, 0.0) << name;
  }
}

// Facets make several minima of a contact where surfaces nearly conform: each is a spring, at any fineness.
// The nearest of each neighbourhood alone has the force of the solids.
TEST(SumOfSprings, ConvergesWithTheEdgeWhereOneOfEachGroupCounts) {
  ErrorRunOptions options;
  options.finenesses = {8, 16, 32};
  options.poses = 60;
  const std::vector<ErrorMethodEntry> grouped{exactErrorMethods().back()};
  for (const char* name : {"sphere-torus", "sphere-bowl", "sphere-nest"})
    EXPECT_GE(orderOf(runErrors(pairNamed(name), grouped, options), &ErrorRow::force), 0.9) << name;
}

// Along a way of many ticks, from lists and from searches for itself, also where a jump lies between.
TEST(TrackedMinima, AreColdOnesToTheLastBitAlongEveryWay) {
  for (const ErrorPair& pair : errorPairs()) {
    const ErrorScene scene(pair.scene(8), pair.part(8), pair.cutoff);
    TrackedQuery tracked(scene.bodies);
    LmdScratch scratch;
    std::vector<Lmd> cold(LmdScratch::kDefaultCapacity);
    std::uint64_t seed = 5;
    for (const ErrorPose& pose : randomPoses(pair, 10, seed)) {
      for (const RigidTransform& step : wayTo(pose.sceneFromPart, 60, ++seed)) {
        const Answer answer = tracked.query(step);
        const LmdResult result =
            findLmds(scene.bodies.sceneTree, scene.bodies.partTree, step, pair.cutoff, scratch, cold);
        ASSERT_TRUE(areSame(tracked.minima().first(answer.count), std::span(cold).first(result.count)))
            << pair.name;
        tracked.workAside(step);
      }
    }
  }
}

constexpr double kAside = 1e-4;  // [s]

/// Finds nothing, and lets another thread work for as long as that.
class WorksAside : public ErrorMethod {
 public:
  void answer(const RigidTransform&, ContactAnswer&) override {}
  void workAside(const RigidTransform&) override {
    const double start = secondsBy(BenchClock::Thread);
    while (secondsBy(BenchClock::Thread) - start < kAside) {
    }
  }
};

TEST(ErrorRows, SayWhatIsDoneBesideAnAnswer) {
  const std::vector<ErrorMethodEntry> methods{
      {"works aside", "", 1, false, [](const ErrorScene&) { return std::make_unique<WorksAside>(); }}};
  ErrorRunOptions options;
  options.finenesses = {1};
  options.poses = 5;
  options.clock = BenchClock::Thread;
  const std::vector<ErrorRow> rows = runErrors(errorPairs().front(), methods, options);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_GE(rows.front().aside, 1e6 * kAside);
  const std::string header = errorCsvHeader(), line = errorCsvLine(rows.front());
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(line.begin(), line.end(), ','));
}

TEST(WayTo, EndsWithThePoseAndGoesByATickAtATime) {
  const RigidTransform pose{glm::angleAxis(0.7, glm::dvec3(0.0, 1.0, 0.0)), {1.0, 2.0, 3.0}};
  const std::vector<RigidTransform> way = wayTo(pose, 5, 1);
  ASSERT_EQ(way.size(), 5U);
  EXPECT_EQ(way.back().translation, pose.translation);
  for (std::size_t i = 1; i < way.size(); ++i)
    EXPECT_NEAR(glm::distance(way[i].translation, way[i - 1].translation), 2e-4, 1e-12);
}

}  // namespace
}  // namespace nearfit::bench::error_run_test

#include "core/batch/part_queries.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::part_queries_test {
namespace {

using testing::HasSubstr;

RigidTransform at(double x, double y, double z) {
  return {glm::dquat(1.0, 0.0, 0.0, 0.0), {x, y, z}};
}

/// A cube of 1 m, which moves, over two others whose tops are at z = 0.5 and z = 0.3, at x = 0 and x = 3.
struct ThreeCubes {
  ThreeCubes() {
    const PartGeometryPtr cube = test::solidGeometryOf(test::boxMesh({1, 1, 1}));
    moving = scene.add(test::partOf(cube, "Moving", at(0, 0, 10)));
    scene.add(test::partOf(cube, "High"));
    scene.add(test::partOf(cube, "Low", at(3, 0, -0.2)));
  }
  Scene scene;
  PartId moving{};
};

/// Poses of a cube about the two others, turned at will.
std::vector<RigidTransform> posesAround(std::size_t count) {
  std::mt19937 random(25);
  std::uniform_real_distribution<double> place(-1.0, 4.0), turn(-1.0, 1.0);
  std::vector<RigidTransform> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dquat q(turn(random), turn(random), turn(random), turn(random));
    poses.push_back(
        RigidTransform{q, {place(random), 0.2 * turn(random), 1.8 + 0.3 * turn(random)}}.normalized());
  }
  return poses;
}

void expectSameTables(const MinimaTable& a, const MinimaTable& b) {
  EXPECT_EQ(a.offsets, b.offsets);
  EXPECT_EQ(a.distances, b.distances);
  EXPECT_EQ(a.movingPoints, b.movingPoints);
  EXPECT_EQ(a.fixedPoints, b.fixedPoints);
  EXPECT_EQ(a.directions, b.directions);
  EXPECT_EQ(a.others, b.others);
  EXPECT_EQ(a.features, b.features);
  EXPECT_EQ(a.isRegion, b.isRegion);
}

TEST(PartQueries, MinimaOfAllOtherPartsComeNearestFirst) {
  ThreeCubes cubes;
  PartQueries queries(cubes.scene, cubes.moving);
  EXPECT_THAT(queries.otherNames(), testing::ElementsAre("High", "Low"));
  // Between the two: 0.7 m over the low one, beside both by 1 m.
  const std::vector<RigidTransform> poses{at(0, 0, 1.25), at(3, 0, 1.0), at(0, 0, 100.0)};
  const MinimaTable table = queries.minima(poses, 0.5);
  ASSERT_EQ(table.poses(), 3U);
  ASSERT_EQ(table.offsets.back(), 2);
  EXPECT_NEAR(table.distances[0], 0.25, 1e-12);
  EXPECT_EQ(table.others[0], 0);
  EXPECT_NEAR(table.fixedPoints[0].z, 0.5, 1e-12);
  EXPECT_NEAR(table.movingPoints[0].z, 0.75, 1e-12);
  EXPECT_NEAR(table.directions[0].z, 1.0, 1e-12);
  EXPECT_NEAR(table.distances[1], 0.2, 1e-12);
  EXPECT_EQ(table.others[1], 1);
  EXPECT_EQ(table.offsets, (std::vector<std::int64_t>{0, 1, 2, 2}));
}

TEST(PartQueries, OfSeveralPartsTheNearestIsFirst) {
  ThreeCubes cubes;
  // A plate over both: 0.1 m over the high one, 0.3 m over the low one.
  const PartId plate = cubes.scene.add(
      test::partOf(test::solidGeometryOf(test::boxMesh({10, 10, 0.2})), "Plate", at(0, 0, 50)));
  PartQueries queries(cubes.scene, plate);
  const MinimaTable table = queries.minima(std::vector{at(1.5, 0, 0.7)}, 0.5);
  ASSERT_EQ(table.rows(), 2U);
  EXPECT_NEAR(table.distances[0], 0.1, 1e-12);
  EXPECT_NEAR(table.distances[1], 0.3, 1e-12);
  EXPECT_EQ(queries.otherNames()[static_cast<std::size_t>(table.others[0])], "High");
  EXPECT_EQ(queries.otherNames()[static_cast<std::size_t>(table.others[1])], "Low");
}

TEST(PartQueries, NumbersOfThreadsAndTrackingChangeNoBit) {
  ThreeCubes cubes;
  PartQueries queries(cubes.scene, cubes.moving);
  const std::vector<RigidTransform> poses = posesAround(300);
  const MinimaTable one = queries.minima(poses, 0.6, {.threads = 1});
  EXPECT_GT(one.rows(), 50U);
  expectSameTables(queries.minima(poses, 0.6, {.threads = 2}), one);
  expectSameTables(queries.minima(poses, 0.6), one);
  expectSameTables(queries.minima(poses, 0.6, {.isTracked = true}), one);
}

TEST(PartQueries, APartAtTheOriginIsAskedAtTheVeryPose) {
  Scene scene;
  const PartGeometryPtr cube = test::solidGeometryOf(test::boxMesh({1, 1, 1}));
  const PartId moving = scene.add(test::partOf(cube, "Moving", at(0, 0, 10)));
  scene.add(test::partOf(cube, "Fixed"));
  PartQueries queries(scene, moving);
  LmdCollector collector(1000);
  for (const RigidTransform& pose : posesAround(50)) {
    const LmdSet set = collector.collect(cube->tree(), cube->tree(), pose, 0.6);
    const MinimaTable table = queries.minima(std::vector{pose}, 0.6);
    ASSERT_EQ(table.rows(), set.lmds.size());
    for (std::size_t i = 0; i < set.lmds.size(); ++i) {
      EXPECT_EQ(table.distances[i], set.lmds[i].distance);
      EXPECT_EQ(table.movingPoints[i], set.lmds[i].partPoint);
      EXPECT_EQ(table.fixedPoints[i], set.lmds[i].scenePoint);
    }
  }
}

TEST(PartQueries, DistancesAndOverlapsFollowFromTheCubes) {
  ThreeCubes cubes;
  PartQueries queries(cubes.scene, cubes.moving);
  const std::vector<RigidTransform> poses{at(0, 0, 1.25), at(3, 0, 0.7), at(1.5, 0, 0.0), at(0, 0, 500.0)};
  const std::vector<double> distances = queries.distances(poses);
  EXPECT_NEAR(distances[0], 0.25, 1e-12);
  EXPECT_EQ(distances[1], 0.0);
  EXPECT_NEAR(distances[2], 0.5, 1e-12);
  EXPECT_NEAR(distances[3], 499.0, 1e-9);
  EXPECT_EQ(queries.overlaps(poses), (std::vector<std::uint8_t>{0, 1, 0, 0}));
  const std::vector<double> near = queries.distances(poses, 0.3);
  EXPECT_NEAR(near[0], 0.25, 1e-12);
  EXPECT_EQ(near[2], std::numeric_limits<double>::infinity());
}

TEST(PartQueries, AWrenchIsTheSumOfTheSprings) {
  ThreeCubes cubes;
  PartQueries queries(cubes.scene, cubes.moving);
  SpringParameters springs;
  springs.cutoff = 0.5;
  springs.stiffness = 200.0;
  // One region between faces, 0.25 m apart: 200 N/m times 0.25 m, through the centre.
  const std::vector<Wrench> wrenches = queries.wrenches(std::vector{at(0, 0, 1.25)}, springs);
  EXPECT_NEAR(wrenches[0].force.z, 50.0, 1e-9);
  EXPECT_NEAR(glm::length(wrenches[0].torque), 0.0, 1e-9);
}

TEST(PartQueries, HiddenPartsAreInNobodysWay) {
  ThreeCubes cubes;
  Part high = *cubes.scene.findByName("High");
  high.isVisible = false;
  cubes.scene.replace(high);
  PartQueries queries(cubes.scene, cubes.moving);
  EXPECT_EQ(queries.minima(std::vector{at(0, 0, 1.25)}, 0.5).rows(), 0U);
}

TEST(PartQueries, InvalidInputIsRefused) {
  ThreeCubes cubes;
  PartQueries queries(cubes.scene, cubes.moving);
  const std::vector<RigidTransform> poses{at(0, 0, 1.25)};
  for (const double cutoff : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(queries.minima(poses, cutoff), UsageError) << cutoff;
  EXPECT_THROW(queries.distances(poses, 0.0), UsageError);
  SpringParameters springs;
  springs.stiffness = 1e308;
  springs.cutoff = 100.0;
  try {
    queries.wrenches(poses, springs);
    ADD_FAILURE() << "no error";
  } catch (const Error& e) {
    EXPECT_THAT(std::string(e.what()), HasSubstr("too large"));
  }
}

TEST(PartQueries, ABatchThatIsCancelledEnds) {
  ThreeCubes cubes;
  PartQueries queries(cubes.scene, cubes.moving);
  BatchOptions options;
  options.progress = [](double) { return false; };
  EXPECT_THROW(queries.minima(posesAround(300), 0.6, options), Cancelled);
}

TEST(PartQueries, OfLargeMeshesEachPoseIsReported) {
  // 20,480 triangles each.
  const PartGeometryPtr ball = test::solidGeometryOf(test::icosphereMesh(1.0, 5));
  Scene scene;
  const PartId moving = scene.add(test::partOf(ball, "Moving", at(0, 0, 10)));
  scene.add(test::partOf(ball, "Fixed"));
  PartQueries slow(scene, moving);
  ThreeCubes cubes;
  PartQueries fast(cubes.scene, cubes.moving);
  EXPECT_TRUE(slow.arePosesSlow());
  EXPECT_FALSE(fast.arePosesSlow());
  std::vector<double> reports;
  BatchOptions options;
  options.threads = 1;
  options.progress = [&reports](double progress) {
    reports.push_back(progress);
    return reports.size() < 3;
  };
  // All in one stretch, which is reported as a whole where poses take no time.
  const std::vector<RigidTransform> poses(4, at(0, 0, 10));
  EXPECT_EQ(fast.distances(poses, 1.0, options).size(), 4U);
  EXPECT_EQ(reports, std::vector{1.0});
  reports.clear();
  EXPECT_THROW(slow.distances(poses, 1.0, options), Cancelled);
  EXPECT_EQ(reports, (std::vector{0.25, 0.5, 0.75}));
}

TEST(PartQueries, ReportsOfEachPoseChangeNoNumber) {
  const PartGeometryPtr ball = test::solidGeometryOf(test::icosphereMesh(1.0, 5));
  Scene scene;
  const PartId moving = scene.add(test::partOf(ball, "Moving"));
  scene.add(test::partOf(test::solidGeometryOf(test::boxMesh({1, 1, 1})), "Fixed"));
  PartQueries queries(scene, moving);
  ASSERT_TRUE(queries.arePosesSlow());
  // More than two stretches. A facet of the ball is nearer to its centre than its corners by 0.2 mm.
  std::vector<RigidTransform> poses;
  for (int i = 0; i < 40; ++i)
    poses.push_back(at(0, 0, 1.75 + 0.125 * i));
  const std::vector<double> found = queries.distances(poses, 10.0);
  const MinimaTable minima = queries.minima(poses, 10.0);
  ASSERT_EQ(minima.poses(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double expected = poses[i].translation.z - 1.5;
    EXPECT_NEAR(found[i], expected, 1e-3) << i;
    EXPECT_NEAR(minima.distances[static_cast<std::size_t>(minima.offsets[i])], expected, 1e-3) << i;
  }
}

}  // namespace
}  // namespace nearfit::part_queries_test

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "tests/bench/bench_shapes.h"
#include "tests/bench/decimated_mesh.h"
#include "tests/bench/error_method.h"
#include "tests/bench/error_shapes.h"
#include "tests/bench/mesh_distance.h"
#include "tests/bench/portable_random.h"
#include "tests/bench/signed_distance_field.h"
#include "tests/bench/surface_samples.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench::approximate_methods_test {
namespace {

std::vector<Lmd> minimaOf(const std::string& method, const ErrorScene& scene, const RigidTransform& pose) {
  for (const ErrorMethodEntry& entry : allErrorMethods()) {
    if (entry.name != method) continue;
    ContactAnswer answer;
    const auto made = entry.make(scene);
    made->answer(pose, answer);
    answer.clear();
    made->answer(pose, answer);
    return answer.minima;
  }
  ADD_FAILURE() << "there is no method " << method;
  return {};
}

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

TEST(ApproximateMethods, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const ErrorMethodEntry& entry : allErrorMethods())
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
}

TEST(ApproximateMethods, SinglePrecisionFindsTheSameSetOfJaggedBodiesToItsRounding) {
  std::mt19937_64 random(3);
  std::size_t same = 0, poses = 0, compared = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const test::BodyPair pair{"stars", test::starMesh(seed, 1.0, 2, 0.3),
                              test::starMesh(seed + 9, 1.0, 2, 0.3)};
    const ErrorScene scene(pair.scene, pair.part, 0.6);
    for (int i = 0; i < 8; ++i, ++poses) {
      const RigidTransform pose = test::poseNearContact(pair, 0.1, random);
      const auto exact = minimaOf("exact cold", scene, pose), single = minimaOf("float leaves", scene, pose);
      if (exact.size() != single.size()) continue;
      ++same;
      compared += exact.size();
      for (std::size_t k = 0; k < exact.size(); ++k)
        EXPECT_NEAR(exact[k].distance, single[k].distance, 2e-6);
    }
  }
  // A minimum that single precision tells wrongly is rare, but there may be one.
  EXPECT_GE(same + 2, poses);
  EXPECT_GT(compared, poses);
}

TEST(ApproximateMethods, SinglePrecisionDoesNotSeeAGapOfANanometreAtAMetre) {
  // Coordinates near 1/3 m are rounded to 3e-8 m there.
  const double gap = 1e-9;
  const ErrorScene scene(test::boxMesh({2.0, 2.0, 2.0 / 3.0}), test::coneMesh(0.1, 0.2, 12), 0.01);
  int wrong = 0;
  for (int i = 0; i < 10; ++i) {
    // The tip, at 0.2 on the part's axis, points down.
    const glm::dquat over = glm::angleAxis(std::numbers::pi, glm::normalize(glm::dvec3(1.0, 0.1 * i, 0.0)));
    const glm::dvec3 tip = over * glm::dvec3(0, 0, 0.2);
    const RigidTransform pose{over, glm::dvec3(0.1 + 0.07 * i, 0.05 * i, 1.0 / 3.0 + gap) - tip};
    const auto exact = minimaOf("exact cold", scene, pose), single = minimaOf("float leaves", scene, pose);
    ASSERT_EQ(exact.size(), 1U);
    EXPECT_NEAR(exact[0].distance, gap, 1e-15);
    wrong += single.size() != 1 || std::abs(single[0].distance - gap) > gap ? 1 : 0;
  }
  EXPECT_GE(wrong, 5);
}

TEST(ApproximateMethods, NormalSpanAddsAtTheSaddlesInARing) {
  // A ball within the ring's hole, nearer to one side: one minimum there by the exact rule on fine meshes or
  // some that facets make; by the spans at least those.
  const ErrorScene scene(fineTorusMesh(1.0, 0.25, 12, 6, 4), geodesicSphereMesh(0.3, 8), 0.25);
  std::size_t exact = 0, span = 0;
  for (int i = 0; i < 40; ++i) {
    const double angle = 0.15 * i;
    const RigidTransform pose = at(0.3 * glm::dvec3(std::cos(angle), std::sin(angle), 0.1));
    exact += minimaOf("exact cold", scene, pose).size();
    span += minimaOf("normal span", scene, pose).size();
  }
  EXPECT_GE(exact, 40U);
  EXPECT_GT(span, exact);
}

TEST(ApproximateMethods, PointsInAFieldFindABallOverTheFloorToACell) {
  const ErrorScene scene(test::boxMesh({4, 4, 0.5}, {0, 0, -0.25}), geodesicSphereMesh(0.5, 16), 0.25);
  const double cell = 4.5 / 128.0;
  const auto minima = minimaOf("points in field 128", scene, at({0.1, -0.2, 0.65}));
  ASSERT_EQ(minima.size(), 1U);
  // A point is within a spacing of the lowest, and no higher above it than the ball is there.
  EXPECT_NEAR(minima[0].distance, 0.15, cell * cell);
  EXPECT_GE(minima[0].distance, 0.15 - 1e-6);
  EXPECT_LT(glm::length(minima[0].direction - glm::dvec3(0, 0, 1)), 1e-6);
  EXPECT_LT(glm::distance(minima[0].partPoint, glm::dvec3(0.1, -0.2, 0.15)), 1.5 * cell);
  EXPECT_LT(glm::distance(minima[0].scenePoint, glm::dvec3(0.1, -0.2, 0.0)), 1.5 * cell);
}

TEST(ApproximateMethods, DecimatedBallsAndBoxesKeepTheirShape) {
  const TriangleMesh ball = decimatedMesh(geodesicSphereMesh(1.0, 16), 4);
  EXPECT_LE(ball.triangles().size(), 5120U / 4 + 2);
  EXPECT_TRUE(ball.topology().isClosed() && ball.topology().isOriented());
  for (const glm::dvec3& p : ball.vertices())
    EXPECT_NEAR(glm::length(p), 1.0, 1e-12);
  const TriangleMesh box = decimatedMesh(fineBoxMesh({1, 2, 3}, 16), 16);
  EXPECT_LE(box.triangles().size(), 12U * 256 / 16 + 2);
  // Its corners are there, and nothing stands out or is folded: its area is that of the box.
  double area = 0.0;
  const auto x = box.vertices();
  for (const Triangle& t : box.triangles())
    area += 0.5 * glm::length(glm::cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]));
  EXPECT_NEAR(area, 22.0, 1e-9);
  EXPECT_EQ(decimatedMesh(test::boxMesh({1, 1, 1}), 16).triangles().size(), 12U);
}

TEST(MeshDistance, OfABoxIsThatOfItsFormula) {
  const TriangleMesh mesh = fineBoxMesh({1, 2, 3}, 5);
  const MeshDistance distance(mesh);
  std::uint32_t nearest = 7;
  std::mt19937_64 random(2);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 p = 4.0 * glm::dvec3{uniform(random), uniform(random), uniform(random)} - 2.0;
    const glm::dvec3 beyond = glm::abs(p) - glm::dvec3(0.5, 1.0, 1.5);
    const double outside = glm::length(glm::max(beyond, glm::dvec3(0.0)));
    const double inside = -std::max({beyond.x, beyond.y, beyond.z});
    EXPECT_NEAR(distance.of(p, 1e9), inside > 0.0 ? inside : outside, 1e-12);
    EXPECT_EQ(distance.ofNext(p, nearest), distance.of(p, 1e9));
    EXPECT_NEAR(distance.of(p, 0.1), std::min(0.1, inside > 0.0 ? inside : outside), 1e-12);
  }
}

TEST(SignedDistanceField, OfABallIsItsDistanceToTheSquareOfACell) {
  const TriangleMesh ball = geodesicSphereMesh(1.0, 32);
  const NormalConeTree tree(ball);
  const SignedDistanceField field(tree, 32, 0.5);
  EXPECT_NEAR(field.cell(), 3.0 / 32.0, 1e-3);
  std::mt19937_64 random(4);
  for (int i = 0; i < 500; ++i) {
    const double r = 0.6 + 0.8 * uniform(random);
    const glm::dvec3 u = randomDirection(random);
    const auto sample = field.at(r * u);
    ASSERT_TRUE(sample.has_value());
    // Interpolation errs by an eighth of the square of the cell times the curvatures, 1/r, of two of the
    // directions, and the facets by their sagitta, below 1e-3.
    EXPECT_NEAR(sample->distance, r - 1.0, 0.25 * field.cell() * field.cell() / r + 1e-3);
    EXPECT_LT(glm::distance(sample->gradient, u), 3.0 * field.cell());
  }
  EXPECT_FALSE(field.at({0, 0, 1.6}).has_value());
  EXPECT_NEAR(field.distanceOfGrid({0, 0, 3.5}), 2.0, field.cell());
}

TEST(SurfaceSamples, LieApartAndLeaveNoHoles) {
  const TriangleMesh box = test::boxMesh({1, 1, 2});
  const SurfaceSamples samples(box, 0.1);
  const MeshDistance distance(box);
  std::size_t visited = 0;
  samples.forNear([](const glm::dvec3&, double) { return true; }, [&](std::uint32_t) { ++visited; });
  EXPECT_EQ(visited, samples.points().size());
  for (std::size_t i = 0; i < samples.points().size(); ++i) {
    EXPECT_LT(distance.of(samples.points()[i], 1.0), 1e-12);
    EXPECT_FALSE(samples.around(i).empty());
    for (const std::uint32_t k : samples.around(i)) {
      EXPECT_GE(glm::distance(samples.points()[i], samples.points()[k]), 0.1);
      EXPECT_LE(glm::distance(samples.points()[i], samples.points()[k]), 0.25);
    }
  }
  // Hexagons as dense as can be would be 1 / (0.1^2 sin 60) a square metre; darts leave more than half.
  EXPECT_GT(static_cast<double>(samples.points().size()), 0.5 * 10.0 / (0.01 * 0.866));
}

}  // namespace
}  // namespace nearfit::bench::approximate_methods_test

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/exact/exact_comparison.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"

/// Edges that are nearly parallel, at angles on both sides of what counts as parallel.
namespace nearfit::lmd_robustness_edges_test {
namespace {

using std::numbers::pi;
using test::BodyPair;
using test::ExactComparison;

/// The part's edge along y, upside down over the scene's, turned by `angle` about where it crosses at
/// `cross`.
RigidTransform crossedEdges(double angle, double cross, double gap) {
  const glm::dvec3 pivot(0.0, cross, gap);
  const glm::dquat turn = glm::angleAxis(angle, glm::dvec3(0, 0, 1)) * glm::dquat(0, 0, 1, 0);
  return {turn, pivot - turn * glm::dvec3(0.0, cross, 0.0)};
}

std::vector<double> smallAngles() {
  std::vector<double> angles{0.0};
  for (int k = 3; k <= 15; ++k) {
    for (const double factor : {1.0, 2.0, 5.0})
      angles.push_back(factor * std::pow(10.0, -k));
  }
  return angles;
}

TEST(LmdRobustness, NearlyParallelEdgesHaveOneMinimumAtEveryAngle) {
  // Wedges edge to edge are nearest where the edges cross, and are as near at every other point as the angle
  // is small: one minimum or one region, never one at each end besides.
  const TriangleMesh wedge = test::wedgeMesh(0.6);
  const NormalConeTree tree(wedge);
  for (const double gap : {1e-4, 1e-3, 0.1}) {
    for (const double cross : {0.0, 0.4, 0.999, 1.0 - 1e-7, 1.0 - 1e-12}) {
      for (const double angle : smallAngles()) {
        const std::vector<Lmd> found = test::allLmds(tree, tree, crossedEdges(angle, cross, gap), 2.0 * gap);
        ASSERT_EQ(found.size(), 1U) << fmt::format("gap {}, crossing at {}, angle {}", gap, cross, angle);
        // d^2 = gap^2 + (angle * y)^2 from the crossing on, and the angle resolves no more than this.
        EXPECT_NEAR(found[0].distance, gap, 1e-9) << fmt::format("{} {} {}", gap, cross, angle);
        EXPECT_GT(found[0].direction.z, 1.0 - 1e-6);
        if (found[0].isRegion) continue;
        const double place = std::abs(found[0].scenePoint.y - cross);
        EXPECT_LE(place * angle * angle, 2e-10 * gap + 1e-14) << fmt::format("{} {} {}", gap, cross, angle);
      }
    }
  }
}

TEST(LmdRobustness, NearlyParallelEdgesHaveTheExactSet) {
  const BodyPair pair{"near-parallel", test::wedgeMesh(0.6), test::wedgeMesh(0.4)};
  ExactComparison comparison(pair);
  std::mt19937_64 random(61);
  std::uniform_real_distribution<double> unit(-1.2, 1.2);
  for (const double angle : smallAngles()) {
    for (const double gap : {1e-7, 1e-3, 0.1}) {
      RigidTransform pose = crossedEdges(angle, unit(random), gap);
      // Tilted a little across as well, so that ends differ in height.
      pose.rotation = pose.rotation * glm::angleAxis(angle * unit(random), glm::dvec3(1, 0, 0));
      comparison.checkPose(pose, 0.3);
    }
  }
  EXPECT_GT(comparison.tally().found, 100U);
}

TEST(LmdRobustness, EdgesNearlyParallelToFacesHaveTheExactSet) {
  const BodyPair pair{"edge over floor", test::boxMesh({3, 3, 0.5}, {0, 0, -0.25}), test::wedgeMesh(0.6)};
  ExactComparison comparison(pair);
  for (const double angle : smallAngles()) {
    for (const double sign : {-1.0, 1.0}) {
      const glm::dquat turn = glm::angleAxis(sign * angle, glm::dvec3(1, 0, 0)) * glm::dquat(0, 0, 1, 0);
      comparison.checkPose({turn, {0.1, 0.05, 0.02}}, 0.3);
      comparison.checkPose({turn * glm::angleAxis(pi / 7, glm::dvec3(0, 0, 1)), {0.1, 0.05, 0.02}}, 0.3);
    }
  }
  EXPECT_GT(comparison.tally().found, 100U);
}

TEST(LmdRobustness, NearlyParallelFacesHaveTheExactSet) {
  const BodyPair pair{"box over floor", test::boxMesh({3, 3, 0.5}, {0, 0, -0.25}), test::boxMesh({1, 1, 1})};
  ExactComparison comparison(pair);
  for (const double angle : smallAngles()) {
    for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), glm::dvec3(0.6, 0.8, 0), glm::dvec3(0, -1, 0)})
      comparison.checkPose({glm::angleAxis(angle, axis), {0.1, 0.05, 0.52}}, 0.3);
  }
  EXPECT_GT(comparison.tally().found, 100U);
}

}  // namespace
}  // namespace nearfit::lmd_robustness_edges_test

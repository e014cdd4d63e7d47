// What the hand feels of flats does not depend on how finely they are cut into triangles.
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/support/mesh_generators.h"
#include "tests/support/proxy_walk.h"

namespace nearfit::dense_flats_test {
namespace {

using std::numbers::pi;

constexpr double kMargin = 1e-4;    // [m]
constexpr double kSamePose = 1e-6;  // [m]
constexpr double kSameTurn = 1e-5;  // Moves the farthest points of these parts by less than kSamePose [rad].

struct Walk {
  std::vector<RigidTransform> poses;
  std::uint64_t work = 0;  ///< Of all ticks.
  std::size_t starved = 0;
};

/// A hand that presses, slides and turns a part.
Walk walk(const TriangleMesh& scene, const TriangleMesh& part, const RigidTransform& start, int ticks) {
  test::ProxyWalk led({{scene, {}}}, part, start, {.margin = kMargin});
  Walk walked;
  for (int i = 0; i < ticks; ++i) {
    const double t = 1e-3 * i;
    RigidTransform hand = start;
    hand.translation +=
        glm::dvec3(0.01 * std::sin(7.0 * t), 8e-3 * std::sin(11.0 * t), -4e-3 * std::min(1.0, 5.0 * t));
    hand.rotation =
        glm::normalize(glm::angleAxis(0.05 * std::sin(5.0 * t), glm::dvec3(0.6, 0.0, 0.8)) * start.rotation);
    const ProxyAccount& account = led.lead(hand);
    walked.poses.push_back(led.pose());
    walked.work += led.proxy().work();
    walked.starved += account.isStarved ? 1 : 0;
  }
  return walked;
}

void expectSame(const Walk& coarse, const Walk& fine) {
  ASSERT_EQ(coarse.poses.size(), fine.poses.size());
  for (std::size_t i = 0; i < coarse.poses.size(); ++i) {
    const RigidTransform &a = coarse.poses[i], &b = fine.poses[i];
    ASSERT_LT(glm::distance(a.translation, b.translation), kSamePose) << "tick " << i;
    ASSERT_GT(std::abs(glm::dot(a.rotation, b.rotation)), std::cos(0.5 * kSameTurn)) << "tick " << i;
  }
  // A tick costs what the contact says, not how many triangles say it.
  EXPECT_LE(fine.work, coarse.work + coarse.work / 4);
  EXPECT_EQ(fine.starved, coarse.starved);
}

/// Even cuts, then cuts at random.
TriangleMesh fine(const TriangleMesh& mesh, std::uint32_t times) {
  return test::cutUnevenly(test::subdivided(mesh, times), 300, 5);
}

TEST(DenseFlats, BlockOnAPlateFeelsTheSame) {
  const TriangleMesh plate = test::boxMesh({0.2, 0.2, 0.02}, {0.0, 0.0, -0.01});
  const TriangleMesh block = test::boxMesh({0.05, 0.04, 0.03});
  const RigidTransform start{{1, 0, 0, 0}, {0.0, 0.0, 0.0155}};
  const Walk coarse = walk(plate, block, start, 600);
  EXPECT_LT(coarse.poses.back().translation.z, 0.0153) << "in contact";
  for (const std::uint32_t times : {2U, 4U})
    expectSame(coarse, walk(fine(plate, times), fine(block, times), start, 600));
}

TEST(DenseFlats, EdgeOnAFlatFeelsTheSame) {
  const TriangleMesh plate = test::boxMesh({0.2, 0.2, 0.02}, {0.0, 0.0, -0.01});
  const TriangleMesh block = test::boxMesh({0.05, 0.04, 0.04});
  const RigidTransform start{glm::angleAxis(0.25 * pi, glm::dvec3(1, 0, 0)), {0.0, 0.0, 0.0288}};
  expectSame(walk(plate, block, start, 600), walk(fine(plate, 3), fine(block, 3), start, 600));
}

TEST(DenseFlats, PegInItsBoreFeelsTheSame) {
  const TriangleMesh bore = test::tubeMesh(0.02, 0.03, 0.04, 24), peg = test::cylinderMesh(0.0195, 0.06, 24);
  expectSame(walk(bore, peg, {}, 600), walk(fine(bore, 2), fine(peg, 2), {}, 600));
}

// A sheet has no inside: its triangles are tested from either side, without lists.
TEST(DenseFlats, OpenSheetFeelsTheSame) {
  const TriangleMesh sheet = test::squareMesh(0.2, 1), block = test::boxMesh({0.05, 0.04, 0.03});
  const RigidTransform start{{1, 0, 0, 0}, {0.0, 0.0, 0.0155}};
  expectSame(walk(sheet, block, start, 400), walk(fine(sheet, 5), fine(block, 3), start, 400));
}

}  // namespace
}  // namespace nearfit::dense_flats_test

#include "tests/support/lmd_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/lmd_query.h"
#include "tests/support/lmd_oracle.h"

namespace nearfit::test {
namespace {

/// Agreement asked of points, as a fraction of the scene's diagonal.
constexpr double kPointAgreement = 1e-9;

/// Slack within which rounding may decide either way: a few thousand roundings of a direction between points
/// that are a millionth of the scene apart.
constexpr double kMarginal = 1e-8;

}  // namespace

std::vector<Lmd> allLmds(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& pose,
                         double cutoff) {
  LmdScratch scratch;
  std::vector<Lmd> out(8192);
  const LmdResult result = findLmds(scene, part, pose, cutoff, scratch, out);
  EXPECT_EQ(result.status, QueryStatus::Complete);
  out.resize(result.count);
  return out;
}

RigidTransform randomRotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return RigidTransform{{normal(random), normal(random), normal(random), normal(random)}, glm::dvec3(0.0)}
      .normalized();
}

RigidTransform poseNearContact(const BodyPair& pair, double reach, std::mt19937_64& random) {
  const auto pick = [&](const TriangleMesh& mesh) {
    const Triangle& t = mesh.triangles()[random() % mesh.triangles().size()];
    return mesh.vertices()[t[random() % 3]];
  };
  std::uniform_real_distribution<double> offset(-reach, reach);
  RigidTransform pose = randomRotation(random);
  const bool isSeparated = random() % 2 == 0;
  pose.translation = pick(pair.scene) - pose.rotation * pick(pair.part) +
                     glm::dvec3(offset(random), offset(random), offset(random));
  if (!isSeparated) return pose;

  // Along a random direction to where the hulls are within reach of each other.
  const glm::dvec3 u = randomRotation(random).rotation * glm::dvec3(0, 0, 1);
  double sceneEnd = -std::numeric_limits<double>::infinity(), partStart = -sceneEnd;
  for (const glm::dvec3& x : pair.scene.vertices())
    sceneEnd = std::max(sceneEnd, glm::dot(u, x));
  for (const glm::dvec3& x : pair.part.vertices())
    partStart = std::min(partStart, glm::dot(u, pose.applyToPoint(x)));
  pose.translation += (sceneEnd - partStart + 0.5 * offset(random)) * u;
  return pose;
}

namespace {

bool isSame(const Lmd& a, const OracleMinimum& b, double tolerance) {
  return glm::distance(a.scenePoint, b.scenePoint) <= tolerance &&
         glm::distance(a.partPoint, b.partPoint) <= tolerance;
}

/// Each certain minimum of the oracle is found, each found one is the oracle's (marginal or not), and none
/// twice.
void expectSameSet(const std::vector<Lmd>& found, const std::vector<OracleMinimum>& expected, double cutoff,
                   double size, const std::string& where, LmdTally& tally) {
  const double tolerance = kPointAgreement * size;
  ++tally.poses;
  for (const OracleMinimum& e : expected) {
    const bool isMarginal =
        e.slack < kMarginal || e.distance > cutoff - tolerance || e.distance < kMarginal * size;
    (isMarginal ? tally.marginal : tally.minima) += 1;
    const auto matches =
        std::count_if(found.begin(), found.end(), [&](auto& f) { return isSame(f, e, tolerance); });
    if (!isMarginal) {
      EXPECT_EQ(matches, 1) << where
                            << fmt::format(": {}-{} at {:.17g}, slack {}", e.features[0], e.features[1],
                                           e.distance, e.slack);
    }
  }
  for (const Lmd& f : found) {
    EXPECT_TRUE(
        std::any_of(expected.begin(), expected.end(), [&](auto& e) { return isSame(f, e, tolerance); }))
        << where
        << fmt::format(": spurious {}-{} at {:.17g}", static_cast<int>(f.sceneFeature),
                       static_cast<int>(f.partFeature), f.distance);
    EXPECT_NEAR(glm::distance(f.scenePoint, f.partPoint), f.distance, tolerance) << where;
  }
  EXPECT_TRUE(
      std::is_sorted(found.begin(), found.end(), [](auto& a, auto& b) { return a.distance < b.distance; }));
}

}  // namespace

LmdTally compareWithOracle(const BodyPair& pair, std::size_t poses, double cutoffFraction,
                           std::uint64_t seed) {
  const NormalConeTree sceneTree(pair.scene), partTree(pair.part);
  const OracleBody scene(pair.scene), part(pair.part);
  const double size = std::max(scene.size(), part.size());
  const double cutoff = cutoffFraction * size;
  std::mt19937_64 random(seed);
  LmdTally tally;
  for (std::size_t i = 0; i < poses && !testing::Test::HasFailure(); ++i) {
    const RigidTransform pose = poseNearContact(pair, cutoff, random);
    const auto expected = bruteForceMinima(scene, part, pose, cutoff, 2.0 * kMarginal);
    expectSameSet(allLmds(sceneTree, partTree, pose, cutoff), expected, cutoff, scene.size() + part.size(),
                  fmt::format("{}, pose {}", pair.name, i), tally);
  }
  return tally;
}

}  // namespace nearfit::test

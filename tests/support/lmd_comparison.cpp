#include "tests/support/lmd_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/query/lmd_query.h"
#include "tests/support/lmd_oracle.h"
#include "tests/support/region_oracle.h"

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
  // Megabytes, which under sanitizers take longer to come by than the query.
  thread_local LmdScratch scratch;
  thread_local std::vector<Lmd> out(8192);
  const LmdResult result = findLmds(scene, part, pose, cutoff, scratch, out);
  EXPECT_EQ(result.status, QueryStatus::Complete);
  return {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(result.count)};
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
  // One after the other: in which order a compiler draws the operands of a sum is its own affair.
  const glm::dvec3 onScene = pick(pair.scene), onPart = pick(pair.part);
  const glm::dvec3 gap{offset(random), offset(random), offset(random)};
  pose.translation = onScene - pose.rotation * onPart + gap;
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

RigidTransform poseWithParallelFaces(const BodyPair& pair, double reach, double tilt,
                                     std::mt19937_64& random) {
  const auto pick = [&](const TriangleMesh& mesh, glm::dvec3& normal) {
    const Triangle& t = mesh.triangles()[random() % mesh.triangles().size()];
    const glm::dvec3 a = mesh.vertices()[t[0]], b = mesh.vertices()[t[1]], c = mesh.vertices()[t[2]];
    normal = glm::normalize(glm::cross(b - a, c - a));
    std::uniform_real_distribution<double> share(0.1, 0.45);
    return a + share(random) * (b - a) + share(random) * (c - a);
  };
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  glm::dvec3 n, m;
  const glm::dvec3 p = pick(pair.scene, n), q = pick(pair.part, m);
  const glm::dquat spin = glm::angleAxis(6.0 * unit(random), n);
  // Which turn takes one to the opposite of the other is any that does.
  const glm::dvec3 helper = std::abs(m.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 across = glm::normalize(glm::cross(m, helper));
  const glm::dquat flip = glm::angleAxis(std::acos(-1.0), across);  // m to -m.
  const glm::dvec3 tiltAxis = randomRotation(random).rotation * glm::dvec3(0, 0, 1);
  RigidTransform pose;
  pose.rotation = glm::normalize(glm::angleAxis(tilt, tiltAxis) * spin * glm::dquat(m, n) * flip);
  pose.translation = p + (0.1 + 0.9 * unit(random)) * reach * n - pose.rotation * q;
  return pose;
}

namespace {

bool isSame(const Lmd& a, const OracleMinimum& b, double tolerance) {
  return glm::distance(a.scenePoint, b.scenePoint) <= tolerance &&
         glm::distance(a.partPoint, b.partPoint) <= tolerance;
}

bool isSameRegion(const Lmd& a, const OracleRegion& b, double size) {
  // Regions that are tilted within the tolerance may be measured along either face's normal.
  constexpr double kRegionAgreement = 1e-6;
  const double tolerance = kRegionAgreement * size;
  return a.isRegion && a.extent.dimension == b.dimension &&
         glm::distance(a.scenePoint, b.centroid) <= tolerance &&
         std::abs(a.extent.measure - b.measure) <= tolerance * (b.dimension == 2 ? size : 1.0) &&
         std::abs(a.distance - b.least) <= kPointAgreement * size;
}

/// What the oracle says of a pose.
struct Expected {
  std::vector<OracleMinimum> minima;
  std::vector<OracleRegion> regions;
};

/// Each certain minimum of the oracle is found unless a region stands for it, each found one is the oracle's
/// (marginal or not), and none twice; likewise regions.
void expectSameSet(const std::vector<Lmd>& found, const Expected& expected, double cutoff, double size,
                   const std::string& where, LmdTally& tally) {
  const double tolerance = kPointAgreement * size;
  ++tally.poses;
  for (const OracleMinimum& e : expected.minima) {
    // Along parallel edges and faces anything goes.
    if (std::any_of(expected.regions.begin(), expected.regions.end(),
                    [&](auto& r) { return isOfRegion(e, r, 1e-5 * size); }))
      continue;
    const bool isMarginal =
        e.slack < kMarginal || e.distance > cutoff - tolerance || e.distance < kMarginal * size;
    (isMarginal ? tally.marginal : tally.minima) += 1;
    const auto matches = std::count_if(found.begin(), found.end(),
                                       [&](auto& f) { return !f.isRegion && isSame(f, e, tolerance); });
    if (!isMarginal) {
      EXPECT_EQ(matches, 1) << where
                            << fmt::format(": {}-{} at {:.17g}, slack {}", e.features[0], e.features[1],
                                           e.distance, e.slack);
    }
  }
  for (const OracleRegion& r : expected.regions) {
    ++tally.regions;
    const auto matches =
        std::count_if(found.begin(), found.end(), [&](auto& f) { return isSameRegion(f, r, size); });
    const bool isMarginal = r.least > cutoff - tolerance || r.least < 1e-5 * size;
    EXPECT_TRUE(matches == 1 || isMarginal)
        << where
        << fmt::format(": region of dimension {}, measure {:.12g} at {:.17g}", r.dimension, r.measure,
                       r.least);
  }
  for (const Lmd& f : found) {
    const bool isKnown =
        f.isRegion ? std::any_of(expected.regions.begin(), expected.regions.end(),
                                 [&](auto& r) { return isSameRegion(f, r, size) || r.least < 1e-5 * size; })
                   : std::any_of(expected.minima.begin(), expected.minima.end(),
                                 [&](auto& e) { return isSame(f, e, tolerance); });
    EXPECT_TRUE(isKnown) << where
                         << fmt::format(": spurious {}-{} at {:.17g}, measure {:.12g}",
                                        static_cast<int>(f.sceneFeature), static_cast<int>(f.partFeature),
                                        f.distance, f.extent.measure);
    EXPECT_NEAR(glm::distance(f.scenePoint, f.partPoint), f.distance, f.isRegion ? 1e-6 * size : tolerance)
        << where;
  }
  EXPECT_TRUE(
      std::is_sorted(found.begin(), found.end(), [](auto& a, auto& b) { return a.distance < b.distance; }));
}

}  // namespace

void compareAtPose(const BodyPair& pair, const RigidTransform& pose, double cutoff, LmdTally& tally) {
  const OracleBody scene(pair.scene), part(pair.part);
  const Expected expected{bruteForceMinima(scene, part, pose, cutoff, 2.0 * kMarginal),
                          bruteForceRegions(scene, part, pose, cutoff)};
  expectSameSet(allLmds(NormalConeTree(pair.scene), NormalConeTree(pair.part), pose, cutoff), expected,
                cutoff, scene.size() + part.size(), pair.name, tally);
}

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
    // No faces or edges are parallel at random.
    const Expected expected{bruteForceMinima(scene, part, pose, cutoff, 2.0 * kMarginal), {}};
    expectSameSet(allLmds(sceneTree, partTree, pose, cutoff), expected, cutoff, scene.size() + part.size(),
                  fmt::format("{}, pose {}", pair.name, i), tally);
  }
  return tally;
}

}  // namespace nearfit::test

#include "core/proximity/lmd_query.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/mesh/mesh_import.h"
#include "core/proximity/normal_cone_tree.h"
#include "tests/support/lmd_oracle.h"
#include "tests/support/mesh_generators.h"

namespace nearfit {
namespace {

using test::OracleBody;
using test::OracleMinimum;

/// Agreement asked of points, as a fraction of the scene's diagonal.
constexpr double kPointAgreement = 1e-9;

/// Slack within which rounding may decide either way: a few thousand roundings of a direction between points
/// that are a millionth of the scene apart.
constexpr double kMarginal = 1e-8;

struct Pair {
  std::string name;
  TriangleMesh scene, part;
};

std::vector<Lmd> query(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& pose,
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

/// A random vertex of the part lies near a random vertex of the scene, at any orientation: near contact, with
/// the bodies interpenetrating elsewhere as often as not.
RigidTransform poseNearContact(const Pair& pair, double reach, std::mt19937_64& random) {
  const auto pick = [&](const TriangleMesh& mesh) {
    const Triangle& t = mesh.triangles()[random() % mesh.triangles().size()];
    return mesh.vertices()[t[random() % 3]];
  };
  std::uniform_real_distribution<double> offset(-reach, reach);
  RigidTransform pose = randomRotation(random);
  pose.translation = pick(pair.scene) - pose.rotation * pick(pair.part) +
                     glm::dvec3(offset(random), offset(random), offset(random));
  return pose;
}

/// Counts of a comparison, so that a test can ask that it compared anything.
struct Tally {
  std::size_t poses = 0, minima = 0, marginal = 0;
};

bool isSame(const Lmd& a, const OracleMinimum& b, double tolerance) {
  return glm::distance(a.scenePoint, b.scenePoint) <= tolerance &&
         glm::distance(a.partPoint, b.partPoint) <= tolerance;
}

/// Each certain minimum of the oracle is found, each found one is the oracle's (marginal or not), and none
/// twice.
void expectSameSet(const std::vector<Lmd>& found, const std::vector<OracleMinimum>& expected, double cutoff,
                   double size, const std::string& where, Tally& tally) {
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

Tally compareWithOracle(const Pair& pair, std::size_t poses, double cutoffFraction, std::uint64_t seed) {
  const NormalConeTree sceneTree(pair.scene), partTree(pair.part);
  const OracleBody scene(pair.scene), part(pair.part);
  const double size = std::max(scene.size(), part.size());
  const double cutoff = cutoffFraction * size;
  std::mt19937_64 random(seed);
  Tally tally;
  for (std::size_t i = 0; i < poses && !testing::Test::HasFailure(); ++i) {
    const RigidTransform pose = poseNearContact(pair, cutoff, random);
    const auto expected = test::bruteForceMinima(scene, part, pose, cutoff, 2.0 * kMarginal);
    expectSameSet(query(sceneTree, partTree, pose, cutoff), expected, cutoff, scene.size() + part.size(),
                  fmt::format("{}, pose {}", pair.name, i), tally);
  }
  return tally;
}

/// The bodies of the paper's appendix where the shared models are there, else stand-ins of the same counts.
class PaperBodies {
 public:
  TriangleMesh load(const std::string& file, const std::function<TriangleMesh()>& standIn) const {
    const std::filesystem::path path =
        std::filesystem::path(NEARFIT_SHARED_DIR) / "models/public/paper_counts" / file;
    return std::filesystem::exists(path) ? importMesh(path, {}).mesh : standIn();
  }
  /// Scaled to a bounding box of unit diagonal, as the parts of one assembly would be alike in size.
  static TriangleMesh unitSize(const TriangleMesh& mesh) {
    return test::transformed(mesh, 1.0 / mesh.bounds().diagonal());
  }
  TriangleMesh sphere() const {
    return unitSize(load("sphere_128.obj", [] { return test::uvSphereMesh(1.0, 16, 5); }));
  }
  TriangleMesh bunny() const {
    return unitSize(load("bunny_2204.ply", [] { return test::starMesh(7, 1.0, 3, 0.2); }));
  }
  TriangleMesh teapot() const {
    return unitSize(load("teapot_5648.ply", [] {
      return test::joined(test::starMesh(8, 1.0, 4, 0.05), test::squareMesh(1.0, 16));
    }));
  }
  TriangleMesh spring() const {
    return unitSize(load("spring_23578.ply", [] { return test::torusMesh(1.0, 0.1, 393, 30); }));
  }
  TriangleMesh gear() const {
    return unitSize(load("gear_6302.ply", [] { return test::tubeMesh(0.5, 1.0, 0.4, 787); }));
  }
  TriangleMesh disc() const {
    return unitSize(load("disc_512.stl", [] { return test::cylinderMesh(1.0, 0.2, 128); }));
  }
  TriangleMesh crankshaft() const {
    return unitSize(load("crankshaft_12802.ply", [] { return test::torusMesh(1.0, 0.3, 100, 64); }));
  }
};

void expectPaperPairAgrees(const Pair& pair, std::size_t poses) {
  const Tally tally = compareWithOracle(pair, poses, 0.02, 2003);
  EXPECT_EQ(tally.poses, poses);
  EXPECT_GT(tally.minima, 10 * poses);  // The poses are near contact: there is something to compare.
  EXPECT_LT(tally.marginal, tally.minima / 1000 + 5);
}

TEST(LmdQueryOnPaperPairs, BunnyAgainstSphereHasTheBruteForceSet) {
  expectPaperPairAgrees({"bunny-sphere", PaperBodies().bunny(), PaperBodies().sphere()}, 600);
}
TEST(LmdQueryOnPaperPairs, SpringAgainstTeapotHasTheBruteForceSet) {
  expectPaperPairAgrees({"spring-teapot", PaperBodies().spring(), PaperBodies().teapot()}, 150);
}
TEST(LmdQueryOnPaperPairs, GearAgainstDiscHasTheBruteForceSet) {
  expectPaperPairAgrees({"gear-disc", PaperBodies().gear(), PaperBodies().disc()}, 300);
}
TEST(LmdQueryOnPaperPairs, GearAgainstGearHasTheBruteForceSet) {
  expectPaperPairAgrees({"gear-gear", PaperBodies().gear(), PaperBodies().gear()}, 200);
}
TEST(LmdQueryOnPaperPairs, CrankshaftAgainstGearHasTheBruteForceSet) {
  expectPaperPairAgrees({"crankshaft-gear", PaperBodies().crankshaft(), PaperBodies().gear()}, 200);
}
TEST(LmdQueryOnPaperPairs, CrankshaftAgainstSphereHasTheBruteForceSet) {
  expectPaperPairAgrees({"crankshaft-sphere", PaperBodies().crankshaft(), PaperBodies().sphere()}, 300);
}

TEST(LmdQuery, RandomClosedMeshesHaveTheBruteForceSetAtEveryScale) {
  std::mt19937_64 random(42);
  Tally sum;
  for (const double scale : {1e-3, 1.0, 1e3}) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const double partScale = scale * std::pow(10.0, static_cast<double>(seed % 3) - 1.0);
      Pair pair{fmt::format("stars {} at scale {}", seed, scale),
                test::transformed(test::starMesh(seed, 1.0, 2, 0.4), scale),
                test::transformed(test::starMesh(seed + 100, 1.0, seed % 2 == 0 ? 1 : 2, 0.4), partScale)};
      const Tally tally = compareWithOracle(pair, 40, 0.2, random());
      sum.poses += tally.poses;
      sum.minima += tally.minima;
      sum.marginal += tally.marginal;
    }
  }
  EXPECT_EQ(sum.poses, 1440U);
  EXPECT_GT(sum.minima, 5'000U);
  EXPECT_LT(sum.marginal, sum.minima / 1000 + 5);
}

TEST(LmdQuery, MeshesTenThousandDiagonalsFromTheirOriginsHaveTheBruteForceSet) {
  // Coordinates are rounded where the mesh lies; the oracle gets the same rounded mesh.
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const RigidTransform away{{1, 0, 0, 0}, {1e4, -2e4, 1.5e4}}, back{{1, 0, 0, 0}, {-3e4, 1e3, 2e4}};
    const Pair pair{fmt::format("far {}", seed),
                    test::transformed(test::starMesh(seed, 1.0, 2, 0.3), 1.0, away),
                    test::transformed(test::starMesh(seed + 50, 1.0, 2, 0.3), 1.0, back)};
    const Tally tally = compareWithOracle(pair, 40, 0.2, seed);
    EXPECT_GT(tally.minima, 40U);  // One a pose: there is something to compare.
  }
}

TEST(LmdQuery, SwappingTheBodiesSwapsTheResult) {
  const Pair pair{"stars", test::starMesh(1, 1.0, 3, 0.3), test::starMesh(2, 0.5, 2, 0.3)};
  const NormalConeTree scene(pair.scene), part(pair.part);
  std::mt19937_64 random(5);
  std::size_t compared = 0;
  for (int i = 0; i < 100; ++i) {
    const RigidTransform pose = poseNearContact(pair, 0.1, random);
    const std::vector<Lmd> there = query(scene, part, pose, 0.1),
                           back = query(part, scene, pose.inverse(), 0.1);
    ASSERT_EQ(there.size(), back.size());
    for (const Lmd& a : there) {
      const bool isThere = std::any_of(back.begin(), back.end(), [&](const Lmd& b) {
        return glm::distance(a.scenePoint, pose.applyToPoint(b.partPoint)) < 1e-9 &&
               glm::distance(a.partPoint, pose.applyToPoint(b.scenePoint)) < 1e-9 &&
               a.sceneIndex == b.partIndex && a.partIndex == b.sceneIndex &&
               a.sceneFeature == b.partFeature && a.partFeature == b.sceneFeature &&
               glm::distance(a.direction, -(pose.rotation * b.direction)) < 1e-7;
      });
      EXPECT_TRUE(isThere);
      ++compared;
    }
  }
  EXPECT_GT(compared, 100U);
}

TEST(LmdQuery, MovingBothBodiesTogetherChangesNothing) {
  const Pair pair{"stars", test::starMesh(3, 1.0, 3, 0.3), test::starMesh(4, 0.5, 2, 0.3)};
  std::mt19937_64 random(6);
  const NormalConeTree scene(pair.scene), part(pair.part);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform pose = poseNearContact(pair, 0.1, random);
    RigidTransform world = randomRotation(random);
    world.translation = {3.0, -2.0, 7.0};
    // Both meshes given in another frame: the same set, moved.
    const TriangleMesh moved = test::transformed(pair.scene, 1.0, world);
    const std::vector<Lmd> before = query(scene, part, pose, 0.1);
    const std::vector<Lmd> after = query(NormalConeTree(moved), part, world * pose, 0.1);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t k = 0; k < before.size(); ++k) {
      EXPECT_NEAR(before[k].distance, after[k].distance, 1e-12);
      EXPECT_LT(glm::distance(world.applyToPoint(before[k].scenePoint), after[k].scenePoint), 1e-9);
    }
  }
}

}  // namespace
}  // namespace nearfit

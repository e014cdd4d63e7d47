#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/exact/exact_comparison.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/trial_share.h"

/// Meshes that are damaged or hard on arithmetic, against exact arithmetic: as the hierarchy would get them
/// from a program, and as a user's file comes, through the builder.
namespace nearfit::lmd_robustness_meshes_test {
namespace {

using test::BodyPair;
using test::ExactComparison;
using test::ExactTally;

TriangleMesh built(const TriangleMesh& mesh) {
  MeshBuildReport report;
  return buildMesh(test::soupOf(mesh), {}, report);
}

/// Whether the builder leaves anything of it: what is thinner than it welds is none.
bool canBuild(const TriangleMesh& mesh) {
  try {
    return !built(mesh).triangles().empty();
  } catch (const Error&) {
    return false;
  }
}

/// Both ways, against a probe with corners, edges and faces, and against itself.
ExactTally check(const std::string& name, const TriangleMesh& mesh, std::size_t poses, std::uint64_t seed) {
  ExactTally sum;
  const TriangleMesh probe = test::tetrahedronMesh(0.3);
  for (const bool isBuilt : {false, true}) {
    if (isBuilt && !canBuild(mesh)) continue;
    for (const bool isSelf : {false, true}) {
      if (isSelf && mesh.triangles().size() > 300) continue;  // Millions of pairs.
      const TriangleMesh scene = isBuilt ? built(mesh) : mesh;
      const BodyPair pair{
          fmt::format("{}{}{}", name, isBuilt ? ", built" : "", isSelf ? ", with itself" : ""), scene,
          isSelf ? scene : probe};
      ExactComparison comparison(pair);
      comparison.checkPoses(std::max<std::size_t>(poses / test::kTrialShare, 5), 0.1, seed);
      sum.minima += comparison.tally().minima;
      sum.marginal += comparison.tally().marginal;
      sum.found += comparison.tally().found;
    }
  }
  EXPECT_GT(sum.found, 0U) << name;
  return sum;
}

TEST(LmdRobustness, PlainMeshesHaveTheExactSet) {
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    check("star", test::starMesh(seed, 0.5, 1, 0.4), 30, seed);
}

TEST(LmdRobustness, SliversAMillionTimesAsLongAsHighHaveTheExactSet) {
  for (const double lift : {0.0, 1e-8, 0.5}) {
    check("slivers", test::withSlivers(test::starMesh(3, 0.5, 0, 0.3), 1e6, lift), 12, 31);
    check("box of slivers", test::withSlivers(test::boxMesh({0.6, 0.4, 0.5}), 1e6, lift), 12, 32);
  }
}

TEST(LmdRobustness, NeedlesAMillionTimesAsLongAsWideHaveTheExactSet) {
  for (const double lift : {0.0, 1e-8, 0.5}) {
    check("needles", test::withNeedles(test::starMesh(3, 0.5, 0, 0.3), 1e6, lift), 12, 33);
    check("box of needles", test::withNeedles(test::boxMesh({0.6, 0.4, 0.5}), 1e6, lift), 12, 34);
  }
}

TEST(LmdRobustness, NeedlesOfFacesThatOverlapAtOneEndOfTheirEdgesHaveTheExactSet) {
  // Two edges, 0.5 m long, face each other. The tips of needles are nearest at one end. At the other end the
  // faces of the boxes overlap in a strip 2e-8 m wide and 0.03 m long. The representative of the region was
  // that strip alone, so that no region held the minima at the tips. At some of these poses the strip appears
  // only with the bodies swapped, at others in both orders.
  const TriangleMesh box = test::withNeedles(test::boxMesh({0.6, 0.4, 0.5}), 1e6, 0.5);
  const BodyPair pair{"box of needles, edge over edge", box, box};
  ExactComparison comparison(pair);
  const auto check = [&](const glm::dvec3& translation) {
    comparison.checkPose({{1, 0, 0, 0}, translation}, 0.0877);
  };
  for (const double along : {0.0, 1.9e-9, 5.4e-7}) {
    for (const double overlap : {0.0, 1e-9, 2.6e-8, 1e-7, 1.6e-7, -9.2e-9})
      check({-0.6 + overlap, 0.44387487329499586, along});
  }
  EXPECT_GT(comparison.tally().minima, 0U);
}

TEST(LmdRobustness, DuplicateFacesHaveTheExactSet) {
  check("duplicates", test::withDuplicates(test::starMesh(5, 0.5, 1, 0.3)), 24, 35);
  check("box with duplicates", test::withDuplicates(test::boxMesh({0.6, 0.4, 0.5})), 24, 36);
}

TEST(LmdRobustness, FacesWithoutAreaHaveTheExactSet) {
  check("no area", test::withFacesWithoutArea(test::starMesh(6, 0.5, 1, 0.3)), 24, 37);
  check("box, no area", test::withFacesWithoutArea(test::boxMesh({0.6, 0.4, 0.5})), 24, 38);
}

TEST(LmdRobustness, VerticesOfAThousandFacesHaveTheExactSet) {
  for (const double height : {0.0, 1e-6, 0.3}) {
    check(fmt::format("fan {}", height), test::jaggedFan(7, 1000, height), 5, 39);
  }
  check("cone", test::coneMesh(0.5, 0.5, 1000), 5, 40);
}

TEST(LmdRobustness, CoplanarFansHaveTheExactSet) {
  check("coplanar fans", test::coplanarFans(8, 16), 18, 41);
  check("disc", test::cylinderMesh(0.5, 0.2, 24), 18, 42);
}

TEST(LmdRobustness, ConesOfHalfATurnHaveTheExactSet) {
  for (const double small : {1e-3, 1e-6, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12}) {
    check(fmt::format("flat cone {}", small), test::coneMesh(0.5, small, 7), 8, 43);
    check(fmt::format("flat roof {}", small), test::wedgeMesh(std::numbers::pi / 2 - small), 8, 46);
    if (small < 1e-9) continue;  // Spikes and knives thinner than that have no more than one point across.
    check(fmt::format("spike {}", small), test::coneMesh(small, 0.5, 7), 8, 44);
    check(fmt::format("knife {}", small), test::wedgeMesh(small), 8, 45);
  }
}

TEST(LmdRobustness, OpenMeshesAndSingleTrianglesHaveTheExactSet) {
  check("triangle", test::looseTriangles(9, 1), 60, 47);
  check("loose triangles", test::looseTriangles(10, 12), 30, 48);
  check("sheet", test::squareMesh(1.0, 3), 30, 49);
  check("open fan", test::jaggedFan(11, 9, 0.2), 30, 50);
}

TEST(LmdRobustness, NonManifoldEdgesHaveTheExactSet) {
  check("fins", test::finsMesh(12, 3, 2.0), 30, 51);
  check("many fins", test::finsMesh(13, 9, 6.0), 30, 52);
  check("two boxes on one edge",
        built(test::joined(test::boxMesh({0.5, 0.5, 0.5}, {0.25, 0.25, 0.0}),
                           test::boxMesh({0.5, 0.5, 0.5}, {-0.25, -0.25, 0.0}))),
        30, 53);
}

}  // namespace
}  // namespace nearfit::lmd_robustness_meshes_test

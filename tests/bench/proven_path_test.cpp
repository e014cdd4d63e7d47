#include "tests/bench/proven_path.h"

#include <gtest/gtest.h>

#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::bench::proven_path_test {
namespace {

/// A cube of 1 m in hand, 2 m beside another one.
Scene twoCubes() {
  Scene scene;
  scene.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Fixed"));
  scene.setMovingPart(scene.add(
      test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Cube", {{1, 0, 0, 0}, {-2, 0, 0}})));
  return scene;
}

/// Along x past the fixed cube, so far aside.
AssemblyPath passing(const Scene& scene, double aside) {
  AssemblyPath path = pathFrame(scene);
  path.poses = {{0.0, {{1, 0, 0, 0}, {-2, aside, 0}}}, {1.0, {{1, 0, 0, 0}, {2, aside, 0}}}};
  return path;
}

TEST(ProvenPath, APathWithAGapIsCertifiedVerifiedAndFreeAtAllPlaces) {
  const Scene scene = twoCubes();
  const AssemblyPath path = passing(scene, 1.01);
  const PathProofCheck proof = proveAndVerify(scene, path, 1e-6);
  EXPECT_TRUE(proof.isCertified);
  EXPECT_TRUE(proof.isVerified) << proof.problem;
  const nearfit::PathBodies bodies = pathBodies(scene, path);
  const PlaceLooks looks = lookAtPlaces(path, bodies, 1000, 1), plain = testPlaces(path, bodies, 1000, 1);
  EXPECT_EQ(looks.looks, 1000U);
  EXPECT_EQ(looks.meetings, 0U);
  EXPECT_GT(looks.argued(), 0U);
  EXPECT_EQ(plain.tested, 1000U);
  EXPECT_EQ(plain.argued(), 0U);
  EXPECT_EQ(plain.meetings, 0U);
}

TEST(ProvenPath, APathThroughAPartIsRefusedAndMeetsItOnHalfOfTheWay) {
  const Scene scene = twoCubes();
  const AssemblyPath path = passing(scene, 0.5);
  const PathProofCheck proof = proveAndVerify(scene, path, 1e-6);
  EXPECT_FALSE(proof.isCertified);
  EXPECT_FALSE(proof.problem.empty());
  const nearfit::PathBodies bodies = pathBodies(scene, path);
  const PlaceLooks looks = lookAtPlaces(path, bodies, 4000, 1), plain = testPlaces(path, bodies, 4000, 1);
  // The cubes overlap from -1 to 1 of the way from -2 to 2.
  EXPECT_NEAR(static_cast<double>(plain.meetings), 2000.0, 200.0);
  EXPECT_EQ(looks.meetings, plain.meetings);
  EXPECT_EQ(looks.firstMeeting, "Cube meets Fixed");
}

TEST(ProvenPath, LooksAreCountedForEachPairOfParts) {
  Scene scene = twoCubes();
  scene.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Far", {{1, 0, 0, 0}, {0, 50, 0}}));
  const AssemblyPath path = passing(scene, 1.01);
  const PlaceLooks looks = lookAtPlaces(path, pathBodies(scene, path), 500, 1);
  EXPECT_EQ(looks.places, 500U);
  EXPECT_EQ(looks.looks, 1000U);
}

}  // namespace
}  // namespace nearfit::bench::proven_path_test

#include <gtest/gtest.h>

#include "tests/exact/exact_verdicts.h"
#include "tests/exact/shared_volume.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::bench::clash_comparison_test {
namespace {

RigidTransform at(double x, double y, double z) {
  return {glm::dquat(1, 0, 0, 0), {x, y, z}};
}

TEST(SharedVolume, OfTwoBoxesIsThatOfTheBoxThatTheyShare) {
  const TriangleMesh large = test::boxMesh({2, 2, 2}), small = test::boxMesh({1, 1, 1});
  // A quarter of the small one along x, half along y.
  const double expected = 0.25 * 0.5 * 1.0;
  const auto nef = test::sharedVolumeByNef(large, small, at(1.25, 1.0, 0.2));
  ASSERT_TRUE(nef);
  EXPECT_NEAR(*nef, expected, 1e-15);
  EXPECT_NEAR(test::sharedVolumeByRays(large, small, at(1.25, 1.0, 0.2), 400), expected, 1e-3 * expected);
}

TEST(SharedVolume, OfABodyInsideAnotherIsItsOwnAndOfBodiesApartNone) {
  const TriangleMesh large = test::boxMesh({2, 2, 2}), ball = test::icosphereMesh(0.5, 2);
  const auto inside = test::sharedVolumeByNef(large, ball, at(0.1, 0, 0)),
             apart = test::sharedVolumeByNef(large, ball, at(3, 0, 0));
  ASSERT_TRUE(inside && apart);
  EXPECT_NEAR(test::sharedVolumeByRays(large, ball, at(0.1, 0, 0), 400), *inside, 1e-3 * *inside);
  EXPECT_EQ(*apart, 0.0);
  EXPECT_EQ(test::sharedVolumeByRays(large, ball, at(3, 0, 0), 400), 0.0);
  // A sphere's volume, less what the flat faces cut off.
  constexpr double kSphere = 4.18879 * 0.125;
  EXPECT_LT(*inside, kSphere);
  EXPECT_GT(*inside, 0.95 * kSphere);
}

TEST(SharedVolume, OfAnOpenMeshIsNotMadeByNefPolyhedra) {
  const TriangleMesh box = test::boxMesh({1, 1, 1});
  const TriangleMesh open({box.vertices().begin(), box.vertices().end()},
                          {box.triangles().begin(), box.triangles().end() - 1});
  EXPECT_FALSE(test::sharedVolumeByNef(open, box, at(0.5, 0, 0)));
}

class ClashComparison : public testing::Test {
 protected:
  ClashComparison() {
    scene.add(test::partOf(test::geometryOf(test::boxMesh({2, 2, 2})), "Large", at(5, 0, 0)));
    scene.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Small", at(6.3, 0.1, 0.2)));
    request = sceneCheckRequest(scene, 0.1);
    check = checkScene(request);
  }

  Scene scene;
  SceneCheckRequest request;
  SceneCheck check;
};

TEST_F(ClashComparison, ConfirmsDepthAndVolumeOfTwoBoxes) {
  const test::ClashComparison found = test::compareClashes(request, check);
  EXPECT_TRUE(found.differences.empty()) << found.differences.front();
  EXPECT_EQ(found.clashes, 1U);
  EXPECT_EQ(found.depths, 1U);
  EXPECT_EQ(found.freed, 1U);
  EXPECT_EQ(found.least, 1U);
  EXPECT_EQ(found.exactDepths, 1U);
  EXPECT_EQ(found.exactLeast, 1U);
  EXPECT_EQ(found.volumes, 1U);
  EXPECT_EQ(found.raysAgree, 1U);
  EXPECT_EQ(found.booleansAgree, 1U);
}

TEST_F(ClashComparison, FindsADepthThatIsTooSmallOrTooLarge) {
  SceneCheck wrong = check;
  wrong.findings.at(0).clash->freeing->length *= 0.999;
  EXPECT_EQ(test::compareClashes(request, wrong).freed, 0U);
  wrong.findings.at(0).clash->freeing->length *= 1.1;
  const test::ClashComparison found = test::compareClashes(request, wrong);
  EXPECT_EQ(found.freed, 1U);
  EXPECT_EQ(found.least, 0U);
  EXPECT_EQ(found.exactLeast, 0U);
}

TEST_F(ClashComparison, FindsAVolumeThatIsOffByLittle) {
  SceneCheck wrong = check;
  *wrong.findings.at(0).clash->volume *= 1.0 + 1e-6;
  const test::ClashComparison found = test::compareClashes(request, wrong);
  EXPECT_EQ(found.raysAgree, 1U) << "rays are coarse";
  EXPECT_EQ(found.booleansAgree, 0U);
  *wrong.findings.at(0).clash->volume *= 1.05;
  EXPECT_EQ(test::compareClashes(request, wrong).raysAgree, 0U);
}

}  // namespace
}  // namespace nearfit::bench::clash_comparison_test

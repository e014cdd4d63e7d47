#include "core/verdict/surface_depth.h"

#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::surface_depth_test {
namespace {

constexpr std::uint64_t kSamples = 500'000;

TEST(SurfaceDepth, OfABoxInAnotherIsThatOfItsDeepestCorner) {
  const NormalConeTree box(test::boxMesh(glm::dvec3(1.0)));
  const RigidTransform pose{{1, 0, 0, 0}, {0.9, 0.1, 0.05}};
  const SurfaceDepth depth = findSurfaceDepth(box, box, pose, 0.0, kSamples);
  EXPECT_LE(depth.least, 0.1 + 1e-12);
  EXPECT_GE(depth.most, 0.1 - 1e-12);
  EXPECT_LE(depth.most, 1.011 * depth.least);
}

TEST(SurfaceDepth, OfAPegInANarrowBoreIsTheInterferenceHoweverLongItIs) {
  constexpr double kFit = 0.01;
  const NormalConeTree tube(test::tubeMesh(0.3, 0.5, 1.0, 32)), peg(test::cylinderMesh(0.3 + kFit, 3.0, 32));
  const SurfaceDepth depth = findSurfaceDepth(tube, peg, {}, 0.0, kSamples);
  EXPECT_LE(depth.least, kFit + 1e-12);
  EXPECT_GE(depth.most, kFit - 1e-12);
  EXPECT_LE(depth.most, 1.011 * depth.least);
}

TEST(SurfaceDepth, TheSearchEndsOnceItIsKnownToBeWithinALimitOrNot) {
  const NormalConeTree tube(test::tubeMesh(0.3, 0.5, 1.0, 32)), peg(test::cylinderMesh(0.31, 3.0, 32));
  EXPECT_LE(findSurfaceDepth(tube, peg, {}, 0.0101, kSamples).most, 0.0101);
  EXPECT_GT(findSurfaceDepth(tube, peg, {}, 0.009, kSamples).least, 0.009);
  EXPECT_GT(findSurfaceDepth(tube, peg, {}, 0.0101, 10).most, 1.0) << "not known";
}

TEST(SurfaceDepth, ABodyInsideAnotherIsAsDeepAsItsInnermostPoint) {
  const NormalConeTree shell(test::boxMesh(glm::dvec3(4.0))), core(test::boxMesh(glm::dvec3(1.0)));
  const RigidTransform pose{{1, 0, 0, 0}, {1.0, 0.0, 0.0}};
  const SurfaceDepth depth = findSurfaceDepth(shell, core, pose, 0.0, kSamples);
  // The face towards the middle, at x = 0.5, where the nearest side is that of y or z, or of x.
  EXPECT_LE(depth.least, 1.5 + 1e-12);
  EXPECT_GE(depth.most, 1.5 - 1e-12);
  EXPECT_LE(depth.most, 1.02 * depth.least);
}

}  // namespace
}  // namespace nearfit::surface_depth_test

#include "tests/bench/feel_certified.h"

#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/bench/feel_scenes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench::feel_certified_test {
namespace {

TEST(CertifiedRow, CountsPosesThatTouchCutOrLieInside) {
  const auto at = [](double x) { return RigidTransform{glm::dquat(1.0, 0.0, 0.0, 0.0), {x, 0.0, 0.0}}; };
  const auto scene = solidScene(test::boxMesh(glm::dvec3(2.0)), test::boxMesh(glm::dvec3(0.5)), at(3.0));
  // The faces touch at 1.25.
  const std::vector<RigidTransform> poses{at(3.0), at(1.2500001), at(1.25), at(1.0), at(0.0)};
  const FeelRow row = certifiedRow("group", "scene", "run", *scene, poses);
  EXPECT_EQ(row.samples, 5U);
  EXPECT_DOUBLE_EQ(row.mean, 0.6);
  EXPECT_EQ(row.max, 1.0);
  EXPECT_EQ(certifiedRow("group", "scene", "run", *scene, std::span(poses).first(2)).max, 0.0);
}

TEST(CertifiedRow, PosesThatFollowTheirLikeCountOnce) {
  const auto at = [](double x) { return RigidTransform{glm::dquat(1.0, 0.0, 0.0, 0.0), {x, 0.0, 0.0}}; };
  const auto scene = solidScene(test::boxMesh(glm::dvec3(2.0)), test::boxMesh(glm::dvec3(0.5)), at(3.0));
  const std::vector<RigidTransform> poses{at(3.0), at(3.0), at(1.0), at(1.0), at(1.0), at(3.0)};
  const FeelRow row = certifiedRow("group", "scene", "run", *scene, poses);
  EXPECT_EQ(row.samples, 3U);
  EXPECT_DOUBLE_EQ(row.mean, 1.0 / 3.0);
}

}  // namespace
}  // namespace nearfit::bench::feel_certified_test

#include "tests/bench/feel_tessellation.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/haptics/virtual_coupling.h"

namespace nearfit::bench::feel_tessellation_test {
namespace {

class Tessellation : public ::testing::TestWithParam<std::size_t> {
 protected:
  const RestScene scene_ = restScenes()[GetParam()];
};

TEST_P(Tessellation, TheWrenchIsOffByNoMoreThanTheMeshesAndThePoseAcrossItByTheRootOfThat) {
  const glm::dvec3 pull = kRestStiffness * (scene_.rest.translation - scene_.hand.translation);
  for (const std::uint32_t fineness : {1U, 2U, 4U, 8U}) {
    SCOPED_TRACE(scene_.name + " x" + std::to_string(fineness * fineness));
    const RestResult rest = restOf(scene_, fineness);
    ASSERT_TRUE(rest.isResting);
    const double difference = rest.meshDifference + kRestSag;
    // What the hand is pressed back by, force and torque in one: no more than the meshes are off.
    EXPECT_NEAR(rest.fromHand, kRestPress, difference);
    // The pose across it, and so the wrench's direction: see restBound.
    EXPECT_LE(rest.fromFormula, restBound(difference));
    EXPECT_LE(glm::distance(rest.wrench.force, pull), kRestStiffness * restBound(difference));
    // The solids' own torque is zero: the hand is not turned against where they rest.
    EXPECT_LE(glm::length(rest.wrench.torque), restTorqueBound(difference, rest.gyration));
  }
}

TEST(RestBounds, FallWithTheLengthOfEdgesAsFacetsSlopes) {
  // The meshes' difference falls with the square of an edge: a quarter of it is half the bound, for small
  // ones.
  EXPECT_NEAR(restBound(1e-9) / restBound(0.25e-9), 2.0, 1e-3);
  // k g x for small turns: 1,000 N/m, 0.1 m, and x = sqrt(4 * 1e-8 * 0.02).
  EXPECT_NEAR(restTorqueBound(1e-8, glm::dvec3(0.1, 0.1, 0.05)), 100.0 * std::sqrt(8e-10), 1e-5);
  EXPECT_TRUE(std::isinf(restTorqueBound(0.1, glm::dvec3(0.01))));
}

TEST_P(Tessellation, MeshesAreOffTheirSolidsByAQuarterAtTwiceTheFineness) {
  const auto off = [&](std::uint32_t fineness) {
    return scene_.meshDifference(scene_.scene(fineness), scene_.part(fineness));
  };
  EXPECT_LE(off(4), off(2) / 3.5);
  EXPECT_LE(off(8), off(4) / 3.5);
}

INSTANTIATE_TEST_SUITE_P(RestScenes, Tessellation, ::testing::Range(std::size_t{0}, restScenes().size()),
                         [](const auto& chosen) {
                           std::string name = restScenes()[chosen.param].name;
                           std::erase(name, '-');
                           return name;
                         });

TEST(TessellationOfABox, RestsOnASlabAtOnePlaceHoweverItIsMeshed) {
  const std::vector<RestScene> scenes = restScenes();
  const auto box = std::ranges::find(scenes, std::string("box-slab"), &RestScene::name);
  ASSERT_NE(box, scenes.end());
  const RestResult plain = restOf(*box, 1);
  for (const std::uint32_t fineness : {2U, 4U, 8U}) {
    const RestResult fine = restOf(*box, fineness);
    EXPECT_LT(glm::distance(fine.pose.translation, plain.pose.translation), 1e-12);
    EXPECT_LT(glm::length(turnBetween(fine.pose.rotation, plain.pose.rotation)), 1e-12);
    EXPECT_LT(glm::distance(fine.wrench.force, plain.wrench.force), 1e-9);
    EXPECT_LT(glm::distance(fine.wrench.torque, plain.wrench.torque), 1e-9);
  }
}

}  // namespace
}  // namespace nearfit::bench::feel_tessellation_test

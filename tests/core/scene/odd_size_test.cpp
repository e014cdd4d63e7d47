#include "core/scene/odd_size.h"

#include <gtest/gtest.h>

#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::odd_size_test {
namespace {

/// @param edge           Of a cube [m].
/// @param metresPerUnit  That its file was read in.
PartId addCube(Scene& scene, double edge, double metresPerUnit = 1e-3) {
  auto geometry = std::make_shared<PartGeometry>(*test::freshGeometryOf(test::boxMesh(glm::dvec3(edge))));
  geometry->metresPerUnit = metresPerUnit;
  return scene.add(test::partOf(geometry, "cube"));
}

std::optional<OddSize> odd(const Scene& scene, std::vector<PartId> parts) {
  return oddSizeOf(scene, parts);
}

TEST(OddSize, MetresReadAsMillimetresAreMadeMetres) {
  Scene scene;
  addCube(scene, 0.05);
  addCube(scene, 0.4);
  const PartId tiny = addCube(scene, 0.1e-3, 1e-3);
  const auto found = odd(scene, {tiny});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->ratio, 0.1e-3 / 0.05, 1e-12);
  EXPECT_DOUBLE_EQ(found->factor, 1000.0);
}

TEST(OddSize, MillimetresReadAsMetresAreMadeMillimetres) {
  Scene scene;
  addCube(scene, 0.05);
  const PartId huge = addCube(scene, 80.0, 1.0);
  const auto found = odd(scene, {huge});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->ratio, 1600.0, 1e-9);
  EXPECT_DOUBLE_EQ(found->factor, 1e-3);
}

TEST(OddSize, SmallScrewBesideALargeHousingIsNotOdd) {
  Scene scene;
  addCube(scene, 2.0);
  const PartId screw = addCube(scene, 0.01);
  EXPECT_FALSE(odd(scene, {screw}));
  const PartId washer = addCube(scene, 0.001);
  EXPECT_FALSE(odd(scene, {washer})) << "there are other small parts";
}

TEST(OddSize, PartsThatCameTogetherAreJudgedTogether) {
  Scene scene;
  addCube(scene, 0.05);
  const PartId one = addCube(scene, 20.0, 1.0), other = addCube(scene, 90.0, 1.0);
  const auto found = odd(scene, {one, other});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->ratio, 400.0, 1e-9);
  EXPECT_DOUBLE_EQ(found->factor, 1e-3);
  EXPECT_FALSE(odd(scene, {one})) << "beside the other it is not";
}

TEST(OddSize, TheFirstOddPartIsTheOneThatIsOddByItself) {
  Scene scene;
  const PartId plain = addCube(scene, 0.05), other = addCube(scene, 0.06);
  EXPECT_FALSE(firstOddPart(scene, std::vector{plain, other, PartId{99}}));
  const PartId tiny = addCube(scene, 0.1e-3), huge = addCube(scene, 90.0, 1.0);
  for (const std::vector<PartId>& parts :
       {std::vector{plain, tiny}, std::vector{plain, huge, tiny}, std::vector{tiny}, std::vector{other}}) {
    std::optional<OddPart> expected;
    for (const PartId part : parts) {
      const auto found = odd(scene, {part});
      if (found && !expected) expected = OddPart{part, *found};
    }
    const std::optional<OddPart> first = firstOddPart(scene, parts);
    ASSERT_EQ(first.has_value(), expected.has_value());
    if (!first) continue;
    EXPECT_EQ(first->part, expected->part);
    EXPECT_EQ(first->size.ratio, expected->size.ratio);
    EXPECT_EQ(first->size.factor, expected->size.factor);
  }
}

TEST(OddSize, PartAloneIsNotOdd) {
  Scene scene;
  EXPECT_FALSE(odd(scene, {addCube(scene, 1e5)}));
  EXPECT_FALSE(odd(scene, {PartId{99}}));
}

TEST(OddSize, PartThatNoUnitBringsNearIsLeft) {
  Scene scene;
  addCube(scene, 0.05);
  EXPECT_FALSE(odd(scene, {addCube(scene, 100.0, 1e-6)})) << "its unit is the smallest already";
}

}  // namespace
}  // namespace nearfit::odd_size_test

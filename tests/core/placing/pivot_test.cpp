#include "core/placing/pivot.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::pivot_test {
namespace {

Part boxPart(const glm::dvec3& size, const glm::dvec3& centre) {
  return test::partOf(test::solidGeometryOf(test::boxMesh(size, centre)), "box");
}

RigidTransform somewhere() {
  return {glm::angleAxis(0.8, glm::normalize(glm::dvec3(3, -1, 2))), {0.3, -0.2, 0.1}};
}

TEST(Pivot, TheCentreOfMassOfSeveralPartsIsWeighed) {
  Part light = boxPart(glm::dvec3(0.1), glm::dvec3(0.0)), heavy = light;
  heavy.density = 3.0 * light.density;
  const PlacedPart parts[] = {{&light, {}}, {&heavy, {{1, 0, 0, 0}, {0.4, 0.0, 0.0}}}};
  EXPECT_LT(glm::distance(centreOfMass(parts), {0.3, 0.0, 0.0}), 1e-12);
  EXPECT_LT(glm::distance(centreOfMass(std::span(parts, 1)), glm::dvec3(0.0)), 1e-15);
}

TEST(Pivot, GoesWithThePartsThatAreMovedTogether) {
  const Part a = boxPart({0.1, 0.2, 0.3}, {0.01, 0.02, 0.03}), b = boxPart({0.2, 0.05, 0.1}, {0, 0, 0.2});
  const RigidTransform beside{glm::angleAxis(0.3, glm::dvec3(0, 0, 1)), {0.2, 0.1, 0.0}};
  const PlacedPart before[] = {{&a, {}}, {&b, beside}};
  const PlacedPart after[] = {{&a, somewhere()}, {&b, somewhere() * beside}};
  EXPECT_LT(glm::distance(somewhere().applyToPoint(centreOfMass(before)), centreOfMass(after)), 1e-12);
  EXPECT_LT(glm::distance(somewhere().applyToPoint(boxCentre(before)), boxCentre(after)), 1e-12);
}

TEST(Pivot, TheBoxHoldsAllParts) {
  const Part a = boxPart(glm::dvec3(0.1), glm::dvec3(0.0));
  const PlacedPart parts[] = {{&a, {}}, {&a, {{1, 0, 0, 0}, {0.5, 0.2, -0.1}}}};
  EXPECT_LT(glm::distance(boxCentre(parts), {0.25, 0.1, -0.05}), 1e-12);
}

TEST(Pivot, PartsShareThePivotThatTheyWereGivenTogether) {
  Part a = boxPart({0.1, 0.2, 0.3}, {0.01, 0.02, 0.03}), b = a;
  const RigidTransform beside{glm::angleAxis(0.3, glm::dvec3(0, 0, 1)), {0.2, 0.1, 0.0}};
  const glm::dvec3 pivot(0.4, -0.3, 0.2);
  const PlacedPart before[] = {{&a, {}}, {&b, beside}};
  EXPECT_EQ(sharedPivot(before), std::nullopt);
  a.pivot = pivot;
  EXPECT_EQ(sharedPivot(std::span(before, 1)), pivot);
  EXPECT_EQ(sharedPivot(before), std::nullopt) << "one has none";
  b.pivot = beside.inverse().applyToPoint(pivot);
  // Far away too, and after many turns.
  RigidTransform way{glm::angleAxis(0.1, glm::normalize(glm::dvec3(1, 2, 3))), {1e4, -2e4, 3e4}};
  PlacedPart after[] = {before[0], before[1]};
  for (int i = 0; i < 20; ++i) {
    for (PlacedPart& each : after)
      each.worldFromPart = (way * each.worldFromPart).normalized();
    ASSERT_TRUE(sharedPivot(after)) << i;
    EXPECT_LT(glm::distance(*sharedPivot(after), after[0].worldFromPart.applyToPoint(pivot)), 1e-9);
  }
  after[1].worldFromPart.translation.x += 1e-6;
  EXPECT_EQ(sharedPivot(after), std::nullopt) << "they have moved apart";
}

TEST(Pivot, ARayMeetsABoxWhereItGoesThroughIt) {
  const Part box = boxPart({0.1, 0.2, 0.3}, {0.01, 0.02, 0.03});
  const PlacedPart placed{&box, somewhere()};
  const glm::dvec3 eye(1.0, 1.0, 1.0);
  const auto towards = [&](const glm::dvec3& inPart) {
    return ViewRay{eye, glm::normalize(placed.worldFromPart.applyToPoint(inPart) - eye)};
  };
  EXPECT_TRUE(meetsBox(towards({0.05, 0.1, 0.17}), placed));
  EXPECT_TRUE(meetsBox(towards({0.01, 0.02, 0.03}), placed));
  EXPECT_FALSE(meetsBox(towards({0.3, 0.4, 0.0}), placed));
  // Along an axis of the box, beside it and through it.
  EXPECT_TRUE(meetsBox({{0.0, 0.0, 5.0}, {0, 0, -1}}, {&box, {}}));
  EXPECT_FALSE(meetsBox({{0.2, 0.0, 5.0}, {0, 0, -1}}, {&box, {}}));
}

}  // namespace
}  // namespace nearfit::pivot_test

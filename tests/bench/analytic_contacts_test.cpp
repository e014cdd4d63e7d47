#include "tests/bench/analytic_contacts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/bench/error_pairs.h"
#include "tests/bench/error_shapes.h"

namespace nearfit::bench::analytic_contacts_test {
namespace {

constexpr double kRounding = 1e-14;
constexpr glm::dvec3 kUp{0.0, 0.0, 1.0};

/// Distances from a point outside to the pieces of a scene, each smooth near it, from the solids' own
/// formulas: a piece's local minima over the part's surface are the pair's.
using Field = std::function<double(const glm::dvec3&)>;

double toRing(const glm::dvec3& p) {
  return std::hypot(std::hypot(p.x, p.y) - 1.0, p.z) - 0.25;
}

double toRod(const glm::dvec3& p) {
  return glm::length(p - glm::dvec3(0.0, 0.0, std::clamp(p.z, -0.5, 0.5))) - 0.2;
}

std::vector<Field> fieldsOf(const std::string& pair) {
  if (pair == "sphere-sphere") return {[](const glm::dvec3& p) { return glm::length(p) - 1.0; }};
  if (pair == "sphere-torus" || pair == "torus-torus") return {toRing};
  if (pair == "sphere-bowl") return {[](const glm::dvec3& p) { return 1.0 - glm::length(p); }};
  if (pair == "capsule-capsule") return {toRod};
  if (pair == "sphere-nest") {
    const double x = 0.7 * std::cos(2.0 * std::numbers::pi / 3.0),
                 y = 0.7 * std::sin(2.0 * std::numbers::pi / 3.0);
    std::vector<Field> balls;
    for (const glm::dvec3& centre :
         {glm::dvec3(0.7, 0.0, 0.0), glm::dvec3(x, y, 0.0), glm::dvec3(x, -y, 0.0)})
      balls.push_back([centre](const glm::dvec3& p) { return glm::distance(p, centre) - 0.5; });
    return balls;
  }
  return {[](const glm::dvec3& p) { return p.z; }};  // The floor.
}

/// A vertex whose value none in two rings around undercuts.
struct SampledMinimum {
  glm::dvec3 point;
  double value;
};

std::vector<std::vector<std::uint32_t>> neighboursOf(const TriangleMesh& mesh) {
  std::vector<std::vector<std::uint32_t>> rings(mesh.vertices().size());
  for (const MeshEdge& edge : mesh.edges()) {
    rings[edge.v0].push_back(edge.v1);
    rings[edge.v1].push_back(edge.v0);
  }
  return rings;
}

std::vector<SampledMinimum> sampledMinima(const TriangleMesh& part,
                                          const std::vector<std::vector<std::uint32_t>>& rings,
                                          const RigidTransform& pose, const Field& field, double cutoff) {
  std::vector<double> values;
  for (const glm::dvec3& p : part.vertices())
    values.push_back(field(pose.applyToPoint(p)));
  std::vector<SampledMinimum> minima;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= cutoff) continue;
    const bool isLeast = std::all_of(rings[i].begin(), rings[i].end(), [&](std::uint32_t j) {
      return values[i] <= values[j] && std::all_of(rings[j].begin(), rings[j].end(),
                                                   [&](std::uint32_t k) { return values[i] <= values[k]; });
    });
    if (isLeast) minima.push_back({pose.applyToPoint(part.vertices()[i]), values[i]});
  }
  return minima;
}

class AnalyticContacts : public ::testing::TestWithParam<ErrorPair> {};

TEST_P(AnalyticContacts, AreThoseOfDenseSamplesOfThePartsSurface) {
  const ErrorPair& pair = GetParam();
  const TriangleMesh part = pair.part(24);
  const auto rings = neighboursOf(part);
  const double edge = longestEdge(part);
  for (const ErrorPose& pose : randomPoses(pair, 25, 7)) {
    std::vector<bool> isFound(pose.contacts.size(), false);
    for (const Field& field : fieldsOf(pair.name)) {
      for (const SampledMinimum& sample :
           sampledMinima(part, rings, pose.sceneFromPart, field, pair.cutoff)) {
        std::size_t nearest = 0;
        const auto away = [&](std::size_t i) {
          return glm::distance(sample.point, pose.contacts[i].partPoint);
        };
        for (std::size_t i = 1; i < pose.contacts.size(); ++i)
          nearest = away(i) < away(nearest) ? i : nearest;
        const TrueContact& contact = pose.contacts[nearest];
        EXPECT_LT(away(nearest), 2.0 * contact.spread * edge + contact.reach);
        // The least sample is above the minimum, by what the surface rises within an edge of it.
        EXPECT_GE(sample.value, contact.distance - kRounding);
        EXPECT_LT(sample.value, contact.distance + 2.0 * contact.spread * edge);
        isFound[nearest] = true;
      }
    }
    EXPECT_TRUE(std::all_of(isFound.begin(), isFound.end(), [](bool found) { return found; }));
  }
}

TEST_P(AnalyticContacts, PointsDirectionAndDistanceBelongTogether) {
  const ErrorPair& pair = GetParam();
  const std::vector<Field> fields = fieldsOf(pair.name);
  for (const ErrorPose& pose : randomPoses(pair, 100, 8)) {
    for (const TrueContact& contact : pose.contacts) {
      EXPECT_NEAR(glm::length(contact.direction), 1.0, kRounding);
      const glm::dvec3 way = contact.distance * contact.direction;
      EXPECT_LT(glm::distance(contact.partPoint, contact.scenePoint + way), kRounding);
      const auto isAt = [&](const Field& field) {
        return std::abs(field(contact.partPoint) - contact.distance) < kRounding &&
               std::abs(field(contact.scenePoint)) < kRounding;
      };
      EXPECT_TRUE(std::any_of(fields.begin(), fields.end(), isAt));
    }
  }
}

std::string nameOf(const ::testing::TestParamInfo<ErrorPair>& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Pairs, AnalyticContacts, ::testing::ValuesIn(errorPairs()), nameOf);

TEST(TorusContacts, RingStandingOverAnotherHasTwo) {
  // In the plane of the standing ring the lying one is the points (-1, 0) and (1, 0); both are hypot(1, 1.3)
  // from its centre, (0, 1.3).
  const std::vector<TrueContact> contacts =
      torusTorus({glm::dvec3(0.0), kUp, 1.0, 0.1}, {{0.0, 0.0, 1.3}, {1.0, 0.0, 0.0}, 1.0, 0.2});
  ASSERT_EQ(contacts.size(), 2U);
  for (const TrueContact& contact : contacts) {
    EXPECT_NEAR(contact.distance, std::hypot(1.0, 1.3) - 1.0 - 0.1 - 0.2, kRounding);
    EXPECT_NEAR(std::abs(contact.direction.y), 1.0 / std::hypot(1.0, 1.3), kRounding);
  }
  EXPECT_LT(contacts[0].direction.y * contacts[1].direction.y, 0.0);
}

TEST(TorusContacts, RingsSideBySideAreNearestOnTheirLineOfCentres) {
  const std::vector<TrueContact> contacts =
      torusTorus({glm::dvec3(0.0), kUp, 1.0, 0.1}, {{2.1, 0.0, 0.0}, kUp, 0.7, 0.2});
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_NEAR(contacts[0].distance, 2.1 - 1.0 - 0.7 - 0.1 - 0.2, kRounding);
  EXPECT_LT(glm::distance(contacts[0].scenePoint, {1.1, 0.0, 0.0}), kRounding);
}

TEST(FloorContacts, AreWhereTheyAreDrawn) {
  const RigidTransform upright{{1.0, 0.0, 0.0, 0.0}, {0.1, 0.2, 1.0}};
  EXPECT_NEAR(floorCylinder(0.3, 1.0, upright).distance, 0.5, kRounding);
  EXPECT_NEAR(floorCylinder(0.3, 1.0, upright).reach, 0.3, kRounding);
  EXPECT_NEAR(floorBox({0.8, 0.6, 0.4}, upright).distance, 0.8, kRounding);
  EXPECT_NEAR(floorBox({0.8, 0.6, 0.4}, upright).reach, 0.5, kRounding);  // Half the 3-4-5 of its base.
  EXPECT_NEAR(floorEllipsoid({0.6, 0.4, 0.25}, upright).distance, 0.75, kRounding);
  EXPECT_NEAR(floorCone(0.4, 0.8, upright)->distance, 1.0, kRounding);
  const RigidTransform onItsHead{{0.0, 1.0, 0.0, 0.0}, {0.1, 0.2, 1.0}};
  EXPECT_NEAR(floorCone(0.4, 0.8, onItsHead)->distance, 0.2, kRounding);
}

TEST(FloorContacts, CylinderAt45DegreesStandsOnItsRim) {
  const double s = std::sqrt(0.5);
  const RigidTransform tilted{glm::angleAxis(std::numbers::pi / 4.0, glm::dvec3(0.0, 1.0, 0.0)),
                              {0.0, 0.0, 1.0}};
  const TrueContact contact = floorCylinder(0.3, 1.0, tilted);
  // The axis leans toward +x; its lower end is at (-0.5 s, 1 - 0.5 s), the rim's lowest point 0.3 below along
  // (1, -1) s.
  EXPECT_NEAR(contact.partPoint.x, -0.5 * s + 0.3 * s, kRounding);
  EXPECT_NEAR(contact.partPoint.z, 1.0 - 0.5 * s - 0.3 * s, kRounding);
}

TEST(ContactSpread, GrowsAsSurfacesConform) {
  const auto round = [](double radius) { return glm::dmat3(1.0 / radius); };
  // Two balls: curvatures 1 and 2 at a distance of 0.1, (1 (1 + 0.2) + 2) / (1 + 2 + 0.1 * 2).
  EXPECT_NEAR(contactSpread(round(1.0), round(0.5), kUp, 0.1), 3.2 / 3.2, kRounding);
  // A ball of 0.4 in a bowl of 1: (1 (1 + 0.25) + 2.5) / (-1 + 2.5 - 0.25).
  EXPECT_NEAR(contactSpread(round(-1.0), round(0.4), kUp, 0.1), 3.75 / 1.25, kRounding);
}

TEST(TrueWrench, IsASpringOnEachContactWithinTheCutoff) {
  TrueContact near;
  near.partPoint = {1.0, 0.0, 0.0};
  near.direction = kUp;
  near.distance = 0.05;
  TrueContact far = near;
  far.distance = 0.3;
  const std::vector<TrueContact> contacts{near, far};
  const Wrench wrench = trueWrench(contacts, 0.25, 4.0, {0.0, 1.0, 0.0});
  // 4 N/m * 0.2 m along z at (1, -1, 0) from the centre.
  EXPECT_LT(glm::distance(wrench.force, {0.0, 0.0, 0.8}), kRounding);
  EXPECT_LT(glm::distance(wrench.torque, {-0.8, -0.8, 0.0}), kRounding);
}

}  // namespace
}  // namespace nearfit::bench::analytic_contacts_test

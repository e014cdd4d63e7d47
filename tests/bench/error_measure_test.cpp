#include "tests/bench/error_measure.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/bench/error_shapes.h"

namespace nearfit::bench::error_measure_test {
namespace {

constexpr glm::dvec3 kUp{0.0, 0.0, 1.0};
constexpr double kEdge = 0.1, kTiny = 1e-15;

SpringParameters springs() {
  SpringParameters parameters;
  parameters.cutoff = 0.5;
  parameters.stiffness = 2.0;
  return parameters;
}

/// Two contacts a metre apart, above the floor.
ErrorPose twoContacts() {
  ErrorPose pose;
  pose.contacts = {{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.1}, kUp, 0.1},
                   {{1.0, 0.0, 0.0}, {1.0, 0.0, 0.2}, kUp, 0.2}};
  return pose;
}

Lmd minimumAt(double x, double distance) {
  Lmd lmd;
  lmd.scenePoint = {x, 0.0, 0.0};
  lmd.partPoint = {x, 0.0, distance};
  lmd.direction = kUp;
  lmd.distance = distance;
  return lmd;
}

TEST(AnswerErrors, TruthHasNone) {
  ContactAnswer answer;
  answer.minima = {minimumAt(0.0, 0.1), minimumAt(1.0, 0.2)};
  answer.wrench = trueWrench(twoContacts().contacts, 0.5, 2.0, glm::dvec3(0.0));
  const AnswerErrors errors = errorsOf(answer, twoContacts(), springs(), kEdge);
  EXPECT_EQ(errors.matched, 2U);
  EXPECT_EQ(errors.missed + errors.spurious + errors.extra, 0U);
  EXPECT_EQ(errors.distance + errors.position + errors.direction + errors.force + errors.torque, 0.0);
}

TEST(AnswerErrors, MinimaAreMissedSpuriousOrExtra) {
  ContactAnswer answer;  // Twice the first, the second not at all, and one from nowhere.
  answer.minima = {minimumAt(0.05, 0.11), minimumAt(-0.02, 0.12), minimumAt(0.5, 0.1)};
  const AnswerErrors errors = errorsOf(answer, twoContacts(), springs(), kEdge);
  EXPECT_EQ(errors.matched, 1U);
  EXPECT_EQ(errors.missed, 1U);
  EXPECT_EQ(errors.spurious, 1U);
  EXPECT_EQ(errors.extra, 1U);
  EXPECT_NEAR(errors.distance, 0.01, kTiny);  // Of the nearer one.
  EXPECT_NEAR(errors.position, std::hypot(0.05, 0.01), kTiny);
}

TEST(AnswerErrors, SilenceIsWrongByTheWholeWrench) {
  const AnswerErrors errors = errorsOf({}, twoContacts(), springs(), kEdge);
  EXPECT_EQ(errors.missed, 2U);
  EXPECT_NEAR(errors.force, 2.0 * 0.4 + 2.0 * 0.3, kTiny);
  EXPECT_NEAR(errors.torque, 2.0 * 0.3, kTiny);  // The second, a metre aside.
}

TEST(AnswerErrors, AnyPointOfARegionBelongsToIt) {
  ErrorPose pose;
  pose.contacts = {{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.1}, kUp, 0.1, 1.0, 0.4}};
  ContactAnswer answer;
  answer.minima = {minimumAt(0.39, 0.1)};
  const AnswerErrors errors = errorsOf(answer, pose, springs(), 1e-3);
  EXPECT_EQ(errors.matched, 1U);
  EXPECT_NEAR(errors.position, 0.39, kTiny);  // Its centroid is what stands for it.
}

TEST(ErrorShapes, AreClosedAndEdgesHalveWithTwiceTheFineness) {
  for (const ErrorPair& pair : errorPairs()) {
    for (const auto& make : {pair.part, pair.scene}) {
      const TriangleMesh coarse = make(8), fine = make(16);
      EXPECT_TRUE(coarse.topology().isClosed() && coarse.topology().isOriented()) << pair.name;
      double volume = 0.0;
      for (const Triangle& t : coarse.triangles()) {
        const auto p = coarse.vertices();
        volume += glm::dot(p[t[0]], glm::cross(p[t[1]], p[t[2]])) / 6.0;
      }
      EXPECT_GT(volume, 0.0) << pair.name;
      const double ratio = longestEdge(coarse) / longestEdge(fine);
      EXPECT_TRUE(ratio == 1.0 || (ratio > 1.85 && ratio < 2.15)) << pair.name << " " << ratio;
    }
  }
}

}  // namespace
}  // namespace nearfit::bench::error_measure_test

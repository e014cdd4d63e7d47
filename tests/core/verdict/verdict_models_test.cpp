// Verdicts on real meshes, and the exact arithmetic that they are held against on bodies whose answers are known.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/scene/part_geometry.h"
#include "core/verdict/scene_check.h"
#include "tests/exact/exact_meeting.h"
#include "tests/exact/exact_verdicts.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/places.h"
#include "tests/support/random_values.h"
#include "tests/support/trial_share.h"

namespace nearfit::verdict_models_test {
namespace {

RigidTransform at(double x, double y, double z) {
  return {glm::dquat(1, 0, 0, 0), {x, y, z}};
}

test::VerdictComparison comparisonOf(const Scene& scene, double threshold) {
  SceneCheckRequest request = sceneCheckRequest(scene, threshold);
  request.hasDepths = false;
  request.maxVolumeTriangles = 0;
  return test::compareVerdicts(request, checkScene(request));
}

void expectAgreement(const test::VerdictComparison& comparison) {
  EXPECT_EQ(comparison.agree, comparison.pairs);
  for (const std::string& difference : comparison.differences)
    ADD_FAILURE() << difference;
}

Scene boxes() {
  Scene scene;
  const auto add = [&scene](double size, const char* name, const RigidTransform& pose) {
    scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(size))), name, pose));
  };
  add(1.0, "box", {});
  add(1.0, "near", at(1.25, 0, 0));
  add(1.0, "touching", at(0, 1, 0));
  add(1.0, "clashing", at(0, 0, -0.9));
  add(0.25, "inside", {});
  add(1.0, "far", at(10, 0, 0));
  return scene;
}

TEST(ExactVerdicts, OfBoxesAreThoseOfTheFormula) {
  // "near" is a quarter from "box", "touching" and "clashing", "inside" 0.275 m from "clashing"; "touching" lies on the
  // sides of "box" and "clashing".
  const test::VerdictComparison comparison = comparisonOf(boxes(), 0.3);
  expectAgreement(comparison);
  EXPECT_EQ(comparison.pairs, 15U);
  EXPECT_EQ(comparison.near, 4U);
  EXPECT_EQ(comparison.touching, 2U);
  EXPECT_EQ(comparison.clashes, 1U);
  EXPECT_EQ(comparison.contained, 1U);
  EXPECT_EQ(comparison.clear, 7U);
}

TEST(ExactVerdicts, ADifferenceIsFound) {
  SceneCheckRequest request = sceneCheckRequest(boxes(), 0.3);
  SceneCheck check = checkScene(request);
  ASSERT_EQ(check.findings.size(), 8U);
  for (PairFinding& finding : check.findings) {
    if (finding.verdict == PairVerdict::Near) finding.distance += 1e-9;
    if (finding.verdict == PairVerdict::Touching) finding.verdict = PairVerdict::Clash;
    if (finding.verdict == PairVerdict::Contained) finding.verdict = PairVerdict::Near;
  }
  const test::VerdictComparison comparison = test::compareVerdicts(request, check);
  EXPECT_EQ(comparison.differences.size(), 7U);
  EXPECT_EQ(comparison.agree, comparison.pairs - comparison.differences.size());
  EXPECT_NEAR(comparison.worstDistance, 1e-9, 1e-12);
}

TEST(ExactVerdicts, TreesFindWhatAllPairsOfTrianglesGive) {
  test::RandomValues random(3);
  std::size_t meeting = 0, apart = 0;
  for (std::uint64_t i = 0; i < 16; ++i) {
    const TriangleMesh scene = test::starMesh(2 * i, 0.5, 1, 0.4),
                       part = test::starMesh(2 * i + 1, 0.5, 1, 0.4);
    RigidTransform pose = random.pose().normalized();
    pose.translation *= 2.0;
    const test::ExactBodies bodies(scene, part);
    const bool doMeet = test::doSurfacesMeetExactly(scene, part, pose);
    EXPECT_EQ(bodies.doSurfacesMeet(pose), doMeet);
    ++(doMeet ? meeting : apart);
    const double distance = test::leastDistanceExactly(scene, part, pose);
    EXPECT_NEAR(bodies.leastDistance(pose, 10.0), distance, 1e-13);
    EXPECT_EQ(bodies.leastDistance(pose, 0.5 * distance), 0.5 * distance);
  }
  EXPECT_GT(meeting, 0U);
  EXPECT_GT(apart, 0U);
}

TEST(ExactVerdicts, PiecesOfAMeshAreThoseWithoutACommonVertex) {
  const TriangleMesh both = test::joined(test::boxMesh(glm::dvec3(1.0)), test::icosphereMesh(0.2, 1));
  const std::vector<TriangleMesh> pieces = test::meshPieces(both);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].triangles().size(), 12U);
  EXPECT_EQ(pieces[1].triangles().size(), both.triangles().size() - 12U);
  EXPECT_TRUE(pieces[0].topology().isClosed());
  EXPECT_NEAR(pieces[1].bounds().upper.x, test::icosphereMesh(0.2, 1).bounds().upper.x, 0.0);
}

/// Reduced: nearfit-bench verdicts has more places, and the models of STEP files.
TEST(VerdictModels, PumpHasTheVerdictsOfExactArithmetic) {
  const std::filesystem::path folder = test::sharedFolder() / "models/public/pump";
  if (!std::filesystem::exists(folder)) return;
  constexpr double kThreshold = 2e-3;
  Scene drawn;
  for (const char* name : {"Axis_of_bearing", "Bottom", "Top"})
    drawn.add(test::partOf(loadPartGeometry(folder / (std::string(name) + ".stl"), 1e-3), name));
  const test::VerdictComparison asDrawn = comparisonOf(drawn, kThreshold);
  expectAgreement(asDrawn);
  EXPECT_EQ(asDrawn.pairs, 3U);
  EXPECT_EQ(asDrawn.clashes, 2U);
  if (test::kTrialShare > 1) return;
  expectAgreement(comparisonOf(test::spreadScene(drawn, 1.15, 1), kThreshold));
  expectAgreement(comparisonOf(test::spreadScene(drawn, 0.85, 2), kThreshold));
}

}  // namespace
}  // namespace nearfit::verdict_models_test

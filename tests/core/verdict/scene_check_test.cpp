#include "core/verdict/scene_check.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/exact/exact_meeting.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/random_values.h"
#include "tests/support/trial_share.h"

namespace nearfit::scene_check_test {
namespace {

RigidTransform at(const glm::dvec3& place) {
  return {glm::dquat(1, 0, 0, 0), place};
}

PartId add(Scene& scene, const TriangleMesh& mesh, const char* name, const RigidTransform& pose = {}) {
  return scene.add(test::partOf(test::geometryOf(mesh), name, pose));
}

SceneCheck checkOf(const Scene& scene, double threshold) {
  return checkScene(sceneCheckRequest(scene, threshold));
}

double lengthOf(const ClashMeasures& clash) {
  double length = 0.0;
  for (const auto& curve : clash.curves) {
    for (std::size_t i = 1; i < curve.size(); ++i)
      length += glm::distance(curve[i - 1], curve[i]);
  }
  return length;
}

TEST(SceneCheck, EachPairWithinTheThresholdHasItsVerdict) {
  Scene scene;
  const PartId box = add(scene, test::boxMesh(glm::dvec3(1.0)), "box"),
               near = add(scene, test::boxMesh(glm::dvec3(1.0)), "near", at({1.25, 0, 0})),
               touching = add(scene, test::boxMesh(glm::dvec3(1.0)), "touching", at({0, 1, 0})),
               clashing = add(scene, test::boxMesh(glm::dvec3(1.0)), "clashing", at({0, 0, -0.9})),
               inside = add(scene, test::boxMesh(glm::dvec3(0.25)), "inside");
  add(scene, test::boxMesh(glm::dvec3(1.0)), "far", at({10, 0, 0}));
  const SceneCheck check = checkOf(scene, 0.3);
  std::map<PartPair, PairVerdict> verdicts;
  for (const PairFinding& finding : check.findings)
    verdicts[finding.pair] = finding.verdict;
  EXPECT_EQ(verdicts.at({box, near}), PairVerdict::Near);
  EXPECT_EQ(verdicts.at({box, touching}), PairVerdict::Touching);
  EXPECT_EQ(verdicts.at({box, clashing}), PairVerdict::Clash);
  EXPECT_EQ(verdicts.at({box, inside}), PairVerdict::Contained);
  EXPECT_EQ(check.checkedPairs(), 15U);
  EXPECT_EQ(check.count(PairVerdict::Contained), 1U);
  EXPECT_EQ(check.count(PairVerdict::Clear), 15U - check.findings.size());
  EXPECT_EQ(check.forbidden(), 2U);
  EXPECT_TRUE(std::ranges::is_sorted(check.findings, {}, &PairFinding::pair));
}

TEST(SceneCheck, ANearPairHasItsDistancePointsAndEveryMinimumBelowTheThreshold) {
  Scene scene;
  const PartId plate = add(scene, test::boxMesh({4, 4, 1}), "plate");
  const RigidTransform turned{glm::angleAxis(std::numbers::pi / 4, glm::dvec3(0, 1, 0)), {0.0, 0.0, 1.3}};
  const PartId bar = add(scene, test::boxMesh({1, 2, 1}), "bar", turned);
  const SceneCheck check = checkOf(scene, 0.2);
  ASSERT_EQ(check.findings.size(), 1U);
  const PairFinding& finding = check.findings[0];
  const double gap = 1.3 - std::numbers::sqrt2 / 2 - 0.5;
  EXPECT_EQ(finding.pair, (PartPair{plate, bar}));
  EXPECT_NEAR(finding.distance, gap, 1e-12);
  EXPECT_NEAR(finding.partPoint.z, 0.5, 1e-12);
  EXPECT_NEAR(finding.otherPoint.z, 0.5 + gap, 1e-12);
  ASSERT_EQ(finding.minima.size(), 1U) << "the lower edge over the face";
  EXPECT_TRUE(finding.minima[0].isRegion);
  EXPECT_NEAR(finding.minima[0].distance, gap, 1e-12);
  EXPECT_TRUE(finding.isEveryMinimum);
  EXPECT_FALSE(finding.clash);
  EXPECT_TRUE(checkOf(scene, gap - 1e-6).findings.empty());
}

TEST(SceneCheck, MoreMinimaThanAreKeptAreSaid) {
  Scene scene;
  TriangleMesh tips = test::tetrahedronMesh(0.1);
  for (int i = 1; i < 30; ++i)
    tips = test::joined(tips, test::transformed(test::tetrahedronMesh(0.1), 1.0, at({0.3 * i, 0, 0})));
  add(scene, tips, "tips");
  add(scene, test::boxMesh({20, 1, 0.1}), "plate", at({4.5, 0, 0.2}));
  SceneCheckRequest request = sceneCheckRequest(scene, 0.2);
  request.maxMinima = 5;
  const SceneCheck few = checkScene(request);
  ASSERT_EQ(few.findings.size(), 1U);
  EXPECT_EQ(few.findings[0].minima.size(), 5U);
  EXPECT_FALSE(few.findings[0].isEveryMinimum);
}

TEST(SceneCheck, WithoutALimitAllMinimaAreKept) {
  // More than are kept by default.
  constexpr int kTips = 120;
  Scene scene;
  TriangleMesh tips = test::tetrahedronMesh(0.1);
  for (int i = 1; i < kTips; ++i)
    tips = test::joined(tips, test::transformed(test::tetrahedronMesh(0.1), 1.0, at({0.3 * i, 0, 0})));
  add(scene, tips, "tips");
  add(scene, test::boxMesh({80, 1, 0.1}), "plate", at({18, 0, 0.2}));
  SceneCheckRequest request = sceneCheckRequest(scene, 0.2);
  const SceneCheck some = checkScene(request);
  ASSERT_EQ(some.findings.size(), 1U);
  EXPECT_EQ(some.findings[0].minima.size(), request.maxMinima);
  EXPECT_FALSE(some.findings[0].isEveryMinimum);
  request.maxMinima = 0;
  const SceneCheck all = checkScene(request);
  ASSERT_EQ(all.findings.size(), 1U);
  EXPECT_GE(all.findings[0].minima.size(), static_cast<std::size_t>(kTips)) << "one for each tip";
  EXPECT_TRUE(all.findings[0].isEveryMinimum);
}

TEST(SceneCheck, AClashHasItsCurvesVolumeAndDepthInTheWorld) {
  Scene scene;
  // Both turned and moved alike: what they share is turned and moved too.
  const RigidTransform world{glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3))), {5.0, -3.0, 2.0}};
  add(scene, test::boxMesh(glm::dvec3(1.0)), "fixed", world);
  add(scene, test::boxMesh(glm::dvec3(1.0)), "moved", world * at({0.8, 0.5, 0.4}));
  const SceneCheck check = checkOf(scene, 0.1);
  ASSERT_EQ(check.findings.size(), 1U);
  const PairFinding& finding = check.findings[0];
  EXPECT_EQ(finding.verdict, PairVerdict::Clash);
  EXPECT_EQ(finding.distance, 0.0);
  ASSERT_TRUE(finding.clash);
  ASSERT_TRUE(finding.clash->volume);
  EXPECT_NEAR(*finding.clash->volume, 0.2 * 0.5 * 0.6, 1e-12);
  EXPECT_NEAR(lengthOf(*finding.clash), 2 * (0.2 + 0.5 + 0.6), 1e-9);
  for (const auto& curve : finding.clash->curves) {
    for (const glm::dvec3& point : curve) {
      const glm::dvec3 p = world.inverse().applyToPoint(point);
      EXPECT_NEAR(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 0.5, 1e-9);
    }
  }
  EXPECT_TRUE(finding.clash->isDepthExact);
  EXPECT_NEAR(*finding.depth(), 0.2, 1e-12);
  // The first part leaves the other one towards its -x.
  const glm::dvec3 direction = world.inverse().applyToVector(finding.clash->freeing->direction);
  EXPECT_NEAR(direction.x, -1.0, 1e-9);
}

TEST(SceneCheck, MeshesThatAreOpenOrCrossThemselvesHaveCurvesButNoVolume) {
  Scene scene;
  add(scene, test::squareMesh(4.0, 2), "sheet");
  add(scene, test::boxMesh(glm::dvec3(1.0)), "box");
  // Far from the sheet, it crosses itself.
  const TriangleMesh cross = test::joined(test::boxMesh(glm::dvec3(0.5), {5, 0, 0}),
                                          test::boxMesh(glm::dvec3(0.5), {5.3, 0.1, 0.2}));
  const TriangleMesh crossed = test::joined(test::boxMesh(glm::dvec3(0.2), {0.6, 0, 0}), cross);
  add(scene, crossed, "crossed", at({-0.05, 0.0, 0.3}));
  const SceneCheck check = checkOf(scene, 0.0);
  std::map<VolumeProblem, int> problems;
  for (const PairFinding& finding : check.findings) {
    ASSERT_TRUE(finding.clash);
    EXPECT_FALSE(finding.clash->volume);
    EXPECT_GT(lengthOf(*finding.clash), 0.1);
    ++problems[finding.clash->volumeProblem];
  }
  EXPECT_EQ(problems[VolumeProblem::Open], 1) << "sheet and box";
  EXPECT_EQ(problems[VolumeProblem::CrossesItself], 1) << "box and crossed";
}

TEST(SceneCheck, RulesLeavePairsOutAndAllowTouchingAndPressFits) {
  Scene scene;
  const GroupId group = scene.addGroup({{}, "Group", {}, false});
  add(scene, test::tubeMesh(0.3, 0.5, 1.0, 16), "Hub");
  add(scene, test::cylinderMesh(0.302, 2.0, 16), "Shaft", at({0, 0, 0.3}));
  Part cap = test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "Cap", at({3, 0, 0}));
  cap.group = group;
  scene.add(cap);
  cap.name = "Cap 2";
  cap.worldFromPart = at({3.5, 0, 0});
  scene.add(cap);
  EXPECT_EQ(checkOf(scene, 0.1).forbidden(), 2U);
  scene.setPairRules({{PairRuleKind::SameGroup}, {PairRuleKind::PressFit, "Shaft", "Hub", 0.001}});
  SceneCheck check = checkOf(scene, 0.1);
  ASSERT_EQ(check.leftOut.size(), 1U);
  EXPECT_EQ(check.leftOut[0].rule, 0U);
  EXPECT_EQ(check.checkedPairs(), 5U);
  EXPECT_EQ(check.forbidden(), 1U) << "the fit is tighter than it may be";
  scene.setPairRules({{PairRuleKind::SameGroup}, {PairRuleKind::PressFit, "Shaft", "Hub", 0.0021}});
  check = checkOf(scene, 0.1);
  EXPECT_EQ(check.forbidden(), 0U);
  ASSERT_EQ(check.findings.size(), 1U);
  EXPECT_EQ(check.findings[0].allowedBy, 1U);
  EXPECT_GT(*check.findings[0].depth(), 0.1) << "freeing it takes far more";
}

TEST(SceneCheck, HiddenPartsAreNotChecked) {
  Scene scene;
  add(scene, test::boxMesh(glm::dvec3(1.0)), "box");
  Part hidden = test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "hidden");
  hidden.isVisible = false;
  scene.add(hidden);
  const SceneCheck check = checkOf(scene, 1.0);
  EXPECT_EQ(check.parts.size(), 1U);
  EXPECT_TRUE(check.findings.empty());
}

/// Distance of two boxes of equal directions; negative where they overlap: minus the least overlap of any axis.
double gapOfBoxes(const glm::dvec3& a, const glm::dvec3& halfA, const glm::dvec3& b,
                  const glm::dvec3& halfB) {
  const glm::dvec3 gaps = glm::abs(b - a) - halfA - halfB;
  if (gaps.x < 0.0 && gaps.y < 0.0 && gaps.z < 0.0) return std::max({gaps.x, gaps.y, gaps.z});
  return glm::length(glm::max(gaps, glm::dvec3(0.0)));
}

TEST(SceneCheck, OfHundredsOfBoxesItFindsThePairsThatTheFormulaFinds) {
  constexpr double kThreshold = 0.06;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    test::RandomValues random(seed);
    Scene scene;
    std::vector<glm::dvec3> places, halves;
    // Few geometries, so that most parts share theirs.
    std::vector<PartGeometryPtr> shapes;
    std::vector<glm::dvec3> sizes;
    for (int i = 0; i < 5; ++i) {
      sizes.push_back(glm::dvec3(0.25) + random.vector(0.15));
      shapes.push_back(test::geometryOf(test::boxMesh(sizes.back())));
    }
    for (int i = 0; i < 200; ++i) {
      const auto shape = static_cast<std::size_t>(i % 5);
      places.push_back(random.vector(1.2));
      halves.push_back(0.5 * sizes[shape]);
      scene.add(test::partOf(shapes[shape], fmt::format("{}", i).c_str(), at(places.back())));
    }
    const SceneCheck check = checkOf(scene, kThreshold);
    auto finding = check.findings.begin();
    std::size_t clashes = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      for (std::size_t k = i + 1; k < places.size(); ++k) {
        const double gap = gapOfBoxes(places[i], halves[i], places[k], halves[k]);
        const PartPair pair{scene.parts()[i]->id, scene.parts()[k]->id};
        const bool isFound = finding != check.findings.end() && finding->pair == pair;
        // Too near to touching, or to the threshold, for the formula's rounding.
        if (std::abs(gap) < 1e-5 || std::abs(gap - kThreshold) < 1e-9) {
          if (isFound) ++finding;
          continue;
        }
        ASSERT_EQ(isFound, gap < kThreshold) << i << " " << k << " " << gap;
        if (!isFound) continue;
        if (gap > 0.0) {
          EXPECT_EQ(finding->verdict, PairVerdict::Near);
          EXPECT_NEAR(finding->distance, gap, 1e-12);
        } else {
          ++clashes;
          EXPECT_GE(finding->verdict, PairVerdict::Clash);
          EXPECT_NEAR(finding->depth().value_or(-1.0), -gap, 1e-9);
          const glm::dvec3 low = glm::max(places[i] - halves[i], places[k] - halves[k]),
                           high = glm::min(places[i] + halves[i], places[k] + halves[k]);
          const glm::dvec3 shared = high - low;
          ASSERT_TRUE(finding->clash->volume) << textOf(finding->clash->volumeProblem);
          EXPECT_NEAR(*finding->clash->volume, shared.x * shared.y * shared.z, 1e-12);
        }
        ++finding;
      }
    }
    EXPECT_GT(clashes, 10U);
    EXPECT_GT(check.findings.size(), clashes + 10);
  }
}

TEST(SceneCheck, JaggedPartsHaveTheVerdictsOfExactArithmetic) {
  constexpr double kThreshold = 0.25;
  test::RandomValues random(8);
  std::size_t found = 0, clear = 0;
  for (unsigned round = 0; round < 8 / test::kTrialShare; ++round) {
    Scene scene;
    for (unsigned i = 0; i < 6; ++i) {
      RigidTransform pose = random.pose().normalized();
      pose.translation *= 3.0;
      scene.add(test::partOf(test::geometryOf(test::starMesh(6 * round + i, 0.5, 1, 0.4)),
                             fmt::format("{}", i).c_str(), pose));
    }
    const SceneCheck check = checkOf(scene, kThreshold);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t k = i + 1; k < 6; ++k) {
        const Part &part = *scene.parts()[i], &other = *scene.parts()[k];
        const RigidTransform pose = (other.worldFromPart.inverse() * part.worldFromPart).normalized();
        const auto at = std::ranges::find(check.findings, PartPair{part.id, other.id}, &PairFinding::pair);
        const bool isFound = at != check.findings.end();
        const TriangleMesh &a = part.geometry->mesh, &b = other.geometry->mesh;
        if (test::doSurfacesMeetExactly(b, a, pose)) {
          ASSERT_TRUE(isFound);
          EXPECT_EQ(at->verdict, PairVerdict::Clash);
          continue;
        }
        const double distance = test::leastDistanceExactly(b, a, pose);
        ASSERT_EQ(isFound, distance <= kThreshold) << distance;
        isFound ? ++found : ++clear;
        if (!isFound) continue;
        EXPECT_NEAR(at->distance, distance, 1e-12);
      }
    }
  }
  EXPECT_GT(found, 0U);
  EXPECT_GT(clear, 0U);
}

TEST(SceneCheck, PairsThatLookAlikeHaveOneResultEachInItsPlace) {
  Scene scene;
  const PartGeometryPtr box = test::geometryOf(test::boxMesh(glm::dvec3(1.0)));
  // Places without rounding: the relative poses are the same to the bit.
  for (int i = 0; i < 12; ++i)
    scene.add(test::partOf(box, fmt::format("{}", i).c_str(), at({0.75 * i, 0.0, 0.0})));
  const SceneCheck check = checkOf(scene, 0.1);
  ASSERT_EQ(check.findings.size(), 11U);
  for (std::size_t i = 0; i < 11; ++i) {
    const PairFinding& finding = check.findings[i];
    EXPECT_NEAR(*finding.clash->volume, 0.25, 1e-12);
    EXPECT_NEAR(*finding.depth(), 0.25, 1e-12);
    for (const auto& curve : finding.clash->curves) {
      for (const glm::dvec3& point : curve)
        EXPECT_NEAR(point.x, 0.75 * static_cast<double>(i) + 0.375, 0.126);
    }
  }
}

TEST(SceneCheck, InvalidRequestsAreRefusedAndTheUserCanCancel) {
  Scene scene;
  add(scene, test::boxMesh(glm::dvec3(1.0)), "a");
  add(scene, test::boxMesh(glm::dvec3(1.0)), "b", at({0.5, 0, 0}));
  EXPECT_THROW(checkOf(scene, -1.0), UsageError);
  EXPECT_THROW(checkOf(scene, std::nan("")), UsageError);
  SceneCheckRequest request = sceneCheckRequest(scene, 0.1);
  EXPECT_THROW(checkScene(request, [](double) { return false; }), Cancelled);
  request.isLowPriority = true;
  EXPECT_THROW(checkScene(request, [](double) { return false; }), Cancelled);
  EXPECT_EQ(checkScene(request).findings.size(), 1U);
  request.rules = {{PairRuleKind::LeaveOut, "", "*"}};
  EXPECT_THROW(checkScene(request), UsageError);
  EXPECT_TRUE(checkOf(Scene(), 0.1).findings.empty());
  EXPECT_EQ(checkOf(Scene(), 0.1).checkedPairs(), 0U);
}

}  // namespace
}  // namespace nearfit::scene_check_test

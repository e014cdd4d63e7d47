#include "tests/bench/check_run.h"

#include <algorithm>
#include <array>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/math/aabb.h"
#include "tests/bench/check_figures.h"
#include "tests/exact/exact_meeting.h"

namespace nearfit::bench::check_run_test {
namespace {

using testing::HasSubstr;

/// Bodies of 80 and 180 triangles, two of which are moved into the one before.
ManyPartsScene smallScene() {
  return stackedParts("small",
                      {.parts = 14, .shapes = 5, .frequency = 2, .clashEvery = 4, .thresholdFraction = 0.05});
}

Aabb placedBox(const ManyPartsScene& scene, std::size_t part) {
  Aabb box;
  for (const glm::dvec3& p : scene.meshOf(part).vertices())
    box.add(scene.parts[part].worldFromPart.applyToPoint(p));
  return box;
}

/// True if the boxes of two parts are farther apart than the threshold along an axis.
bool areFar(const ManyPartsScene& scene, std::size_t i, std::size_t k) {
  const Aabb a = placedBox(scene, i), b = placedBox(scene, k);
  const double reach = 1.001 * scene.threshold;
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    if (a.lower[axis] > b.upper[axis] + reach || b.lower[axis] > a.upper[axis] + reach) return true;
  }
  return false;
}

/// A library by brute force over all pairs of parts and triangles, in exact arithmetic.
PeerCheck bruteForce(const ManyPartsScene& scene) {
  PeerCheck check;
  check.buildSeconds = 1.0;
  check.pairsSeconds = 2.0;
  for (std::uint32_t i = 0; i < scene.parts.size(); ++i) {
    for (std::uint32_t k = i + 1; k < scene.parts.size(); ++k) {
      ++check.candidates;
      if (areFar(scene, i, k)) continue;
      const RigidTransform pose = scene.parts[k].worldFromPart.inverse() * scene.parts[i].worldFromPart;
      const double distance = test::leastDistanceExactly(scene.meshOf(k), scene.meshOf(i), pose);
      if (distance > scene.threshold) continue;
      check.near.push_back(
          {i, k, distance, test::doSurfacesMeetExactly(scene.meshOf(k), scene.meshOf(i), pose)});
    }
  }
  check.measured = check.candidates;
  return check;
}

class CheckRun : public testing::Test {
 protected:
  /// Takes seconds: once for all tests.
  static const PeerCheck& exactCheck() {
    static const PeerCheck check = bruteForce(smallScene());
    return check;
  }

  const ManyPartsScene scene = smallScene();
  const PeerCheck& exact = exactCheck();
};

TEST_F(CheckRun, NearPairsDistancesAndClashesAreThoseOfBruteForceInExactArithmetic) {
  EXPECT_GT(exact.near.size(), 8U) << "a scene that tests something";
  EXPECT_LT(exact.near.size(), exact.candidates);
  const OwnCheck own = measureOwnCheck(scene, true);
  EXPECT_EQ(own.found.findings.size(), exact.near.size());
  const CheckAgreement agreement = compareChecks(own.found, exact, scene);
  EXPECT_TRUE(agreement.holds);
  EXPECT_EQ(agreement.compared, exact.near.size());
  EXPECT_LE(agreement.worstDistance, 1e-12);
  EXPECT_GE(own.found.count(PairVerdict::Clash), scene.meantClashes.size());
}

TEST_F(CheckRun, LibrariesBuiltInAgreeWithExactArithmetic) {
  for (const CheckPeer& peer : checkPeers()) {
    const PeerCheck check = peer.check(scene, 1e9);
    EXPECT_FALSE(check.isCut());
    ASSERT_EQ(check.near.size(), exact.near.size()) << peer.name;
    for (std::size_t i = 0; i < check.near.size(); ++i) {
      EXPECT_EQ(check.near[i].part, exact.near[i].part) << peer.name;
      EXPECT_EQ(check.near[i].other, exact.near[i].other) << peer.name;
      EXPECT_NEAR(check.near[i].distance, exact.near[i].distance, 1e-9) << peer.name;
      EXPECT_EQ(check.near[i].doMeet, exact.near[i].doMeet) << peer.name;
    }
    EXPECT_TRUE(compareChecks(measureOwnCheck(scene, false).found, check, scene).holds) << peer.name;
  }
}

TEST(CheckPeers, ListsHaveAllPairsOfTrianglesWithinTheThreshold) {
  const ManyPartsScene scene =
      stackedParts("two", {.parts = 2, .shapes = 2, .frequency = 2, .thresholdFraction = 0.05});
  const auto trianglesOf = [&](std::size_t part) {
    std::vector<std::array<glm::dvec3, 3>> placed;
    const TriangleMesh& mesh = scene.meshOf(part);
    for (const Triangle& t : mesh.triangles()) {
      placed.emplace_back();
      for (std::size_t k = 0; k < 3; ++k)
        placed.back()[k] = scene.parts[part].worldFromPart.applyToPoint(mesh.vertices()[t[k]]);
    }
    return placed;
  };
  // Coal's own distance of two triangles is iterated.
  const double rounding = 1e-5 * scene.threshold;
  std::size_t surely = 0, perhaps = 0;
  for (const auto& a : trianglesOf(0)) {
    for (const auto& b : trianglesOf(1)) {
      const double distance = test::exactDistance(a, b);
      surely += distance < scene.threshold - rounding ? 1U : 0U;
      perhaps += distance < scene.threshold + rounding ? 1U : 0U;
    }
  }
  EXPECT_GT(surely, 10U) << "a scene that tests something";
  for (const CheckPeer& peer : checkPeers()) {
    const PeerCheck check = peer.check(scene, 1e9);
    EXPECT_EQ(check.near.size(), 1U) << peer.name;
    EXPECT_EQ(check.fullLists, 0U) << peer.name;
    if (peer.name != "coal-lists") continue;
    EXPECT_GE(check.listed, surely);
    EXPECT_LE(check.listed, perhaps);
  }
}

TEST_F(CheckRun, WhatClashesAreMeasuredByCanBeLeftOut) {
  const auto isMeasured = [](const PairFinding& finding) {
    return finding.clash && (finding.clash->volume || finding.clash->freeing);
  };
  const SceneCheck whole = measureOwnCheck(scene, true).found, bare = measureOwnCheck(scene, false).found;
  EXPECT_TRUE(std::ranges::any_of(whole.findings, isMeasured));
  EXPECT_TRUE(std::ranges::none_of(bare.findings, isMeasured));
  ASSERT_EQ(whole.findings.size(), bare.findings.size());
  for (std::size_t i = 0; i < whole.findings.size(); ++i) {
    EXPECT_EQ(whole.findings[i].pair, bare.findings[i].pair);
    EXPECT_EQ(whole.findings[i].verdict, bare.findings[i].verdict);
  }
}

TEST_F(CheckRun, AWrongDistanceAMissingPairAndAClashApartAreFound) {
  const OwnCheck own = measureOwnCheck(scene, false);
  const auto isApart = [](const PeerPair& pair) { return !pair.doMeet; };
  const auto apart = static_cast<std::size_t>(std::ranges::find_if(exact.near, isApart) - exact.near.begin());
  const auto meeting =
      static_cast<std::size_t>(std::ranges::find_if_not(exact.near, isApart) - exact.near.begin());
  ASSERT_LT(apart, exact.near.size());
  ASSERT_LT(meeting, exact.near.size());

  PeerCheck wrong = exact;
  wrong.near[apart].distance += 1e-6;
  EXPECT_FALSE(compareChecks(own.found, wrong, scene).holds);
  EXPECT_NEAR(compareChecks(own.found, wrong, scene).worstDistance, 1e-6, 1e-12);

  wrong = exact;
  wrong.near[meeting].doMeet = false;
  EXPECT_EQ(compareChecks(own.found, wrong, scene).apart, 1U);

  wrong = exact;
  wrong.near.erase(wrong.near.begin() + static_cast<std::ptrdiff_t>(apart));
  EXPECT_EQ(compareChecks(own.found, wrong, scene).missing, 1U);
  // It may not have come to it.
  --wrong.measured;
  EXPECT_EQ(compareChecks(own.found, wrong, scene).missing, 0U);

  SceneCheck less = own.found;
  less.findings.pop_back();
  EXPECT_EQ(compareChecks(less, exact, scene).extra, 1U);
  EXPECT_FALSE(compareChecks(less, exact, scene).holds);
}

TEST_F(CheckRun, ThePeakOfMemoryIsNoLessThanWhatWasThere) {
  const OwnCheck own = measureOwnCheck(scene, false);
  EXPECT_GT(own.residentBefore, 0U);
  // The kernel adds up its counters of each processor only now and then.
  constexpr std::size_t kCounterSlack = std::size_t{1} << 20;
  EXPECT_GE(own.residentPeak + kCounterSlack, own.residentBefore);
}

TEST_F(CheckRun, FiguresStateTheMedianTheWorstAndIfGoalsAreMet) {
  const CheckPeer slow{"slow", [](const ManyPartsScene&, double) { return exactCheck(); }};
  const std::vector<CheckMethodRuns> runs = runChecks(scene, {slow}, {.repeats = 3});
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_TRUE(checkProblems(scene, runs).empty());
  EXPECT_EQ(runs[2].near, exact.near.size());
  const auto figureNamed = [&](const CheckGoals& goals, const char* method, const char* name) {
    for (const CheckFigure& figure : checkFigures(scene, goals, runs)) {
      if (figure.method == method && figure.name == name) return figure;
    }
    ADD_FAILURE() << method << ": " << name;
    return CheckFigure();
  };
  const CheckFigure whole = figureNamed({1e9, 0.0, 0.0}, "nearfit", "whole check");
  EXPECT_EQ(whole.runs, 3U);
  EXPECT_GE(whole.worst, whole.median);
  EXPECT_TRUE(whole.isMet());
  EXPECT_FALSE(figureNamed({1e-9, 0.0, 0.0}, "nearfit", "whole check").isMet());
  EXPECT_FALSE(figureNamed({0.0, 1.0, 0.0}, "nearfit", "max resident memory").isMet());

  // With fewer near pairs than the goals are for, none is met.
  for (const char* name : {"whole check", "max resident memory", "near pairs"}) {
    EXPECT_TRUE(figureNamed({1e9, 1e18, 0.0, runs[0].near}, "nearfit", name).isMet()) << name;
    EXPECT_FALSE(figureNamed({1e9, 1e18, 0.0, runs[0].near + 1}, "nearfit", name).isMet()) << name;
  }

  // It says that it takes three seconds.
  const CheckFigure ratio = figureNamed({0.0, 0.0, 1e-9}, "slow", "times nearfit");
  EXPECT_LE(ratio.worst, ratio.median);
  EXPECT_TRUE(ratio.isMet());
  EXPECT_FALSE(figureNamed({0.0, 0.0, 1e12}, "slow", "times nearfit").isMet());
  EXPECT_THAT(checkCsvLine(ratio), HasSubstr(",slow,times nearfit,x,3,"));
  EXPECT_EQ(std::ranges::count(checkCsvLine(ratio), ','), std::ranges::count(checkCsvHeader(), ','));
}

TEST_F(CheckRun, AListIsJudgedBesideTheCheckThatMeasuresNoClashEither) {
  const CheckPeer lists{"lists", [](const ManyPartsScene&, double) {
                          PeerCheck check = exactCheck();
                          check.listed = 7;
                          check.fullLists = 2;
                          return check;
                        }};
  const std::vector<CheckMethodRuns> runs = runChecks(scene, {lists}, {.repeats = 1});
  std::size_t judged = 0;
  for (const CheckFigure& figure : checkFigures(scene, {0.0, 0.0, 5.0}, runs)) {
    if (figure.method != "lists") continue;
    if (figure.name == "pairs of triangles listed") {
      EXPECT_EQ(figure.median, 7.0);
    }
    if (figure.name == "whole check") {
      EXPECT_EQ(figure.remark, "cut: 2 lists are full");
    }
    if (figure.goal == 0.0) continue;
    EXPECT_EQ(figure.name, "times nearfit-unmeasured");
    ++judged;
  }
  EXPECT_EQ(judged, 1U);
}

TEST_F(CheckRun, ALibraryThatIsCutIsSaidToBe) {
  const CheckPeer cut{"cut", [](const ManyPartsScene&, double) {
                        PeerCheck check = exactCheck();
                        check.measured = 20;
                        return check;
                      }};
  const std::vector<CheckMethodRuns> runs = runChecks(scene, {cut}, {.repeats = 1});
  EXPECT_TRUE(runs[2].isCut());
  EXPECT_TRUE(runs[2].agreement.holds);
  bool isSaid = false;
  for (const CheckFigure& figure : checkFigures(scene, {}, runs))
    isSaid = isSaid || figure.remark == "cut: 20 of 91 pairs measured";
  EXPECT_TRUE(isSaid);
}

}  // namespace
}  // namespace nearfit::bench::check_run_test

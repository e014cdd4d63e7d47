#include "core/path/path_search.h"

#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/math/aabb.h"
#include "core/path/certificate.h"
#include "core/path/path_verifier.h"
#include "tests/exact/pose_certifier.h"
#include "tests/support/path_scenes.h"
#include "tests/support/random_values.h"
#include "tests/support/refusal_of.h"
#include "tests/support/suggest_scenes.h"

namespace nearfit::path_search_test {
namespace {

using testing::HasSubstr;

/// Time is no limit in these tests: the number of motions is.
constexpr double kAnyTime = 3600.0;

PathSearchOptions withSeed(std::uint64_t seed, std::uint64_t maxMotions = 200'000) {
  PathSearchOptions options;
  options.seconds = kAnyTime;
  options.seed = seed;
  options.maxMotions = maxMotions;
  return options;
}

PathSearchResult search(const test::SuggestScene& made, const PathSearchOptions& options) {
  return searchPath(made.scene, made.goal, options);
}

std::string described(const test::SuggestScene& made, const PathSearchResult& result) {
  return describePathSearch(made.scene, made.goal, result,
                            [](double length) { return fmt::format("{:.3g} m", length); });
}

/// Checks a path by the verifier, and by exact predicates at random places; neither shares code with the search.
void expectFreePath(const test::SuggestScene& made, const PathSearchResult& result) {
  ASSERT_EQ(result.end, PathSearchEnd::Found) << described(made, result);
  const Part& moving = made.scene.get(*made.scene.movingPart());
  ASSERT_EQ(result.path.parts, std::vector<std::string>{moving.name});
  EXPECT_EQ(result.path.poses.front().worldFromLead.translation, moving.worldFromPart.translation);
  if (made.goal.pose) {
    EXPECT_EQ(result.path.poses.back().worldFromLead.translation, made.goal.pose->translation);
  }
  const Verification verified =
      verifyCertificate(certificateOf(made.scene, result.path, result.proof, {}), made.scene, {});
  EXPECT_EQ(verified.problem, "");
  test::RandomValues random(3);
  for (const Scene::PartPtr& other : made.scene.parts()) {
    if (other->id == moving.id) continue;
    const test::PoseCertifier oracle(other->geometry->mesh, moving.geometry->mesh);
    for (int i = 0; i < 200; ++i) {
      const double place = random.in(0.0, result.path.end());
      ASSERT_FALSE(oracle.doMeet(other->worldFromPart.inverse() * poseAt(result.path, place)))
          << "at place " << place;
    }
  }
}

TEST(PathSearch, APegComesStraightOutOfItsHole) {
  const test::SuggestScene made = test::pegInHole();
  const PathSearchResult result = search(made, withSeed(1));
  expectFreePath(made, result);
  EXPECT_EQ(result.method, PathSearchMethod::Straight);
  const glm::dvec3 last = result.path.poses.back().worldFromLead.translation;
  EXPECT_LT(std::hypot(last.x, last.y), 1e-9) << "along the hole";
  EXPECT_GT(std::abs(last.z), 40e-3) << "the whole depth of the hole";
}

TEST(PathSearch, APegThatLiesBesideFindsIntoItsHole) {
  const test::SuggestScene made = test::pegBesideHole();
  expectFreePath(made, search(made, withSeed(1)));
}

TEST(PathSearch, ABentPipeComesOutRoundItsBend) {
  const test::SuggestScene made = test::pipeOut();
  const PathSearchResult result = search(made, withSeed(1));
  expectFreePath(made, result);
  EXPECT_GT(result.path.poses.size(), 2U) << "no straight motion leads out";
  Aabb box;
  for (const glm::dvec3& vertex : made.scene.findByName("Pipe")->geometry->mesh.vertices())
    box.add(result.path.poses.back().worldFromLead.applyToPoint(vertex));
  // Before or behind the plate, or beside it.
  EXPECT_TRUE(box.lower.z > 2e-3 || box.upper.z < -2e-3 || box.lower.x > 0.1 || box.upper.x < -0.1 ||
              box.lower.y > 0.1 || box.upper.y < -0.1);
}

TEST(PathSearch, TheSameSeedGivesTheSamePath) {
  const test::SuggestScene made = test::pegBesideHole();
  const PathSearchResult a = search(made, withSeed(5)), b = search(made, withSeed(5));
  ASSERT_EQ(a.end, PathSearchEnd::Found);
  EXPECT_TRUE(isSamePath(a.path, b.path));
}

TEST(PathSearch, WhereNothingLeadsOutItSaysHowFarItCame) {
  const test::SuggestScene made = test::ballInBox();
  const PathSearchResult result = search(made, withSeed(1, 2000));
  EXPECT_EQ(result.end, PathSearchEnd::NotFound);
  EXPECT_GE(result.motions, 2000U);
  EXPECT_GT(result.directions, 0U);
  // The box leaves the ball's centre 20 mm along each axis.
  EXPECT_GT(result.farthest, 15e-3);
  EXPECT_LT(result.farthest, 1.05 * std::sqrt(3.0) * 20e-3);
  EXPECT_THAT(described(made, result), HasSubstr("does not mean that there is none"));
}

TEST(PathSearch, APartThatTouchesAtTheStartIsNamed) {
  test::SuggestScene made{"cubes", {}, {}};
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Post"));
  made.scene.setMovingPart(
      made.scene.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Cube", test::at(1.0, 0, 0))));
  const PathSearchResult result = search(made, withSeed(1));
  EXPECT_EQ(result.end, PathSearchEnd::StartNotFree);
  ASSERT_TRUE(result.blocked.has_value());
  EXPECT_EQ(made.scene.get(result.blocked->other).name, "Post");
  EXPECT_THAT(described(made, result), HasSubstr("at the start"));
}

TEST(PathSearch, AGoalInsideAnotherPartIsNamed) {
  test::SuggestScene made{"cubes", {}, {}};
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Post"));
  made.scene.setMovingPart(made.scene.add(
      test::partOf(test::geometryOf(test::boxMesh({0.1, 0.1, 0.1})), "Cube", test::at(1.0, 0, 0))));
  made.goal.pose = RigidTransform{};
  const PathSearchResult result = search(made, withSeed(1));
  EXPECT_EQ(result.end, PathSearchEnd::GoalNotFree);
  ASSERT_TRUE(result.blocked.has_value());
  EXPECT_TRUE(result.blocked->isInside);
}

TEST(PathSearch, WithoutTurnsNoPoseTurns) {
  test::SuggestScene made = test::pegBesideHole();
  PathSearchOptions options = withSeed(1);
  options.mayTurn = false;
  EXPECT_THAT(test::refusalOf([&] { search(made, options); }), HasSubstr("may not turn"));
  Part peg = *made.scene.findByName("Peg");
  peg.worldFromPart.rotation = glm::dquat(1.0, 0.0, 0.0, 0.0);
  made.scene.replace(peg);
  const PathSearchResult result = search(made, options);
  expectFreePath(made, result);
  for (const PathPose& pose : result.path.poses)
    EXPECT_NEAR(std::abs(pose.worldFromLead.rotation.w), 1.0, 1e-12);
}

TEST(PathSearch, WhatMakesNoSenseIsRefused) {
  test::SuggestScene made = test::pegInHole();
  PathSearchOptions options = withSeed(1);
  options.seconds = 0.0;
  EXPECT_THAT(test::refusalOf([&] { search(made, options); }), HasSubstr("not a valid time"));
  options = withSeed(1);
  options.separation = -1.0;
  EXPECT_THAT(test::refusalOf([&] { search(made, options); }), HasSubstr("not a valid separation"));
  made.goal.pose = RigidTransform{};
  EXPECT_THAT(test::refusalOf([&] { search(made, withSeed(1)); }), HasSubstr("there already"));
  made.scene.setMovingPart(std::nullopt);
  EXPECT_THAT(test::refusalOf([&] { search(made, withSeed(1)); }), HasSubstr("nothing is in hand"));
}

/// The time goes on by a step with each look at the clock, whatever the machine does meanwhile. Shortening, of up to 32
/// looks, went on after the time was over.
TEST(PathSearch, ShorteningEndsWithinTheTimeThatIsSet) {
  constexpr double kStep = 1e-3;
  // Looks that threads have begun when the time ends, and those that see that it has.
  const double slack = kStep * (8.0 + std::thread::hardware_concurrency());
  test::SuggestScene made{"plate", {}, {}};
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({4, 4, 1})), "Plate"));
  made.scene.setMovingPart(
      made.scene.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Cube", test::at(0, 0, 2))));
  made.goal.pose = test::at(0, 0, -1.2);
  const auto searchWithin = [&made](double seconds) {
    PathSearchOptions options = withSeed(1);
    options.separation = 0.05;
    options.seconds = seconds;
    options.now = [looks = std::make_shared<std::atomic<int>>(0)] { return kStep * looks->fetch_add(1); };
    return search(made, options);
  };
  const PathSearchResult whole = searchWithin(kAnyTime);
  ASSERT_EQ(whole.end, PathSearchEnd::Found);
  EXPECT_GT(whole.path.poses.size(), 2U) << "else there is nothing to shorten";
  // Threads share the looks out anew each time, so that many ends are tried.
  for (int before = 0; before < 120; before += 4) {
    const double seconds = whole.seconds - before * kStep;
    if (!(seconds > 0.0)) break;
    const PathSearchResult result = searchWithin(seconds);
    if (result.end == PathSearchEnd::Found) {
      EXPECT_LE(result.seconds, seconds + slack) << before << " looks before the end";
    }
  }
}

TEST(PathSearch, StopsWhenTheUserCancels) {
  const test::SuggestScene made = test::ballInBox();
  EXPECT_THROW(searchPath(made.scene, made.goal, withSeed(1), [](double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace nearfit::path_search_test

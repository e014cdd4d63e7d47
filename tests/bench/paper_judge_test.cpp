#include "tests/bench/paper_judge.h"

#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/bench/portable_random.h"
#include "tests/bench/selection.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench::paper_judge_test {
namespace {

/// Two jagged bodies near each other at a pose with several minima.
class JudgedStars : public testing::Test {
 protected:
  JudgedStars()
      : scene_(test::starMesh(1, 0.5, 1, 0.3), test::starMesh(2, 0.5, 1, 0.3), 0.4),
        oracle_(scene_.bodies.meshes.scene, scene_.bodies.meshes.part) {
    std::mt19937_64 random(3);
    while (truth_.minima.size() < 3 || !truth_.isWrenchKnown()) {
      const RigidTransform pose{test::randomRotation(random).rotation, 1.1 * randomDirection(random)};
      truth_ = judgedPose(oracle_, scene_, pose);
    }
  }

  ContactAnswer answerOf(const char* method) const {
    ContactAnswer answer;
    chosen(allErrorMethods(), {method}, "test").front().make(scene_)->answer(truth_.sceneFromPart, answer);
    return answer;
  }
  Judgement judged(ContactAnswer answer) const {
    answer.wrench = scene_.wrenchOf(answer.minima, truth_.sceneFromPart);
    return judge(answer, truth_, oracle_.size());
  }

  ErrorScene scene_;
  test::ExactOracle oracle_;
  JudgedPose truth_;
};

TEST_F(JudgedStars, TheExactSetHasNoErrors) {
  const Judgement judgement = judged(answerOf("exact cold"));
  EXPECT_EQ(judgement.missed, 0U);
  EXPECT_EQ(judgement.spurious, 0U);
  EXPECT_LT(judgement.force.value(), 1e-9);
  EXPECT_LT(judgement.torque.value(), 1e-9);
}

TEST_F(JudgedStars, AMissingMinimumIsMissedAndItsSpringIsTheError) {
  ContactAnswer answer = answerOf("exact cold");
  const Lmd lost = answer.minima.front();
  answer.minima.erase(answer.minima.begin());
  const Judgement judgement = judged(answer);
  EXPECT_EQ(judgement.missed, 1U);
  EXPECT_EQ(judgement.spurious, 0U);
  // Springs push with 1 N when pressed all the way.
  const double push = 1.0 - lost.distance / scene_.bodies.cutoff;
  EXPECT_NEAR(judgement.force.value(), push / glm::length(truth_.wrench.force), 1e-9);
}

TEST_F(JudgedStars, WhatIsNoneAndWhatIsThereTwiceIsSpurious) {
  ContactAnswer answer = answerOf("exact cold");
  answer.minima.push_back(answer.minima.front());
  Lmd none = answer.minima.front();
  none.partPoint += glm::dvec3(0.01, 0.0, 0.0);
  answer.minima.push_back(none);
  const Judgement judgement = judged(answer);
  EXPECT_EQ(judgement.missed, 0U);
  EXPECT_EQ(judgement.spurious, 2U);
  EXPECT_GT(judgement.force.value(), 0.01);
}

TEST_F(JudgedStars, NoAnswerMissesAllAndLosesAllOfTheForce) {
  const Judgement judgement = judged({});
  EXPECT_EQ(judgement.missed, truth_.minima.size());
  EXPECT_NEAR(judgement.force.value(), 1.0, 1e-12);
  EXPECT_NEAR(judgement.torque.value(), 1.0, 1e-12);
}

TEST(JudgedPoses, AFaceTiltedWithinTheFlatToleranceHasNoMinimumOfItsOwn) {
  const ErrorScene scene(test::boxMesh({1.0, 1.0, 1.0}), test::boxMesh({0.5, 0.5, 0.5}), 0.4);
  const test::ExactOracle oracle(scene.bodies.meshes.scene, scene.bodies.meshes.part);
  // One corner is nearest, by far more than double precision resolves.
  const glm::dvec3 axis = glm::normalize(glm::dvec3(2.0, 1.0, 0.0));
  for (const double tilt : {3e-7, 3e-4}) {
    const RigidTransform pose{glm::angleAxis(tilt, axis), {0.1, 0.05, 0.85}};
    const JudgedPose truth = judgedPose(oracle, scene, pose);
    const bool isPoint = tilt > 1e-6;
    EXPECT_EQ(truth.minima.size(), isPoint ? 1U : 0U) << tilt;
    EXPECT_EQ(truth.isWrenchKnown(), isPoint) << tilt;
    ContactAnswer answer;
    chosen(allErrorMethods(), {"exact cold"}, "test").front().make(scene)->answer(pose, answer);
    ASSERT_EQ(answer.minima.size(), 1U) << tilt;
    EXPECT_EQ(answer.minima.front().isRegion, !isPoint) << tilt;
    const Judgement judgement = judge(answer, truth, oracle.size());
    EXPECT_EQ(judgement.missed, 0U) << tilt;
    EXPECT_EQ(judgement.spurious, 0U) << tilt;
  }
}

TEST(JudgeFigures, SayThatTheStrictReadingMissesNoneOfClosedMeshesAndAddsSome) {
  const ErrorScene scene(test::starMesh(1, 0.5, 1, 0.3), test::starMesh(2, 0.5, 1, 0.3), 0.4);
  const std::vector<ErrorMethodEntry> methods =
      chosen(allErrorMethods(), {"exact cold", "paper spans"}, "test");
  std::mt19937_64 random(5);
  std::vector<RigidTransform> poses;
  for (int i = 0; i < 20; ++i)
    poses.push_back(
        {test::randomRotation(random).rotation, (1.15 + 0.2 * uniform(random)) * randomDirection(random)});
  double missed = -1.0, none = -1.0, exactWrong = -1.0;
  for (const PaperFigure& f : judgeFigures({"judge", "stars", ""}, scene, methods, poses)) {
    if (f.method == "exact cold" && f.quantity == "poses with another set [share]") exactWrong = f.max;
    if (f.method == "paper spans" && f.quantity == "minima missed") missed = f.max;
    if (f.method == "paper spans" && f.quantity == "minima that are none") none = f.max;
  }
  EXPECT_EQ(exactWrong, 0.0);
  EXPECT_EQ(missed, 0.0);
  EXPECT_GE(none, 1.0);
}

}  // namespace
}  // namespace nearfit::bench::paper_judge_test

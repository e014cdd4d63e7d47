#include "core/path/path_certifier.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/exact/exact_meeting.h"
#include "tests/exact/pose_certifier.h"
#include "tests/support/path_scenes.h"
#include "tests/support/random_values.h"
#include "tests/support/refusal_of.h"

namespace nearfit::path_certifier_test {
namespace {

using testing::HasSubstr;

PathProof prove(const test::PathScene& made, double separation) {
  return PathCertifier(made.scene, made.path, separation).prove(made.path);
}

/// Checks that the stretches of each pair follow each other over the whole path.
void expectCovered(const PathProof& proof, const AssemblyPath& path) {
  for (const PairProof& pair : proof.pairs) {
    double from = 0.0;
    for (const ProvenStretch& stretch : pair.stretches) {
      EXPECT_EQ(stretch.from, from);
      EXPECT_LE(stretch.from, stretch.anchor);
      EXPECT_LE(stretch.anchor, stretch.to);
      EXPECT_GE(stretch.bound, proof.separation);
      from = stretch.to;
    }
    EXPECT_EQ(from, path.end());
  }
}

/// Checks by exact predicates, at random places on the path, that the parts do not meet, and that a gap of the
/// separation is between them.
void expectFreeAtRandomPlaces(const test::PathScene& made, const char* part, const char* other,
                              double separation, int count) {
  const Part &mine = made.part(part), &its = made.part(other);
  const test::PoseCertifier oracle(its.geometry->mesh, mine.geometry->mesh);
  test::RandomValues random(11);
  for (int i = 0; i < count; ++i) {
    const double place = random.in(0.0, made.path.end());
    const RigidTransform pose = its.worldFromPart.inverse() * poseAt(made.path, place);
    ASSERT_FALSE(oracle.doMeet(pose)) << "at place " << place;
    ASSERT_GE(oracle.surfacesApart(pose, separation), (1.0 - 1e-9) * separation) << "at place " << place;
  }
}

/// A rough body that goes round another in many steps, turning as it goes. Both are within 0.65 m of their middles.
test::PathScene rockRoundRock(unsigned seed, double orbit) {
  constexpr int kSteps = 24;
  test::RandomValues random(seed);
  test::PathScene made;
  made.scene.add(test::partOf(test::geometryOf(test::starMesh(seed, 0.5, 2, 0.3)), "Still",
                              {random.pose().rotation, glm::dvec3(0.0)}));
  made.scene.add(
      test::partOf(test::geometryOf(test::starMesh(seed + 1, 0.5, 2, 0.3)), "Rock", test::at(9, 9, 9)));
  std::vector<RigidTransform> poses;
  RigidTransform pose{random.pose().rotation, glm::dvec3(0.0)};
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSteps;
    pose.translation = {orbit * std::cos(angle), orbit * std::sin(angle), 0.0};
    pose = pose.normalized();
    poses.push_back(pose);
    pose.rotation = pose.rotation * rotationOf(random.vector(0.5));
  }
  made.path = test::pathThrough("Rock", poses);
  return made;
}

TEST(PathCertifier, ACubeThatPassesByAKnownGapKeepsLessThanThat) {
  const test::PathScene made = test::cubePastCube(0.01);
  const PathProof proof = prove(made, 0.009);
  ASSERT_TRUE(proof.isFree());
  ASSERT_EQ(proof.pairs.size(), 1U);
  expectCovered(proof, made.path);
  for (const ProvenStretch& stretch : proof.pairs[0].stretches)
    EXPECT_LE(stretch.bound, test::cubeDistance(0.01, stretch.anchor))
        << "no bound claims more than the distance";
  expectFreeAtRandomPlaces(made, "Cube", "Post", 0.009, 200);
}

TEST(PathCertifier, APathThatGrazesByLessThanTheSeparationIsRefusedWhereItFirstDoes) {
  const double gap = 0.01, separation = 0.0101;
  const PathProof proof = prove(test::cubePastCube(gap), separation);
  ASSERT_FALSE(proof.isFree());
  EXPECT_TRUE(proof.pairs.empty());
  const UnprovenPlace& place = *proof.unproven;
  EXPECT_FALSE(place.isInside);
  EXPECT_EQ(place.time, place.place) << "a pose each second";
  EXPECT_NEAR(place.distance, test::cubeDistance(gap, place.time), 1e-9);
  EXPECT_LE(place.distance, separation * 17.0 / 16.0);
  EXPECT_LT(place.time, 0.5);
  EXPECT_GE(place.distance, separation * 15.0 / 16.0) << "before it is nearer";
}

TEST(PathCertifier, ABodyThinnerThanTheStepIsFound) {
  const double thickness = 1e-4, separation = 1e-3;
  test::PathScene made;
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({thickness, 2, 2})), "Plate"));
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({0.2, 0.2, 0.2})), "Cube", test::at(-1, 0, 0)));
  made.path = test::pathThrough("Cube", {test::at(-1, 0, 0), test::at(1, 0, 0)});
  const PathProof proof = prove(made, separation);
  ASSERT_FALSE(proof.isFree());
  const double distance = -(-1.0 + 2.0 * proof.unproven->time) - 0.1 - 0.5 * thickness;
  EXPECT_NEAR(proof.unproven->distance, distance, 1e-9);
  EXPECT_LE(distance, separation * 17.0 / 16.0);
  EXPECT_GE(distance, separation * 15.0 / 16.0);
  EXPECT_EQ(proof.unproven->other, made.part("Plate").id);
}

TEST(PathCertifier, ABarThatTurnsInARingKeepsTheLeastGapOfItsPolygon) {
  const double radius = 0.95, gap = test::leastRingGap(radius);
  const test::PathScene made = test::barInRing(radius);
  const PathProof proof = prove(made, 0.93 * gap);
  ASSERT_TRUE(proof.isFree()) << proof.unproven->time << " " << proof.unproven->distance;
  expectCovered(proof, made.path);
  expectFreeAtRandomPlaces(made, "Bar", "Ring", 0.93 * gap, 200);
  EXPECT_FALSE(prove(made, 1.01 * (1.0 - radius)).isFree()) << "the gap is nowhere as wide";
}

TEST(PathCertifier, ABarThatIsFreeAtEachPoseButNotBetweenThemIsRefused) {
  test::PathScene made = test::barInRing(0.8);
  // A stop that a bar at right angles does not reach.
  made.scene.add(
      test::partOf(test::geometryOf(test::boxMesh({0.1, 0.1, 0.1})), "Stop", test::at(0.5, 0.5, 0.0)));
  const PathProof proof = prove(made, 1e-3);
  ASSERT_FALSE(proof.isFree());
  EXPECT_EQ(proof.unproven->other, made.part("Stop").id);
  EXPECT_GT(proof.unproven->time, 0.0);
  EXPECT_LT(proof.unproven->time, 0.5);
}

TEST(PathCertifier, APegThatIsScrewedDownABoreKeepsItsGap) {
  const double radius = 0.95, gap = test::leastRingGap(radius);
  const test::PathScene made = test::pegScrewedIn(radius);
  const PathProof proof = prove(made, 0.93 * gap);
  ASSERT_TRUE(proof.isFree());
  expectCovered(proof, made.path);
  expectFreeAtRandomPlaces(made, "Peg", "Bore", 0.93 * gap, 200);
  EXPECT_FALSE(prove(made, 1.01 * (1.0 - radius)).isFree());
}

TEST(PathCertifier, ABodyInsideAnotherIsRefusedThoughTheirSurfacesAreApart) {
  test::PathScene made;
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({4, 4, 4})), "Block"));
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Cube"));
  made.path = test::pathThrough("Cube", {test::at(0, 0, 0), test::at(0.5, 0, 0)});
  const PathProof proof = prove(made, 1e-3);
  ASSERT_FALSE(proof.isFree());
  EXPECT_TRUE(proof.unproven->isInside);
  EXPECT_EQ(proof.unproven->place, 0.0);
}

TEST(PathCertifier, ABodyInACavityIsFree) {
  test::PathScene made;
  const TriangleMesh shell = test::joined(test::boxMesh({4, 4, 4}), test::turned(test::boxMesh({3, 3, 3})));
  made.scene.add(test::partOf(test::geometryOf(shell), "Shell"));
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Cube"));
  made.path = test::pathThrough("Cube", {test::at(0, 0, 0), test::at(0.5, 0, 0)});
  EXPECT_TRUE(prove(made, 0.4).isFree());
}

TEST(PathCertifier, ThePartIsOnTheWayWhereverTheSceneHasIt) {
  test::PathScene made = test::cubePastCube(0.01);
  Part post = made.part("Post");
  post.worldFromPart = {rotationOf({0.3, -0.2, 1.0}), {5.0, -2.0, 1.0}};
  const RigidTransform moved = post.worldFromPart;
  made.scene.replace(post);
  for (PathPose& pose : made.path.poses)
    pose.worldFromLead = (moved * pose.worldFromLead).normalized();
  EXPECT_TRUE(prove(made, 0.009).isFree());
  EXPECT_FALSE(prove(made, 0.0101).isFree());
}

TEST(PathCertifier, AllPartsOfAGroupMoveAndHiddenOthersAreNotInTheWay) {
  test::PathScene made = test::cubePastCube(2.0);
  // A second cube, one gap nearer to the post.
  made.scene.add(
      test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Second", test::at(-3.0, 1.0 + 0.01, 0.0)));
  made.path.parts = {"Cube", "Second"};
  EXPECT_TRUE(prove(made, 0.009).isFree());
  const PathProof proof = prove(made, 0.0101);
  ASSERT_FALSE(proof.isFree());
  EXPECT_EQ(proof.unproven->part, made.part("Second").id);
  Part post = made.part("Post");
  post.isVisible = false;
  made.scene.replace(post);
  EXPECT_TRUE(prove(made, 0.0101).isFree());
}

TEST(PathCertifier, WhatIsFarIsProvenByOneStretch) {
  test::PathScene made = test::cubePastCube(100.0);
  const PathProof proof = prove(made, 0.01);
  ASSERT_TRUE(proof.isFree());
  ASSERT_EQ(proof.pairs.size(), 1U);
  EXPECT_EQ(proof.pairs[0].stretches.size(), 1U);
}

TEST(PathCertifier, APartThatRestsIsProvenToo) {
  test::PathScene made = test::cubePastCube(0.01);
  made.path = test::pathThrough("Cube", {test::at(0, 1.01, 0), test::at(0, 1.01, 0), test::at(0, 1.01, 0)});
  EXPECT_TRUE(prove(made, 0.009).isFree());
  const PathProof refused = prove(made, 0.0101);
  ASSERT_FALSE(refused.isFree());
  EXPECT_EQ(refused.unproven->place, 0.0);
}

TEST(PathCertifier, RoughBodiesKeepWhatIsProvenAtRandomPlaces) {
  // Chords of the orbit come no nearer than 1.308 m, and the bodies no farther than 1.3 m.
  for (const unsigned seed : {1U, 20U, 300U}) {
    const test::PathScene made = rockRoundRock(seed, 1.32);
    const PathProof proof = prove(made, 0.005);
    ASSERT_TRUE(proof.isFree());
    expectCovered(proof, made.path);
    expectFreeAtRandomPlaces(made, "Rock", "Still", 0.005, 200);
  }
}

TEST(PathCertifier, WhereRoughBodiesComeTooNearTheExactDistanceSaysSo) {
  for (const unsigned seed : {1U, 20U, 300U}) {
    const test::PathScene made = rockRoundRock(seed, 1.1);
    const PathProof proof = prove(made, 0.4);
    ASSERT_FALSE(proof.isFree()) << "both reach at least 0.34 m from their middles all round";
    if (proof.unproven->isInside) continue;
    const Part& still = made.part("Still");
    const RigidTransform pose = still.worldFromPart.inverse() * poseAt(made.path, proof.unproven->place);
    const double exact =
        test::leastDistanceExactly(still.geometry->mesh, made.part("Rock").geometry->mesh, pose.normalized());
    EXPECT_NEAR(proof.unproven->distance, exact, 1e-9);
    EXPECT_LE(exact, 0.4 * 17.0 / 16.0);
  }
}

TEST(PathCertifier, ProvesTheSameEachTime) {
  const test::PathScene made = rockRoundRock(5, 1.32);
  const PathProof a = prove(made, 0.004), b = prove(made, 0.004);
  ASSERT_EQ(a.pairs.size(), b.pairs.size());
  ASSERT_EQ(a.pairs[0].stretches.size(), b.pairs[0].stretches.size());
  for (std::size_t i = 0; i < a.pairs[0].stretches.size(); ++i) {
    EXPECT_EQ(a.pairs[0].stretches[i].to, b.pairs[0].stretches[i].to);
    EXPECT_EQ(a.pairs[0].stretches[i].anchor, b.pairs[0].stretches[i].anchor);
    EXPECT_EQ(a.pairs[0].stretches[i].bound, b.pairs[0].stretches[i].bound);
  }
}

TEST(PathCertifier, SegmentsAreFreeOrNotEachByItself) {
  const test::PathScene made = test::cubePastCube(0.01);
  const PathCertifier certifier(made.scene, made.path, 0.009);
  const std::vector<PathSegment> segments{{test::at(-3, 1.01, 0), test::at(3, 1.01, 0)},
                                          {test::at(-3, 0.5, 0), test::at(3, 0.5, 0)},
                                          {test::at(-3, 0, 0), test::at(-2, 0, 0)}};
  EXPECT_THAT(certifier.freeSegments(segments), testing::ElementsAre(1, 0, 1));
}

TEST(PathCertifier, WhatCannotBeCertifiedIsRefusedWithAReason) {
  const test::PathScene made = test::cubePastCube(0.01);
  const auto refused = [&](const char* part, double separation) {
    AssemblyPath path = made.path;
    path.parts = {part};
    return test::refusalOf([&] { PathCertifier(made.scene, path, separation); });
  };
  EXPECT_THAT(refused("Peg", 0.01), HasSubstr("no part \"Peg\""));
  for (const double separation : {0.0, -1.0, 1e-12, std::nan(""), static_cast<double>(INFINITY)})
    EXPECT_THAT(refused("Cube", separation), HasSubstr("separation"));
}

TEST(PathCertifier, StopsWhenAsked) {
  const test::PathScene made = test::cubePastCube(0.01);
  const PathCertifier certifier(made.scene, made.path, 0.009);
  EXPECT_THROW(certifier.prove(made.path, [](double) { return false; }), Cancelled);
}

TEST(PathCertifier, DefaultSeparationIsAMillionthOfThePartAtMostAMicrometre) {
  test::PathScene made = test::cubePastCube(0.01);
  EXPECT_EQ(defaultSeparation(made.scene, made.path), 1e-6);
  Part cube = made.part("Cube");
  cube.geometry = test::geometryOf(test::boxMesh({0.01, 0.01, 0.01}));
  made.scene.replace(cube);
  EXPECT_NEAR(defaultSeparation(made.scene, made.path), 1e-6 * 0.01 * std::sqrt(3.0), 1e-14);
}

TEST(PathCertifier, ASegmentThatTakesTooManyDistancesIsNotProven) {
  // Past a gap of 0.1 m for a way of 2 m on which both sides overlap: some ten distances.
  const test::PathScene made = test::cubePastCube(0.1);
  const PathCertifier certifier(made.scene, made.path, 1e-3);
  const PathSegment segment{made.path.poses[0].worldFromLead, made.path.poses[1].worldFromLead};
  EXPECT_EQ(certifier.freeSegments(std::span(&segment, 1)).front(), 1);
  EXPECT_EQ(certifier.freeSegments(std::span(&segment, 1), {}, 1000).front(), 1);
  EXPECT_EQ(certifier.freeSegments(std::span(&segment, 1), {}, 3).front(), 0);
}

}  // namespace
}  // namespace nearfit::path_certifier_test

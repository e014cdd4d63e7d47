#include "core/path/assembly_path.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/path_scenes.h"
#include "tests/support/random_values.h"
#include "tests/support/refusal_of.h"

namespace nearfit::assembly_path_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

double distanceOf(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::length(a - b);
}

AssemblyPath threePoses() {
  return test::pathThrough("Peg", {test::at(0, 0, 0), test::at(1, 0, 0), test::at(1, 2, 0)});
}

TEST(AssemblyPath, CentreGoesStraightWhileThePartTurnsAboutItEvenly) {
  // A quarter turn about z; the centre is off the part's origin.
  const glm::dvec3 centre(1.0, 0.0, 0.0);
  const RigidTransform from = test::at(0, 0, 0);
  const RigidTransform to{rotationOf({0, 0, std::numbers::pi / 2}), {3.0, 1.0, 2.0}};
  for (const double share : {0.0, 0.25, 0.5, 0.9, 1.0}) {
    const RigidTransform pose = poseBetween(from, to, centre, share);
    const glm::dvec3 wanted = glm::dvec3(1, 0, 0) + share * (glm::dvec3(3, 2, 2) - glm::dvec3(1, 0, 0));
    EXPECT_LT(distanceOf(pose.applyToPoint(centre), wanted), 1e-14);
    const double angle = share * std::numbers::pi / 2;
    EXPECT_LT(distanceOf(pose.applyToVector({1, 0, 0}), {std::cos(angle), std::sin(angle), 0}), 1e-14);
  }
}

TEST(AssemblyPath, TurnsTheShorterWayWhateverTheSenseOfTheQuaternions) {
  RigidTransform to{rotationOf({0, 0, 1.0}), {0, 0, 0}};
  to.rotation = -to.rotation;
  const RigidTransform pose = poseBetween(test::at(0, 0, 0), to, glm::dvec3(0.0), 0.5);
  EXPECT_LT(distanceOf(pose.applyToVector({1, 0, 0}), {std::cos(0.5), std::sin(0.5), 0}), 1e-14);
}

TEST(AssemblyPath, PlacesAndTimesMatch) {
  AssemblyPath path = threePoses();
  path.poses[1].time = 4.0;
  path.poses[2].time = 6.0;
  EXPECT_EQ(placeAt(path, 1.0), 0.25);
  EXPECT_EQ(placeAt(path, 5.0), 1.5);
  EXPECT_EQ(timeAt(path, 1.5), 5.0);
  EXPECT_EQ(placeAt(path, -1.0), 0.0);
  EXPECT_EQ(placeAt(path, 60.0), 2.0);
  EXPECT_EQ(timeAt(path, 7.0), 6.0);
  EXPECT_EQ(poseAt(path, 1.5).translation, glm::dvec3(1, 1, 0));
}

TEST(AssemblyPath, DisplacementBoundHoldsForPointsOfTheBody) {
  test::RandomValues random(7);
  for (int i = 0; i < 200; ++i) {
    const RigidTransform a = random.pose(), b = random.pose();
    const glm::dvec3 centre = random.vector(1.0), arm = random.vector(0.5);
    const double moved = distanceOf(a.applyToPoint(centre + arm), b.applyToPoint(centre + arm));
    EXPECT_LE(moved, displacementBound(a, b, centre, glm::length(arm)) + 1e-14);
  }
}

TEST(AssemblyPath, TrimmingInterpolatesTheEndsAndKeepsTimes) {
  const AssemblyPath path = trimmed(threePoses(), 0.25, 1.5);
  ASSERT_EQ(path.poses.size(), 3U);
  EXPECT_EQ(path.poses[0].time, 0.25);
  EXPECT_EQ(path.poses[0].worldFromLead.translation, glm::dvec3(0.25, 0, 0));
  EXPECT_EQ(path.poses[1].worldFromLead.translation, glm::dvec3(1, 0, 0));
  EXPECT_EQ(path.poses[2].time, 1.5);
  EXPECT_EQ(path.poses[2].worldFromLead.translation, glm::dvec3(1, 1, 0));
}

TEST(AssemblyPath, TrimmingBeyondTheMotionLeavesItWhole) {
  EXPECT_TRUE(isSamePath(trimmed(threePoses(), -5.0, 50.0), threePoses()));
}

TEST(AssemblyPath, TrimmingToNothingIsRefused) {
  EXPECT_THAT(test::refusalOf([] { trimmed(threePoses(), 1.0, 1.0); }), HasSubstr("no motion"));
  EXPECT_THAT(test::refusalOf([] { trimmed(threePoses(), 5.0, 6.0); }),
              HasSubstr("choose times from 0 to 2"));
  EXPECT_THAT(test::refusalOf([] { trimmed(threePoses(), std::nan(""), 1.0); }), HasSubstr("no motion"));
}

TEST(AssemblyPath, ARecordedMotionBecomesThePathOfWhatIsInHand) {
  Scene scene = test::barInRing(0.5).scene;
  scene.setMovingPart(scene.findByName("Bar")->id);
  std::vector<MotionRow> rows(4);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].time = 0.5 * static_cast<double>(i);
    rows[i].proxy = test::at(0.0, 0.0, static_cast<double>(i));
    rows[i].handle = test::at(9.0, 9.0, 9.0);
  }
  rows[2].time = rows[1].time;
  const AssemblyPath path = pathOfMotion(rows, scene);
  EXPECT_THAT(path.parts, ElementsAre("Bar"));
  ASSERT_EQ(path.poses.size(), 3U) << "of two rows at one time the last counts";
  EXPECT_EQ(path.poses[1].worldFromLead.translation.z, 2.0);
  EXPECT_EQ(path.poses[2].time, 1.5);
  EXPECT_LT(glm::length(path.centre), 1e-15) << "the middle of the bar's box";
}

TEST(AssemblyPath, AMovingGroupNamesItsVisiblePartsTheLeadFirst) {
  Scene scene;
  const GroupId group = scene.addGroup({.id = {}, .name = "Gripper", .parent = {}, .isLocked = false});
  for (const char* name : {"A", "B", "C"}) {
    Part part = test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), name, test::at(name[0] - 'A', 0, 0));
    part.group = group;
    part.isVisible = name[0] != 'B';
    scene.add(part);
  }
  scene.setMovingGroup(group);
  std::vector<MotionRow> rows(2);
  rows[1].time = 1.0;
  rows[1].proxy = test::at(0, 0, 1);
  const AssemblyPath path = pathOfMotion(rows, scene);
  EXPECT_THAT(path.parts, ElementsAre("A", "C"));
  EXPECT_LT(distanceOf(path.centre, {1.0, 0.0, 0.0}), 1e-15);
}

TEST(AssemblyPath, PathsThatCannotBeFollowedAreRefused) {
  const auto refused = [](const auto& change) {
    AssemblyPath path = threePoses();
    change(path);
    return test::refusalOf([&] { checkPath(path, "path"); });
  };
  EXPECT_EQ(refused([](AssemblyPath&) {}), "");
  EXPECT_THAT(refused([](AssemblyPath& p) { p.poses.resize(1); }), HasSubstr("less than two poses"));
  EXPECT_THAT(refused([](AssemblyPath& p) { p.poses[1].time = 0.0; }), HasSubstr("no later"));
  EXPECT_THAT(refused([](AssemblyPath& p) { p.poses[1].time = std::nan(""); }),
              HasSubstr("not a valid time"));
  EXPECT_THAT(refused([](AssemblyPath& p) { p.poses[1].worldFromLead.translation.x = INFINITY; }),
              HasSubstr("pose 1"));
  EXPECT_THAT(refused([](AssemblyPath& p) { p.poses[1].worldFromLead.rotation.w = 1.0 + 1e-9; }),
              HasSubstr("not of unit length"));
  EXPECT_THAT(refused([](AssemblyPath& p) { p.poses[1].worldFromLead.rotation = rotationOf({3.0, 0, 0}); }),
              HasSubstr("170 degrees"));
  EXPECT_THAT(refused([](AssemblyPath& p) { p.parts.clear(); }), HasSubstr("names no part"));
  EXPECT_THAT(refused([](AssemblyPath& p) { p.parts = {"A", "A"}; }), HasSubstr("twice"));
  EXPECT_THAT(refused([](AssemblyPath& p) { p.centre.y = std::nan(""); }), HasSubstr("centre"));
}

TEST(AssemblyPath, TheWayOfAPointFollowsItsArc) {
  // Half a turn about z in two steps, and a pose where nothing moves.
  AssemblyPath path;
  path.parts = {"Bar"};
  for (const double angle : {0.0, 0.5, 1.0, 1.0})
    path.poses.push_back({static_cast<double>(path.poses.size()),
                          {rotationOf({0.0, 0.0, angle * std::numbers::pi}), glm::dvec3(0.0)}});
  const std::vector<GuidancePose> way = wayOf(path, {2.0, 0.0, 0.0});
  ASSERT_GT(way.size(), 60U);
  EXPECT_NEAR(glm::distance(way.back().place, glm::dvec3(-2.0, 0.0, 0.0)), 0.0, 1e-12);
  for (std::size_t i = 0; i < way.size(); ++i) {
    EXPECT_NEAR(glm::length(way[i].place), 2.0, 1e-12);
    if (i == 0) continue;
    EXPECT_GT(glm::distance(way[i - 1].place, way[i].place), 0.0);
    // No farther from the arc than a 3000th of its radius.
    EXPECT_GT(glm::length(0.5 * (way[i - 1].place + way[i].place)), 2.0 * (1.0 - 1.0 / 3000.0));
  }
  // The centre stays, and turns: its way is of rotations alone.
  const std::vector<GuidancePose> turned = wayOf(path, {0.0, 0.0, 0.0});
  ASSERT_EQ(turned.size(), way.size());
  for (const GuidancePose& pose : turned)
    EXPECT_EQ(pose.place, glm::dvec3(0.0));
  EXPECT_NEAR(std::abs(turned.back().rotation.z), 1.0, 1e-12);
}

}  // namespace
}  // namespace nearfit::assembly_path_test

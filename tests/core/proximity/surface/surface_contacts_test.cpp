#include "core/proximity/surface/surface_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/query/motion_budget.h"
#include "tests/exact/exact_meeting.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/trial_share.h"
#include "tests/support/triangle_tests.h"

namespace nearfit::surface_contacts_test {
namespace {

using test::BodyPair;

constexpr std::uint64_t kAnyWork = std::numeric_limits<std::uint64_t>::max();

UnsidedSurface surfaceOf(const TriangleMesh& mesh) {
  return UnsidedSurface(NormalConeTree(mesh));
}

/// Listed at a pose and tested there; the bound holds for either.
SurfaceContacts findContacts(const UnsidedSurface& scene, const UnsidedSurface& part,
                             const RigidTransform& pose, double within, std::span<SurfaceContact> out,
                             std::uint64_t work = kAnyWork) {
  static LmdScratch scratch;
  static std::vector<TrianglePair> pairs(1U << 20);
  const NearbyTriangles nearby = findNearbyTriangles(scene, part, pose, within, scratch, pairs, work);
  return test::testTriangles(scene, part, pose, within,
                             {std::span(pairs).first(nearby.count), nearby.within, 0.0, 0.0}, out);
}

std::vector<SurfaceContact> contactsAt(const UnsidedSurface& scene, const UnsidedSurface& part,
                                       const RigidTransform& pose, double within) {
  std::vector<SurfaceContact> contacts(4096);
  const SurfaceContacts found = findContacts(scene, part, pose, within, contacts);
  EXPECT_EQ(found.completeTo, within);
  contacts.resize(found.count);
  EXPECT_TRUE(std::ranges::is_sorted(contacts, {}, &SurfaceContact::distance));
  for (const SurfaceContact& c : contacts) {
    EXPECT_LE(c.distance, within);
    EXPECT_LE(found.lowerBound, c.distance);
    EXPECT_LT(glm::distance(c.scenePoint + c.distance * c.direction, c.partPoint),
              1e-12 * (1.0 + glm::length(c.partPoint)));
  }
  return contacts;
}

/// Turned about y, then moved.
RigidTransform tilted(double angle, const glm::dvec3& translation) {
  return {glm::angleAxis(angle, glm::dvec3(0, 1, 0)), translation};
}

TEST(SurfaceContacts, FlatPartOverATessellatedSheetHasAContactAtEachCornerStraightAcross) {
  const UnsidedSurface sheet = surfaceOf(test::squareMesh(1.0, 50)),
                       part = surfaceOf(test::boxMesh({0.313, 0.217, 0.1}));
  for (const double side : {-1.0, 1.0}) {
    // A hundred squares of the sheet are within reach of each corner.
    const auto contacts = contactsAt(sheet, part, tilted(0.0, {0.011, 0.003, side * 0.09}), 0.08);
    ASSERT_EQ(contacts.size(), 4U);
    for (const SurfaceContact& c : contacts) {
      EXPECT_NEAR(c.direction.z, side, 1e-12);
      EXPECT_NEAR(c.distance, 0.04, 1e-12);
      EXPECT_NEAR(std::abs(c.partPoint.x - 0.011), 0.1565, 1e-12);
      EXPECT_NEAR(std::abs(c.partPoint.y - 0.003), 0.1085, 1e-12);
    }
  }
}

TEST(SurfaceContacts, PartTiltedALittleKeepsItsFartherCorners) {
  const UnsidedSurface sheet = surfaceOf(test::squareMesh(1.0, 7)),
                       part = surfaceOf(test::boxMesh({0.4, 0.3, 0.1}));
  const auto contacts = contactsAt(sheet, part, tilted(0.02, {0, 0, 0.09}), 0.08);
  ASSERT_EQ(contacts.size(), 4U);
  // By hand: corners at +-0.2 along x, 0.05 below the middle.
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = i < 2 ? 0.2 : -0.2;
    EXPECT_NEAR(contacts[i].distance, 0.09 - 0.05 * std::cos(0.02) - x * std::sin(0.02), 1e-12);
    EXPECT_NEAR(contacts[i].direction.z, 1.0, 1e-12);
  }
  // Tilted more than that, the farther corners are none.
  EXPECT_EQ(contactsAt(sheet, part, tilted(0.1, {0, 0, 0.09}), 0.08).size(), 2U);
}

TEST(SurfaceContacts, OpenEdgesTouchEachOtherFromAnySide) {
  const TriangleMesh strip({{-1, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}});
  const TriangleMesh across({{0, -1, 0}, {0, 1, 0}, {0, 0, -1}}, {{0, 1, 2}});
  for (const TriangleMesh& a : {strip, test::turned(strip)}) {
    const auto contacts = contactsAt(surfaceOf(a), surfaceOf(across), tilted(0.0, {0.2, 0.1, -0.25}), 0.5);
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].distance, 0.25, 1e-15);
    EXPECT_NEAR(contacts[0].direction.z, -1.0, 1e-15);
    EXPECT_LT(glm::distance(contacts[0].partPoint, {0.2, 0.0, -0.25}), 1e-15);
  }
}

/// All isolated minima must be contacts; the nearest contact must be as near as the surfaces are.
void compare(const BodyPair& pair, std::size_t poses, double within, bool areClosed, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const UnsidedSurface scene = surfaceOf(pair.scene), part = surfaceOf(pair.part);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < poses / test::kTrialShare; ++i) {
    const RigidTransform pose = test::poseNearContact(pair, within, random);
    const std::vector<SurfaceContact> contacts = contactsAt(scene, part, pose, within);
    const double least = test::leastDistanceExactly(pair.scene, pair.part, pose);
    if (least > 0.0 && least < within) {
      ASSERT_FALSE(contacts.empty()) << pair.name;
      EXPECT_NEAR(contacts[0].distance, least, 1e-12) << pair.name;
      ++compared;
    }
    if (!areClosed) continue;
    for (const Lmd& lmd : test::allLmds(scene.tree(), part.tree(), pose, within)) {
      if (lmd.isRegion) continue;
      EXPECT_TRUE(std::ranges::any_of(contacts,
                                      [&](const SurfaceContact& c) {
                                        return glm::distance(c.partPoint, lmd.partPoint) < 1e-7 &&
                                               glm::distance(c.scenePoint, lmd.scenePoint) < 1e-7;
                                      }))
          << pair.name << " " << lmd.distance;
      ++compared;
    }
  }
  // At the few poses of sanitized builds the bodies may all pass through each other.
  if (test::kTrialShare == 1) {
    EXPECT_GT(compared, poses / 8);
  }
}

TEST(SurfaceContacts, HoldTheNearestPointsAndAllMinima) {
  compare({"stars", test::starMesh(1, 1.0, 2, 0.4), test::starMesh(2, 0.3, 1, 0.4)}, 24, 0.2, true, 1);
  compare({"boxes", test::boxMesh({1, 2, 3}), test::boxMesh({0.5, 0.5, 0.5})}, 24, 0.2, true, 2);
  compare({"fans", test::jaggedFan(3, 40, 0.2), test::jaggedFan(4, 30, 0.4)}, 24, 0.4, false, 3);
  compare({"soup", test::looseTriangles(3, 60), test::looseTriangles(4, 3)}, 24, 0.2, false, 4);
  compare({"sheets", test::squareMesh(1.0, 6), test::coplanarFans(1, 4)}, 24, 0.4, false, 5);
}

TEST(SurfaceContacts, FullStorageKeepsTheNearest) {
  const BodyPair pair{"stars", test::starMesh(1, 1.0, 3, 0.3), test::starMesh(2, 1.0, 3, 0.3)};
  const UnsidedSurface scene = surfaceOf(pair.scene), part = surfaceOf(pair.part);
  const RigidTransform pose{{1, 0, 0, 0}, {1.9, 0.1, 0.2}};
  const std::vector<SurfaceContact> all = contactsAt(scene, part, pose, 0.5);
  ASSERT_GT(all.size(), 6U);
  std::array<SurfaceContact, 4> few;
  const SurfaceContacts found = findContacts(scene, part, pose, 0.5, few);
  EXPECT_EQ(found.count, few.size());
  EXPECT_EQ(found.completeTo, all[few.size() - 1].distance);
  for (std::size_t i = 0; i < few.size(); ++i)
    EXPECT_EQ(few[i].distance, all[i].distance);
  EXPECT_EQ(findContacts(scene, part, pose, 0.5, {}).count, 0U);
}

TEST(SurfaceContacts, LowerBoundHoldsWhateverTheWork) {
  const BodyPair pair{"stars", test::starMesh(1, 1.0, 2, 0.3), test::starMesh(2, 1.0, 2, 0.3)};
  const UnsidedSurface scene = surfaceOf(pair.scene), part = surfaceOf(pair.part);
  std::array<SurfaceContact, 16> out;
  for (const double x : {1.5, 2.1, 2.5}) {
    const RigidTransform pose{{1, 0, 0, 0}, {x, 0, 0}};
    const double least = test::leastDistanceExactly(pair.scene, pair.part, pose);
    for (const std::uint64_t work : {0, 1, 5, 20, 100, 1000}) {
      const SurfaceContacts found = findContacts(scene, part, pose, 1.0, out, work);
      EXPECT_LE(found.lowerBound, least);
    }
  }
  const RigidTransform bad{{1, 0, 0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0, 0}};
  EXPECT_EQ(findContacts(scene, part, bad, 1.0, out).lowerBound, 0.0);
}

bool isAmong(const SurfaceContact& c, const std::vector<SurfaceContact>& all) {
  return std::ranges::any_of(all, [&](const SurfaceContact& other) {
    return glm::distance(c.partPoint, other.partPoint) < 1e-8 &&
           glm::distance(c.scenePoint, other.scenePoint) < 1e-8 &&
           std::abs(c.distance - other.distance) < 1e-12;
  });
}

/// No distance on a way may be less than the bound that the tests gave [m].
void checkWay(const BodyPair& pair, const RigidTransform& from, const RigidTransform& to, double leastOnWay) {
  const glm::dvec3 shift = to.translation - from.translation;
  const RigidTransform middle{glm::slerp(from.rotation, to.rotation, 0.5), from.translation + 0.5 * shift};
  EXPECT_LE(leastOnWay, test::leastDistanceExactly(pair.scene, pair.part, middle)) << pair.name;
}

/// Pairs held through random motions of up to `slack` must give what a search at each pose gives, however the work is
/// doled out and whatever tests were given up before.
void compareHeld(const BodyPair& pair, double within, double slack, std::uint64_t seed) {
  std::mt19937_64 random(seed), portions(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const UnsidedSurface scene = surfaceOf(pair.scene), part = surfaceOf(pair.part);
  const double radius = 0.5 * part.tree().size() + glm::length(part.tree().centre());
  LmdScratch scratch;
  std::vector<TrianglePair> pairs(1U << 18);
  std::size_t compared = 0, provedWays = 0;
  for (std::size_t i = 0; i < std::max<std::size_t>(4, 8 / test::kTrialShare); ++i) {
    const RigidTransform start = test::poseNearContact(pair, within, random);
    const NearbyTriangles nearby =
        findNearbyTriangles(scene, part, start, within + slack, scratch, pairs, kAnyWork);
    ASSERT_EQ(nearby.within, within + slack);
    // Along a way of leaps and small steps, so that what is kept of a pair from pose to pose is old.
    RigidTransform before = start;
    glm::dvec3 axis(0.0);
    double share = 0.0;
    for (int k = 0; k < 8; ++k) {
      if (k % 3 == 0) {
        axis = test::randomRotation(random).rotation * glm::dvec3(1, 0, 0);
        share = unit(random);
      } else {
        share *= 0.9;
      }
      const RigidTransform pose{
          glm::normalize(glm::angleAxis(0.45 * share * slack / radius, axis) * start.rotation),
          start.translation + 0.5 * share * slack * axis};
      const double travel = motionBetween(start, pose, radius).travel;
      ASSERT_LE(travel, slack);
      std::vector<SurfaceContact> held(4096);
      const TriangleTests::Asked asked{
          .scene = &scene,
          .part = &part,
          .sceneFromPart = pose,
          .within = within,
          .held = {std::span(pairs).first(nearby.count), nearby.within, travel,
                   motionBetween(before, pose, radius).travel},
          .way = PartWay{before, pose, motionBetween(before, pose, radius).travel,
                         bendOf(motionBetween(before, pose, radius).turn, radius)},
          .enough = 0.5 * within};
      TriangleTests tests;
      tests.begin(asked, held);
      if (k % 4 == 1) {
        std::uint64_t little = 1 + portions() % 50;
        if (!tests.goOn(little)) {
          tests.settle();
          before = pose;
          continue;
        }
        tests.begin(asked, held);
      }
      for (std::uint64_t work = 0; !tests.goOn(work);)
        work = 1 + portions() % 40;
      const SurfaceContacts found = tests.result();
      // The exact distance takes long.
      if (k % 4 == 3) checkWay(pair, before, pose, found.leastOnWay);
      provedWays += found.leastOnWay > 0.0 ? 1 : 0;
      before = pose;
      held.resize(found.count);
      EXPECT_EQ(found.completeTo, within);
      const std::vector<SurfaceContact> cold = contactsAt(scene, part, pose, within);
      for (const SurfaceContact& c : held)
        EXPECT_TRUE(isAmong(c, cold)) << pair.name << " " << c.distance;
      for (const SurfaceContact& c : cold)
        EXPECT_TRUE(isAmong(c, held)) << pair.name << " " << c.distance;
      compared += cold.size();
      if (k > 0) continue;
      const double least = test::leastDistanceExactly(pair.scene, pair.part, pose);
      EXPECT_NEAR(found.lowerBound, std::min(least, within), 1e-10) << pair.name;
      EXPECT_LE(found.lowerBound, least) << pair.name;
    }
  }
  EXPECT_GT(compared, 0U) << pair.name;
  EXPECT_GT(provedWays, 0U) << pair.name;
}

TEST(SurfaceContacts, HeldPairsGiveTheContactsOfEveryPoseThatTheyAreHeldFor) {
  compareHeld({"stars", test::starMesh(1, 1.0, 2, 0.4), test::starMesh(2, 0.3, 2, 0.4)}, 0.1, 0.05, 11);
  compareHeld({"boxes", test::boxMesh({1, 2, 3}), test::boxMesh({0.5, 0.5, 0.5})}, 0.1, 0.3, 12);
  compareHeld({"fans", test::jaggedFan(3, 40, 0.2), test::jaggedFan(4, 30, 0.4)}, 0.2, 0.1, 13);
  compareHeld({"soup", test::looseTriangles(3, 60), test::looseTriangles(4, 3)}, 0.2, 0.2, 14);
  compareHeld({"sheets", test::squareMesh(1.0, 6), test::coplanarFans(1, 4)}, 0.2, 0.1, 15);
}

TEST(SurfaceContacts, WorkIsBoundedWhereAllTrianglesOfTwoSheetsAreNear) {
  constexpr double kGap = 1e-3;
  const UnsidedSurface sheet = surfaceOf(test::squareMesh(1.0, 70));
  LmdScratch scratch;
  std::vector<TrianglePair> pairs(1U << 18);
  std::vector<SurfaceContact> out(512);
  const RigidTransform above{{1, 0, 0, 0}, {0.003, 0.002, kGap}};
  // What a traversal comes to before it looks at its bound, each pair as dear as it is to list.
  constexpr std::uint64_t kBatch = 80 * kWorkOfListing + 2;
  for (const std::uint64_t work : {0, 1, 100, 1000, 10000, 100000}) {
    const NearbyTriangles nearby = findNearbyTriangles(sheet, sheet, above, 2.6 * kGap, scratch, pairs, work);
    EXPECT_LE(nearby.work, work + kBatch);
    EXPECT_GE(nearby.work, kWorkOfListing * nearby.count);
    TriangleTests tests;
    tests.begin({.scene = &sheet,
                 .part = &sheet,
                 .sceneFromPart = above,
                 .within = 2.6 * kGap,
                 .held = {std::span(pairs).first(nearby.count), nearby.within, 0.0, 0.0}},
                out);
    // Nothing is known before the end, and no part of it is longer than its work.
    std::size_t parts = 0;
    for (std::uint64_t left = 0; !tests.goOn(left); ++parts)
      left = 100;
    EXPECT_GE(parts, nearby.count / kPassedOver / 100);
    const SurfaceContacts& found = tests.result();
    EXPECT_LE(found.lowerBound, kGap);
    EXPECT_LE(found.completeTo, std::max(kGap, nearby.within));
  }
  // Where there is no more room for pairs, what was left out is no nearer than is said.
  const NearbyTriangles few =
      findNearbyTriangles(sheet, sheet, above, 2.6 * kGap, scratch, std::span(pairs).first(100), kAnyWork);
  EXPECT_EQ(few.count, 100U);
  EXPECT_LE(few.within, kGap);
}

TEST(SurfaceContacts, FindingThemAllocatesNothing) {
  const UnsidedSurface scene = surfaceOf(test::starMesh(1, 1.0, 3, 0.3)),
                       part = surfaceOf(test::starMesh(2, 1.0, 3, 0.3));
  std::array<SurfaceContact, 64> out;
  findContacts(scene, part, {}, 0.2, out);  // Makes what it keeps.
  test::resetAllocationCount();
  test::startCountingAllocations();
  for (const double x : {0.5, 1.0, 1.8, 2.2})
    findContacts(scene, part, {{1, 0, 0, 0}, {x, 0, 0}}, 0.2, out);
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0U);
}

}  // namespace
}  // namespace nearfit::surface_contacts_test

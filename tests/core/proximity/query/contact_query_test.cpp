#include "core/proximity/query/contact_query.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <tuple>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/tracking/candidate_list.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/lmd_oracle.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::contact_query_test {
namespace {

using test::BodyPair;

constexpr double kReach = 0.1;
constexpr double kTurn = 0.03;
constexpr std::uint64_t kNoBound = std::numeric_limits<std::uint64_t>::max();

/// From a search anew; complete to nothing where that took too much work.
ContactResult findContacts(const BodyPairQuery& query, LmdScratch& scratch, std::span<ContactPair> out,
                           double turn = kTurn, std::uint64_t maxNodePairs = kNoBound) {
  static std::vector<LeafPair> pairs(1U << 18);
  static std::vector<EdgePairs> blocks(1U << 12);
  const ContactReach reach{kReach, turn};
  const NearbyPairs nearby = findNearbyPairs(query, reach, {}, scratch, pairs, maxNodePairs);
  const std::span<LeafPair> found = std::span(pairs).first(nearby.count);
  const std::size_t filled = std::min(edgePairsToFront(found) / EdgePairs::kLanes, blocks.size());
  for (std::size_t i = 0; i < filled; ++i)
    packEdgePairs(query.scene, query.part, found.subspan(i * EdgePairs::kLanes).first<EdgePairs::kLanes>(),
                  edgePairKernels(defaultSimdLevel()), blocks[i]);
  ContactResult result = testContacts(query, reach, found, out,
                                      {std::span(blocks).first(filled), edgePairKernels(defaultSimdLevel())});
  if (!nearby.isComplete) result.completeTo = 0.0;
  return result;
}

class Bodies {
 public:
  explicit Bodies(BodyPair p) : pair(std::move(p)), scene(pair.scene), part(pair.part) {}

  const BodyPair pair;
  const NormalConeTree scene, part;
  LmdScratch scratch;

  std::vector<ContactPair> contacts(const RigidTransform& pose, double turn = kTurn) {
    std::vector<ContactPair> out(8192);
    last = findContacts({scene, part, pose, kReach}, scratch, out, turn);
    out.resize(last.count);
    return out;
  }
  ContactResult last;
};

Bodies stars() {
  return Bodies({"stars", test::starMesh(21, 1.0, 3, 0.25), test::starMesh(22, 0.7, 3, 0.25)});
}

std::vector<ContactPair> sorted(std::vector<ContactPair> contacts) {
  const auto key = [](const ContactPair& c) {
    return std::tuple(c.distance, c.point.x, c.point.y, c.point.z, c.direction.x, c.direction.y);
  };
  std::sort(contacts.begin(), contacts.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  return contacts;
}

bool isPlaneBetween(const BodyPair& pair, const RigidTransform& pose, const glm::dvec3& normal) {
  double below = -std::numeric_limits<double>::infinity(), above = -below;
  for (const glm::dvec3& p : pair.scene.vertices())
    below = std::max(below, glm::dot(normal, p));
  for (const glm::dvec3& q : pair.part.vertices())
    above = std::min(above, glm::dot(normal, pose.applyToPoint(q)));
  return below < above;
}

TEST(ContactQuery, HoldsEveryMinimumThatBruteForceFinds) {
  Bodies bodies = stars();
  const test::OracleBody scene(bodies.pair.scene), part(bodies.pair.part);
  constexpr double kCertain = 1e-9;
  std::mt19937_64 random(5);
  std::size_t compared = 0;
  for (int i = 0; i < 60; ++i) {
    const RigidTransform pose = test::poseNearContact(bodies.pair, kReach, random);
    const std::vector<ContactPair> contacts = bodies.contacts(pose);
    for (const test::OracleMinimum& minimum : test::bruteForceMinima(scene, part, pose, kReach, 0.0)) {
      if (minimum.slack < kCertain) continue;
      ++compared;
      const bool isThere = std::any_of(contacts.begin(), contacts.end(), [&](const ContactPair& c) {
        return glm::distance(c.point, minimum.partPoint) < 1e-9 &&
               glm::distance(c.distance * c.direction, minimum.partPoint - minimum.scenePoint) < 1e-9;
      });
      EXPECT_TRUE(isThere) << "distance " << minimum.distance;
    }
  }
  EXPECT_GT(compared, 100U);
}

TEST(ContactQuery, LeastContactIsTheDistanceOfTheBodies) {
  // Flat on flat, edges along edges, and nothing in particular.
  std::vector<Bodies> all;
  all.push_back(stars());
  all.emplace_back(BodyPair{"boxes", test::boxMesh({1.0, 1.0, 1.0}), test::boxMesh({0.6, 0.4, 0.5})});
  all.emplace_back(
      BodyPair{"peg in bore", test::tubeMesh(0.5, 0.8, 1.0, 24), test::cylinderMesh(0.45, 2.0, 24)});
  const auto expectDistance = [](Bodies& bodies, const RigidTransform& pose, double distance) {
    bodies.contacts(pose);
    EXPECT_LE(bodies.last.distanceBound(), distance * (1.0 + 1e-9));
    EXPECT_GE(bodies.last.distanceBound(), distance * (1.0 - 2.0 * kTurn * kTurn));
  };
  // Face over face, square to it and turned: by hand.
  expectDistance(all[1], {{1, 0, 0, 0}, {0.1, 0.2, 0.8}}, 0.05);
  expectDistance(all[1], {glm::angleAxis(0.3, glm::dvec3(0, 0, 1)), {0.1, 0.2, 0.8}}, 0.05);
  // Edge along edge, off by the same in x and z.
  expectDistance(all[1], {{1, 0, 0, 0}, {0.83, 0.0, 0.78}}, std::hypot(0.03, 0.03));
  // A peg whose facets are parallel to the bore's: the gap of two regular polygons.
  expectDistance(all[2], {}, 0.05 * std::cos(std::acos(-1.0) / 24.0));
  // Two boxes anyhow: where a plane lies between them, the minimum square to it is their distance.
  std::mt19937_64 random(6);
  std::vector<Lmd> lmds(64);
  std::size_t compared = 0;
  for (int i = 0; i < 1000; ++i) {
    const RigidTransform pose = test::poseNearContact(all[1].pair, kReach, random);
    if (findLmds(all[1].scene, all[1].part, pose, kReach, all[1].scratch, lmds).count == 0) continue;
    if (!isPlaneBetween(all[1].pair, pose, lmds[0].direction)) continue;
    expectDistance(all[1], pose, lmds[0].distance);
    ++compared;
  }
  EXPECT_GT(compared, 100U);
}

TEST(ContactQuery, WithoutRoomForMotionAListGivesTheContactsOfThePoseItself) {
  Bodies bodies = stars();
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const MotionRange range{{{0.01, 0.005, 0.0}, {0.0, 0.01, 0.0}}, {0.03, 0.03}};
  CandidateList list;
  std::vector<LeafPair> pairs(1U << 18);
  std::vector<ContactPair> fromList(8192), cold(8192);
  std::size_t contacts = 0;
  std::uint64_t work = 0, whole = 0;
  for (int i = 0; i < 80; ++i) {
    const RigidTransform middle = test::poseNearContact(bodies.pair, kReach, random);
    list.build({bodies.scene, bodies.part, middle, kReach}, range, bodies.scratch, {1U << 20, 1U << 30},
               kTurn);
    const RigidTransform pose{
        middle.rotation, middle.translation + 0.015 * glm::dvec3{unit(random), unit(random), unit(random)}};
    const BodyPairQuery query{bodies.scene, bodies.part, pose, kReach};
    const auto nearby = list.nearbyPairs(pose, {kReach, kTurn}, {}, bodies.scratch, pairs);
    ASSERT_TRUE(nearby && nearby->isComplete);
    work += nearby->work;
    whole += list.size() / NormalConeTree::kWidth;
    const ContactResult listed =
        testContacts(query, {kReach, kTurn}, std::span(pairs).first(nearby->count), fromList);
    const NearbyPairs all = findNearbyPairs(query, {kReach, kTurn}, {}, bodies.scratch, pairs, kNoBound);
    const ContactResult searched =
        testContacts(query, {kReach, kTurn}, std::span(pairs).first(all.count), cold);
    EXPECT_EQ(listed.count, searched.count);
    EXPECT_EQ(listed.least, searched.least);
    contacts += searched.count;
  }
  EXPECT_GT(contacts, 100U);
  // Those that matter far from the middle alone are not gone through.
  EXPECT_LT(work, whole);
}

TEST(ContactQuery, NearbyPairsHoldTheContactsOfEveryPoseThatTheyAreSaidToHoldFor) {
  Bodies bodies = stars();
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const MotionBudget slack{0.02, 0.02};
  const MotionRange range{{{0.01, 0.005, 0.0}, {0.0, 0.01, 0.0}}, {0.03, 0.03}};
  const double radius = 0.5 * bodies.part.size();
  CandidateList list;
  std::size_t compared = 0, held = 0;
  std::vector<LeafPair> pairs(1U << 18);
  std::vector<ContactPair> found(8192);
  for (int i = 0; i < 80; ++i) {
    const RigidTransform middle = test::poseNearContact(bodies.pair, kReach, random);
    list.build({bodies.scene, bodies.part, middle, kReach}, range, bodies.scratch, {1U << 20, 1U << 30},
               kTurn);
    const bool isListed = i % 2 == 0;
    const RigidTransform start{middle.rotation, middle.translation + 0.01 * unit(random)};
    const auto nearby = isListed
                            ? list.nearbyPairs(start, {kReach, kTurn}, slack, bodies.scratch, pairs).value()
                            : findNearbyPairs({bodies.scene, bodies.part, start, kReach}, {kReach, kTurn},
                                              slack, bodies.scratch, pairs, kNoBound);
    ASSERT_TRUE(nearby.isComplete);
    for (int k = 0; k < 20; ++k) {
      const glm::dvec3 axis = test::randomRotation(random).rotation * glm::dvec3(1, 0, 0);
      const double share = unit(random);
      const RigidTransform pose{
          glm::normalize(glm::angleAxis(0.4 * share * nearby.holds.travel / radius, axis) * start.rotation),
          start.translation + 0.5 * share * nearby.holds.travel * axis};
      if (!(spentShare(motionBetween(start, pose, radius), nearby.holds) <= 1.0)) continue;
      ++held;
      const ContactResult result = testContacts({bodies.scene, bodies.part, pose, kReach}, {kReach, kTurn},
                                                std::span(pairs).first(nearby.count), found);
      const auto expected = sorted(bodies.contacts(pose));
      const auto listed = sorted({found.begin(), found.begin() + static_cast<std::ptrdiff_t>(result.count)});
      ASSERT_EQ(listed.size(), expected.size());
      for (std::size_t n = 0; n < listed.size(); ++n) {
        EXPECT_EQ(listed[n].point, expected[n].point);
        EXPECT_EQ(listed[n].direction, expected[n].direction);
      }
      EXPECT_EQ(result.least, bodies.last.least);
      compared += listed.size();
    }
  }
  EXPECT_GT(held, 500U);
  EXPECT_GT(compared, 1000U);
}

TEST(ContactQuery, PairsListedAlongAWayHoldEveryContactOnItAndBesideIt) {
  Bodies bodies = stars();
  std::mt19937_64 random(19);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const MotionBudget slack{0.01, 0.01};
  const MotionStretch stretch{{0.03, 0.015, -0.01}, {0.01, 0.03, 0.0}};
  const double radius = 0.5 * bodies.part.size();
  CandidateList list;
  std::size_t compared = 0, held = 0;
  std::vector<LeafPair> pairs(1U << 18);
  std::vector<ContactPair> found(8192);
  const auto centred = [&](const RigidTransform& pose) {
    return RigidTransform{pose.rotation, pose.applyToPoint(bodies.part.centre())};
  };
  const auto ofPart = [&](const RigidTransform& pose) {
    return RigidTransform{pose.rotation, pose.translation - pose.rotation * bodies.part.centre()};
  };
  for (int i = 0; i < 40; ++i) {
    const RigidTransform middle = test::poseNearContact(bodies.pair, kReach, random);
    list.build({bodies.scene, bodies.part, middle, kReach}, {stretch, {0.03, 0.03}}, bodies.scratch,
               {1U << 20, 1U << 30}, kTurn);
    const RigidTransform from = poseOn(stretch, centred(middle), -0.5),
                         to = poseOn(stretch, centred(middle), 0.6);
    const auto nearby =
        list.nearbyPairsAlong(ofPart(from), ofPart(to), {kReach, kTurn}, slack, bodies.scratch, pairs);
    ASSERT_TRUE(nearby && nearby->isComplete);
    for (int k = 0; k < 20; ++k) {
      const RigidTransform on = poseOn(stretch, centred(middle), 0.05 + 0.55 * unit(random));
      const glm::dvec3 axis = test::randomRotation(random).rotation * glm::dvec3(1, 0, 0);
      const double share = unit(random);
      const RigidTransform beside{
          glm::normalize(glm::angleAxis(0.4 * share * nearby->holds.travel / radius, axis) * on.rotation),
          on.translation + 0.5 * share * nearby->holds.travel * axis};
      if (!(spentShare(motionBetween(on, beside, radius), nearby->holds) <= 1.0)) continue;
      ++held;
      const RigidTransform pose = ofPart(beside);
      const ContactResult result = testContacts({bodies.scene, bodies.part, pose, kReach}, {kReach, kTurn},
                                                std::span(pairs).first(nearby->count), found);
      const auto expected = sorted(bodies.contacts(pose));
      const auto listed = sorted({found.begin(), found.begin() + static_cast<std::ptrdiff_t>(result.count)});
      ASSERT_EQ(listed.size(), expected.size());
      for (std::size_t n = 0; n < listed.size(); ++n)
        EXPECT_EQ(listed[n].point, expected[n].point);
      compared += listed.size();
    }
    const RigidTransform beyond = poseOn(stretch, centred(middle), 3.0);
    EXPECT_FALSE(
        list.nearbyPairsAlong(ofPart(from), ofPart(beyond), {kReach, kTurn}, slack, bodies.scratch, pairs));
  }
  EXPECT_GT(held, 300U);
  EXPECT_GT(compared, 500U);
}

TEST(ContactQuery, ListThatWasMadeForLessRelaxationDoesNotAnswer) {
  Bodies bodies = stars();
  CandidateList list;
  list.build({bodies.scene, bodies.part, {}, kReach}, {{}, {0.01, 0.01}}, bodies.scratch, {}, 0.5 * kTurn);
  std::vector<LeafPair> out(1U << 18);
  EXPECT_FALSE(list.nearbyPairs({}, {kReach, kTurn}, {}, bodies.scratch, out));
  EXPECT_TRUE(list.nearbyPairs({}, {kReach, 0.5 * kTurn}, {}, bodies.scratch, out));
}

TEST(ContactQuery, FullStorageKeepsTheNearestAndSaysHowFarItIsComplete) {
  Bodies bodies{{"peg in bore", test::tubeMesh(0.5, 0.8, 1.0, 24), test::cylinderMesh(0.45, 2.0, 24)}};
  const RigidTransform pose{{1, 0, 0, 0}, {0.01, 0.004, 0.0}};
  const std::vector<ContactPair> all = sorted(bodies.contacts(pose));
  ASSERT_GT(all.size(), 20U);
  std::vector<ContactPair> few(10);
  const ContactResult result = findContacts({bodies.scene, bodies.part, pose, kReach}, bodies.scratch, few);
  EXPECT_EQ(result.count, few.size());
  EXPECT_EQ(result.least, all.front().distance);
  const std::vector<ContactPair> kept = sorted(few);
  for (std::size_t i = 0; i < kept.size(); ++i)
    EXPECT_EQ(kept[i].distance, all[i].distance);
  EXPECT_EQ(result.completeTo, all[kept.size()].distance);
}

TEST(ContactQuery, TooMuchWorkIsSaidAndBoundsTheDistanceByNothing) {
  Bodies bodies = stars();
  std::mt19937_64 random(8);
  const RigidTransform pose = test::poseNearContact(bodies.pair, kReach, random);
  std::vector<ContactPair> out(64);
  const ContactResult result =
      findContacts({bodies.scene, bodies.part, pose, kReach}, bodies.scratch, out, kTurn, 2);
  EXPECT_EQ(result.completeTo, 0.0);
  EXPECT_EQ(result.distanceBound(), 0.0);
}

TEST(ContactQuery, AllocatesNothing) {
  Bodies bodies = stars();
  std::mt19937_64 random(9);
  const RigidTransform pose = test::poseNearContact(bodies.pair, kReach, random);
  CandidateList list;
  list.build({bodies.scene, bodies.part, pose, kReach}, {{}, {0.01, 0.01}}, bodies.scratch, {}, kTurn);
  std::vector<ContactPair> out(4096);
  std::vector<LeafPair> pairs(1U << 18);
  findContacts({bodies.scene, bodies.part, pose, kReach}, bodies.scratch, out);  // Makes what it keeps.
  test::resetAllocationCount();
  test::startCountingAllocations();
  findContacts({bodies.scene, bodies.part, pose, kReach}, bodies.scratch, out);
  const auto nearby = list.nearbyPairs(pose, {kReach, kTurn}, {}, bodies.scratch, pairs);
  testContacts({bodies.scene, bodies.part, pose, kReach}, {kReach, kTurn}, pairs, out);
  const bool isListed = nearby.has_value();
  test::stopCountingAllocations();
  EXPECT_TRUE(isListed);
  EXPECT_EQ(test::countedAllocations(), 0U);
}

}  // namespace
}  // namespace nearfit::contact_query_test

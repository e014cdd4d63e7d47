#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/contact_query.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::contact_relaxation_test {
namespace {

using test::BodyPair;

constexpr double kTurn = 0.02;
constexpr std::uint64_t kNoBound = std::numeric_limits<std::uint64_t>::max();

/// Two bodies, and every pair of their features that can be a contact.
class Bodies {
 public:
  explicit Bodies(BodyPair p) : pair(std::move(p)), scene(pair.scene), part(pair.part) {
    for (const std::uint32_t s : leavesOf(scene)) {
      for (const std::uint32_t m : leavesOf(part)) {
        const FeatureKind a = NormalConeTree::leafKind(s), b = NormalConeTree::leafKind(m);
        if ((a != FeatureKind::Face || b == FeatureKind::Vertex) &&
            (b != FeatureKind::Face || a == FeatureKind::Vertex))
          all.push_back({s, m});
      }
    }
    room.resize(all.size());
  }

  std::vector<LeafPair> nearby(const RigidTransform& pose, double reach, const MotionBudget& slack = {}) {
    const NearbyPairs found =
        findNearbyPairs({scene, part, pose, reach}, {reach, kTurn}, slack, scratch, room, kNoBound);
    EXPECT_TRUE(found.isComplete);
    return {room.begin(), room.begin() + static_cast<std::ptrdiff_t>(found.count)};
  }
  std::vector<ContactPair> contacts(const RigidTransform& pose, double reach,
                                    std::span<const LeafPair> pairs) const {
    std::vector<ContactPair> out(all.size());
    out.resize(testContacts({scene, part, pose, reach}, {reach, kTurn}, pairs, out).count);
    return out;
  }

  const BodyPair pair;
  const NormalConeTree scene, part;
  std::vector<LeafPair> all, room;
  LmdScratch scratch{64};

 private:
  static std::vector<std::uint32_t> leavesOf(const NormalConeTree& tree) {
    std::vector<std::uint32_t> leaves;
    for (const NormalConeTree::Node& node : tree.nodes())
      std::ranges::copy_if(node.child, std::back_inserter(leaves), [](std::uint32_t child) {
        return NormalConeTree::isLeaf(child) && child != NormalConeTree::kNoChild;
      });
    return leaves;
  }
};

/// A pair that every contact of is among those that are found near, however close to the limits.
void expectNoneCulled(BodyPair pair, double reach) {
  Bodies bodies(std::move(pair));
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> tilt(0.0, 2.5 * kTurn);
  std::size_t contacts = 0;
  constexpr int kPoses = 60;
  for (int i = 0; i < kPoses; ++i) {
    // What is nearly parallel has contacts that are hardly any.
    const RigidTransform pose = i % 4 == 0
                                    ? test::poseNearContact(bodies.pair, reach, random)
                                    : test::poseWithParallelFaces(bodies.pair, reach, tilt(random), random);
    const std::size_t all = bodies.contacts(pose, reach, bodies.all).size();
    const std::size_t found = bodies.contacts(pose, reach, bodies.nearby(pose, reach)).size();
    EXPECT_EQ(found, all) << bodies.pair.name << " at " << reach << ", pose " << i;
    contacts += all;
  }
  EXPECT_GT(contacts, static_cast<std::size_t>(kPoses)) << bodies.pair.name;
}

TEST(ContactRelaxation, NoContactIsCulledHoweverSharpOrFlatTheFeatures) {
  // A search with room for motion found more: culls allowed for the relaxation of one body's conditions, not
  // of both, and of conditions that meet at a sharp corner the tests took what is far from both.
  for (const double reach : {0.05, 0.5}) {
    expectNoneCulled(
        {"box and sharp annulus", test::boxMesh({2.0, 0.5, 0.25}), test::tubeMesh(0.1, 0.2, 0.2, 3)}, reach);
    expectNoneCulled({"flat cones", test::coneMesh(1.0, 0.02, 7), test::coneMesh(0.5, 0.01, 5)}, reach);
    expectNoneCulled({"boxes", test::boxMesh({1.0, 1.0, 1.0}), test::boxMesh({0.6, 0.4, 0.5})}, reach);
    expectNoneCulled({"spheres", test::uvSphereMesh(1.0, 12, 8), test::uvSphereMesh(0.6, 10, 6)}, reach);
    expectNoneCulled({"open squares", test::squareMesh(1.0, 2), test::squareMesh(0.5, 2)}, reach);
    expectNoneCulled({"stars", test::starMesh(21, 1.0, 1, 0.25), test::starMesh(22, 0.7, 1, 0.25)}, reach);
  }
}

TEST(ContactRelaxation, FootBeyondASharpCornerIsNoContact) {
  // The faces between an annulus's two triangles have corners of 11 degrees. Over one, the foot of the box's
  // corner was within the relaxation of the lines along both sides and seven times as far from the face.
  Bodies bodies({"box under annulus", test::boxMesh({2.0, 0.5, 0.25}),
                 test::transformed(test::tubeMesh(0.5, 1.0, 1.0, 3), 1.0 / 32.0)});
  const RigidTransform pose{glm::angleAxis(0.5 * std::numbers::pi + 1e-12, glm::dvec3(1, 0, 0)),
                            {1.0, 1.0, 1e-9}};
  constexpr double kReach = 2.0;
  const auto cold = bodies.contacts(pose, kReach, bodies.nearby(pose, kReach));
  const auto roomy = bodies.contacts(pose, kReach, bodies.nearby(pose, kReach, {0.02, 0.01}));
  EXPECT_GT(cold.size(), 0U);
  EXPECT_EQ(roomy.size(), cold.size());
  for (const ContactPair& contact : roomy) {
    // The part's radius, and what a direction may be off by.
    EXPECT_LT(glm::distance(contact.point, pose.translation), 0.05 + kTurn * contact.distance);
  }
}

TEST(ContactRelaxation, DirectionBeyondASharpCornerOfAConeIsNoContact) {
  // Two of the three edges at a flat tip are nearly opposite: the polar cone has a sharp corner between their
  // walls. A direction straight beyond it is off the cone by far more than off either wall.
  constexpr double kHeight = 0.2;
  const auto onRing = [](double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    return glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
  };
  const glm::dvec3 tip(0, 0, kHeight), first = onRing(0.0), second = onRing(165.0), third = onRing(262.5);
  const TriangleMesh pyramid({first, second, third, tip}, {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}});
  Bodies bodies({"tip", pyramid, test::tetrahedronMesh(0.01)});
  const glm::dvec3 e0 = glm::normalize(first - tip), e1 = glm::normalize(second - tip);
  const glm::dvec3 ray = glm::normalize(glm::cross(e0, e1));
  // Away from the cone, between the walls' outer sides: off each by the same.
  const glm::dvec3 outward = glm::normalize(e0 + e1);
  const double offOfEach = glm::dot(outward, e0);
  const auto isContact = [&](double offOfWalls) {
    const double sine = offOfWalls / offOfEach;
    const glm::dvec3 direction = std::sqrt(1.0 - sine * sine) * ray + sine * outward;
    // A vertex of the part in that direction, its other vertices beyond.
    const glm::dvec3 vertex = bodies.pair.part.vertices()[0];
    const glm::dquat turn(glm::normalize(vertex), -direction);
    const RigidTransform pose{turn, tip + 0.1 * direction - turn * vertex};
    return std::ranges::any_of(bodies.contacts(pose, 0.2, bodies.all), [&](const ContactPair& c) {
      return glm::distance(c.point, tip + 0.1 * direction) < 1e-9 && std::abs(c.distance - 0.1) < 1e-9;
    });
  };
  EXPECT_LT(offOfEach, 0.25);
  EXPECT_TRUE(isContact(0.5 * kTurn * offOfEach));
  EXPECT_TRUE(isContact(0.99 * kTurn * offOfEach));
  EXPECT_FALSE(isContact(1.01 * kTurn * offOfEach));
  EXPECT_FALSE(isContact(0.99 * kTurn));
}

TEST(ContactRelaxation, WhatBecomesAMinimumByATurnIsAContactBefore) {
  // A minimum of a vertex, at a pose; the part turned about the point on it where that was.
  Bodies bodies({"stars", test::starMesh(21, 1.0, 2, 0.25), test::starMesh(22, 0.7, 2, 0.25)});
  constexpr double kReach = 0.3;
  std::mt19937_64 random(17);
  std::vector<Lmd> minima(256);
  std::size_t compared = 0;
  for (int i = 0; i < 400; ++i) {
    const RigidTransform pose = test::poseNearContact(bodies.pair, kReach, random);
    const std::size_t count =
        findLmds(bodies.scene, bodies.part, pose, 0.9 * kReach, bodies.scratch, minima).count;
    for (const Lmd& minimum : std::span(minima).first(count)) {
      if (minimum.isRegion) continue;
      if (minimum.sceneFeature != FeatureKind::Vertex && minimum.partFeature != FeatureKind::Vertex) continue;
      const glm::dvec3 axis = test::randomRotation(random).rotation * glm::dvec3(0, 0, 1);
      const glm::dquat turn = glm::angleAxis(0.95 * kTurn, axis);
      const RigidTransform turned{glm::normalize(turn * pose.rotation),
                                  minimum.partPoint + turn * (pose.translation - minimum.partPoint)};
      const auto contacts = bodies.contacts(turned, kReach, bodies.nearby(turned, kReach));
      EXPECT_TRUE(std::ranges::any_of(contacts,
                                      [&](const ContactPair& c) {
                                        return glm::distance(c.point, minimum.partPoint) <=
                                                   1.1 * kTurn * minimum.distance &&
                                               glm::distance(c.direction, minimum.direction) <= 1.1 * kTurn;
                                      }))
          << "distance " << minimum.distance << ", pose " << i;
      ++compared;
    }
  }
  EXPECT_GT(compared, 100U);
}

}  // namespace
}  // namespace nearfit::contact_relaxation_test

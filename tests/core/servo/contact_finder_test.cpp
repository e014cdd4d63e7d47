#include "core/servo/contact_finder.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/allocation_hook.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/proxy_walk.h"
#include "tests/support/ringed_pair.h"

namespace nearfit::contact_finder_test {
namespace {

constexpr double kReach = 2.6e-3;

RigidTransform raised(double z) {
  return {{1, 0, 0, 0}, {0.003, 0.002, z}};
}

void beginTick(ContactFinder& finder) {
  finder.beginTick();
  finder.allow(ContactFinder::kUsualWork, ContactFinder::Excess::ToGather);
}

/// An open sheet of thousands of triangles in slight waves: no flats, whose triangles are merged.
TriangleMesh waved(std::uint32_t divisions, double height) {
  const TriangleMesh flat = test::squareMesh(1.0, divisions);
  std::vector<glm::dvec3> vertices;
  for (const glm::dvec3& p : flat.vertices())
    vertices.emplace_back(p.x, p.y, height * std::sin(20.0 * p.x));
  return {std::move(vertices), {flat.triangles().begin(), flat.triangles().end()}};
}

/// Two such sheets, one along the other, all of whose triangles are near.
test::ProxyWalk sheets() {
  return test::ProxyWalk({{waved(100, 1e-3), {}}}, waved(100, 1e-3), raised(0.1), {1e-3, 0.0});
}

TEST(ContactFinder, ATickAmongOpenSheetsEndsWithinItsWork) {
  test::ProxyWalk walk = sheets();
  walk.lead(walk.pose());
  ContactFinder finder;
  std::vector<BodyContact> out(ContactFinder::kMaxContacts);
  std::uint64_t most = 0;
  for (int tick = 0; tick < 3; ++tick) {
    beginTick(finder);
    for (int look = 0; look < 24; ++look) {
      const double z = 1e-3 + 1e-5 * look;
      const Surroundings around = finder.find(walk.tracked(), raised(z), kReach, 1e-3, out);
      EXPECT_LE(around.distance, z);
      if (finder.isWorkSpent()) break;
    }
    most = std::max(most, finder.work());
  }
  // And some for asking which bodies are near.
  EXPECT_LE(most, ContactFinder::kMaxSurfaceWork + 64);
  EXPECT_GT(most, ContactFinder::kMaxSurfaceWork / 2);
}

/// Waves in phase, one above the other: their boxes overlap down to the leaves.
TriangleMesh waves() {
  return waved(18, 0.02);
}

// A search that was left off with its nodes still overlapping says of nothing that it is away. Taken for an
// answer, it left no work for a shorter look: a part that slid among coils took one step a tick. Here even the
// shortest says nothing within what surfaces have of a tick: those that follow may take more.
TEST(ContactFinder, WhereALookSaysNothingAShorterOneDoes) {
  test::ProxyWalk walk({{waves(), {}}}, waves(), raised(0.1), {1e-3, 0.0});
  walk.lead(walk.pose());
  ContactFinder finder;
  std::vector<BodyContact> out(ContactFinder::kMaxContacts);
  for (int tick = 0; tick < 8; ++tick) {
    beginTick(finder);
    const RigidTransform pose{{1, 0, 0, 0}, {0.0, 0.0, 1.2e-3 + 1e-5 * tick}};
    const Surroundings around = finder.find(walk.tracked(), pose, kReach, 1e-3, out);
    // The first ticks learn that there is too much for longer ones.
    if (tick < 4) continue;
    EXPECT_GT(around.completeTo, 0.0);
    EXPECT_GT(around.distance, 0.2e-3);
    EXPECT_LE(around.distance, pose.translation.z);
  }
}

bool isSameContact(const BodyContact& a, const BodyContact& b) {
  return a.body == b.body && a.pair.distance == b.pair.distance && a.pair.point == b.pair.point &&
         a.pair.direction == b.pair.direction;
}

// A rod in a tube, ringed alike: thousands of pairs, more than a tick tests.
TEST(ContactFinder, ALookThatTakesManyTicksFindsWhatOneDoes) {
  constexpr double kMargin = 0.008;
  const test::RingedPair pair{.detail = 3};
  test::ProxyWalk walk({{pair.tube(), {}}}, pair.rod(), {}, {kMargin, 0.0});
  for (int i = 0; i < 20; ++i)
    walk.lead({});
  const double reach = kContactReach * kMargin;
  const RigidTransform pose = {{1, 0, 0, 0}, {6e-3, 3e-3, -3e-3}}, from;
  const ContactFinder::Step step{from, true};
  ContactFinder whole, split;
  std::vector<BodyContact> expected(ContactFinder::kMaxContacts), found(ContactFinder::kMaxContacts);
  whole.beginTick();
  whole.allow(1U << 24, ContactFinder::Excess::ToGather);
  const Surroundings around = whole.find(walk.tracked(), pose, reach, 1e-3, expected, &step);
  ASSERT_FALSE(around.isPending);
  ASSERT_GT(around.completeTo, 0.0);
  ASSERT_GT(around.count, 20U);
  int ticks = 0;
  Surroundings there{.isPending = true};
  for (; there.isPending && ticks < 1000; ++ticks) {
    split.beginTick();
    split.allow(200, ContactFinder::Excess::ToGather);
    there = split.find(walk.tracked(), pose, reach, 1e-3, found, &step);
  }
  EXPECT_GT(ticks, 10);
  EXPECT_EQ(there.distance, around.distance);
  EXPECT_EQ(there.completeTo, around.completeTo);
  EXPECT_EQ(there.onWay, around.onWay);
  ASSERT_EQ(there.count, around.count);
  for (std::size_t i = 0; i < there.count; ++i)
    EXPECT_TRUE(isSameContact(found[i], expected[i])) << i;
}

TEST(ContactFinder, LooksAmongOpenSheetsAllocateNothing) {
  test::ProxyWalk walk = sheets();
  walk.lead(walk.pose());
  ContactFinder finder;
  std::vector<BodyContact> out(ContactFinder::kMaxContacts);
  test::resetAllocationCount();
  test::startCountingAllocations();
  for (int look = 0; look < 24; ++look) {
    beginTick(finder);
    finder.find(walk.tracked(), raised(1e-3 + 1e-4 * look), kReach, 1e-3, out);
  }
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0U);
}

}  // namespace
}  // namespace nearfit::contact_finder_test

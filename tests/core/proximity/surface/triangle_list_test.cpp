#include "core/proximity/surface/triangle_list.h"

#include <algorithm>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/support/degenerate_meshes.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::triangle_list_test {
namespace {

using test::BodyPair;

constexpr std::uint64_t kAnyWork = std::numeric_limits<std::uint64_t>::max();

std::set<std::pair<std::uint32_t, std::uint32_t>> indicesOf(std::span<const TrianglePair> pairs) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> out;
  for (const TrianglePair& pair : pairs)
    out.insert({pair.scene, pair.part});
  return out;
}

/// A pose not far from another.
RigidTransform nudged(const RigidTransform& pose, double most, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const glm::dvec3 shift(unit(random), unit(random), unit(random));
  return {glm::normalize(glm::angleAxis(most * unit(random),
                                        test::randomRotation(random).rotation * glm::dvec3(1, 0, 0)) *
                         pose.rotation),
          pose.translation + most * shift};
}

/// What a list has around other poses must hold what a search there finds, to the distance that it says.
void compareLists(const BodyPair& pair, double within, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const UnsidedSurface scene{NormalConeTree(pair.scene)}, part{NormalConeTree(pair.part)};
  LmdScratch scratch;
  std::vector<TrianglePair> found(1U << 18);
  TriangleList list;
  std::size_t compared = 0;
  for (int i = 0; i < 6; ++i) {
    const RigidTransform start = test::poseNearContact(pair, 0.5 * within, random);
    list.build(scene, part, start, within, scratch, found.size(), kAnyWork);
    ASSERT_EQ(list.within(), within);
    for (const std::size_t most : {found.size(), std::size_t{20}}) {
      for (int k = 0; k < 6; ++k) {
        const RigidTransform pose = k == 0 ? start : nudged(start, 0.1 * within, random);
        const TriangleList::Around around = list.around(pose, most);
        EXPECT_LE(around.pairs.size(), most);
        EXPECT_LE(around.within, within - around.travel);
        EXPECT_TRUE(std::ranges::is_sorted(around.pairs, {}, &TrianglePair::atLeast));
        if (!(around.within > 0.0)) continue;
        const auto listed = indicesOf(around.pairs);
        const NearbyTriangles nearby =
            findNearbyTriangles(scene, part, pose, around.within, scratch, found, kAnyWork);
        for (const TrianglePair& each : std::span(found).first(nearby.count)) {
          // A search lists by a bound on the distance, which may be less.
          const auto& s = scene.tree().faces()[each.scene].corners;
          const auto& p = part.tree().faces()[each.part].corners;
          const auto at = scene.tree().positions(), on = part.tree().positions();
          const glm::dvec3 centre = pose.applyToPoint(part.tree().centre()) - scene.tree().centre();
          const auto placed = [&](std::uint32_t v) { return pose.rotation * on[v] + centre; };
          const double distance = std::sqrt(
              closestOfTriangles({at[s[0]], at[s[1]], at[s[2]]}, {placed(p[0]), placed(p[1]), placed(p[2])})
                  .distanceSquared);
          if (distance >= around.within) continue;
          EXPECT_TRUE(listed.contains({each.scene, each.part})) << pair.name << " " << distance;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 0U) << pair.name;
}

TEST(TriangleList, HoldsWhatIsNearAroundOtherPoses) {
  compareLists({"stars", test::starMesh(1, 1.0, 2, 0.4), test::starMesh(2, 0.3, 2, 0.4)}, 0.3, 21);
  compareLists({"boxes", test::boxMesh({1, 2, 3}), test::boxMesh({0.5, 0.5, 0.5})}, 0.5, 22);
  compareLists({"soup", test::looseTriangles(3, 60), test::looseTriangles(4, 3)}, 0.4, 23);
  compareLists({"sheets", test::squareMesh(1.0, 6), test::coplanarFans(1, 4)}, 0.3, 24);
}

TEST(TriangleList, ReachesLessFarWithoutRoomOrWork) {
  const UnsidedSurface sheet{NormalConeTree(test::squareMesh(1.0, 40))};
  const RigidTransform above{{1, 0, 0, 0}, {0.003, 0.002, 0.01}};
  LmdScratch scratch;
  TriangleList list;
  list.build(sheet, sheet, above, 0.05, scratch, 1U << 18, kAnyWork);
  EXPECT_EQ(list.within(), 0.05);
  list.build(sheet, sheet, above, 0.05, scratch, 100, kAnyWork);
  EXPECT_LE(list.within(), 0.01) << "pairs that touch are as near as any that were left out";
  list.build(sheet, sheet, above, 0.05, scratch, 1U << 18, 10);
  EXPECT_LE(list.within(), 0.01);
  EXPECT_LE(list.reachAt({{1, 0, 0, 0}, {0.003, 0.002, 0.5}}), 0.0) << "too far away to serve";
}

}  // namespace
}  // namespace nearfit::triangle_list_test

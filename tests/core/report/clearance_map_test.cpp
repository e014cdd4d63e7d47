#include "core/report/clearance_map.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/parallel/parallel_for.h"
#include "core/report/clearance_histogram.h"
#include "tests/exact/exact_meeting.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/point_oracle.h"
#include "tests/support/random_values.h"
#include "tests/support/trial_share.h"

namespace nearfit::clearance_map_test {
namespace {

RigidTransform at(double x, double y, double z) {
  return {{1.0, 0.0, 0.0, 0.0}, {x, y, z}};
}

ClearanceMap mapOf(const Scene& scene, PartId subject, double range, bool hasNearParts = false) {
  return ClearanceMapper().map(clearanceMapRequest(scene, subject, range, hasNearParts));
}

/// Signed distance by brute force: the least over the others, minus the depth in those that wind around the point.
double bruteForceClearance(const Scene& scene, PartId subject, const std::vector<PartId>& others,
                           const glm::dvec3& worldPoint) {
  double least = std::numeric_limits<double>::infinity();
  for (const PartId id : others) {
    if (id == subject) continue;
    const Part& other = scene.get(id);
    const glm::dvec3 p = other.worldFromPart.inverse().applyToPoint(worldPoint);
    const TriangleMesh& mesh = other.geometry->mesh;
    const double distance = test::distanceToMesh(mesh, p);
    const bool isInside = mesh.topology().isClosed() && std::lround(test::windingNumber(mesh, p)) != 0;
    least = std::min(least, isInside ? -distance : distance);
  }
  return least;
}

/// Compares every sample; those within `slack` of the range or of a surface may be either.
void expectAsBruteForce(const Scene& scene, const ClearanceMap& map, const MappedSurface& mapped,
                        const std::vector<PartId>& others, std::size_t stride) {
  const Part& part = scene.get(mapped.part);
  constexpr double kSlack = 1e-12;
  for (std::size_t i = 0; i < mapped.surface->points.size(); i += stride) {
    const glm::dvec3 point = part.worldFromPart.applyToPoint(mapped.surface->points[i]);
    const double expected = bruteForceClearance(scene, mapped.part, others, point);
    const double found = mapped.distances[i];
    if (std::isnan(found)) {
      EXPECT_GT(expected, map.range - kSlack);
      EXPECT_EQ(mapped.nearest[i], PartId{});
      continue;
    }
    EXPECT_LE(expected, map.range + kSlack);
    // On the surface, to rounding, the sign is not decided.
    if (std::abs(expected) < 1e-10) {
      EXPECT_LT(std::abs(found), 2e-10);
      continue;
    }
    EXPECT_NEAR(found, expected, kSlack);
    EXPECT_NEAR(glm::distance(mapped.nearestPoints[i], point), std::abs(expected), kSlack);
    const Part& nearest = scene.get(mapped.nearest[i]);
    const glm::dvec3 there = nearest.worldFromPart.inverse().applyToPoint(mapped.nearestPoints[i]);
    EXPECT_LT(test::distanceToMesh(nearest.geometry->mesh, there), kSlack);
  }
}

TEST(ClearanceMap, RandomPartsHaveTheBruteForceDistances) {
  test::RandomValues random(21);
  std::size_t inside = 0, beyond = 0, within = 0;
  for (std::uint64_t round = 0; round < 8 / test::kTrialShare; ++round) {
    Scene scene;
    std::vector<PartId> ids;
    const auto place = [&](const char* name, TriangleMesh mesh, double reach) {
      RigidTransform pose = random.pose().normalized();
      pose.translation *= reach;
      ids.push_back(scene.add(test::partOf(test::geometryOf(std::move(mesh)), name, pose)));
    };
    place("subject", test::starMesh(3 * round, 0.5, 1, 0.4), 0.5);
    place("near", test::starMesh(3 * round + 1, 0.5, 1, 0.4), 1.5);
    place("slivers", test::withSlivers(test::icosphereMesh(0.4, 0), 1e6, 0.1), 2.0);
    place("sheet", test::withFacesWithoutArea(test::squareMesh(1.0, 3)), 2.0);
    const ClearanceMap map = mapOf(scene, ids[0], 0.25, true);
    ASSERT_FALSE(map.surfaces.empty());
    EXPECT_EQ(map.surfaces[0].part, ids[0]);
    for (const MappedSurface& mapped : map.surfaces) {
      const bool isSubject = mapped.part == ids[0];
      expectAsBruteForce(scene, map, mapped, isSubject ? ids : std::vector{ids[0]}, 5);
      for (const double distance : mapped.distances) {
        std::isnan(distance) ? ++beyond : ++within;
        if (distance < 0.0) ++inside;
      }
    }
  }
  EXPECT_GT(inside, 100U);
  EXPECT_GT(beyond, 100U);
  EXPECT_GT(within, inside);
}

TEST(ClearanceMap, ParallelPlatesHaveOneGap) {
  constexpr double kGap = 0.003;
  Scene scene;
  const PartId below = scene.add(test::partOf(test::geometryOf(test::boxMesh({0.1, 0.1, 0.01})), "below"));
  const PartId above = scene.add(
      test::partOf(test::geometryOf(test::boxMesh({0.05, 0.05, 0.01})), "above", at(0.0, 0.0, 0.01 + kGap)));
  const ClearanceMap map = mapOf(scene, above, 0.005);
  const MappedSurface& mapped = map.surfaces.at(0);
  std::size_t faces = 0;
  for (std::size_t i = 0; i < mapped.distances.size(); ++i) {
    const double height = mapped.surface->points[i].z + 0.005;
    if (height + kGap > 0.005 + 1e-12) {
      EXPECT_TRUE(std::isnan(mapped.distances[i]));
      continue;
    }
    EXPECT_NEAR(mapped.distances[i], kGap + height, 1e-15);
    EXPECT_EQ(mapped.nearest[i], below);
    if (height == 0.0) ++faces;
  }
  EXPECT_GT(faces, 400U) << "two triangles are sampled";
  // The lower face, and the lower two millimetres of the four sides.
  const AreaByClearance areas(mapped);
  EXPECT_NEAR(areas.nearerThan(0.0031), 0.05 * 0.05, 4.0 * 0.05 * map.range / 8.0);
  EXPECT_NEAR(areas.least().value_or(-1.0), kGap, 1e-15);
}

TEST(ClearanceMap, PartsThatMoveAsOneAreMappedToTheOthersAndNotToEachOther) {
  Scene scene;
  const PartId below = scene.add(test::partOf(test::geometryOf(test::boxMesh({0.1, 0.1, 0.01})), "below"));
  // 3 mm and 5 mm above it, and a quarter of the one inside the other.
  const auto cube = test::geometryOf(test::boxMesh(glm::dvec3(0.02)));
  const PartId first = scene.add(test::partOf(cube, "first", at(0.0, 0.0, 0.018)));
  const PartId second = scene.add(test::partOf(cube, "second", at(0.015, 0.0, 0.020)));
  const std::vector<PartId> body{first, second};
  const ClearanceMap map = ClearanceMapper().map(clearanceMapRequest(scene, body, 0.01, true));
  ASSERT_EQ(map.subjectCount, 2U);
  ASSERT_EQ(map.surfaces.size(), 3U);
  EXPECT_EQ(map.surfaces[2].part, below);
  for (std::size_t i = 0; i < 3; ++i)
    expectAsBruteForce(scene, map, map.surfaces[i], i < 2 ? std::vector{below} : body, 1);
  EXPECT_NEAR(map.leastDistance, 0.003, 1e-15);
  const AreaByClearance areas(map.subject());
  EXPECT_NEAR(areas.total(), 2 * 6 * 0.02 * 0.02, 1e-15);
  EXPECT_NEAR(areas.least().value_or(-1.0), 0.003, 1e-15);
  EXPECT_EQ(areas.overlapping(), 0.0);
  // A part of it that is hidden counts neither way.
  Part hidden = scene.get(second);
  hidden.isVisible = false;
  scene.replace(hidden);
  const ClearanceMapRequest request = clearanceMapRequest(scene, body, 0.01, true);
  EXPECT_EQ(request.subject, std::vector{first});
  EXPECT_EQ(request.parts.size(), 2U);
}

TEST(ClearanceMap, TheSubjectIsWhatIsInHandUnlessSomethingElseIsSelected) {
  Scene scene;
  const auto cube = test::geometryOf(test::boxMesh(glm::dvec3(0.02)));
  const GroupId group = scene.addGroup({{}, "pair", {}, false});
  std::vector<PartId> ids;
  for (const char* name : {"first", "second", "third"}) {
    Part part = test::partOf(cube, name);
    if (ids.size() < 2) part.group = group;
    ids.push_back(scene.add(part));
  }
  EXPECT_TRUE(mapSubject(scene, {}).empty());
  scene.setMovingGroup(group);
  const std::vector<PartId> pair{ids[0], ids[1]};
  EXPECT_EQ(mapSubject(scene, {}), pair);
  EXPECT_EQ(mapSubject(scene, {ids[1], ids[0]}), pair);
  EXPECT_EQ(mapSubject(scene, {ids[0]}), std::vector{ids[0]});
  EXPECT_EQ(mapSubject(scene, {ids[0], ids[2]}), std::vector{ids[2]});
}

TEST(ClearanceMap, CylinderInItsBoreHasTheGapAllAround) {
  // Facets of both are at the same angles: they are parallel, and the gap is that of the radii to their middles. A corner
  // of the pin has its foot on the facets beside it, not in the edge of the bore.
  constexpr double kPin = 0.0099, kBore = 0.01;
  constexpr std::uint32_t kSegments = 48;
  Scene scene;
  const PartId pin =
      scene.add(test::partOf(test::geometryOf(test::cylinderMesh(kPin, 0.02, kSegments)), "pin"));
  scene.add(test::partOf(test::geometryOf(test::tubeMesh(kBore, 0.02, 0.04, kSegments)), "bore"));
  const ClearanceMap map = mapOf(scene, pin, 0.0005);
  const MappedSurface& mapped = map.surfaces.at(0);
  const double gap = (kBore - kPin) * std::cos(std::acos(-1.0) / kSegments);
  std::size_t wall = 0;
  for (std::size_t i = 0; i < mapped.distances.size(); ++i) {
    const glm::dvec3& p = mapped.surface->points[i];
    if (std::abs(mapped.surface->normals[i].z) > 0.5F) continue;
    ++wall;
    EXPECT_NEAR(mapped.distances[i], gap, 1e-12) << p.x << ' ' << p.y << ' ' << p.z;
  }
  EXPECT_GT(wall, 1000U);
}

TEST(ClearanceMap, BallInABowlIsEquallyNearEverywhereBelow) {
  constexpr std::uint32_t kSegments = 64, kRings = 32;
  constexpr double kBall = 0.9, kBowl = 1.0;
  Scene scene;
  const PartId ball =
      scene.add(test::partOf(test::geometryOf(test::uvSphereMesh(kBall, kSegments, 2 * kRings)), "ball"));
  scene.add(test::partOf(test::geometryOf(test::bowlMesh(kBowl, 1.2, kSegments, kRings)), "bowl"));
  const ClearanceMap map = mapOf(scene, ball, 0.3);
  const MappedSurface& mapped = map.surfaces.at(0);
  // Facets are nearer to the centre than their corners by this share of the radius at most.
  const double sag = 1.0 - std::pow(std::cos(std::acos(-1.0) / kSegments), 2.0);
  std::size_t below = 0;
  for (std::size_t i = 0; i < mapped.distances.size(); ++i) {
    if (!(mapped.surface->points[i].z < -0.05)) continue;
    ++below;
    EXPECT_GT(mapped.distances[i], kBowl * (1.0 - sag) - kBall - 1e-12);
    EXPECT_LT(mapped.distances[i], kBowl - kBall * (1.0 - sag) + 1e-12);
  }
  EXPECT_GT(below, 1000U);
}

TEST(ClearanceMap, InsideAnotherPartItIsMinusTheDepthHoweverDeep) {
  Scene scene;
  scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(2.0))), "block"));
  const PartId pin =
      scene.add(test::partOf(test::geometryOf(test::boxMesh({0.2, 0.2, 1.0})), "pin", at(0.0, 0.0, 0.8)));
  const ClearanceMap map = mapOf(scene, pin, 0.01);
  const MappedSurface& mapped = map.surfaces.at(0);
  double deepest = 0.0;
  for (std::size_t i = 0; i < mapped.distances.size(); ++i) {
    const glm::dvec3 p = mapped.surface->points[i] + glm::dvec3(0.0, 0.0, 0.8);
    const double height = p.z - 1.0;
    if (height > 0.01 + 1e-12) {
      EXPECT_TRUE(std::isnan(mapped.distances[i]));
    } else if (std::abs(height) > 1e-9) {
      EXPECT_NEAR(mapped.distances[i], height, 1e-12) << "the top is nearer than the sides";
    }
    if (!std::isnan(mapped.distances[i])) deepest = std::min(deepest, mapped.distances[i]);
  }
  EXPECT_NEAR(deepest, -0.7, 1e-12) << "beyond the range";
}

TEST(ClearanceMap, ACavityIsOutsideAndAnOpenMeshHasNoInside) {
  Scene scene;
  const TriangleMesh hollow =
      test::joined(test::boxMesh(glm::dvec3(4.0)), test::turned(test::boxMesh(glm::dvec3(2.0))));
  scene.add(test::partOf(test::geometryOf(hollow), "hollow"));
  const PartId core = scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "core"));
  const ClearanceMap inCavity = mapOf(scene, core, 1.0);
  for (const double distance : inCavity.surfaces.at(0).distances)
    EXPECT_NEAR(distance, 0.5, 1e-12);
  Scene open;
  TriangleMesh lidless = test::boxMesh(glm::dvec3(2.0));
  lidless = TriangleMesh({lidless.vertices().begin(), lidless.vertices().end()},
                         {lidless.triangles().begin(), lidless.triangles().end() - 1});
  open.add(test::partOf(test::geometryOf(lidless), "lidless"));
  const PartId inner = open.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "inner"));
  const ClearanceMap inOpenMesh = mapOf(open, inner, 2.0);
  for (const double distance : inOpenMesh.surfaces.at(0).distances)
    EXPECT_GT(distance, 0.0);
}

TEST(ClearanceMap, NearPartsShowWhereTheSubjectComesNear) {
  Scene scene;
  const PartId bed = scene.add(test::partOf(test::geometryOf(test::boxMesh({1.0, 1.0, 0.1})), "bed"));
  const PartId ball =
      scene.add(test::partOf(test::geometryOf(test::icosphereMesh(0.01, 3)), "ball", at(0.21, 0.13, 0.061)));
  // It touches the bed, which is of no interest, and is far from the ball.
  scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(0.1))), "post", at(-0.3, -0.3, 0.1)));
  const ClearanceMap map = mapOf(scene, ball, 0.004, true);
  ASSERT_EQ(map.surfaces.size(), 2U);
  const MappedSurface* mapped = map.find(bed);
  ASSERT_NE(mapped, nullptr);
  EXPECT_LT(mapped->surface->points.size(), 50'000U) << "fine only below the ball";
  double least = 1.0;
  std::size_t near = 0;
  for (std::size_t i = 0; i < mapped->distances.size(); ++i) {
    if (std::isnan(mapped->distances[i])) continue;
    ++near;
    least = std::min(least, mapped->distances[i]);
    EXPECT_LT(glm::distance(glm::dvec2(mapped->surface->points[i]), glm::dvec2(0.21, 0.13)), 0.015);
    EXPECT_EQ(mapped->nearest[i], ball);
  }
  EXPECT_GT(near, 50U);
  EXPECT_NEAR(least, 0.001, 3e-4);
}

TEST(ClearanceMap, HiddenPartsAreNotMeasured) {
  Scene scene;
  Part other = test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "hidden", at(0.0, 0.0, 1.1));
  other.isVisible = false;
  scene.add(other);
  const PartId subject = scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "subject"));
  const ClearanceMap map = mapOf(scene, subject, 0.5);
  EXPECT_TRUE(std::ranges::all_of(map.surfaces.at(0).distances, [](double d) { return std::isnan(d); }));
}

/// Two rough parts that are partly inside each other, with many samples.
ClearanceMapRequest roughPair() {
  Scene scene;
  const PartId subject =
      scene.add(test::partOf(test::geometryOf(test::starMesh(1, 0.5, 3, 0.3)), "subject", at(0.7, 0.1, 0.0)));
  scene.add(test::partOf(test::geometryOf(test::starMesh(2, 0.5, 3, 0.3)), "other"));
  return clearanceMapRequest(scene, subject, 0.2, true);
}

bool isSameTo(const ClearanceMap& a, const ClearanceMap& b) {
  if (a.surfaces.size() != b.surfaces.size() || a.range != b.range) return false;
  for (std::size_t i = 0; i < a.surfaces.size(); ++i) {
    const MappedSurface &p = a.surfaces[i], &q = b.surfaces[i];
    const auto isSame = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
    if (!std::ranges::equal(p.distances, q.distances, isSame) || p.nearest != q.nearest ||
        p.nearestPoints != q.nearestPoints || p.surface->points != q.surface->points)
      return false;
  }
  return true;
}

TEST(ClearanceMap, DoesNotDependOnThreads) {
  ClearanceMapRequest request = roughPair();
  ClearanceMapper mapper;
  request.isParallel = false;
  const ClearanceMap alone = mapper.map(request);
  EXPECT_GT(alone.samples(), 2'000U);
  request.isParallel = true;
  EXPECT_TRUE(isSameTo(mapper.map(request), alone));
  EXPECT_TRUE(isSameTo(ClearanceMapper().map(request), alone)) << "nothing kept";
  // Several maps at once, of one mapper, that share what threads there are.
  std::atomic<int> different{0};
  parallelFor(6, [&](std::size_t) {
    if (!isSameTo(mapper.map(request), alone)) ++different;
  });
  EXPECT_EQ(different, 0);
}

TEST(ClearanceMap, CancellingStopsItAnywhereAndProgressOnlyRises) {
  ClearanceMapRequest request = roughPair();
  // One of several threads may skip its report while another one reports.
  request.isParallel = false;
  int calls = 0;
  double last = 0.0;
  (void)ClearanceMapper().map(request, [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    last = fraction;
    ++calls;
    return true;
  });
  EXPECT_GT(calls, 3);
  EXPECT_DOUBLE_EQ(last, 1.0);
  ClearanceMapper mapper;
  for (int stop = 0; stop < 3; ++stop) {
    int left = stop;
    EXPECT_THROW((void)mapper.map(request, [&](double) { return left-- > 0; }), Cancelled) << stop;
  }
  EXPECT_TRUE(isSameTo(mapper.map(request), ClearanceMapper().map(request)))
      << "it goes on as if nothing was";
}

TEST(ClearanceMap, TooManySamplesAreSaidToBeCoarser) {
  Scene scene;
  const PartId subject = scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "subject"));
  scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "other", at(0.0, 0.0, 1.01)));
  ClearanceMapRequest request = clearanceMapRequest(scene, subject, 0.02, false);
  EXPECT_FALSE(ClearanceMapper().map(request).isCoarse);
  request.maxSamples = 2'000;
  const ClearanceMap map = ClearanceMapper().map(request);
  EXPECT_TRUE(map.isCoarse);
  EXPECT_LE(map.samples(), 2'000U);
}

TEST(ClearanceMap, WhatMakesNoSenseIsRefused) {
  Scene scene;
  const PartId part = scene.add(test::partOf(test::geometryOf(test::tetrahedronMesh()), "part"));
  EXPECT_THROW(clearanceMapRequest(scene, PartId{99}, 1.0, false), UsageError);
  EXPECT_THROW(clearanceMapRequest(scene, part, -1.0, false), UsageError);
  EXPECT_THROW(clearanceMapRequest(scene, part, std::nan(""), false), UsageError);
  EXPECT_THROW((void)ClearanceMapper().map({}), UsageError);
  const ClearanceMap alone = mapOf(scene, part, 0.0);
  EXPECT_EQ(alone.surfaces.size(), 1U) << "without another part there is nothing near";
}

TEST(ClearanceMap, TheAutomaticRangeFollowsSizeAndDistanceAndIsKeptAsLongAsItSuits) {
  EXPECT_DOUBLE_EQ(automaticRange(0.1, 0.0), 0.005);
  EXPECT_DOUBLE_EQ(automaticRange(0.1, 0.012), 0.02);
  EXPECT_DOUBLE_EQ(automaticRange(0.1, std::numeric_limits<double>::infinity()), 0.005);
  EXPECT_DOUBLE_EQ(automaticRange(0.1, 0.003, 0.02), 0.02) << "four times as much as wanted";
  EXPECT_DOUBLE_EQ(automaticRange(0.1, 0.0, 0.05), 0.005);
  EXPECT_DOUBLE_EQ(automaticRange(0.1, 0.02, 0.02), 0.05);
  Scene scene;
  const PartId subject =
      scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(0.01))), "subject"));
  scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(0.01))), "other", at(0.03, 0.0, 0.0)));
  EXPECT_DOUBLE_EQ(mapOf(scene, subject, 0.0).range, 0.05) << "one and a half times 20 mm, rounded up";
}

TEST(ClearanceMap, TheLeastDistanceIsExactWhereNoSampleIs) {
  // Two cubes on edges that cross at right angles, 10 um apart, 1.3 mm off the middle of the upper one's edge: not at
  // an equal part of it that is as long as the spacing.
  const double cos45 = std::sqrt(0.5), gap = 1e-5, halfDiagonal = 0.01 * std::sqrt(2.0);
  const double c = std::sqrt(0.5 * (1.0 + cos45)), s = std::sqrt(0.5 * (1.0 - cos45));
  const auto cube = test::geometryOf(test::boxMesh(glm::dvec3(0.02)));
  Scene scene;
  const PartId upper =
      scene.add(test::partOf(cube, "upper", {{c, s, 0.0, 0.0}, {0.0, 0.0, 2.0 * halfDiagonal + gap}}));
  scene.add(test::partOf(cube, "lower", {{c, 0.0, s, 0.0}, {0.0013, 0.0, 0.0}}));
  for (const double range : {0.0, 0.005}) {
    const ClearanceMap map = mapOf(scene, upper, range);
    const AreaByClearance areas(map.surfaces.front());
    EXPECT_GT(areas.least().value(), gap + 1e-8) << "else the samples happen to be right";
    const auto least = leastClearanceOf(map, areas);
    ASSERT_TRUE(least && least->isExact);
    EXPECT_NEAR(least->distance, gap, 1e-12);
  }
  const ClearanceMap none = mapOf(scene, upper, 5e-6);
  EXPECT_FALSE(leastClearanceOf(none, AreaByClearance(none.surfaces.front())).has_value());
}

TEST(ClearanceMap, ADepthIsThatOfTheDeepestSample) {
  Scene scene;
  const auto cube = test::geometryOf(test::boxMesh(glm::dvec3(0.02)));
  const PartId upper = scene.add(test::partOf(cube, "upper", at(0.0, 0.0, 0.019)));
  scene.add(test::partOf(test::geometryOf(test::boxMesh({0.1, 0.1, 0.02})), "lower"));
  const ClearanceMap map = mapOf(scene, upper, 0.005);
  const auto least = leastClearanceOf(map, AreaByClearance(map.surfaces.front()));
  ASSERT_TRUE(least.has_value());
  EXPECT_FALSE(least->isExact);
  EXPECT_NEAR(least->distance, -0.001, 1e-12);
}

TEST(ClearanceMap, TheAutomaticRangeTellsNarrowGapsApart) {
  // A 20th of the upper plate is 7.1 mm. More area is 0.3 mm over the lower plate than is up to there along the sides.
  Scene scene;
  const PartId upper = scene.add(
      test::partOf(test::geometryOf(test::boxMesh({0.1, 0.1, 0.01})), "upper", at(0.0, 0.0, 0.0103)));
  scene.add(test::partOf(test::geometryOf(test::boxMesh({0.3, 0.3, 0.01})), "lower"));
  EXPECT_DOUBLE_EQ(mapOf(scene, upper, 0.0).range, 5e-4) << "one and a half times 0.3 mm, rounded up";
  const ClearanceMap map = mapOf(scene, upper, 0.0);
  for (std::size_t i = 0; i < map.samples(); ++i) {
    const double distance = map.surfaces.front().distances[i];
    EXPECT_TRUE(std::isnan(distance) ? map.surfaces.front().nearest[i] == PartId{} : distance <= map.range);
  }
  // In contact over its whole face, only its sides have colours: from 0 to 7.1 mm alike.
  Part lowered = scene.get(upper);
  lowered.worldFromPart = at(0.0, 0.0, 0.01);
  scene.replace(lowered);
  EXPECT_DOUBLE_EQ(mapOf(scene, upper, 0.0).range, 0.01);
}

TEST(ClearanceMap, BetweenSamplesItIsInterpolated) {
  Scene scene;
  scene.add(test::partOf(test::geometryOf(test::boxMesh({1.0, 1.0, 0.1})), "below"));
  const PartId wall =
      scene.add(test::partOf(test::geometryOf(test::boxMesh({0.1, 0.1, 0.4})), "wall", at(0.0, 0.0, 0.3)));
  const ClearanceMap map = mapOf(scene, wall, 0.2);
  const MappedSurface& mapped = map.surfaces.at(0);
  const TriangleMesh& mesh = scene.get(wall).geometry->mesh;
  test::RandomValues random(3);
  std::size_t known = 0;
  for (std::uint32_t i = 0; i < mesh.triangles().size(); ++i) {
    const Triangle& t = mesh.triangles()[i];
    for (int round = 0; round < 50; ++round) {
      const double u = random.in(0.0, 1.0), v = random.in(0.0, 1.0 - u);
      const glm::dvec3 p = mesh.vertices()[t[0]] + u * (mesh.vertices()[t[1]] - mesh.vertices()[t[0]]) +
                           v * (mesh.vertices()[t[2]] - mesh.vertices()[t[0]]);
      const std::optional<double> found = clearanceAt(mapped, i, p);
      const double height = p.z + 0.3 - 0.05;
      EXPECT_TRUE(height <= 0.2 || !found.has_value());
      if (!found) {
        EXPECT_GT(height, 0.2 - map.range / 8.0);
        continue;
      }
      ++known;
      EXPECT_NEAR(*found, height, 1e-12) << "linear over the wall";
    }
  }
  EXPECT_GT(known, 100U);
  EXPECT_FALSE(clearanceAt(mapped, 99, glm::dvec3(0.0)).has_value());
}

}  // namespace
}  // namespace nearfit::clearance_map_test

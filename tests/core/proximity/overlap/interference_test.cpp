#include "core/proximity/overlap/interference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/exact/triangle_predicates.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/overlap/containment.h"
#include "tests/exact/exact_meeting.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/trial_share.h"

namespace nearfit::interference_test {
namespace {

using test::BodyPair;
using Kind = InterferenceKind;

RigidTransform shift(double x, double y, double z) {
  return {{1, 0, 0, 0}, {x, y, z}};
}

/// A body, its hierarchy built.
struct Built {
  explicit Built(TriangleMesh m) : mesh(std::move(m)), tree(mesh) {}
  TriangleMesh mesh;
  NormalConeTree tree;
};

Interference between(const Built& scene, const Built& part, const RigidTransform& pose = {}) {
  return findInterference(scene.tree, part.tree, pose);
}

/// The witnesses must be what the answer says, by rational arithmetic.
void expectWitnesses(const Built& scene, const Built& part, const RigidTransform& pose,
                     const Interference& found) {
  if (found.kind != Kind::SurfacesMeet) return;
  std::array<glm::dvec3, 3> a, b;
  for (std::size_t k = 0; k < 3; ++k) {
    a[k] = scene.mesh.vertices()[scene.mesh.triangles()[found.sceneTriangle][k]];
    b[k] = pose.applyToPoint(part.mesh.vertices()[part.mesh.triangles()[found.partTriangle][k]]);
  }
  EXPECT_TRUE(test::doMeetExactly(a, b));
}

/// Whether they meet, asked of both.
bool doMeet(const Built& scene, const Built& part, const RigidTransform& pose) {
  const Interference found = between(scene, part, pose);
  expectWitnesses(scene, part, pose, found);
  const bool isMeeting = found.kind == Kind::SurfacesMeet;
  EXPECT_EQ(isMeeting, test::doSurfacesMeetExactly(scene.mesh, part.mesh, pose));
  return isMeeting;
}

TEST(Interference, RandomClosedMeshesMeetWhereBruteForceSaysSo) {
  std::mt19937_64 random(3);
  int meetings = 0, others = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const BodyPair pair{"stars", test::starMesh(seed, 1.0, 2, 0.4), test::starMesh(seed + 9, 0.3, 1, 0.4)};
    const Built scene(pair.scene), part(pair.part);
    for (std::size_t i = 0; i < 24 / test::kTrialShare; ++i) {
      const RigidTransform pose = test::poseNearContact(pair, 0.3, random);
      doMeet(scene, part, pose) ? ++meetings : ++others;
    }
  }
  EXPECT_GT(meetings, 0);
  EXPECT_GT(others, 0);
}

TEST(Interference, FirstContactIsToldToTheLastBit) {
  std::mt19937_64 random(4);
  const Built scene(test::starMesh(1, 1.0, 1, 0.4)), part(test::starMesh(2, 0.5, 0, 0.4));
  for (int i = 0; i < 2; ++i) {
    RigidTransform pose = test::randomRotation(random);
    const glm::dvec3 away = test::randomRotation(random).rotation * glm::dvec3(0, 0, 1);
    double inside = 0.0, outside = 3.0;
    // A vertex of the part is within its radius of the centre: at 0 the surfaces may be apart, farther out
    // not.
    for (pose.translation = inside * away; !doMeet(scene, part, pose); pose.translation = inside * away)
      inside += 0.1;
    while (std::nextafter(inside, outside) < outside) {
      const double middle = inside + 0.5 * (outside - inside);
      if (middle <= inside || middle >= outside) break;
      pose.translation = middle * away;
      (doMeet(scene, part, pose) ? inside : outside) = middle;
    }
  }
}

TEST(Interference, BoxesThatTouchMeetAndAreApartAHairFarther) {
  const Built box(test::boxMesh({2, 2, 2}));
  const double touch = 2.0, beyond = std::nextafter(touch, 3.0);
  // Faces coplanar and shifted along; edges along each other; corners; one face on the other, aligned.
  for (const glm::dvec2 side : {glm::dvec2(0, 0), glm::dvec2(0.7, 0.3), glm::dvec2(2, 0), glm::dvec2(2, 2)}) {
    EXPECT_EQ(between(box, box, shift(touch, side.x, side.y)).kind, Kind::SurfacesMeet);
    EXPECT_EQ(between(box, box, shift(beyond, side.x, side.y)).kind, Kind::Disjoint);
  }
}

TEST(Interference, CornerOnAFaceAndOnAVertexMeets) {
  const Built box(test::boxMesh({2, 2, 2})), cone(test::coneMesh(1.0, 1.0, 7));
  // The apex points down on the top face, and on its corner.
  const RigidTransform down{{0, 1, 0, 0}, {0.25, 0.5, 2.0}}, corner{{0, 1, 0, 0}, {1, 1, 2.0}};
  for (RigidTransform pose : {down, corner}) {
    EXPECT_TRUE(doMeet(box, cone, pose));
    pose.translation.z = std::nextafter(2.0, 3.0);
    EXPECT_FALSE(doMeet(box, cone, pose));
    EXPECT_EQ(between(box, cone, pose).kind, Kind::Disjoint);
  }
}

TEST(Interference, BodyInsideASolidIsTold) {
  const Built outer(test::boxMesh({4, 4, 4})), inner(test::starMesh(1, 0.5, 1, 0.3));
  const Interference part = between(outer, inner, shift(1.0, -1.0, 0.5));
  EXPECT_EQ(part.kind, Kind::PartInside);
  EXPECT_EQ(part.sceneTriangle, Interference::kNone);
  EXPECT_EQ(part.partTriangle, 0U);
  const Interference scene = between(inner, outer, shift(1.0, -1.0, 0.5));
  EXPECT_EQ(scene.kind, Kind::SceneInside);
  EXPECT_EQ(scene.sceneTriangle, 0U);
  EXPECT_EQ(between(outer, inner, shift(3.0, 0, 0)).kind, Kind::Disjoint);
}

TEST(Interference, ComponentsKeptFromPoseToPoseChangeNoAnswer) {
  // Beside the solid an open sheet, which contains nothing.
  const Built outer(test::joined(test::boxMesh({4, 4, 4}), test::squareMesh(20.0, 1))),
      inner(test::joined(test::starMesh(1, 0.5, 1, 0.3), test::boxMesh({0.25, 0.25, 0.25}, {9, 0, 0})));
  ComponentsOnDemand outerPieces, innerPieces;
  std::mt19937_64 random(5);
  int inside = 0;
  for (int i = 0; i < 200; ++i) {
    RigidTransform pose = test::randomRotation(random);
    pose.translation = {0.05 * (i - 100), 0.7, 1.1};
    const Interference anew = between(outer, inner, pose);
    const Interference kept = findInterference({outer.tree, outerPieces}, {inner.tree, innerPieces}, pose);
    EXPECT_EQ(kept.kind, anew.kind);
    EXPECT_EQ(kept.sceneTriangle, anew.sceneTriangle);
    EXPECT_EQ(kept.partTriangle, anew.partTriangle);
    if (anew.kind != Kind::PartInside) continue;
    ++inside;
    const glm::dvec3 p =
        pose.applyToPoint(inner.mesh.vertices()[inner.mesh.triangles()[anew.partTriangle][0]]);
    EXPECT_LT(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 2.0);
  }
  EXPECT_GT(inside, 0);
}

TEST(Interference, VerticesInLineWithEdgesAreStillTold) {
  // Each corner of the small box is in line with edges or in the plane of faces of the large one's inside.
  const Built outer(test::joined(test::boxMesh({4, 4, 4}), test::turned(test::boxMesh({2, 2, 2}))));
  const Built inner(test::boxMesh({1, 1, 1}));
  EXPECT_EQ(between(outer, inner).kind, Kind::Disjoint);
  EXPECT_EQ(between(Built(test::boxMesh({4, 4, 4})), inner).kind, Kind::PartInside);
  EXPECT_EQ(between(outer, inner, shift(5.0, 0, 0)).kind, Kind::Disjoint);
}

TEST(Interference, CavityHoldsAPartThatTheWallDoesNot) {
  const Built hollow(test::joined(test::boxMesh({4, 4, 4}), test::turned(test::boxMesh({2, 2, 2}))));
  const Built inCavity(test::starMesh(1, 0.5, 1, 0.3)), inWall(test::starMesh(1, 0.2, 1, 0.3));
  EXPECT_EQ(between(hollow, inCavity).kind, Kind::Disjoint);
  EXPECT_EQ(between(hollow, inWall, shift(1.5, 0, 0)).kind, Kind::PartInside);
  EXPECT_EQ(between(hollow, inCavity, shift(0.8, 0, 0)).kind, Kind::SurfacesMeet);
}

TEST(Interference, EachPieceOfAPartCounts) {
  const Built scene(test::boxMesh({2, 2, 2}));
  const TriangleMesh piece = test::boxMesh({0.5, 0.5, 0.5});
  const Built pair(test::joined(test::transformed(piece, 1.0, shift(5, 0, 0)), piece));
  const Interference found = between(scene, pair);
  EXPECT_EQ(found.kind, Kind::PartInside);
  EXPECT_GE(found.partTriangle, 12U);
  EXPECT_EQ(between(scene, pair, shift(0, 5, 0)).kind, Kind::Disjoint);
}

TEST(Interference, SolidsThatTouchAlongAnEdgeContainAsTwo) {
  // Four faces at one edge: no manifold, yet each edge is run as often either way.
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  for (const glm::dvec3 centre : {glm::dvec3(0.0), glm::dvec3(2, 2, 0)}) {
    const TriangleMesh box = test::boxMesh({2, 2, 2}, centre);
    std::vector<std::uint32_t> index;
    for (const glm::dvec3& p : box.vertices()) {
      auto at = std::find(vertices.begin(), vertices.end(), p);
      index.push_back(static_cast<std::uint32_t>(at - vertices.begin()));
      if (at == vertices.end()) vertices.push_back(p);
    }
    for (const Triangle& t : box.triangles())
      triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
  }
  const Built two(TriangleMesh(vertices, triangles)), small(test::boxMesh({0.5, 0.5, 0.5}));
  ASSERT_GT(two.mesh.topology().nonManifoldEdges, 0U);
  EXPECT_EQ(between(two, small).kind, Kind::PartInside);
  EXPECT_EQ(between(two, small, shift(2, 2, 0)).kind, Kind::PartInside);
  EXPECT_EQ(between(two, small, shift(0, 2, 0)).kind, Kind::Disjoint);
}

TEST(Interference, OpenMeshContainsNothingButMeetsAsAnyOther) {
  const TriangleMesh box = test::boxMesh({2, 2, 2});
  const Built open(TriangleMesh({box.vertices().begin(), box.vertices().end()},
                                {box.triangles().begin(), box.triangles().end() - 1}));
  const Built small(test::boxMesh({0.5, 0.5, 0.5}));
  EXPECT_EQ(between(open, small).kind, Kind::Disjoint);
  EXPECT_EQ(between(open, small, shift(1.0, 0, 0)).kind, Kind::SurfacesMeet);
  const Built sheet(test::squareMesh(1.0, 3));
  EXPECT_EQ(between(Built(box), sheet).kind, Kind::PartInside);
  EXPECT_EQ(between(Built(box), sheet, shift(0, 0, 1.0)).kind, Kind::SurfacesMeet);
}

TEST(Interference, PointsOfStarsAreInsideWhereTheirWindingNumberSaysSo) {
  std::mt19937_64 random(8);
  const Built star(test::starMesh(5, 1.0, 3, 0.3)), speck(test::tetrahedronMesh(1e-3));
  std::uniform_real_distribution<double> coordinate(-1.2, 1.2);
  int inside = 0;
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 to{coordinate(random), coordinate(random), coordinate(random)};
    const RigidTransform pose = shift(to.x, to.y, to.z);
    const Kind kind = between(star, speck, pose).kind;
    if (kind == Kind::SurfacesMeet) continue;
    const bool isInside = test::windingNumber(star.mesh, pose.translation) > 0.5;
    EXPECT_EQ(kind, isInside ? Kind::PartInside : Kind::Disjoint);
    inside += isInside ? 1 : 0;
  }
  EXPECT_GT(inside, 20);
}

TEST(Interference, TrianglesWithoutAreaCountAsTheLinesTheyAre) {
  const Built box(test::boxMesh({2, 2, 2}));
  // A face that is a line from (0, 0, 0) to (4, 0, 0), out through a face of the box, and one that is a
  // point.
  const Built line(TriangleMesh({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}}, {{0, 1, 2}}));
  const Built point(TriangleMesh({{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}));
  EXPECT_TRUE(doMeet(box, line, {}));
  EXPECT_FALSE(doMeet(box, line, shift(0, 0, 1.5)));
  EXPECT_TRUE(doMeet(line, box, shift(0, 0, 1.0)));
  EXPECT_TRUE(doMeet(box, point, {}));
  EXPECT_FALSE(doMeet(box, point, shift(0.1, 0, 0)));
  EXPECT_TRUE(doMeet(line, point, {}));
  const Built damaged(test::withFacesWithoutArea(test::boxMesh({2, 2, 2})));
  EXPECT_EQ(between(damaged, damaged, shift(2, 0, 0)).kind, Kind::SurfacesMeet);
  EXPECT_EQ(between(damaged, damaged, shift(2.0001, 0, 0)).kind, Kind::Disjoint);
}

TEST(Interference, SliversAndNeedlesMeetWhereBruteForceSaysSo) {
  std::mt19937_64 random(5);
  for (const double aspect : {1e3, 1e9, 1e15}) {
    const BodyPair pair{"slivers", test::withSlivers(test::icosphereMesh(1.0, 1), aspect, 0.1),
                        test::withNeedles(test::icosphereMesh(0.5, 0), aspect, 0.1)};
    const Built scene(pair.scene), part(pair.part);
    for (std::size_t i = 0; i < 16 / test::kTrialShare; ++i)
      doMeet(scene, part, test::poseNearContact(pair, 0.1, random));
  }
}

TEST(Interference, FarFromTheOriginRoundedPlacesDecide) {
  const RigidTransform far{{1, 0, 0, 0}, {1e9, -2e9, 3e9}};
  const Built scene(test::transformed(test::boxMesh({2, 2, 2}), 1.0, far)), part(test::boxMesh({2, 2, 2}));
  for (const double gap : {-1e-6, 0.0, 1e-7, 1e-6, 1e-3}) {
    RigidTransform pose = far;
    pose.translation.x += 2.0 + gap;
    doMeet(scene, part, pose);
  }
  RigidTransform pose = far;
  pose.translation.x += 2.0;
  EXPECT_TRUE(doMeet(scene, part, pose));
  pose.translation.x += 1e-3;
  EXPECT_FALSE(doMeet(scene, part, pose));
}

TEST(Interference, EmptyMeshMeetsNothingAndAPoseThatIsNoNumberIsRefused) {
  const Built box(test::boxMesh({2, 2, 2})), empty{TriangleMesh()};
  EXPECT_EQ(between(box, empty).kind, Kind::Disjoint);
  EXPECT_EQ(between(empty, box).kind, Kind::Disjoint);
  EXPECT_THROW(between(box, box, shift(std::numeric_limits<double>::quiet_NaN(), 0, 0)), UsageError);
}

TEST(TrianglePredicates, CrossingThroughAnEdgeOrCornerIsUnclear) {
  const TriangleCorners t{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
  EXPECT_EQ(crossingOf({1, 1, -1}, {1, 1, 1}, t), Crossing::Out);
  EXPECT_EQ(crossingOf({1, 1, 1}, {1, 1, -1}, t), Crossing::In);
  EXPECT_EQ(crossingOf({3, 3, 1}, {3, 3, -1}, t), Crossing::None);
  EXPECT_EQ(crossingOf({1, 1, 1}, {1, 1, 2}, t), Crossing::None);
  EXPECT_EQ(crossingOf({2, 2, 1}, {2, 2, -1}, t), Crossing::Unclear);
  EXPECT_EQ(crossingOf({0, 0, 1}, {0, 0, -1}, t), Crossing::Unclear);
  EXPECT_EQ(crossingOf({5, 0, 0}, {1, 1, 1}, t), Crossing::None);
}

}  // namespace
}  // namespace nearfit::interference_test

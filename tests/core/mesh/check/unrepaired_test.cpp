#include "core/mesh/check/unrepaired.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/mesh/check/faulty_meshes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::unrepaired_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<UnrepairedKind> unrepaired(const TriangleMesh& mesh, const MeshRepairs& made = {}) {
  return unrepairedKinds(checkMesh(mesh), made);
}

std::vector<FindingKind> kindsOf(const std::vector<UnrepairedKind>& unrepaired) {
  std::vector<FindingKind> kinds;
  for (const UnrepairedKind& left : unrepaired) {
    EXPECT_FALSE(left.reason.empty());
    kinds.push_back(left.kind);
  }
  return kinds;
}

/// Findings that are left after repairs, by a check of the repaired mesh.
std::vector<UnrepairedKind> leftAfter(const TriangleMesh& mesh, const MeshRepairs& repairs) {
  return unrepaired(repairMesh(mesh, repairs).mesh, repairs);
}

/// A strip of three quadrangles, closed after half a turn.
TriangleMesh halfTurnedStrip() {
  return {{{0, 0, 0}, {0, 0, 1}, {2, 0, 0.2}, {2, 0.2, 1}, {1, 2, 0.4}, {1, 1.8, 1}},
          {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}, {4, 1, 5}, {5, 1, 0}}};
}

TEST(Unrepaired, NothingIsSaidOfASoundMeshOrOfWhatARepairMends) {
  const TriangleMesh box = test::boxMesh({3, 4, 5});
  EXPECT_THAT(unrepaired(box), IsEmpty());
  EXPECT_THAT(unrepaired(test::withoutTriangle(box, 0)), IsEmpty()) << "a hole";
  EXPECT_THAT(unrepaired(test::turned(box)), IsEmpty()) << "an inverted shell";
}

TEST(Unrepaired, NoRepairMendsSelfIntersections) {
  const TriangleMesh crossing =
      test::joined(test::boxMesh({3, 4, 5}), test::moved(test::boxMesh({3, 4, 5}), {1.0, 1.1, 1.2}));
  EXPECT_THAT(kindsOf(unrepaired(crossing)), ElementsAre(FindingKind::SelfIntersections));
}

TEST(Unrepaired, AnEdgeOfThreeFacesIsNotRepairedUnlessOneOfThemRepeatsAnother) {
  const TriangleMesh box = test::boxMesh({3, 4, 5});
  std::vector<glm::dvec3> vertices = test::verticesOf(box);
  std::vector<Triangle> triangles = test::trianglesOf(box);
  const Triangle first = triangles.front();
  // A fin along one of its edges.
  vertices.emplace_back(9.0, 9.0, 9.0);
  triangles.push_back({first[0], first[1], static_cast<std::uint32_t>(vertices.size() - 1)});
  const auto withFin = kindsOf(unrepaired({vertices, triangles}));
  EXPECT_EQ(std::ranges::count(withFin, FindingKind::NonManifoldEdges), 1);
  const auto doubled = kindsOf(unrepaired(test::withTriangle(box, first)));
  EXPECT_EQ(std::ranges::count(doubled, FindingKind::NonManifoldEdges), 0);
}

TEST(Unrepaired, HolesThatFillingHasLeftAreToldFromLargerOnes) {
  const TriangleMesh single({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  EXPECT_THAT(leftAfter(single, {{RepairKind::FillHoles, 1.0}}), IsEmpty()) << "larger than what was filled";
  const auto left = leftAfter(single, {{RepairKind::FillHoles, 2.0}});
  ASSERT_THAT(kindsOf(left), ElementsAre(FindingKind::OpenEdges));
  EXPECT_TRUE(left.front().areAll);
  // Another one beside it, ten times as large.
  const TriangleMesh two = test::joined(single, {{{20, 0, 0}, {30, 0, 0}, {20, 10, 0}}, {{0, 1, 2}}});
  const auto some = leftAfter(two, {{RepairKind::FillHoles, 2.0}});
  ASSERT_THAT(kindsOf(some), ElementsAre(FindingKind::OpenEdges));
  EXPECT_FALSE(some.front().areAll);
}

TEST(Unrepaired, ARepairThatCameLaterMayHaveOpenedWhatWasFilled) {
  const TriangleMesh single({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  EXPECT_THAT(unrepaired(single, {{RepairKind::FillHoles, 2.0}, {RepairKind::Clean}}), IsEmpty());
  EXPECT_THAT(kindsOf(unrepaired(single, {{RepairKind::FillHoles, 2.0}, {RepairKind::Orient}})),
              ElementsAre(FindingKind::OpenEdges));
}

TEST(Unrepaired, CracksAreLeftIfTheyAreNoWiderThanWhatWasStitched) {
  const TriangleMesh loose = test::boxWithALooseLid(1e-4);
  const auto isCrack = [](const UnrepairedKind& left) { return left.kind == FindingKind::HairlineCracks; };
  EXPECT_EQ(std::ranges::count_if(unrepaired(loose, {{RepairKind::Stitch, 1e-3}}), isCrack), 1);
  EXPECT_EQ(std::ranges::count_if(unrepaired(loose, {{RepairKind::Stitch, 1e-5}}), isCrack), 0);
}

TEST(Unrepaired, ASurfaceOfOneSideCannotBeOriented) {
  const auto isOfSides = [](const UnrepairedKind& left) {
    return left.kind == FindingKind::InconsistentEdges;
  };
  EXPECT_EQ(std::ranges::count_if(unrepaired(halfTurnedStrip()), isOfSides), 0) << "orienting is offered";
  const auto left = leftAfter(halfTurnedStrip(), {{RepairKind::Orient}});
  ASSERT_EQ(std::ranges::count_if(left, isOfSides), 1);
  EXPECT_EQ(std::ranges::find_if(left, isOfSides)->reason,
            "the surface has one side only, as a Moebius strip has");
}

}  // namespace
}  // namespace nearfit::unrepaired_test

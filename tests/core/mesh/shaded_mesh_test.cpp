#include "core/mesh/shaded_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/mesh/coordinate_rounding.h"
#include "core/mesh/flat_groups.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::shaded_mesh_test {
namespace {

constexpr double kDegrees30 = std::numbers::pi / 6.0;

/// Checks that the triangles are those of the mesh, with their corners at the same places.
void expectSameTriangles(const TriangleMesh& mesh, const ShadedMesh& shaded) {
  ASSERT_EQ(shaded.triangles.size(), mesh.triangles().size());
  ASSERT_EQ(shaded.normals.size(), shaded.vertices.size());
  for (std::size_t t = 0; t < shaded.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(shaded.vertices.at(shaded.triangles[t][k]), mesh.triangles()[t][k]);
  }
}

TEST(ShadedMesh, ABoxHasThreeNormalsAtEachCorner) {
  const TriangleMesh mesh = test::boxMesh(glm::dvec3(2.0));
  const ShadedMesh shaded = shadedMesh(mesh, kDegrees30);
  expectSameTriangles(mesh, shaded);
  EXPECT_EQ(shaded.vertices.size(), 24U);
  EXPECT_EQ(shaded.sharpEdges.size(), 12U);
  for (std::size_t i = 0; i < shaded.vertices.size(); ++i) {
    // On a cube of half side 1 about the origin a face's plane is n.p = 1.
    EXPECT_NEAR(glm::dot(glm::dvec3(shaded.normals[i]), mesh.vertices()[shaded.vertices[i]]), 1.0, 1e-6);
  }
}

TEST(ShadedMesh, AFineBallIsSmoothAndItsNormalsPointOut) {
  const TriangleMesh mesh = test::icosphereMesh(1e-4, 4);
  const ShadedMesh shaded = shadedMesh(mesh, kDegrees30);
  expectSameTriangles(mesh, shaded);
  EXPECT_EQ(shaded.vertices.size(), mesh.vertices().size());
  EXPECT_TRUE(shaded.sharpEdges.empty());
  for (std::size_t i = 0; i < shaded.vertices.size(); ++i) {
    const glm::dvec3 out = glm::normalize(mesh.vertices()[shaded.vertices[i]]);
    EXPECT_GT(glm::dot(glm::dvec3(shaded.normals[i]), out), 0.999);
  }
}

TEST(ShadedMesh, ACylinderIsSplitAlongItsRims) {
  constexpr std::uint32_t kSegments = 36;  // Facets meet at 10 degrees.
  const TriangleMesh mesh = test::cylinderMesh(1.0, 2.0, kSegments);
  const ShadedMesh shaded = shadedMesh(mesh, kDegrees30);
  expectSameTriangles(mesh, shaded);
  // Each vertex of a rim once for the wall and once for the cap; the middles of the caps.
  EXPECT_EQ(shaded.vertices.size(), 4U * kSegments + 2U);
  EXPECT_EQ(shaded.sharpEdges.size(), 2U * kSegments);
}

TEST(ShadedMesh, OpenAndNonManifoldEdgesAreSharpAndPassNoNormalOn) {
  EXPECT_EQ(shadedMesh(test::squareMesh(1.0, 5), kDegrees30).sharpEdges.size(), 20U);
  const ShadedMesh fins = shadedMesh(test::finsMesh(1, 3, 0.1), kDegrees30);
  EXPECT_EQ(fins.vertices.size(), 9U) << "each fin has its own";
  EXPECT_EQ(fins.sharpEdges.size(), 7U);
}

TEST(ShadedMesh, FacesWithoutAreaHaveNoNormal) {
  const TriangleMesh mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}});
  for (const glm::vec3& normal : shadedMesh(mesh, kDegrees30).normals)
    EXPECT_EQ(normal, glm::vec3(0.0F));
}

// For each face at a vertex or an edge, all others there were once looked at.
TEST(ShadedMesh, FansAndBooksOfManyFacesAreShadedLikeOthers) {
  constexpr std::uint32_t kFaces = 500'000;
  const TriangleMesh fan = test::jaggedFan(2, kFaces, 1e-9);
  const ShadedMesh flat = shadedMesh(fan, kDegrees30);
  expectSameTriangles(fan, flat);
  EXPECT_EQ(flat.sharpEdges.size(), kFaces) << "its rim";
  EXPECT_EQ(flat.vertices.size(), kFaces + 1U);
  const TriangleMesh book = test::finsMesh(3, kFaces, 6.0);
  const ShadedMesh pages = shadedMesh(book, kDegrees30);
  expectSameTriangles(book, pages);
  EXPECT_EQ(pages.vertices.size(), 3U * kFaces);
  EXPECT_EQ(pages.sharpEdges.size(), book.edges().size());
}

/// A mesh with a sliver along a side of each face, turned, and as a file holds it.
struct Slivered {
  explicit Slivered(const TriangleMesh& clean)
      : mesh(test::inSinglePrecision(test::transformed(test::withSlivers(clean, 1e7, 0.0), 1.0, place))),
        tolerance(flatTolerance(mesh, coordinateRounding(mesh.vertices()))) {}

  /// A vertex in the frame of the clean mesh.
  glm::dvec3 at(std::uint32_t vertex) const { return place.inverse().applyToPoint(mesh.vertices()[vertex]); }
  /// Total length of those edges.
  double lengthOf(const std::vector<std::uint32_t>& edges) const {
    double length = 0.0;
    for (const std::uint32_t e : edges)
      length += glm::distance(mesh.vertices()[mesh.edges()[e].v0], mesh.vertices()[mesh.edges()[e].v1]);
    return length;
  }

  RigidTransform place = RigidTransform{{0.7, -0.2, 0.4, 0.55}, {0.1, 0.2, -0.3}}.normalized();
  TriangleMesh mesh;
  double tolerance;
};

// Rounding turns slivers anywhere, so that each side of one was drawn as a sharp edge: diagonals on dense flats.
TEST(ShadedMesh, SliversInAFlatMakeNoEdges) {
  constexpr std::uint32_t kDivisions = 20;
  const Slivered flat(test::squareMesh(1.0, kDivisions));
  EXPECT_GT(shadedMesh(flat.mesh, kDegrees30).sharpEdges.size(), 10U * kDivisions) << "by their own normals";
  const ShadedMesh shaded = shadedMesh(flat.mesh, kDegrees30, flat.tolerance);
  expectSameTriangles(flat.mesh, shaded);
  for (const std::uint32_t e : shaded.sharpEdges)
    EXPECT_EQ(flat.mesh.facesOfEdge(e).size(), 1U) << "only its rim";
  EXPECT_EQ(shaded.sharpEdges.size(), 4U * kDivisions);
  const glm::dvec3 normal = flat.place.applyToVector({0.0, 0.0, 1.0});
  for (const glm::vec3& n : shaded.normals)
    EXPECT_GT(glm::dot(glm::dvec3(n), normal), 0.999);
}

TEST(ShadedMesh, SliversAlongSharpEdgesKeepThem) {
  const Slivered box(test::subdivided(test::boxMesh(glm::dvec3(1.0)), 3));
  EXPECT_GT(box.lengthOf(shadedMesh(box.mesh, kDegrees30).sharpEdges), 20.0) << "by their own normals";
  const ShadedMesh shaded = shadedMesh(box.mesh, kDegrees30, box.tolerance);
  for (const std::uint32_t e : shaded.sharpEdges) {
    int shared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = box.at(box.mesh.edges()[e].v0)[axis], b = box.at(box.mesh.edges()[e].v1)[axis];
      shared += std::abs(std::abs(a) - 0.5) < 1e-6 && std::abs(a - b) < 1e-6 ? 1 : 0;
    }
    EXPECT_GE(shared, 2) << "inside a face";
  }
  // Each of the twelve edges once, whichever side of a sliver along it is drawn.
  EXPECT_NEAR(box.lengthOf(shaded.sharpEdges), 12.0, 1e-3);
}

TEST(ShadedMesh, SliversInACurvedWallMakeNoEdges) {
  constexpr std::uint32_t kSegments = 36;
  const Slivered cylinder(test::cylinderMesh(0.4, 1.0, kSegments));
  const ShadedMesh shaded = shadedMesh(cylinder.mesh, kDegrees30, cylinder.tolerance);
  EXPECT_FALSE(shaded.sharpEdges.empty());
  for (const std::uint32_t e : shaded.sharpEdges) {
    const MeshEdge& edge = cylinder.mesh.edges()[e];
    const glm::dvec3 a = cylinder.at(edge.v0), b = cylinder.at(edge.v1);
    EXPECT_NEAR(std::abs(a.z), 0.5, 1e-6);
    EXPECT_NEAR(a.z, b.z, 1e-6) << "along the wall";
  }
}

}  // namespace
}  // namespace nearfit::shaded_mesh_test

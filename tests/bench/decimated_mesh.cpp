#include "tests/bench/decimated_mesh.h"

#include <vector>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "core/base/error.h"

namespace nearfit::bench {
namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Halfedges = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;

constexpr std::size_t kFewTriangles = 48;
/// Of a triangle, in a collapse [degrees].
constexpr float kMaxTurn = 60.0F;

Halfedges halfedgesOf(const TriangleMesh& mesh) {
  Halfedges out;
  std::vector<Halfedges::VertexHandle> vertices;
  for (const glm::dvec3& p : mesh.vertices())
    vertices.push_back(out.add_vertex({p.x, p.y, p.z}));
  for (const Triangle& t : mesh.triangles()) {
    if (!out.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]).is_valid())
      throw Error("mesh", "it is not manifold", "decimate another one");
  }
  // What ModNormalFlippingT asks.
  out.request_face_normals();
  out.update_face_normals();
  return out;
}

TriangleMesh meshOf(const Halfedges& mesh) {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  for (const auto v : mesh.vertices()) {
    const OpenMesh::Vec3d& p = mesh.point(v);
    vertices.emplace_back(p[0], p[1], p[2]);
  }
  for (const auto f : mesh.faces()) {
    Triangle& t = triangles.emplace_back();
    std::size_t k = 0;
    for (const auto v : mesh.fv_range(f))
      t[k++] = static_cast<std::uint32_t>(v.idx());
  }
  return TriangleMesh(std::move(vertices), std::move(triangles));
}

}  // namespace

TriangleMesh decimatedMesh(const TriangleMesh& mesh, std::size_t factor) {
  if (mesh.triangles().size() < kFewTriangles) return mesh;
  Halfedges halfedges = halfedgesOf(mesh);
  OpenMesh::Decimater::DecimaterT<Halfedges> decimater(halfedges);
  OpenMesh::Decimater::ModQuadricT<Halfedges>::Handle quadric;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
  // Within a plane every collapse is for free, those that fold the surface over itself as well.
  OpenMesh::Decimater::ModNormalFlippingT<Halfedges>::Handle flipping;
  decimater.add(flipping);
  decimater.module(flipping).set_max_normal_deviation(kMaxTurn);
  decimater.initialize();
  decimater.decimate_to_faces(0, mesh.triangles().size() / factor);
  halfedges.garbage_collection();
  return meshOf(halfedges);
}

}  // namespace nearfit::bench

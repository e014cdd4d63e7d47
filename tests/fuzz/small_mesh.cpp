#include "tests/fuzz/small_mesh.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/mesh/mesh_builder.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::fuzz {
namespace {

using Faces = std::vector<Triangle>;

TriangleMesh simpleSolid(std::size_t kind) {
  switch (kind) {
    case 1:
      return test::tetrahedronMesh();
    case 2:
      return test::boxMesh({1.0, 1.0, 1.0});
    case 3:
      return test::boxMesh({2.0, 0.5, 0.25});
    case 4:
      return test::uvSphereMesh(1.0, 4, 2);
    case 5:
      return test::coneMesh(1.0, 1.0, 5);
    case 6:
      return test::squareMesh(1.0, 1);
    case 7:
      return test::wedgeMesh(0.5);
    case 8:
      return test::joined(test::tetrahedronMesh(),
                          test::transformed(test::tetrahedronMesh(), 0.5, {{1, 0, 0, 0}, {0.3, 0, 0}}));
    default:
      return test::tubeMesh(0.5, 1.0, 1.0, 3);
  }
}

/// Moves a vertex, or makes one of others.
glm::dvec3 changed(ByteSource& bytes, const glm::dvec3& old, const std::vector<glm::dvec3>& all) {
  const auto other = [&] { return all.empty() ? glm::dvec3(0.0) : all[bytes.below(all.size())]; };
  constexpr double kRounding = 2.2e-16, kWeld = 1e-9;
  switch (bytes.below(7)) {
    case 0:
      return bytes.vector();
    case 1:
      return other();
    case 2:
      return old * (1.0 + kRounding * static_cast<double>(bytes.raw<std::int8_t>()));
    case 3:
      return other() + kWeld * bytes.vector();
    case 4: {
      const glm::dvec3 a = other(), b = other();
      return a + bytes.number() * (b - a);
    }
    case 5: {
      const glm::dvec3 a = other(), b = other(), c = other();
      return a + bytes.number() * (b - a) + bytes.number() * (c - a);
    }
    default:
      return {old.x, old.y, bytes.number()};
  }
}

void changeVertices(ByteSource& bytes, std::vector<glm::dvec3>& vertices) {
  for (std::size_t i = bytes.below(16); i > 0; --i) {
    const std::size_t at = bytes.below(vertices.size() + 1);
    const glm::dvec3 old = at < vertices.size() ? vertices[at] : glm::dvec3(0.0);
    const glm::dvec3 v = changed(bytes, old, vertices);
    if (at < vertices.size()) {
      vertices[at] = v;
    } else if (at < kMaxVertices) {
      vertices.push_back(v);
    }
  }
}

void changeFaces(ByteSource& bytes, Faces& faces, std::size_t vertices) {
  for (std::size_t i = bytes.below(16); i > 0; --i) {
    const std::size_t at = bytes.below(kMaxTriangles + 1);
    const auto corner = [&] { return static_cast<std::uint32_t>(bytes.below(vertices)); };
    if (at >= faces.size()) {
      faces.push_back({corner(), corner(), corner()});
    } else if (bytes.flag()) {
      std::swap(faces[at][0], faces[at][1]);
    } else {
      faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(at));
    }
  }
}

/// Least height of a triangle over its longest side, the least of all.
double slimmest(const TriangleMesh& mesh) {
  double least = 1.0;
  for (const Triangle& t : mesh.triangles()) {
    const auto v = mesh.vertices();
    const glm::dvec3 a = v[t[1]] - v[t[0]], b = v[t[2]] - v[t[0]];
    const double longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(a - b, a - b)});
    least = std::min(least, glm::length(glm::cross(a, b)) / longest);
  }
  return least;
}

double shortestEdge(const TriangleMesh& mesh) {
  double least = mesh.bounds().diagonal();
  for (const MeshEdge& e : mesh.edges())
    least = std::min(least, glm::distance(mesh.vertices()[e.v0], mesh.vertices()[e.v1]));
  return least;
}

}  // namespace

PolygonSoup smallSoup(ByteSource& bytes) {
  std::vector<glm::dvec3> vertices;
  Faces faces;
  if (const std::size_t kind = bytes.below(10); kind != 0) {
    const TriangleMesh solid = simpleSolid(kind);
    vertices.assign(solid.vertices().begin(), solid.vertices().end());
    faces.assign(solid.triangles().begin(), solid.triangles().end());
  }
  changeVertices(bytes, vertices);
  PolygonSoup soup;
  if (vertices.empty()) return soup;
  changeFaces(bytes, faces, vertices.size());
  const int exponent = bytes.raw<std::int8_t>() / 4;
  const glm::dvec3 shift = bytes.flag() ? bytes.vector() : glm::dvec3(0.0);
  for (const glm::dvec3& v : vertices)
    soup.vertices.push_back(
        glm::dvec3(std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)) + shift);
  for (const Triangle& t : faces) {
    soup.corners.insert(soup.corners.end(), t.begin(), t.end());
    soup.closePolygon();
  }
  return soup;
}

std::optional<TriangleMesh> smallMesh(ByteSource& bytes) {
  const PolygonSoup soup = smallSoup(bytes);
  if (soup.vertices.empty()) return std::nullopt;
  try {
    MeshBuildReport report;
    return buildMesh(soup, {}, report);
  } catch (const Error&) {
    return std::nullopt;
  }
}

RigidTransform smallPose(ByteSource& bytes) {
  RigidTransform pose;
  constexpr std::array<double, 4> kTurns{0.0, 1e-12, 1e-6, 0.01};
  switch (bytes.below(3)) {
    case 0:
      break;
    case 1:
      pose.rotation = {
          static_cast<double>(bytes.raw<std::int8_t>()), static_cast<double>(bytes.raw<std::int8_t>()),
          static_cast<double>(bytes.raw<std::int8_t>()), static_cast<double>(bytes.raw<std::int8_t>())};
      break;
    default: {
      constexpr double kQuarter = 1.5707963267948966;
      const std::array<double, 3> turns{static_cast<double>(bytes.below(4)),
                                        static_cast<double>(bytes.below(4)),
                                        kTurns[bytes.below(kTurns.size())]};
      pose.rotation = glm::angleAxis(kQuarter * turns[0], glm::dvec3(0, 0, 1)) *
                      glm::angleAxis(kQuarter * turns[1] + turns[2], glm::dvec3(1, 0, 0));
    }
  }
  pose.translation = bytes.vector();
  if (!isFinite(pose.translation)) pose.translation = glm::dvec3(0.0);
  return pose.normalized();
}

bool isPromised(const TriangleMesh& mesh) {
  constexpr double kMin = 1e-6, kMax = 1e6, kFarthest = 1e6, kSlimmest = 1e-6, kDetail = 1e-6;
  const double size = mesh.bounds().diagonal();
  return size >= kMin && size <= kMax && glm::length(mesh.bounds().centre()) <= kFarthest * size &&
         slimmest(mesh) >= kSlimmest && shortestEdge(mesh) >= kDetail * size;
}

bool isPromised(const TriangleMesh& scene, const TriangleMesh& part, const RigidTransform& pose) {
  constexpr double kRatio = 1e6, kFarthest = 1e6;
  const double a = scene.bounds().diagonal(), b = part.bounds().diagonal();
  return isPromised(scene) && isPromised(part) && a <= kRatio * b && b <= kRatio * a &&
         glm::length(pose.translation) <= kFarthest * std::max(a, b);
}

}  // namespace nearfit::fuzz

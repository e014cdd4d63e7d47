#include "core/mesh/solidity.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

/// The first of the vertices that are connected with one.
std::uint32_t rootOf(std::vector<std::uint32_t>& parent, std::uint32_t vertex) {
  while (parent[vertex] != vertex)
    vertex = parent[vertex] = parent[parent[vertex]];
  return vertex;
}

}  // namespace

bool isSolidThroughout(const TriangleMesh& mesh) {
  if (!mesh.topology().isClosed() || !mesh.topology().isOriented()) return false;
  std::vector<std::uint32_t> parent(mesh.vertices().size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (const Triangle& t : mesh.triangles()) {
    parent[rootOf(parent, t[1])] = rootOf(parent, t[0]);
    parent[rootOf(parent, t[2])] = rootOf(parent, t[0]);
  }
  // Pieces that share a vertex count as one.
  const glm::dvec3 origin = mesh.bounds().centre();
  std::vector<double> volume(parent.size(), 0.0);
  for (const Triangle& t : mesh.triangles()) {
    const glm::dvec3 a = mesh.vertices()[t[0]] - origin, b = mesh.vertices()[t[1]] - origin,
                     c = mesh.vertices()[t[2]] - origin;
    volume[rootOf(parent, t[0])] += glm::dot(a, glm::cross(b, c));
  }
  return std::all_of(mesh.triangles().begin(), mesh.triangles().end(),
                     [&](const Triangle& t) { return volume[rootOf(parent, t[0])] > 0.0; });
}

}  // namespace nearfit

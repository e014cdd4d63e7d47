#include "tests/support/surface_hits.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace nearfit::test {

SurfaceHit hitBy(const TriangleMesh& mesh, const glm::dvec3& from, const glm::dvec3& towards) {
  const glm::dvec3 along = glm::normalize(towards - from);
  SurfaceHit hit;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < mesh.triangles().size(); ++i) {
    const Triangle& t = mesh.triangles()[i];
    const glm::dvec3 a = mesh.vertices()[t[0]], b = mesh.vertices()[t[1]], c = mesh.vertices()[t[2]];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double distance = glm::dot(a - from, normal) / glm::dot(along, normal);
    if (!(distance > 0.0) || !(distance < nearest)) continue;
    const glm::dvec3 p = from + distance * along;
    const double inside = -1e-9 * glm::dot(normal, normal);
    if (glm::dot(glm::cross(b - a, p - a), normal) < inside ||
        glm::dot(glm::cross(c - b, p - b), normal) < inside ||
        glm::dot(glm::cross(a - c, p - c), normal) < inside)
      continue;
    nearest = distance;
    hit = {i, p};
  }
  EXPECT_TRUE(std::isfinite(nearest)) << "nothing was hit";
  return hit;
}

}  // namespace nearfit::test

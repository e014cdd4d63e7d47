#include "tests/support/point_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace nearfit::test {
namespace {

using Number = long double;
using Vector = glm::vec<3, Number>;

Number toSegment(const Vector& a, const Vector& b, const Vector& p) {
  const Vector along = b - a;
  const Number square = glm::dot(along, along);
  const Number share =
      square > 0.0L ? std::clamp(glm::dot(p - a, along) / square, Number(0), Number(1)) : Number(0);
  return glm::length(a + share * along - p);
}

/// By the normal equations: the foot of the point is within the triangle if both its shares are.
Number toTriangle(const Vector& a, const Vector& b, const Vector& c, const Vector& p) {
  const Number sides = std::min({toSegment(a, b, p), toSegment(b, c, p), toSegment(c, a, p)});
  const Vector u = b - a, v = c - a, w = p - a;
  const Number uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v);
  const Number wu = glm::dot(w, u), wv = glm::dot(w, v), determinant = uu * vv - uv * uv;
  if (!(determinant > 0.0L)) return sides;
  const Number s = (wu * vv - wv * uv) / determinant, t = (wv * uu - wu * uv) / determinant;
  if (!(s >= 0.0L && t >= 0.0L && s + t <= 1.0L)) return sides;
  return std::min(sides, glm::length(a + s * u + t * v - p));
}

}  // namespace

double distanceToMesh(const TriangleMesh& mesh, const glm::dvec3& point) {
  Number least = std::numeric_limits<Number>::infinity();
  const auto at = [&mesh](std::uint32_t vertex) { return Vector(mesh.vertices()[vertex]); };
  for (const Triangle& t : mesh.triangles())
    least = std::min(least, toTriangle(at(t[0]), at(t[1]), at(t[2]), Vector(point)));
  return static_cast<double>(least);
}

}  // namespace nearfit::test

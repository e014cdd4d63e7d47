#include "tests/exact/exact_meeting.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <CGAL/Gmpq.h>
#include <glm/geometric.hpp>

#include "core/math/aabb.h"

namespace nearfit::test {
namespace {

using Number = CGAL::Gmpq;
using Corners = std::array<glm::dvec3, 3>;

struct Vector {
  Number x, y, z;
};
Vector difference(const glm::dvec3& a, const glm::dvec3& b) {
  return {Number(a.x) - Number(b.x), Number(a.y) - Number(b.y), Number(a.z) - Number(b.z)};
}
Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Number dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
bool isZero(const Vector& v) {
  return v.x == 0 && v.y == 0 && v.z == 0;
}

bool isZeroOn(const Vector& a, const Vector& b) {
  return isZero(cross(a, b)) && dot(a, b) <= 0;
}

bool isZeroIn(const Vector& a, const Vector& b, const Vector& c) {
  const Vector n = cross(b - a, c - a);
  if (isZero(n) || dot(n, a) != 0) return false;
  return dot(cross(a, b), n) >= 0 && dot(cross(b, c), n) >= 0 && dot(cross(c, a), n) >= 0;
}

bool isZeroIn(const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
  const Number volume = dot(cross(b - a, c - a), d - a);
  if (volume == 0) return false;
  // Zero in the place of each corner in turn: no volume turns round.
  const std::array<Number, 4> parts{dot(cross(b, c), d), -dot(cross(a, c), d), dot(cross(a, b), d),
                                    -dot(cross(a, b), c)};
  for (const Number& part : parts) {
    if (part * volume < 0) return false;
  }
  return true;
}

bool isBeyond(const std::vector<Vector>& points, const Vector& axis) {
  int above = 0, below = 0;
  for (const Vector& p : points) {
    const Number height = dot(p, axis);
    above += height > 0 ? 1 : 0;
    below += height < 0 ? 1 : 0;
  }
  const int all = static_cast<int>(points.size());
  return above == all || below == all;
}

Vector normalOf(const Corners& t) {
  return cross(difference(t[1], t[0]), difference(t[2], t[0]));
}

Aabb boxOf(const Corners& t) {
  Aabb box;
  for (const glm::dvec3& p : t)
    box.add(p);
  return box;
}

Corners placed(const TriangleMesh& mesh, const Triangle& t, const RigidTransform* pose) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 p = mesh.vertices()[t[k]];
    corners[k] = pose == nullptr ? p : pose->applyToPoint(p);
  }
  return corners;
}

}  // namespace

bool doMeetExactly(const Corners& a, const Corners& b) {
  std::vector<Vector> d;
  for (const glm::dvec3& p : a) {
    for (const glm::dvec3& q : b)
      d.push_back(difference(p, q));
  }
  // Quick to show that zero is not in their hull, mostly.
  if (isBeyond(d, normalOf(a)) || isBeyond(d, normalOf(b))) return false;
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (isZero(d[i])) return true;
    for (std::size_t j = 0; j < i; ++j) {
      if (isZeroOn(d[i], d[j])) return true;
      for (std::size_t k = 0; k < j; ++k) {
        if (isZeroIn(d[i], d[j], d[k])) return true;
        for (std::size_t l = 0; l < k; ++l) {
          if (isZeroIn(d[i], d[j], d[k], d[l])) return true;
        }
      }
    }
  }
  return false;
}

bool doSurfacesMeetExactly(const TriangleMesh& scene, const TriangleMesh& part,
                           const RigidTransform& sceneFromPart) {
  for (const Triangle& t : part.triangles()) {
    const Corners b = placed(part, t, &sceneFromPart);
    const Aabb box = boxOf(b);
    for (const Triangle& s : scene.triangles()) {
      const Corners a = placed(scene, s, nullptr);
      const Aabb other = boxOf(a);
      bool isApart = false;
      for (glm::length_t i = 0; i < 3; ++i)
        isApart = isApart || box.lower[i] > other.upper[i] || other.lower[i] > box.upper[i];
      if (!isApart && doMeetExactly(a, b)) return true;
    }
  }
  return false;
}

double windingNumber(const TriangleMesh& mesh, const glm::dvec3& point) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles()) {
    const glm::dvec3 a = mesh.vertices()[t[0]] - point, b = mesh.vertices()[t[1]] - point,
                     c = mesh.vertices()[t[2]] - point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    sum += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                            la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return sum / (4.0 * std::numbers::pi);
}

}  // namespace nearfit::test

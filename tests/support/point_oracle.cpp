#include "tests/support/point_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace nearfit::test {
namespace {

/// Numbers of 113 bits: the normal equations of a triangle lose twice the digits of its aspect ratio.
__extension__ using Quad = __float128;

template <class Number>
using Vector = std::array<Number, 3>;

template <class Number>
Vector<Number> wide(const glm::dvec3& p) {
  return {static_cast<Number>(p.x), static_cast<Number>(p.y), static_cast<Number>(p.z)};
}

template <class Number>
Vector<Number> difference(const Vector<Number>& a, const Vector<Number>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class Number>
Number dot(const Vector<Number>& a, const Vector<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Distance from the origin to a + s u + t v.
template <class Number>
long double lengthAt(const Vector<Number>& a, Number s, const Vector<Number>& u, Number t,
                     const Vector<Number>& v) {
  const Vector<Number> p{a[0] + s * u[0] + t * v[0], a[1] + s * u[1] + t * v[1], a[2] + s * u[2] + t * v[2]};
  return std::sqrt(static_cast<long double>(dot(p, p)));
}

/// Corners relative to the point.
template <class Number>
long double toSegment(const Vector<Number>& a, const Vector<Number>& b) {
  const Vector<Number> along = difference(b, a);
  const Number square = dot(along, along), zero = 0, one = 1;
  const Number share = square > zero ? std::clamp(-dot(a, along) / square, zero, one) : zero;
  return lengthAt(a, share, along, zero, along);
}

/// By the normal equations: the foot of the point is within the triangle if both its shares are.
/// @param isPoor  Set if these numbers are too short for so thin a triangle.
template <class Number>
long double toTriangle(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& point, bool& isPoor) {
  const Vector<Number> p = wide<Number>(point);
  const Vector<Number> a = difference(wide<Number>(corners[0]), p),
                       b = difference(wide<Number>(corners[1]), p),
                       c = difference(wide<Number>(corners[2]), p);
  const long double sides = std::min({toSegment(a, b), toSegment(b, c), toSegment(c, a)});
  const Vector<Number> u = difference(b, a), v = difference(c, a);
  const Number uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = -dot(a, u), wv = -dot(a, v);
  const Number determinant = uu * vv - uv * uv;
  // Aspect ratios to a hundred: four of the 19 digits.
  isPoor = determinant < static_cast<Number>(1e-4L) * uu * vv;
  if (!(determinant > Number(0))) return sides;
  const Number s = (wu * vv - wv * uv) / determinant, t = (wv * uu - wu * uv) / determinant;
  if (!(s >= Number(0) && t >= Number(0) && s + t <= Number(1))) return sides;
  return std::min(sides, lengthAt(a, s, u, t, v));
}

}  // namespace

double distanceToMesh(const TriangleMesh& mesh, const glm::dvec3& point) {
  long double least = std::numeric_limits<long double>::infinity();
  for (const Triangle& t : mesh.triangles()) {
    const std::array corners{mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]};
    bool isPoor = false;
    long double found = toTriangle<long double>(corners, point, isPoor);
    if (isPoor) found = toTriangle<Quad>(corners, point, isPoor);
    least = std::min(least, found);
  }
  return static_cast<double>(least);
}

}  // namespace nearfit::test

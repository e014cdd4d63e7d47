#include "core/mesh/mass_properties.h"

#include <algorithm>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/mesh/oriented_box.h"

namespace nearfit {
namespace {

/// A closed mesh with less volume than this fraction of area times size is a sheet: its volume is rounding
/// (1e-16 of area times size), and its inertia would be singular.
constexpr double kMinThickness = 1e-12;
/// Min thickness and width of the substitute box, as a fraction of its length.
constexpr double kMinBoxThickness = 1e-3;

/// Sums over the tetrahedra between a reference point and each face.
struct Moments {
  double volume = 0.0, area = 0.0;
  glm::dvec3 first{0.0};   ///< Integral of position.
  glm::dmat3 second{0.0};  ///< Integral of position times its transpose.
};

/// Relative to `origin`, so that a mesh far from the frame's origin loses no precision.
Moments momentsAbout(const TriangleMesh& mesh, const glm::dvec3& origin) {
  Moments sum;
  for (const Triangle& t : mesh.triangles()) {
    const glm::dvec3 a = mesh.vertices()[t[0]] - origin, b = mesh.vertices()[t[1]] - origin,
                     c = mesh.vertices()[t[2]] - origin;
    const double volume6 = glm::dot(a, glm::cross(b, c));
    const glm::dvec3 corners = a + b + c;
    sum.volume += volume6 / 6.0;
    sum.area += 0.5 * glm::length(glm::cross(b - a, c - a));
    sum.first += volume6 / 24.0 * corners;
    sum.second += volume6 / 120.0 *
                  (glm::outerProduct(corners, corners) + glm::outerProduct(a, a) + glm::outerProduct(b, b) +
                   glm::outerProduct(c, c));
  }
  return sum;
}

/// Inertia tensor from second moments about the same point.
glm::dmat3 inertiaOf(const glm::dmat3& second) {
  return glm::dmat3(second[0][0] + second[1][1] + second[2][2]) - second;
}

std::optional<MassProperties> fromVolume(const TriangleMesh& mesh) {
  if (!mesh.topology().isClosed() || !mesh.topology().isOriented()) return std::nullopt;
  const glm::dvec3 origin = mesh.bounds().centre();
  const Moments moments = momentsAbout(mesh, origin);
  if (!(moments.volume > kMinThickness * moments.area * mesh.bounds().diagonal())) return std::nullopt;
  const glm::dvec3 centre = moments.first / moments.volume;
  const glm::dmat3 second = moments.second - moments.volume * glm::outerProduct(centre, centre);
  return MassProperties{moments.volume, origin + centre, inertiaOf(second), MassBasis::VolumeIntegrals};
}

MassProperties fromBox(OrientedBox box) {
  const double longest = std::max({box.halfSize.x, box.halfSize.y, box.halfSize.z});
  box.halfSize = glm::max(box.halfSize, glm::dvec3(kMinBoxThickness * longest));
  const glm::dvec3 moments = box.volume() / 3.0 * box.halfSize * box.halfSize;
  glm::dmat3 second(0.0);
  for (int i = 0; i < 3; ++i)
    second += moments[i] * glm::outerProduct(box.axes[i], box.axes[i]);
  return {box.volume(), box.centre, inertiaOf(second), MassBasis::OrientedBox};
}

}  // namespace

const char* nameOf(MassBasis basis) noexcept {
  return basis == MassBasis::VolumeIntegrals ? "volume integrals" : "oriented box";
}

MassProperties massProperties(const TriangleMesh& mesh) {
  if (const std::optional<MassProperties> exact = fromVolume(mesh)) return *exact;
  return fromBox(orientedBox(mesh));
}

}  // namespace nearfit

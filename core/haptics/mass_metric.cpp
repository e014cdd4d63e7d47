#include "core/haptics/mass_metric.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/math/symmetric_eigen.h"

namespace nearfit {
namespace {

/// Distance of the farthest vertex that a triangle uses; unused vertices are not part of the surface.
double farthestVertex(const TriangleMesh& mesh, const glm::dvec3& centre) {
  double farthest = 0.0;
  for (const Triangle& triangle : mesh.triangles()) {
    for (const std::uint32_t vertex : triangle)
      farthest = std::max(farthest, glm::distance(mesh.vertices()[vertex], centre));
  }
  return farthest;
}

/// Rotation from orthonormal axes, which may be left-handed.
glm::dquat rotationFromAxes(const std::array<glm::dvec3, 3>& axes) {
  return glm::normalize(glm::quat_cast(glm::dmat3(axes[0], axes[1], glm::cross(axes[0], axes[1]))));
}

/// Limits the gyration: partly inverted surfaces can have impossible moments, even negative ones.
double safeGyration(double momentOverMass, double radius) {
  const double gyration = momentOverMass > 0.0 ? std::sqrt(momentOverMass) : 0.0;
  return std::clamp(gyration, kMinGyration * radius, radius);
}

}  // namespace

MassMetric massMetric(const MassProperties& mass, const TriangleMesh& mesh) {
  MassMetric metric;
  metric.radius = farthestVertex(mesh, mass.centre);
  if (!(metric.radius > 0.0)) return metric;
  // Divide first: products of the moments of a micrometre-sized body would underflow.
  const glm::dmat3 inertiaOverMass = mass.volume > 0.0 ? mass.inertia / mass.volume : glm::dmat3(0.0);
  const SymmetricEigen principal = symmetricEigen(inertiaOverMass);
  metric.partFromPrincipal = rotationFromAxes(principal.vectors);
  for (int i = 0; i < 3; ++i)
    metric.gyration[i] = safeGyration(principal.values[static_cast<std::size_t>(i)], metric.radius);
  return metric;
}

}  // namespace nearfit
